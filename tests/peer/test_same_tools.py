"""Tool changes, step by step, on Debian's LinuxCNC and on ours: the same pins, status, table and variables.

The script is the changer itself: it answers each request when it has noted what is asked for. Nonrandom and random.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.support import stock_machine
from tests.support.compared import each_time
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

SCRIPT = r"""
import hal
s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
PINS = ("tool-number", "tool-prep-number", "tool-prep-pocket", "tool-prep-index", "tool-from-pocket")
h = hal.component("changer")
for name in PINS:
    h.newpin(name, hal.HAL_S32, hal.HAL_IN)
for name, way in (("tool-prepare", hal.HAL_IN), ("tool-change", hal.HAL_IN), ("tool-prepared", hal.HAL_OUT),
                  ("tool-changed", hal.HAL_OUT)):
    h.newpin(name, hal.HAL_BIT, way)
h.ready()
for name in ("prepare", "prepared", "change", "changed"):
    subprocess.run(["halcmd", "unlinkp", "iocontrol.0.tool-" + name], check=True)
for name in (*PINS, "tool-prepare", "tool-change", "tool-prepared", "tool-changed"):
    subprocess.run(["halcmd", "net", "the-" + name, "iocontrol.0." + name, "changer." + name], check=True)

def note(label):
    time.sleep(0.15)
    s.poll()
    texts = []
    while (message := e.poll()):
        texts.append(list(message))
    table = [list(tool) for tool in s.tool_table if tool[0] != -1]
    out.append([label, {
        "pins": {name: h[name] for name in PINS}, "texts": texts, "table": table, "offset": list(s.tool_offset),
        "held": [s.tool_in_spindle, s.pocket_prepped, s.tool_from_pocket], "state": [s.state, s.interp_state],
        "requests": [bool(h["tool-prepare"]), bool(h["tool-change"])], "place": list(s.position[:3])}])

def until(name, value):
    end = time.time() + 30
    while time.time() < end and bool(h[name]) != value:
        time.sleep(0.005)

def requested(name):
    "Whether the changer is asked for this before the line is over, which it is when it stays so."
    end, idle = time.time() + 30, 0
    while time.time() < end and idle < 10:
        if h[name]:
            return True
        time.sleep(0.02)
        s.poll()
        over = s.echo_serial_number == c.serial and s.state != linuxcnc.RCS_EXEC
        idle = idle + 1 if over and s.interp_state == linuxcnc.INTERP_IDLE else 0
    return False

def mdi(line, seconds=20):
    c.mdi(line)
    c.wait_complete(seconds)
    note(line)

def tool(line, asked=("prepare", "change")):
    c.mdi(line)
    for request in asked:
        if requested("tool-" + request):
            note(line + ": " + request)
            h["tool-" + request + "d"] = True
            until("tool-" + request, False)
            h["tool-" + request + "d"] = False
    c.wait_complete(20)
    note(line)
    mdi("(debug, #<_current_tool> #<_current_pocket> #<_selected_tool> #5400 #5403 #5410)")

def abort_in(line, *answers):
    c.mdi(line)
    for request in answers:
        until("tool-" + request, True)
        h["tool-" + request + "d"] = True
        until("tool-" + request, False)
        h["tool-" + request + "d"] = False
    until("tool-change" if answers else "tool-prepare", True)
    c.abort()
    c.wait_complete(20)
    note(line + " aborted")

open("stock.tbl", "w").write(TABLE)
s.poll()
end = time.time() + 10
while not s.axis_mask and time.time() < end:
    time.sleep(0.05)
    s.poll()
for order in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
    c.state(order)
    c.wait_complete(20)
c.home(-1)
c.wait_complete(20)
time.sleep(0.5)
c.mode(linuxcnc.MODE_MDI)
c.load_tool_table()
c.wait_complete(20)
note("start")
tool("T1 M6")
tool("T10 M6")
mdi("G43")
mdi("G43 H1")
mdi("G49")
tool("T1", ("prepare",))
tool("T10", ("prepare",))
tool("M6", ("change",))
tool("T0 M6")
mdi("T55")
mdi("M61 Q10")
mdi("M61 Q0")
mdi("M61 Q55")
mdi("M61 Q1")
mdi("G10 L1 P1 Z1.5 R0.2")
mdi("(debug, #5403 #5410)")
mdi("G10 L10 P1 Z2")
mdi("(debug, #5403)")
mdi("G10 L1 P77 Z1")
abort_in("T10 M6")
abort_in("T10 M6", "prepare")
mdi("G0 X1")
tool("T10 M6")
c.tool_offset(10, 3.0, 0.0, 0.4, 1.0, 2.0, 3)
c.wait_complete(20)
note("tool_offset")
"""

TABLES = {
    "0": "T1 P4 Z1.0 D0.125 ; first\nT10 P3 Z3 D0.5 ; ten\nT999 P50 Z2 D0.25 ; big\n",
    "1": "T999 P7 Z0.5 D0.1\nT1 P3 Z1.0 D0.125\nT10 P50 Z3 D0.5\nT0 P2 Z0\n",
}


@pytest.mark.parametrize("random", ["0", "1"])
@each_time
def test_every_step_of_tool_changes_is_the_same(tmp_path: Path, random: str) -> None:
    script = SCRIPT.replace("TABLE)", f"{TABLES[random]!r})", 1)
    changes = {"TOOL_TABLE =": f"RANDOM_TOOLCHANGER = {random}\nTOOL_TABLE ="}
    theirs: list[Any] = stock_machine.display(script, changes=changes)
    ours: list[Any] = stock_machine.ours(tmp_path, script, changes=changes)
    assert [label for label, _ in ours] == [label for label, _ in theirs]
    differing = [
        (label, name, values[name], own[name])
        for (label, values), (_, own) in zip(theirs, ours, strict=True)
        for name in values
        if not close(values[name], own[name])
    ]
    assert differing == []


def close(stock: Any, ours: Any) -> bool:
    """Equal, but for the last digits of numbers."""
    if isinstance(stock, dict):
        return stock.keys() == ours.keys() and all(close(stock[key], ours[key]) for key in stock)
    if isinstance(stock, list):
        return len(stock) == len(ours) and all(map(close, stock, ours))
    return bool(stock == (pytest.approx(ours) if isinstance(ours, float) else ours))
