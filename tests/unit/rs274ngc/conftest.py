"""A canon that writes down what the interpreter asks of it, and a program run on it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rs274ngc.interp import Interpreter
from rs274ngc.offline import OfflineCanon

COMMANDS = (
    "straight_traverse", "straight_feed", "arc_feed", "set_feed_rate", "message", "comment", "dwell", "select_tool",
    "change_tool", "program_end", "program_stop", "optional_program_stop", "set_g5x_offset", "set_g92_offset",
    "start_spindle_clockwise", "stop_spindle_turning", "set_motion_output_value", "set_aux_output_value",
    "home_cycle", "home_cycle_joint",
)  # fmt: skip


class Recorder(OfflineCanon):
    """Keeps (name, arguments) of the calls in COMMANDS."""

    def __init__(self, **machine: Any) -> None:
        super().__init__(**machine)
        self.calls: list[tuple[str, tuple[Any, ...]]] = []

    def named(self, name: str) -> list[tuple[Any, ...]]:
        return [arguments for called, arguments in self.calls if called == name]


def recorded(name: str) -> Callable[..., None]:
    def method(self: Recorder, *arguments: Any) -> None:
        self.calls.append((name, arguments))
        getattr(OfflineCanon, name)(self, *arguments)

    return method


for _name in COMMANDS:
    setattr(Recorder, _name, recorded(_name))


@pytest.fixture
def run(tmp_path: Path) -> Callable[..., Recorder]:
    def run(program: str, **machine: Any) -> Recorder:
        path = tmp_path / "program.ngc"
        path.write_text(program)
        canon = Recorder(**machine)
        interp = Interpreter(canon)
        interp.init()
        canon.calls.clear()
        interp.open(path)
        interp.run_file()
        return canon

    return run
