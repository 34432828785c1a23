"""halui beside Debian's: the same buttons pressed on machines with the same files, every lamp compared after each."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.support import stock_machine
from tests.support.compared import first_same
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

SECTIONS = {
    "[HAL]\n": "[HAL]\nHALUI = halui\n",
    "[TASK]\n": "MAX_FEED_OVERRIDE = 1.5\nMIN_SPINDLE_OVERRIDE = 0.5\nMAX_SPINDLE_OVERRIDE = 1.2\n[TASK]\n",
    "[TRAJ]\n": "[HALUI]\nMDI_COMMAND = G21 G90 G0 X3\nMDI_COMMAND = G0 Y-2\n[TRAJ]\n",
}

PANEL = r'''
import hal

s = linuxcnc.stat()
panel = hal.component("panel")
pins = {}
for one in hal.get_info_pins():
    if one["NAME"].startswith("halui."):
        pins[one["NAME"][len("halui."):]] = (int(one["TYPE"]), int(one["DIRECTION"]), one["VALUE"])
for name, (kind, direction, value) in pins.items():
    panel.newpin(name, kind, hal.HAL_OUT if direction == hal.HAL_IN else hal.HAL_IN)
    if direction == hal.HAL_IN:
        panel[name] = value
panel.ready()
for name, (kind, direction, value) in pins.items():
    hal.new_sig("p." + name, kind)
    hal.connect("halui." + name, "p." + name)
    hal.connect("panel." + name, "p." + name)
lamps = [name for name, (kind, direction, value) in pins.items() if direction == hal.HAL_OUT]
out.append({name: list(row) for name, row in pins.items()})

def settle():
    before, same, end = None, 0, time.time() + 15
    while same < 4 and time.time() < end:
        time.sleep(0.06)
        s.poll()
        now = (s.joint_position, s.task_mode, s.task_state, s.interp_state, [panel[name] for name in lamps])
        same = same + 1 if now == before else 0
        before = now

def step(pin, value=None):
    if value is None:
        panel[pin] = 1
        time.sleep(0.1)
        panel[pin] = 0
    else:
        panel[pin] = value
    settle()
    out.append([pin, value, {name: panel[name] for name in lamps}, s.task_mode, list(s.position[:3])])

open("part.ngc", "w").write("G21 G90 F3000\nG0 X0 Y0\nG1 X5\nM2\n")
settle()
for one in STEPS:
    if one[0] == "open":
        c = linuxcnc.command()
        c.mode(linuxcnc.MODE_AUTO)
        c.wait_complete()
        c.program_open(os.path.abspath("part.ngc"))
        c.wait_complete()
        continue
    step(*one)
'''

STEPS: list[tuple[Any, ...]] = [
    ("estop.reset",),
    ("mode.mdi",),
    ("mode.manual",),
    ("machine.on",),
    ("machine.off",),
    ("machine.on",),
    ("joint.2.select",),
    ("joint.selected.home",),
    ("joint.0.home",),
    ("joint.0.unhome",),
    ("home-all",),
    ("mode.joint",),
    ("joint.jog-speed", 600.0),
    ("joint.1.increment", 1.5),
    ("joint.1.increment-plus",),
    ("joint.selected.increment", 0.5),
    ("joint.selected.increment-minus",),
    ("joint.0.analog", 0.1),
    ("joint.0.analog", 0.0),
    ("mode.teleop",),
    ("axis.jog-speed", 600.0),
    ("axis.y.select",),
    ("axis.a.select",),
    ("axis.selected.increment", 0.25),
    ("axis.selected.increment-plus",),
    ("axis.x.increment", -1.0),
    ("axis.x.increment-plus",),
    ("mdi-command-00",),
    ("mdi-command-01",),
    ("mode.auto",),
    ("mdi-command-00",),
    ("mode.mdi",),
    ("mdi-command-01",),
    ("mode.manual",),
    ("feed-override.counts", 3),
    ("feed-override.counts", 12),
    ("feed-override.decrease",),
    ("feed-override.reset",),
    ("feed-override.direct-value", 1),
    ("feed-override.counts", 7),
    ("rapid-override.decrease",),
    ("rapid-override.increase",),
    ("rapid-override.increase",),
    ("spindle.0.override.increase",),
    ("spindle.0.override.increase",),
    ("spindle.0.override.increase",),
    ("max-velocity.scale", 5.0),
    ("max-velocity.decrease",),
    ("max-velocity.increase",),
    ("max-velocity.increase",),
    ("spindle.0.start",),
    ("spindle.0.reverse",),
    ("spindle.0.stop",),
    ("spindle.0.brake-off",),
    ("spindle.0.brake-on",),
    ("flood.on",),
    ("mist.on",),
    ("mist.off",),
    ("lube.on",),
    ("lube.off",),
    ("program.optional-stop.on",),
    ("program.block-delete.on",),
    ("program.block-delete.off",),
    ("program.run",),
    ("open",),
    ("program.run",),
    ("abort",),
    ("mode.manual",),
    ("estop.activate",),
]

NEW_IN_2_10 = {"halui-mdi-is-running"}
HAL_IN = 16


@pytest.fixture(scope="module")
def panels(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Any], list[Any]]:
    """What the panel saw on Debian's machine and on ours."""
    script = f"STEPS = {STEPS!r}\n{PANEL}"

    def compare() -> tuple[list[Any], list[Any]]:
        theirs = stock_machine.display(script, changes=SECTIONS)
        return theirs, stock_machine.ours(tmp_path_factory.mktemp("ours"), script, changes=SECTIONS)

    return first_same(compare, unlike_lamps)


def test_the_pins_have_the_same_names_types_and_directions_and_inputs_the_same_defaults(
    panels: tuple[list[Any], list[Any]]
) -> None:
    theirs, ours = ({name: defaults(*row) for name, row in pins[0].items()} for pins in panels)
    assert set(ours) - set(theirs) == NEW_IN_2_10
    assert {name: row for name, row in ours.items() if name in theirs} == theirs


def defaults(kind: int, direction: int, value: Any) -> tuple[int, int, Any]:
    """What a pin is, and what an input holds before it is connected."""
    return kind, direction, value if direction == HAL_IN else None


def test_every_lamp_is_the_same_after_every_button(panels: tuple[list[Any], list[Any]]) -> None:
    assert unlike_lamps(panels) == []


def unlike_lamps(panels: tuple[list[Any], list[Any]]) -> list[tuple[Any, ...]]:
    """Lamps, modes and positions that differ: after which button, which, and both values."""
    differing: list[tuple[Any, ...]] = []
    for stock, ours in zip(panels[0][1:], panels[1][1:], strict=True):
        pin, value, lamps, mode, position = stock
        pairs = {name: (shown, ours[2][name]) for name, shown in lamps.items()} | {"(mode)": (mode, ours[3])}
        pairs |= {f"({axis})": pair for axis, pair in zip("xyz", zip(position, ours[4], strict=True), strict=True)}
        differing += [(pin, value, name, *pair) for name, pair in pairs.items() if not same(*pair)]
    return differing


def same(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-6)
