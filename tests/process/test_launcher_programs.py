"""What the launcher starts beside the machine, executes at its end, and adds to the reason of a start that failed."""

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from tests.support.machine import ROOT, Run, copy_mill, processes, running, traces, wait_until

pytestmark = pytest.mark.process

SCREEN = "#!/bin/sh\nfor i in $(seq 600); do [ -e told ] && exit 0; sleep 0.1; done\nexit 9\n"
"""A display that lives until the file ``told`` is there, at most a minute."""


def script(path, text):
    path.write_text(text)
    path.chmod(0o755)


def started(tmp_path, section, screen=SCREEN):
    """A finished run of the mill with one more section in its INI file."""
    script(tmp_path / "screen", screen)
    ini = copy_mill(tmp_path, changes={"DISPLAY.DISPLAY": "./screen"})
    ini.write_text(f"{ini.read_text()}{section}\n")
    return Run(ini, speed=10.0)


def test_applications_start_with_their_arguments_in_the_folder_of_the_ini_file(tmp_path):
    script(tmp_path / "app", '#!/bin/sh\necho "$PWD $*" > all\nmv all told\n')
    run = started(tmp_path, "[APPLICATIONS]\nAPP = ./app one 'two words'\nDELAY = 0.1")
    assert run.finish() == 0, run.errors
    assert (tmp_path / "told").read_text() == f"{tmp_path} one two words\n"
    wait_until(lambda: traces() == [], "the end of everything")  # the programs of an application are its own


def test_the_machine_runs_without_an_application_that_is_missing_or_fails(tmp_path):
    script(tmp_path / "app", "#!/bin/sh\necho broken >&2\ntouch told\nexit 3\n")
    run = started(tmp_path, "[APPLICATIONS]\nAPP = nosuchprogram -x\nAPP = app")
    assert run.finish() == 0, run.errors
    assert "[APPLICATIONS]APP = nosuchprogram -x: no such program; the machine goes on without it" in run.errors
    assert "broken" in run.errors


def listed() -> dict[str, str]:
    """Command lines of the machine's processes by their names."""
    found = {}
    for pid, command in processes():
        with suppress(OSError):  # it may have ended meanwhile
            found[Path(f"/proc/{pid}/comm").read_text().strip()] = command.strip()
    return found


def test_every_process_is_listed_under_its_own_name_and_command_line(tmp_path):
    ini = copy_mill(tmp_path)
    with running(ini) as run:
        run.port()
        for name in ("milltask", "io", "linuxcncrsh"):
            wait_until(lambda start=f"{name} -ini /", name=name: listed().get(name, "").startswith(start), name)
        wait_until(lambda: listed().get("linuxcnc-guard") == "linuxcnc-guard", "the guard")


def test_applications_end_with_the_machine(tmp_path):
    script(tmp_path / "app", "#!/bin/sh\ntouch told\nexec sleep 100\n")
    run = started(tmp_path, "[APPLICATIONS]\nAPP = ./app")
    assert run.finish() == 0, run.errors
    assert traces() == []


def test_the_shutdown_file_is_executed_when_the_machine_is_at_rest(tmp_path):
    (tmp_path / "end.hal").write_text("loadusr -w ./end\n")
    script(tmp_path / "end", "#!/bin/sh\nhalcmd getp iocontrol.0.user-enable-out > told\n")
    ini = copy_mill(tmp_path, changes={"DISPLAY.DISPLAY": "./screen"})
    script(tmp_path / "screen", "#!/bin/sh\nexit 0\n")
    ini.write_text(ini.read_text().replace("[HAL]\n", "[HAL]\nSHUTDOWN = end.hal\n"))
    run = Run(ini, speed=10.0)
    assert run.finish() == 0, run.errors
    assert (tmp_path / "told").read_text() == "FALSE\n"
    assert traces() == []


def test_what_the_realtime_host_has_to_say_reaches_the_terminal_once(tmp_path):
    script(
        tmp_path / "short",
        f"#!{sys.executable}\nimport hal, os\nc = hal.component('short')\nc.ready()\n"
        "open('told', 'w').close()\nos.kill(os.getpid(), 9)\n",
    )
    script(tmp_path / "waiting", SCREEN)
    script(tmp_path / "screen", "#!/bin/sh\nwhile [ ! -e heard ]; do sleep 0.1; done\n")
    ini = copy_mill(tmp_path, changes={"DISPLAY.DISPLAY": "./screen"}, hal="loadusr ./short\nloadusr -w ./waiting\n")
    run = Run(ini, speed=10.0)
    wait_until(lambda: run.process.poll() is not None or run.has_said("'short' died"), "what the host has to say")
    (tmp_path / "heard").touch()
    assert run.finish() == 0, run.errors
    assert run.errors.count("HAL: component 'short' died without leaving; removed") == 1


def test_a_start_that_fails_in_a_hal_file_names_what_else_is_wrong(tmp_path):
    ini = copy_mill(tmp_path, changes={"JOINT_0.HOME": "9999"}, hal="setp no.such-pin 1\n")
    run = Run(ini, speed=10.0)
    assert run.finish() == 1
    reason, finding = run.errors.strip().splitlines()
    assert reason.startswith("test.hal:1: ") or "test.hal:1: " in reason
    assert "[JOINT_0]HOME = 9999 is outside the limits" in finding
    wait_until(lambda: traces() == [], "everything is gone")


def test_a_program_that_a_hal_file_waits_for_in_vain_ends_with_the_start(tmp_path):
    script(tmp_path / "never", "#!/bin/sh\ntouch told\nexec sleep 1000\n")
    run = Run(copy_mill(tmp_path, hal="loadusr -W ./never\n"), speed=10.0)
    try:
        wait_until((tmp_path / "told").exists, "the program")
    finally:
        assert run.stop() == 143
    assert traces() == []


def test_the_python_of_our_modules_can_be_named_in_a_scripts_first_line(tmp_path):
    script(tmp_path / "linuxcnc-python", f"#!{sys.executable}\nfrom linuxcnc.python import main\nmain()\n")
    script(tmp_path / "tool", "#!/usr/bin/env linuxcnc-python\nimport hal, linuxcnc, sys\nprint(sys.argv[1])\n")
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
    done = subprocess.run([tmp_path / "tool", "word"], env=environment, capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr) == ("word\n", "")
