"""What a type checker tells the author of a client script about ``import linuxcnc``."""

import subprocess
import sys

import pytest

from tests.support.machine import ROOT

pytest.importorskip("mypy", reason="mypy is not installed")

pytestmark = pytest.mark.process

SCRIPT = """\
import linuxcnc
from linuxcnc.aio import Machine

status, command, errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
status.poll()
x: float = status.position[0]
mode: int = status.task_mode
name: str = status.file
enabled: bool = status.joint[0]["enabled"]
message: tuple[int, str] | None = errors.poll()
result: int = command.wait_complete(1.0)
came_of_it = command.result(1.0)
texts: tuple[str, ...] = came_of_it.messages if came_of_it else ()


async def work(machine: Machine) -> bool:
    return bool(await machine.mdi("G0 X1"))


value: str | None = linuxcnc.ini("machine.ini").find("EMC", "MACHINE")
command.mdi(5)
command.jog(linuxcnc.JOG_STOP, True)
"""


def test_right_calls_are_accepted_and_wrong_ones_named(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    options = ["--strict", "--follow-imports=silent", "--cache-dir", str(tmp_path / "cache")]
    result = subprocess.run(
        [sys.executable, "-m", "mypy", *options, str(script)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    errors = [line for line in result.stdout.splitlines() if "error:" in line]
    lines = [int(line.split(":")[1]) for line in errors]
    assert lines == [21, 22], result.stdout


@pytest.mark.parametrize("package", ["linuxcnc", "nml", "hal"])
def test_installed_packages_say_that_they_are_typed(package):
    assert (ROOT / package / "py.typed").exists()
