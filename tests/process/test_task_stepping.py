"""Single steps through a program with a loop and a subroutine: block by block, and the whole path."""

from __future__ import annotations

import pytest

import linuxcnc
from tests.support.desk import DONE, at_desk
from tests.support.machine import PATIENCE

pytestmark = pytest.mark.process

PROGRAM = """\
o<corner> sub
G1 F6000 X#1 Y#2
o<corner> endsub
G21 G90
#1 = 0
o1 repeat [3]
M67 E0 Q[#1]
(debug, round)
o<corner> call [5+#1] [#1]
G1 F6000 Y[5+#1]
#1 = [#1+5]
o1 endrepeat
M2
"""


def test_steps_go_through_loops_and_subroutines_block_by_block(tmp_path):
    with at_desk(tmp_path) as desk:
        desk.ready(linuxcnc.MODE_AUTO)
        desk.program(PROGRAM)
        stops = []
        desk.command.auto(linuxcnc.AUTO_STEP)
        while True:
            desk.until(lambda s: s.interp_state in (linuxcnc.INTERP_IDLE, linuxcnc.INTERP_PAUSED) and s.inpos, "a stop")
            status = desk.stat
            if status.interp_state == linuxcnc.INTERP_IDLE:
                break
            stops.append((round(status.position[0], 6), round(status.position[1], 6), status.call_level))
            serial = status.echo_serial_number
            desk.command.auto(linuxcnc.AUTO_STEP)
            desk.until(lambda s, before=serial: s.echo_serial_number > before, "the step is taken")
        assert desk.command.wait_complete(PATIENCE) == DONE
        places = list(dict.fromkeys(place[:2] for place in stops))
        assert places == [(0, 0), (5, 0), (5, 5), (10, 5), (10, 10), (15, 10), (15, 15)]
        assert {level for x, y, level in stops if x > y} == {1}, "behind the subroutine's move"
        assert desk.look().aout[0] == 10.0
        assert [text.strip() for text in desk.texts] == ["round"] * 3
