"""What a tired user types: a mistake gets one clear line and a code that is not 0, and leaves the session working."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from hal.interactive import run as run_shell
from hal.session import Session
from tests.support.halsession import environment, halcmd, run

pytestmark = pytest.mark.process

PATIENCE_S = 30.0


@pytest.fixture
def session(own_namespace: str) -> Iterator[None]:
    """A thread that is running, with a component in it."""
    loads = "loadrt threads name1=servo period1=1000000\nloadrt and2 count=2\nloadrt sum2 names=s\n"
    assert run("halcmd", "-f", given=loads + "addf and2.0 servo\naddf s servo\nstart\n").returncode == 0
    yield
    assert run("halrun", "-U").returncode == 0


MISTAKES = {
    "setp and2.0.in 1": "did you mean 'and2.0.in",
    "setp and2.0.in0 maybe": "'maybe' invalid for bit; 1, TRUE, 0 or FALSE would be right",
    "setp s.in0 1,5": "'1,5' invalid for float",
    "setp s.out 1": "its component 'sum2' drives it",
    "and2.0.in0=1": "'and2.0.in0 = 1' would be right",
    "SETP s.in0 1": "did you mean 'setp'?",
    "net x and2.0.out and2.1.out": "it already has OUT pin 'and2.0.out'",
    "net x and2.0.out s.in0": "of type 'bit' cannot add pin 's.in0' of type 'float'",
    "net and2.0.out and2.1.in0": "Did you omit the signal name?",
    "net x and2.0.out -> and2.1.in0": "'->' is no arrow; => would be right",
    "net x and2.0.out, and2.1.in0": "did you mean 'and2.0.out'?",
    'print "not closed': "unterminated quoted string",
    "setp s.in0 [AXIS](MAX": "Missing close parenthesis",
    "setp s.in0 [AXIS]MAX": "no INI file was given",
    "loadrt sigen": "did you mean 'siggen'?",
    "loadrt xor2 count=two": "count=two: whole numbers",
    "loadrt xor2 names=and2.0": "duplicate",
    "loadrt threads name1=servo": "already exists",
    "addf and2.1 sevro": "did you mean 'servo'?",
    "addf and2.1 servo 9": "too high",
    "addf s servo": "may only be added to one thread",
    "unloadrt and3": "did you mean 'and2'?",
    "loadusr no-such-program": "not found",
    "loadusr ./not-executable": "is no executable file; 'chmod +x ./not-executable' would make it one",
    "show pins": "did you mean 'pin'?",
    "save all /no/such/folder": "cannot write '/no/such/folder': No such file or directory",
    "save all /dev/full": "cannot write '/dev/full': No space left on device",
    "source gone.hal": "Could not open",
    f"source {'x' * 300}.hal": "Could not open",
    "source itself.hal": "is being executed already",
    "loadrt ./nothing.py": "nothing.py: there is no function load(host, args)",
    "loadrt ./fails.py": "fails.py:2: ZeroDivisionError: division by zero",
    "loadrt ./unfinished.py": "unfinished.py:1: SyntaxError",
    "loadrt ./lacks.py": "lacks.py cannot be loaded: No module named 'no_such_module'",
    "loadrt ./junk.so": "junk.so cannot be loaded: ",
}
FILES = {
    "itself.hal": "source itself.hal\n",
    "not-executable": "",
    "nothing.py": "answer = 42\n",
    "fails.py": "def load(host, args):\n    1 / 0\n",
    "lacks.py": "import no_such_module\n",
    "junk.so": "junk",
    "unfinished.py": "def load(host, args)\n    pass\n",
}


def saved() -> str:
    """What the session is made of, without values that change by themselves."""
    return "".join(halcmd("save", kind) for kind in ("comp", "sig", "netla", "thread"))


def test_each_mistake_gets_one_clear_line_and_leaves_the_session_working(session: None, tmp_path: Path) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    before = saved()
    done = run("halcmd", "-k", "-f", cwd=tmp_path, given="".join(line + "\n" for line in MISTAKES))
    assert (done.returncode, done.stdout) == (1, "")
    told: dict[int, list[str]] = {}
    for line in done.stderr.splitlines():
        place, _, text = line.partition(": ")
        if place.startswith("<stdin>:"):
            told.setdefault(int(place.removeprefix("<stdin>:")), []).append(text)
    for number, (mistake, what) in enumerate(MISTAKES.items(), 1):
        assert len(told.get(number, [])) == 1, (mistake, done.stderr)
        assert what in told[number][0] or (mistake.startswith("source") and what in done.stderr), mistake
    assert "Traceback" not in done.stderr
    assert saved() == before
    assert halcmd("getp", "s.out") == "0\n"


@pytest.mark.parametrize("period", ["-1000", "1", "999"])
def test_a_period_that_no_thread_can_keep_is_refused(own_namespace: str, period: str) -> None:
    done = run("halrun", "-f", given=f"loadrt threads name1=t period1={period}\n")
    assert done.returncode == 1
    assert f"period1={period}: from 1000 (ns) would be right, or 0 for no thread" in done.stderr


def test_a_file_with_a_byte_order_mark_and_dos_lines_is_read(own_namespace: str, tmp_path: Path) -> None:
    (tmp_path / "dos.hal").write_bytes(b"\xef\xbb\xbfnewsig a bit\r\nsets a 1\r\ngets a\r\n")
    done = run("halrun", "-f", str(tmp_path / "dos.hal"))
    assert (done.returncode, done.stdout) == (0, "TRUE\n")


@pytest.mark.parametrize("program", ["halcmd", "halrun"])
def test_output_that_cannot_be_written_gets_one_line(own_namespace: str, program: str) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", f"hal.{program}", "-f"], input="show all\n", stdout=full, stderr=subprocess.PIPE,
            text=True, env=environment(), timeout=60, check=False,
        )  # fmt: skip
    assert done.returncode != 0
    assert done.stderr.splitlines() == [f"{program}: cannot write: No space left on device"]


def test_a_closed_output_is_no_mistake(own_namespace: str) -> None:
    command = [sys.executable, "-m", "hal.halcmd", "show", "all"]
    done = subprocess.run(
        ["sh", "-c", '"$@" >&-', "sh", *command], capture_output=True, text=True, env=environment(), timeout=60,
        check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def test_ctrl_c_ends_a_command_that_waits_with_one_line(session: None) -> None:
    program = ["sh", "-c", "echo here; exec sleep 600"]
    waiting = subprocess.Popen(
        # a test run in the background ignores SIGINT
        ["env", "--default-signal=INT", sys.executable, "-m", "hal.halcmd", "loadusr", "-W", *program],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment(), start_new_session=True,
    )  # fmt: skip
    try:
        assert waiting.stdout is not None
        assert waiting.stdout.readline() == "here\n"
        os.killpg(waiting.pid, signal.SIGINT)
        _, said = waiting.communicate(timeout=PATIENCE_S)
    finally:
        waiting.kill()
    assert (waiting.returncode, said) == (130, "halcmd: interrupted\n")
    assert halcmd("getp", "s.out") == "0\n"


def test_the_scope_tells_at_once_what_it_could_never_do(session: None) -> None:
    assert halcmd("stop") == ""
    for kind in ("csv", "png"):
        done = run("scope", "--capture", "s.out", "--thread", "servo", f"--{kind}", f"/no/such/folder/a.{kind}")
        assert (done.returncode, done.stderr) == (1, f"halscope: there is no folder /no/such/folder for a.{kind}\n")


def test_a_component_of_a_running_thread_is_unloaded_safely(session: None) -> None:
    assert halcmd("unloadrt", "and2") == ""
    end = time.monotonic() + PATIENCE_S
    while "and2" in halcmd("show", "thread") and time.monotonic() < end:
        pass
    assert "and2" not in halcmd("show", "thread")
    assert run("halcmd", "getp", "and2.0.out").returncode == 1
    assert halcmd("getp", "s.out") == "0\n"


def interrupted(*_: object) -> None:
    raise KeyboardInterrupt


def test_ctrl_c_in_the_shell_ends_the_command_and_not_the_session(
    own_namespace: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = iter(["newsig a bit", "waitusr endless", "sets a 1", "gets a"])
    monkeypatch.setattr("builtins.input", lambda prompt: next(lines))
    monkeypatch.setattr("hal.loadusr.wait_gone", interrupted)
    with Session() as session, contextlib.suppress(StopIteration, KeyboardInterrupt):
        run_shell(session)
    told = capsys.readouterr()
    assert (told.out, told.err) == ("\nTRUE\n", "<stdin>:2: interrupted\n")
