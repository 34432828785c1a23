"""The launcher's options of LinuxCNC, each on a whole machine or as the one line that refuses it."""

import os
import pty
import subprocess
import sys

import pytest

from linuxcnc import launcher as module
from tests.support.machine import ROOT, Run, copy_mill, traces

pytestmark = pytest.mark.process


DESKTOP = ("DISPLAY", "WAYLAND_DISPLAY")


def started(folder, *options, changes=None, hal=""):
    """A run with options that shows its machine works: the display ends at once, with 7."""
    screen = folder / "screen"
    screen.write_text("#!/bin/sh\nexit 7\n")
    screen.chmod(0o755)
    ini = copy_mill(folder, changes={"DISPLAY.DISPLAY": "./screen"} | (changes or {}), hal=hal)
    run = Run(ini, *options, speed=10.0)
    run.finish()
    assert traces() == []
    return run


def launcher(home, *words, stdin=subprocess.DEVNULL):
    return subprocess.run(
        [sys.executable, "-m", "linuxcnc_start", *words],
        cwd=ROOT,
        env=os.environ | dict.fromkeys(DESKTOP, "") | {"HOME": str(home), "TERM": "dumb"},
        stdin=stdin,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_the_modules_of_this_build_are_accepted(tmp_path):
    run = started(tmp_path, "-t", "tpmod", "-m", "homemod", "-r")
    assert (run.finish(), run.errors) == (7, "")


def test_a_misspelt_entry_is_named_at_a_normal_start_too(tmp_path):
    run = started(tmp_path, changes={"JOINT_0.TYPE": "LINEAR\nMAX_JERQ = 500"})
    assert run.finish() == 7
    (line,) = run.errors.splitlines()
    assert line.endswith("nobody reads [JOINT_0]MAX_JERQ; did you mean MAX_JERK?")


@pytest.mark.parametrize(
    ("option", "module"), [("-t", "mytp"), ("-m", "homecomp"), ("-t", "mytp depth=3")], ids=lambda text: text
)
def test_a_module_that_is_not_there_is_refused_in_one_line(tmp_path, option, module):
    run = started(tmp_path, option, module)
    assert run.finish() == 1
    (line,) = run.errors.splitlines()
    assert f"{option} {module}: no such module; use " in line


def test_a_module_of_the_ini_file_is_refused_with_its_line(tmp_path):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("[TRAJ]", "[TRAJ]\nTPMOD = mytp"))
    run = Run(ini)
    assert run.finish() == 1
    number = ini.read_text().splitlines().index("TPMOD = mytp") + 1
    assert run.errors.startswith(f"{ini}:{number}: [TRAJ]TPMOD = mytp: no such module")


def test_a_module_that_refuses_its_arguments_ends_the_start_in_one_line(tmp_path):
    run = started(tmp_path, "-t", "tpmod depth=3")
    assert run.finish() == 1
    assert run.errors == "<command line>: tpmod: unknown argument depth; it has none\n"


def test_hal_files_are_looked_for_in_the_named_folder_first(tmp_path):
    first = tmp_path / "first"
    first.mkdir()
    (first / "test.hal").write_text("bogus\n")
    run = started(tmp_path, "-H", str(first), hal="# nothing\n")
    assert run.errors.startswith(f"{first}/test.hal:1: ")


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    run = started(tmp_path, "-H", str(tmp_path / "none"))
    assert run.finish() == 1
    assert run.errors == f"<command line>: -H {tmp_path}/none: there is no such folder\n"


def test_errors_in_hal_files_can_be_passed_over(tmp_path):
    run = started(tmp_path, "-k", hal="bogus\nnewsig after bit\n")
    assert run.finish() == 7
    assert run.errors.startswith(f"{tmp_path}/test.hal:1: ")


def test_what_is_started_is_said_when_asked_for(tmp_path):
    steps = started(tmp_path, "-v").errors.splitlines()
    assert {"starting io", "starting task", "starting display"} <= set(steps)


def test_debugging_shows_command_lines_and_hal_commands(tmp_path):
    errors = started(tmp_path, "-d", hal="newsig noticed bit\n").errors
    assert "milltask -ini" in errors
    assert "newsig noticed bit" in errors


def test_the_last_configuration_starts_again(tmp_path):
    assert started(tmp_path).finish() == 7
    assert launcher(tmp_path, "-l").returncode == 7


def test_a_file_that_is_named_from_the_folder_is_complained_of_once(tmp_path):
    run = launcher(tmp_path, "none.ini")
    (line,) = run.stderr.splitlines()
    assert (run.returncode, line) == (1, f"{ROOT}/none.ini: cannot read the INI file: No such file or directory")


def test_without_a_last_configuration_one_line_says_so(tmp_path):
    answer = launcher(tmp_path, "-l")
    assert answer.returncode == 1
    assert len(answer.stderr.splitlines()) == 1


def test_without_a_configuration_and_a_terminal_one_line_says_so(tmp_path):
    answer = launcher(tmp_path)
    assert answer.returncode == 1
    assert "no terminal" in answer.stderr
    assert len(answer.stderr.splitlines()) == 1


def test_an_icon_on_a_desktop_starts_the_wizard(monkeypatch):
    started_with = []
    monkeypatch.setattr(module.subprocess, "call", lambda words: started_with.append(words) or 0)
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
    with open(os.devnull) as nobody:
        monkeypatch.setattr(sys, "stdin", nobody)
        assert module.main([]) == 0
    assert started_with == [[sys.executable, "-P", "-m", "gui.web", "--wizard"]]


def test_a_configuration_is_chosen_in_a_dumb_terminal(tmp_path):
    folder = tmp_path / "linuxcnc" / "configs" / "mine"
    folder.mkdir(parents=True)
    copy_mill(folder, units="inch", changes={"DISPLAY.DISPLAY": "nodisplay"})
    ours, theirs = pty.openpty()
    with os.fdopen(ours, "r+b", buffering=0) as terminal:
        process = subprocess.Popen(
            [sys.executable, "-m", "linuxcnc_start"],
            cwd=ROOT,
            env=os.environ | {"HOME": str(tmp_path), "TERM": "dumb"},
            stdin=theirs,
            stdout=theirs,
            stderr=subprocess.PIPE,
            text=True,
        )
        os.close(theirs)
        terminal.write(b"mine\n1\n")
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"{folder}/mill_inch.ini:" in errors
    assert "nodisplay" in errors


def test_a_check_starts_nothing_and_its_exit_code_tells(tmp_path):
    ini = copy_mill(tmp_path)
    fine = launcher(tmp_path, "--check", str(ini))
    assert (fine.returncode, fine.stdout, fine.stderr) == (0, "", "")
    ini.write_text(ini.read_text().replace("JOINTS = 3", "JOINTS = 2"))
    found = launcher(tmp_path, "--check", str(ini))
    assert found.returncode == 1
    assert all(line.startswith(f"{ini}:") for line in found.stdout.splitlines())
    assert traces() == []
