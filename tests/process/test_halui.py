"""halui on a whole machine: buttons wired in HAL move it, lamps show it."""

import pytest

import hal
import linuxcnc
from tests.support.machine import copy_mill, running, traces, wait_until

pytestmark = pytest.mark.process


@pytest.fixture
def buttons(tmp_path):
    """A component whose pins are wired to halui of a machine that is up."""
    ini = copy_mill(tmp_path)
    text = ini.read_text().replace("[HAL]", "[HALUI]\nMDI_COMMAND = G21 G90 G0 X3\n\n[HAL]\nHALUI = halui")
    ini.write_text(text)
    with running(ini, speed=10.0) as run:
        run.port()
        component = hal.component("buttons")
        for name in ("reset", "on", "home", "mdi", "plus"):
            component.newpin(name, hal.HAL_BIT, hal.HAL_OUT)
        component.newpin("speed", hal.HAL_FLOAT, hal.HAL_OUT)
        component.newpin("homed", hal.HAL_BIT, hal.HAL_IN)
        component.ready()
        wires = {
            "reset": "halui.estop.reset",
            "on": "halui.machine.on",
            "home": "halui.home-all",
            "mdi": "halui.mdi-command-00",
            "plus": "halui.joint.1.plus",
            "speed": "halui.joint.jog-speed",
            "homed": "halui.joint.0.is-homed",
        }
        for name, pin in wires.items():
            hal.new_sig(f"b-{name}", hal.HAL_FLOAT if name == "speed" else hal.HAL_BIT)
            hal.connect(f"buttons.{name}", f"b-{name}")
            hal.connect(pin, f"b-{name}")
        yield component
        component.exit()
    assert traces() == []


def test_buttons_switch_on_home_jog_and_run_mdi(buttons):
    status = linuxcnc.stat()
    buttons["reset"] = True
    wait_until(lambda: status.poll() or status.task_state == linuxcnc.STATE_ESTOP_RESET, "reset")
    buttons["on"] = True
    wait_until(lambda: status.poll() or status.task_state == linuxcnc.STATE_ON, "on")
    buttons["speed"] = 300.0
    buttons["plus"] = True
    wait_until(lambda: status.poll() or status.joint_position[1] > 1.0, "jog")
    buttons["plus"] = False
    wait_until(lambda: status.poll() or status.inpos, "stop")
    buttons["home"] = True
    wait_until(lambda: buttons["homed"], "the lamp of joint 0")
    wait_until(lambda: status.poll() or all(status.homed[:3]), "home")
    buttons["mdi"] = True
    wait_until(lambda: status.poll() or abs(status.position[0] - 3.0) < 1e-6, "MDI command")
    wait_until(lambda: status.poll() or status.task_mode == linuxcnc.MODE_MANUAL, "the mode from before")
