"""``halui``: a user interface of HAL pins, for knobs, switches and lamps; each pin of halui(1).

Inputs give orders on their rising edges, outputs show the status. The tables below are the whole interface: one line
for each pin, or for each pin of a joint, axis or spindle.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import hal
import linuxcnc
from gui.halui_inputs import Button, Dial, Jog, Step
from gui.halui_panel import AXIS, JOINT, Panel
from gui.rsh_values import in_program
from nml import clock

PERIOD = 0.02  # host seconds between looks at the pins
LETTERS = "xyzabcuvw"
NO_LIMIT = float("inf")
JOG_DEADBAND = 0.2  # of analog jog pins until the deadband pin says else

Order = Callable[[Panel], None]


class Seen:
    """The status of one cycle, with the parts that many lamps show taken out once."""

    def __init__(self, panel: Panel) -> None:
        self.panel = panel
        self.status = panel.status
        self.joint = self.status.joint
        self.spindle = self.status.spindle
        self.positions = {
            "pos-commanded": self.status.position,
            "pos-feedback": self.status.actual_position,
            "pos-relative": in_program(self.status.actual_position, self.status),
        }


Shown = Callable[[Seen], Any]
StatusShown = Callable[[linuxcnc.stat], Any]


def _state(state: int) -> Order:
    return lambda panel: panel.command.state(state)


def _mode(mode: int) -> Order:
    return lambda panel: panel.mode(mode)


BUTTONS: dict[str, Order] = {
    "abort": lambda panel: panel.command.abort(),
    "estop.activate": _state(linuxcnc.STATE_ESTOP),
    "estop.reset": _state(linuxcnc.STATE_ESTOP_RESET),
    "flood.off": lambda panel: panel.command.flood(linuxcnc.FLOOD_OFF),
    "flood.on": lambda panel: panel.command.flood(linuxcnc.FLOOD_ON),
    "joint.selected.home": lambda panel: panel.command.home(panel.joint),
    "joint.selected.unhome": lambda panel: panel.command.unhome(panel.joint),
    "lube.off": lambda panel: panel.command.lube(0),
    "lube.on": lambda panel: panel.command.lube(1),
    "machine.off": _state(linuxcnc.STATE_OFF),
    "machine.on": _state(linuxcnc.STATE_ON),
    "mist.off": lambda panel: panel.command.mist(linuxcnc.MIST_OFF),
    "mist.on": lambda panel: panel.command.mist(linuxcnc.MIST_ON),
    "mode.auto": _mode(linuxcnc.MODE_AUTO),
    "mode.joint": lambda panel: panel.teleop(False),
    "mode.manual": _mode(linuxcnc.MODE_MANUAL),
    "mode.mdi": _mode(linuxcnc.MODE_MDI),
    "mode.teleop": lambda panel: panel.teleop(True),
    "program.block-delete.off": lambda panel: panel.command.set_block_delete(0),
    "program.block-delete.on": lambda panel: panel.command.set_block_delete(1),
    "program.optional-stop.off": lambda panel: panel.command.set_optional_stop(0),
    "program.optional-stop.on": lambda panel: panel.command.set_optional_stop(1),
    "program.pause": lambda panel: panel.command.auto(linuxcnc.AUTO_PAUSE),
    "program.resume": lambda panel: panel.command.auto(linuxcnc.AUTO_RESUME),
    "program.run": Panel.run,
    "program.step": Panel.step,
    "program.stop": lambda panel: panel.command.abort(),
}

JOINT_BUTTONS: dict[str, Callable[[Panel, int], None]] = {
    "home": lambda panel, joint: panel.command.home(joint),
    "select": lambda panel, joint: panel.select_joint(joint),
    "unhome": lambda panel, joint: panel.command.unhome(joint),
}

SPINDLE_BUTTONS: dict[str, Callable[[Panel, int], None]] = {
    "brake-off": lambda panel, n: panel.command.brake(linuxcnc.BRAKE_RELEASE, n),
    "brake-on": lambda panel, n: panel.command.brake(linuxcnc.BRAKE_ENGAGE, n),
    "forward": lambda panel, n: panel.turn(n, linuxcnc.SPINDLE_FORWARD),
    "reverse": lambda panel, n: panel.turn(n, linuxcnc.SPINDLE_REVERSE),
    "start": lambda panel, n: panel.turn(n, linuxcnc.SPINDLE_FORWARD),
    "stop": lambda panel, n: panel.command.spindle(linuxcnc.SPINDLE_OFF, n),
}

SPINDLE_STEPS = {"decrease": linuxcnc.SPINDLE_DECREASE, "increase": linuxcnc.SPINDLE_INCREASE}


def _tool_diameter(status: linuxcnc.stat) -> float:
    return status.tool_table[0].diameter if status.tool_in_spindle > 0 else 0.0


LAMPS: dict[str, tuple[int, StatusShown]] = {
    "estop.is-activated": (hal.HAL_BIT, lambda s: s.estop),
    "flood.is-on": (hal.HAL_BIT, lambda s: s.flood),
    "lube.is-on": (hal.HAL_BIT, lambda s: s.lube),
    "machine.is-on": (hal.HAL_BIT, lambda s: s.task_state == linuxcnc.STATE_ON),
    "machine.units-per-mm": (hal.HAL_FLOAT, lambda s: s.linear_units),
    "mist.is-on": (hal.HAL_BIT, lambda s: s.mist),
    "mode.is-auto": (hal.HAL_BIT, lambda s: s.task_mode == linuxcnc.MODE_AUTO),
    "mode.is-joint": (hal.HAL_BIT, lambda s: s.motion_mode == linuxcnc.TRAJ_MODE_FREE),
    "mode.is-manual": (hal.HAL_BIT, lambda s: s.task_mode == linuxcnc.MODE_MANUAL),
    "mode.is-mdi": (hal.HAL_BIT, lambda s: s.task_mode == linuxcnc.MODE_MDI),
    "mode.is-teleop": (hal.HAL_BIT, lambda s: s.motion_mode == linuxcnc.TRAJ_MODE_TELEOP),
    "program.block-delete.is-on": (hal.HAL_BIT, lambda s: s.block_delete),
    "program.is-idle": (hal.HAL_BIT, lambda s: s.interp_state == linuxcnc.INTERP_IDLE),
    "program.is-paused": (hal.HAL_BIT, lambda s: s.interp_state == linuxcnc.INTERP_PAUSED),
    "program.is-running": (
        hal.HAL_BIT,
        lambda s: s.interp_state in (linuxcnc.INTERP_READING, linuxcnc.INTERP_WAITING),
    ),
    "program.optional-stop.is-on": (hal.HAL_BIT, lambda s: s.optional_stop),
    "tool.diameter": (hal.HAL_FLOAT, _tool_diameter),
    "tool.number": (hal.HAL_U32, lambda s: max(0, s.tool_in_spindle)),
}

JOINT_LAMPS: dict[str, str] = {
    "has-fault": "fault",
    "is-homed": "homed",
    "on-hard-max-limit": "max_hard_limit",
    "on-hard-min-limit": "min_hard_limit",
    "on-soft-max-limit": "max_soft_limit",
    "on-soft-min-limit": "min_soft_limit",
    "override-limits": "override_limits",
}

SPINDLE_LAMPS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "brake-is-on": lambda spindle: spindle["brake"],
    "is-on": lambda spindle: spindle["enabled"],
    "runs-backward": lambda spindle: spindle["direction"] < 0,
    "runs-forward": lambda spindle: spindle["direction"] > 0,
}


def _always(number: int) -> Callable[[], int]:
    return lambda: number


def _of_status(shown: StatusShown) -> Shown:
    return lambda seen: shown(seen.status)


def _joint_lamp(key: str, joint: Callable[[], int]) -> Shown:
    return lambda seen: seen.joint[joint()][key]


def _spindle_lamp(word: Callable[[dict[str, Any]], Any], spindle: int) -> Shown:
    return lambda seen: word(seen.spindle[spindle])


def _axis_lamp(name: str, index: int) -> Shown:
    return lambda seen: seen.positions[name][index]


def _tool_offset(index: int) -> StatusShown:
    return lambda status: status.tool_offset[index]


def _selected(kind: str, number: int) -> Shown:
    return lambda seen: getattr(seen.panel, kind) == number


class Input(Protocol):
    def scan(self) -> None: ...


class HalUi:
    """The component with all its pins."""

    def __init__(self, ini: linuxcnc.ini) -> None:
        mdi_commands = ini.findall("HALUI", "MDI_COMMAND")
        self.joints = int(ini.find("KINS", "JOINTS") or 3)
        self.spindles = int(ini.find("TRAJ", "SPINDLES") or 1)
        coordinates = (ini.find("TRAJ", "COORDINATES") or "XYZ").lower()
        self.axes = [letter for letter in LETTERS if letter in coordinates]
        self.panel = Panel(mdi_commands, [LETTERS.index(letter) for letter in self.axes])
        self.component = hal.component("halui")
        self.inputs: list[Input] = []
        self.lamps: list[tuple[Callable[[Any], None], Shown]] = []
        self._add_buttons(len(mdi_commands), ini.find("JOINT_0", "HOME_SEQUENCE") is not None)
        self._add_jogs()
        self._add_dials(ini)
        self._add_lamps(bool(mdi_commands))
        self.component.ready()

    def _new(self, name: str, kind: int, direction: int) -> Any:
        return self.component.newpin(name, kind, direction)

    def _button(self, name: str, action: Callable[[], None]) -> None:
        self.inputs.append(Button(self._new(name, hal.HAL_BIT, hal.HAL_IN), action))

    def _lamp(self, name: str, kind: int, shown: Shown) -> None:
        self.lamps.append((self._new(name, kind, hal.HAL_OUT).set, shown))

    def _add_buttons(self, mdi_count: int, home_all: bool) -> None:
        panel = self.panel
        for name, order in BUTTONS.items():
            self._button(name, partial(order, panel))
        if home_all:
            self._button("home-all", partial(panel.command.home, -1))
        for joint in range(self.joints):
            for name, act in JOINT_BUTTONS.items():
                self._button(f"joint.{joint}.{name}", partial(act, panel, joint))
        for spindle in range(self.spindles):
            for name, act in SPINDLE_BUTTONS.items():
                self._button(f"spindle.{spindle}.{name}", partial(act, panel, spindle))
            for name, step in SPINDLE_STEPS.items():
                pin = self._new(f"spindle.{spindle}.{name}", hal.HAL_BIT, hal.HAL_IN)
                self.inputs.append(Step(pin, partial(panel.change_speed, spindle, step)))
        for index, letter in enumerate(LETTERS):
            self._button(f"axis.{letter}.select", partial(panel.select_axis, index))
        for number in range(mdi_count):
            self._button(f"mdi-command-{number:02}", partial(panel.mdi, number))

    def _add_jogs(self) -> None:
        self._add_jogs_of("joint", JOINT, [str(n) for n in range(self.joints)], lambda: self.panel.joint)
        self._add_jogs_of("axis", AXIS, list(LETTERS), lambda: self.panel.axis)

    def _add_jogs_of(self, kind: str, flag: int, names: list[str], selected: Callable[[], int]) -> None:
        speed = self._new(f"{kind}.jog-speed", hal.HAL_FLOAT, hal.HAL_IN)
        deadband = self._new(f"{kind}.jog-deadband", hal.HAL_FLOAT, hal.HAL_IN)
        deadband.set(JOG_DEADBAND)
        targets = [*((name, _always(index)) for index, name in enumerate(names)), ("selected", selected)]
        for name, index in targets:
            self.inputs.append(Jog(self.panel, flag, f"{kind}.{name}", index, self._new, (speed, deadband)))

    def _add_dials(self, ini: linuxcnc.ini) -> None:
        status, command, new = self.panel.status, self.panel.command, self._new

        def limit(section: str, key: str, default: float) -> float:
            return float(ini.find(section, key) or default)

        most_speed = limit("TRAJ", "MAX_LINEAR_VELOCITY", limit("TRAJ", "MAX_VELOCITY", NO_LIMIT))
        feed = (0.0, limit("DISPLAY", "MAX_FEED_OVERRIDE", 1.0))
        turning = limit("DISPLAY", "MIN_SPINDLE_OVERRIDE", 0.0), limit("DISPLAY", "MAX_SPINDLE_OVERRIDE", 1.0)
        self.inputs += [
            Dial("feed-override", new, lambda: status.feedrate, command.feedrate, feed),
            Dial("rapid-override", new, lambda: status.rapidrate, command.rapidrate, (0.0, 1.0)),
            Dial("max-velocity", new, lambda: status.max_velocity, command.maxvel, (0.0, most_speed), scale=0.0),
        ]
        self.inputs += [self._spindle_dial(number, turning) for number in range(self.spindles)]

    def _spindle_dial(self, number: int, limits: tuple[float, float]) -> Dial:
        status, command = self.panel.status, self.panel.command
        return Dial(
            f"spindle.{number}.override",
            self._new,
            lambda: status.spindle[number]["override"],
            lambda value: command.spindleoverride(value, number),
            limits,
        )

    def _add_lamps(self, mdi: bool) -> None:
        for name, (kind, shown) in LAMPS.items():
            self._lamp(name, kind, _of_status(shown))
        if mdi:
            self._lamp("halui-mdi-is-running", hal.HAL_BIT, lambda seen: seen.panel.mdi_runs)
        self._lamp("joint.selected", hal.HAL_U32, lambda seen: seen.panel.joint)
        self._lamp("axis.selected", hal.HAL_U32, lambda seen: seen.panel.axis)
        for name, key in JOINT_LAMPS.items():
            self._lamp(f"joint.selected.{name}", hal.HAL_BIT, _joint_lamp(key, lambda: self.panel.joint))
            for joint in range(self.joints):
                self._lamp(f"joint.{joint}.{name}", hal.HAL_BIT, _joint_lamp(key, _always(joint)))
        for joint in range(self.joints):
            self._lamp(f"joint.{joint}.is-selected", hal.HAL_BIT, _selected("joint", joint))
        for spindle in range(self.spindles):
            for name, word in SPINDLE_LAMPS.items():
                self._lamp(f"spindle.{spindle}.{name}", hal.HAL_BIT, _spindle_lamp(word, spindle))
        for index, letter in enumerate(LETTERS):
            self._lamp(f"tool.length_offset.{letter}", hal.HAL_FLOAT, _of_status(_tool_offset(index)))
        for letter in self.axes:
            index = LETTERS.index(letter)
            self._lamp(f"axis.{letter}.is-selected", hal.HAL_BIT, _selected("axis_shown", index))
            for name in ("pos-commanded", "pos-feedback", "pos-relative"):
                self._lamp(f"axis.{letter}.{name}", hal.HAL_FLOAT, _axis_lamp(name, index))

    def cycle(self) -> None:
        """Look at every input and set every lamp; a refused order is the operator's to read, not halui's end."""
        self.panel.status.poll()
        for one in self.inputs:
            try:
                one.scan()
            except linuxcnc.error as reason:
                print(f"halui: {reason}", file=sys.stderr, flush=True)
        self.panel.finish_mdi()
        seen = Seen(self.panel)
        for light, shown in self.lamps:
            light(shown(seen))


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    parser = argparse.ArgumentParser(prog="halui", description="A user interface of HAL pins.")
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="INI file of the machine")
    options = parser.parse_args(arguments)
    stopping = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stopping.append(True))
    try:
        if options.ini is None:
            raise linuxcnc.error("no INI file; give one with -ini")
        ui = HalUi(linuxcnc.ini(options.ini))
        while not stopping:
            ui.cycle()
            clock.host_sleep(PERIOD)
    except (linuxcnc.error, hal.error) as reason:
        print(f"halui: {reason}", file=sys.stderr)
        return 1
    ui.component.exit()
    return 0


if __name__ == "__main__":
    sys.exit(main())
