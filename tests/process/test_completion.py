"""Completion of linuxcnc-ctl in a real bash, zsh and fish: what pressing TAB offers."""

import shutil
import subprocess
import sys

import pytest

from tests.support.machine import ROOT

pytestmark = pytest.mark.process

# Each script gets the interpreter, then the words of a command line, the last of which is being typed
PRESS_TAB = {
    "bash": """
source <("$1" -m linuxcnc.ctl completion bash)
COMP_WORDS=("${@:2}")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_linuxcnc_ctl
printf '%s\\n' "${COMPREPLY[@]}"
""",
    # A completing zsh offers what compadd takes; here it prints what fits the word
    "zsh": """
compdef() {}
offer() { for one in "$@"; do [[ $one == "${words[CURRENT]}"* ]] && print -r -- $one; done }
compadd() { shift; offer "$@"; }
_describe() { offer "${(@)${(P)2}%%:*}"; }
_files() { offer *(N); }
eval "$($1 -m linuxcnc.ctl completion zsh)"
words=("${@:2}") CURRENT=$(($# - 1))
_linuxcnc_ctl
true
""",
    "fish": """
$argv[1] -m linuxcnc.ctl completion fish | source
complete -C (string join -- ' ' $argv[2..]) | string replace -r '\\t.*' ''
true
""",
}


def offered(shell, folder, *words):
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not installed")
    name = ["--"] if shell == "fish" else [shell]
    result = subprocess.run(
        [program, "-c", PRESS_TAB[shell], *name, sys.executable, "linuxcnc-ctl", *words],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin", "HOME": str(folder)},
        check=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert result.stderr == ""
    return result.stdout.split()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["o"], ["on", "off", "override"]),
        (["--n"], ["--namespace"]),
        (["--namespace", "mill", "wat"], ["watch"]),
        (["status", "--"], ["--help", "--json", "--watch"]),
        (["jog", "x", "1", "--sp"], ["--speed"]),
        (["run", "pa"], ["part.ngc"]),
        (["mdi", "pa"], []),
        (["completion", "z"], ["zsh"]),
    ],
)
def test_tab_offers_what_the_command_knows(tmp_path, shell, words, expected):
    (tmp_path / "part.ngc").touch()
    assert sorted(offered(shell, tmp_path, *words)) == sorted(expected)
