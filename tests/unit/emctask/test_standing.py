"""What an abort brings back: the lines that make the modes and offsets of a block be in force again."""

from types import SimpleNamespace

from emctask.places import Block, Modes
from emctask.standing import ACTIVE_SYSTEM, G92_IN_FORCE, STORED, blocks, read_offsets, set_motion, write_offsets
from rs274ngc.canon import Canon
from rs274ngc.interp import Interpreter

CODES = (4, 10, -1, 170, 400, 210, 910, 940, 550, 430, 990, 610, -1, 970, 911, 80, 923)
CANON = SimpleNamespace(config=SimpleNamespace(axis_mask=0b101), in_program_units=lambda offset: offset)


def block(**parameters: float) -> Block:
    found = Block("part.ngc")
    found.modes = Modes(CODES, (), (4.0, 600.0, 0.0, 0.0, 0.0))
    values = {ACTIVE_SYSTEM: 2.0} | {int(name[1:]): value for name, value in parameters.items()}
    found.offsets = tuple(values.get(number, 0.0) for number in STORED)
    found.tool_offset = (0.0,) * 9
    return found


def test_another_system_is_selected_first_so_that_changed_origins_count():
    lines = list(blocks(block(), CANON))
    assert lines[0] == "G40"
    assert lines[2:] == ["G54", "G55", "G92.2", "G49"]
    assert list(blocks(block(p5220=1.0), CANON))[2:4] == ["G59.3", "G54"]


def test_an_axis_offset_and_a_tool_offset_of_the_machines_axes_come_back():
    place = block(p5210=1.0)
    place.tool_offset = (0.0, 0.0, -1.25, *[0.0] * 6)
    assert place.offsets[G92_IN_FORCE - STORED.start] == 1.0
    assert list(blocks(place, CANON))[-2:] == ["G92.3", "G43.1 X0.000000000 Z-1.250000000"]


def test_stored_offsets_are_written_where_they_were_read():
    interp = Interpreter(Canon())
    interp.init()
    before = read_offsets(interp)
    interp.execute_mdi("G10 L2 P3 X7")
    assert interp.parameter(5261) == 7.0
    write_offsets(interp, before)
    assert interp.parameter(5261) == 0.0
    assert read_offsets(interp) == before


def test_a_cycle_is_not_resumed_but_a_straight_move_is():
    interp = Interpreter(Canon())
    interp.init()
    for code, restored in ((10, 10), (0, 0), (810, 800)):
        set_motion(interp, Modes((1, code, *CODES[2:]), (), ()))
        assert interp.active_g_codes()[1] == restored
