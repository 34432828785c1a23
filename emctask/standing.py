"""Brings the interpreter back to what was in force at the block that the machine was at.

The interpreter reads ahead, so an abort finds it with modes and offsets that the machine never came to. Each block
keeps what was in force after it; here that becomes parameters, at once, and lines for the interpreter, once the
machine stands.
"""

from __future__ import annotations

from collections.abc import Iterator

from emctask.config import AXES
from emctask.places import Block, Modes
from emctask.world import WorldModel
from rs274ngc.interp import Interpreter

STORED = range(5161, 5391)
"""Parameters of places and offsets: G28, G30, G92 (5210 on), the active coordinate system (5220), G54 to G59.3."""
G92_IN_FORCE, ACTIVE_SYSTEM = 5210, 5220
SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")

MOTIONS = (0, 10, 20, 30)
"""Motion codes times ten that come back; a cycle is programmed anew."""
NO_MOTION = 800

Offsets = tuple[float, ...]


def read_offsets(interp: Interpreter) -> Offsets:
    """The stored offsets as they are."""
    return tuple(map(interp.parameter, STORED))


def write_offsets(interp: Interpreter, offsets: Offsets) -> None:
    """Put them into the parameters; they are in force when ``blocks`` were executed."""
    for number, value in zip(STORED, offsets, strict=True):
        interp.set_parameter(number, value)


def blocks(block: Block, canon: WorldModel) -> Iterator[str]:
    """Lines that bring back the modes, then the offsets, of a block; cutter compensation begins anew after an abort."""
    yield "G40"
    if block.modes is not None:
        yield block.modes.as_block()
    index = int(block.offsets[ACTIVE_SYSTEM - STORED.start]) - 1
    yield SYSTEMS[index - 1]  # selecting the system in force does nothing, so another one comes first
    yield SYSTEMS[index]
    yield "G92.3" if block.offsets[G92_IN_FORCE - STORED.start] else "G92.2"
    if any(block.tool_offset):
        offset = canon.in_program_units(block.tool_offset)
        words = (f"{AXES[axis]}{value:.9f}" for axis, value in enumerate(offset) if canon.config.axis_mask >> axis & 1)
        yield f"G43.1 {' '.join(words)}"
    else:
        yield "G49"


def set_motion(interp: Interpreter, modes: Modes) -> None:
    """The motion code of these modes is in force; a block with that code would move."""
    motion = modes.g_codes[1]
    interp.state.motion = motion if motion in MOTIONS else NO_MOTION
