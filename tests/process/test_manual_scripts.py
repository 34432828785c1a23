"""Scripts of the kinds that the manual's chapter on the Python interface shows, run unchanged beside a machine."""

import subprocess
import sys

import pytest

from tests.support.machine import ROOT, copy_mill, running

pytestmark = pytest.mark.process

SCRIPTS = {
    "all values": """
import sys
import linuxcnc
try:
    s = linuxcnc.stat()
    s.poll()
except linuxcnc.error as detail:
    print("error", detail)
    sys.exit(1)
values = {x: getattr(s, x) for x in dir(s) if not x.startswith("_")}
assert len(values) > 80
assert values["estop"] == 1
""",
    "is it safe to send MDI": """
import linuxcnc, time
s = linuxcnc.stat()
c = linuxcnc.command()
def ok_for_mdi():
    s.poll()
    return (not s.estop and s.enabled and s.homed.count(1) == s.joints
            and s.interp_state == linuxcnc.INTERP_IDLE)
assert not ok_for_mdi()
c.state(linuxcnc.STATE_ESTOP_RESET)
c.state(linuxcnc.STATE_ON)
c.wait_complete()
c.home(-1)
end = time.time() + 60
while not ok_for_mdi():
    assert time.time() < end
    time.sleep(0.01)
c.mode(linuxcnc.MODE_MDI)
c.wait_complete()
c.mdi("G0 X10 Y20 Z30")
assert c.wait_complete() == linuxcnc.RCS_DONE
s.poll()
assert [round(at, 6) for at in s.position[:3]] == [10, 20, 30]
""",
    "the error channel": """
import linuxcnc
c = linuxcnc.command()
e = linuxcnc.error_channel()
while e.poll():
    pass
c.mode(linuxcnc.MODE_MDI)
c.wait_complete()
c.mdi("G1 X nothing")
assert c.wait_complete() == linuxcnc.RCS_ERROR
kind, text = e.poll()
assert kind in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)
assert text
assert e.poll() is None
""",
    "the INI file": """
import linuxcnc
s = linuxcnc.stat()
s.poll()
inifile = linuxcnc.ini(s.ini_filename)
assert inifile.find("EMC", "MACHINE") == "sim-mill-mm"
assert (inifile.find("EMC", "NOTHING") or "unknown") == "unknown"
assert inifile.findall("FILTER", "PROGRAM_EXTENSION") == []
assert len(inifile.findall("HAL", "HALFILE")) > 1
""",
    "the loaded tool": """
import linuxcnc
s, c = linuxcnc.stat(), linuxcnc.command()
s.poll()
assert s.tool_table[0].id in (0, -1)
number = next(tool.id for tool in s.tool_table[1:] if tool.id > 0)
c.mode(linuxcnc.MODE_MDI)
c.wait_complete()
c.mdi("M61 Q%d" % number)
assert c.wait_complete() == linuxcnc.RCS_DONE
s.poll()
assert s.tool_in_spindle == s.tool_table[0].id == s.toolinfo(number)["toolno"] == number
assert s.tool_table[0].zoffset == s.toolinfo(number)["zoffset"]
""",
    "spindles and joints": """
import linuxcnc
s, c = linuxcnc.stat(), linuxcnc.command()
c.mode(linuxcnc.MODE_MANUAL)
c.wait_complete()
c.spindle(linuxcnc.SPINDLE_FORWARD, 1024)
c.wait_complete()
c.spindle(linuxcnc.SPINDLE_INCREASE)
c.wait_complete()
c.spindle(linuxcnc.SPINDLE_OFF, 0)
assert c.wait_complete() == linuxcnc.RCS_DONE
s.poll()
print("Joint 1 homed: ", s.joint[1]["homed"])
assert s.joint[1]["homed"] == 1
assert s.spindle[0]["override"] == 1.0
""",
}


def test_the_scripts_do_what_they_say(tmp_path):
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        for title, script in SCRIPTS.items():
            result = subprocess.run(
                [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
            )
            assert result.returncode == 0, f"{title}\n{result.stderr}"
