"""The other way round: our ``linuxcnc`` module reads and commands a machine of Debian's LinuxCNC through its server."""

from __future__ import annotations

import time
from typing import Any

import pytest

from tests.support.compared import each_time
from tests.support.nml_server import SOURCE
from tests.support.stock import DRIVE
from tests.support.stock_machine import needs_stock_machine, session

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

OURS = "import linuxcnc, subprocess\nlinuxcnc.nmlfile = 'client.nml'\n" + DRIVE

COMPARE = """
stock = '''
import json, linuxcnc
linuxcnc.nmlfile = "client.nml"
s = linuxcnc.stat(); s.poll()
names = [n for n in dir(s) if not n.startswith("_") and not callable(getattr(s, n)) and n != "tool_table"]
print(json.dumps({n: getattr(s, n) for n in names}))
'''
open(".tool.mmap", "wb").write(bytes(16 + 1001 * 112))
command = ["/usr/bin/python3", "-c", stock]
theirs = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)
s.poll()
out.append(theirs)
out.append(json.loads(json.dumps({name: getattr(s, name) for name in theirs})))
"""


@each_time
def test_our_module_switches_on_homes_and_moves_a_stock_machine() -> None:
    state, homed, moved, position, jogged, at_rest, failed, message = session(
        OURS
        + """
until(lambda: s.task_state == linuxcnc.STATE_ESTOP)
out.append([s.task_state, do("state", linuxcnc.STATE_ESTOP_RESET), do("state", linuxcnc.STATE_ON), s.task_state])
do("home", -1); until(lambda: all(s.homed[:3])); out.append(s.homed[:4])
do("mode", linuxcnc.MODE_MDI)
out.append(do("mdi", "G21 G90 G0 X5 Y4 Z-3")); out.append(s.position[:3])
do("mode", linuxcnc.MODE_MANUAL); do("teleop_enable", 0)
c.jog(linuxcnc.JOG_CONTINUOUS, True, 0, 5.0); until(lambda: s.joint_position[0] > 6)
out.append(s.joint_position[0])
c.jog(linuxcnc.JOG_STOP, True, 0)
places = [None]; until(lambda: places.append(s.joint_position[0]) or time.sleep(0.2) or places[-1] == places[-2])
at = s.joint_position[0]
time.sleep(0.2); s.poll(); out.append(s.joint_position[0] == at)
do("mode", linuxcnc.MODE_MDI)
out.append(do("mdi", "G1 bad")); out.append(e.poll())
"""
    )
    assert state == [1, 1, 1, 4]
    assert homed == [1, 1, 1, 0]
    assert moved == 1
    assert position == pytest.approx([5.0, 4.0, -3.0])
    assert jogged > 6.0
    assert at_rest
    assert failed == 3
    assert message == [11, "(the server did not send the text of this message)"]


@each_time
def test_our_module_runs_a_program_on_a_stock_machine() -> None:
    done, file, position = session(
        OURS
        + """
open("part.ngc", "w").write("G21 G90 F300\\nG0 X0 Y0\\nG1 X5\\nG2 X10 Y5 I0 J5\\nM2\\n")
ready(); do("mode", linuxcnc.MODE_AUTO); do("program_open", os.path.abspath("part.ngc"))
c.auto(linuxcnc.AUTO_RUN, 0); until(lambda: s.interp_state != linuxcnc.INTERP_IDLE)
until(lambda: s.interp_state == linuxcnc.INTERP_IDLE)
out.append(c.wait_complete(60)); out.append(os.path.basename(s.file)); s.poll(); out.append(s.position[:3])
"""
    )
    assert done == 1
    assert file == "part.ngc"
    assert position == pytest.approx([10.0, 5.0, 0.0])


@each_time
def test_our_module_sees_what_the_stock_module_sees() -> None:
    theirs, ours = session(OURS + "ready(); do('mode', linuxcnc.MODE_MDI); do('mdi', 'G0 X1 Y2')\n" + COMPARE)
    differing = {name: (value, ours[name]) for name, value in theirs.items() if not same(value, ours[name])}
    assert not differing


@each_time
def test_the_diagnostics_report_of_the_stock_server_has_our_layout() -> None:
    (head, entries) = session(
        f"sys.path.insert(0, {str(SOURCE)!r})\n"
        "from tests.support.diagnosed import report\n"
        "head, entries = report(5005)\n"
        "out += [head, [[str(part) for part in entry] for entry in entries]]",
        status="diag",
    )
    assert head[1] == 0
    assert head[4] == pytest.approx(time.time(), abs=300.0)
    assert head[6] == 32 + 140 * head[5]
    (client,) = entries
    assert client[:5] == ["b'tester'", "b'desk.example'", "4711", "1.5", "3"]
    assert client[8] == "1"
    assert float(client[12]) == float(client[13]) == pytest.approx(time.time(), abs=300.0)
    assert client[14:16] == ["10000.0", "0.0"]


def same(stock: Any, ours: Any) -> bool:
    """Equal, where our dictionaries may have more."""
    if isinstance(stock, dict):
        return all(same(value, ours[key]) for key, value in stock.items())
    if isinstance(stock, list):
        return len(stock) == len(ours) and all(map(same, stock, ours))
    return bool(stock == ours)


@pytest.mark.parametrize("options", ["POLL", "sub=0.05"])
@each_time
def test_reads_that_do_not_wait_work_with_the_stock_server(options: str) -> None:
    before, after = session(
        OURS + "until(lambda: s.task_state == 1); out.append(s.task_state); ready(); out.append(s.task_state)", options
    )
    assert (before, after) == (1, 4)
