"""Run from line: a dry run up to the line, then the machine gets the state that is in force there, in a safe order.

The dry run reads with a RehearsalCanon, so it can move nothing. When the line is the next one, this is queued: modes
and offsets, overrides, the prepared tool, spindles, coolant. Then the tool goes to where the program assumes it: up to
the highest place that the program has reached so far, across, and down with the feed in force. What cannot be right,
another tool in the spindle for example, is a StartRefused before anything is queued.
"""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING

from emctask.config import AXES
from emctask.places import RESTORABLE, Block, Modes
from emctask.rehearsal import RehearsalCanon, hand_over, hand_over_path_mode, spindle_text
from nml import clock
from nml.errors import PyemcError
from rs274ngc.canon import CANON_EXACT_STOP
from rs274ngc.interp import INTERP_ENDFILE, INTERP_EXECUTE_FINISH, INTERP_EXIT, Interpreter

if TYPE_CHECKING:
    from emctask.canon import TaskCanon

SAME_PLACE = 1e-6  # machine units or degrees: nearer than this is there
TEXT_WIDTH = 240  # bytes of one text for the operator
BLOCKS_PER_LOOK = 32  # blocks between two looks at the clock
XYZ = 0b111
Z = 2
SIDE = 4  # place of the codes of cutter compensation among the active G codes
COMPENSATED = (410, 420)

COMMENT = re.compile(r"\([^)]*\)|;.*")
TOOL_CHANGE = re.compile(r"M0*61?(?![\d.])", re.IGNORECASE)


class StartRefused(PyemcError):
    """The program cannot begin at this line; the text says what to do."""


class RunFromLine:
    """One start at a line; see the module."""

    def __init__(self, interp: Interpreter, machine: TaskCanon, file: str, line: int, before: Block) -> None:
        self._interp = interp
        self._machine = machine
        self._file = file
        self._line = line
        self._before = before
        self.rehearsal = RehearsalCanon(machine)
        self._use(self.rehearsal)
        interp.repeats_main = False

    def _use(self, canon: RehearsalCanon | TaskCanon) -> None:
        self._interp.canon = self._interp.state.canon = canon

    def leave(self) -> None:
        """The interpreter speaks to the machine again; cutter compensation must be off."""
        self._use(self._machine)
        self._interp.repeats_main = True

    # --- The dry run

    def advance(self, until: float) -> bool:
        """Read on until the line is next, or until this host time; is the line next?

        InterpError: a line before it is wrong. StartRefused: the program does not come to it.
        """
        interp = self._interp
        while clock.host_now() < until:
            for _ in range(BLOCKS_PER_LOOK):
                if self._is_next():
                    self.rehearsal.flush()
                    return True
                if interp.read() == INTERP_ENDFILE:
                    self._never_reached()
                code = interp.execute()
                if code == INTERP_EXIT:
                    self._never_reached()
                if code == INTERP_EXECUTE_FINISH:
                    interp.synch()
        return False

    def _is_next(self) -> bool:
        source = self._interp.flow.source
        return source is not None and source.line + 1 == self._line and source.path == self._file

    def _never_reached(self) -> None:
        raise StartRefused(
            f"the program never comes to line {self._line}: it ends at line {self._interp.line}; "
            "it may lie beyond the end, in a branch that is not taken, or in a subroutine that is not called"
        )

    # --- What is not allowed

    def check(self, modes: Modes) -> None:
        """StartRefused if the machine cannot be what the program needs; ``modes``: in force at the line."""
        wanted, line = self.rehearsal, self._line
        if modes.g_codes[SIDE] in COMPENSATED:
            raise StartRefused(f"line {line} is inside cutter compensation; start before the G41 or G42")
        if self._interp.state.nurbs_active:
            raise StartRefused(f"line {line} is inside a NURBS; start before its first line")
        if self.changes_tool:
            return
        held = self._machine.io.status.tool.toolInSpindle
        if wanted.loaded is not None and max(wanted.loaded, 0) != max(held, 0):
            raise StartRefused(
                f"line {line} is for tool {wanted.loaded}, but tool {held} is in the spindle; "
                f"change the tool first (MDI: T{wanted.loaded} M6), or start at the line of the tool change"
            )
        if self._way and self._machine.config.axis_mask & XYZ != XYZ:
            raise StartRefused(
                f"the tool does not stand where line {line} begins; bring it there first: "
                f"{self._describe_point(wanted.end_point)} (machine coordinates)"
            )

    @property
    def changes_tool(self) -> bool:
        """Does the line itself change the tool? Then neither the tool in the spindle nor its place matters."""
        with open(self._file, "rb") as stream:
            stream.seek(self._interp.flow.source.position)
            text = stream.readline(256).decode("utf-8", "replace")
        return TOOL_CHANGE.search(COMMENT.sub("", text).replace(" ", "")) is not None

    @property
    def _way(self) -> bool:
        """Is there a way to go before the line can begin?"""
        mask = self._machine.config.axis_mask
        pairs = enumerate(zip(self._machine.end_point, self.rehearsal.end_point, strict=True))
        return any(mask >> axis & 1 and abs(here - there) > SAME_PLACE for axis, (here, there) in pairs)

    # --- The start

    def start(self, modes: Modes, offsets: tuple[float, ...]) -> list[str]:
        """Queue what brings the state of the dry run about; texts that tell the operator what that is.

        ``modes`` and ``offsets``: in force and stored at the line.
        """
        differences = [*self._code_differences(modes), *self._offset_differences()]
        changes_tool = self.changes_tool
        self.leave()
        self._machine.begin_block(self._line, self._file, ())
        hand_over(self.rehearsal, self._machine)
        for arguments in self.rehearsal.table_entries:
            self._machine.set_tool_table_entry(*arguments)
        for (name, *spindle), allowed in self.rehearsal.switches.items():
            getattr(self._machine, f"{'enable' if allowed else 'disable'}_{name}")(*spindle)
        differences += self._tool()
        if not changes_tool:
            differences += [*self._spindles(), *self._coolant(), *self._approach()]
        self._machine.end_block(modes, offsets)
        if self.rehearsal.left_out:
            differences.append(f"not repeated: {', '.join(self.rehearsal.left_out)}")
        if self._interp.state.frame.labels:
            differences.append("the line is inside an O-word block, in its first pass")
        text = "; ".join(differences) or "nothing to restore"
        return textwrap.wrap(f"run from line {self._line}: {text}", TEXT_WIDTH)

    def _code_differences(self, modes: Modes) -> list[str]:
        earlier = self._before.modes or modes
        pairs = zip(earlier.g_codes[1:], modes.g_codes[1:], strict=True)
        changed = [f"G{then / 10:g}" for before, then in pairs if before != then and then in RESTORABLE]
        feed = modes.settings[1]
        return changed + ([f"F{feed:g}"] if feed != earlier.settings[1] else [])

    def _offset_differences(self) -> list[str]:
        found = []
        now, then = self._machine.coords, self.rehearsal.coords
        for name in ("g5x", "g92", "tool"):
            offset = getattr(then, name)
            if getattr(now, name) != offset:
                title = {"g5x": "work offset", "g92": "G92 offset", "tool": "tool offset"}[name]
                found.append(f"{title} {self._describe_point(offset)}")
        if now.rotation != then.rotation:
            found.append(f"rotation {then.rotation:g}")
        return found

    def _describe_point(self, point: tuple[float, ...]) -> str:
        mask = self._machine.config.axis_mask
        return " ".join(f"{AXES[axis]}{value:.4g}" for axis, value in enumerate(point) if mask >> axis & 1)

    def _tool(self) -> list[str]:
        prepared = self.rehearsal.prepared
        if prepared is None:
            return []
        self._machine.select_tool(prepared)
        return [f"tool {prepared} is prepared"]

    def _spindles(self) -> list[str]:
        machine, found = self._machine, []
        for number in range(len(machine.config.spindles)):
            now, then = machine.spindles[number], self.rehearsal.spindles[number]
            before = spindle_text(now)
            differs = not now.same(then)
            turned = now.direction
            now.take(then)
            if not differs:
                continue
            if then.direction > 0:
                machine.start_spindle_clockwise(number, True)
            elif then.direction < 0:
                machine.start_spindle_counterclockwise(number, True)
            elif turned:
                machine.stop_spindle_turning(number)
            found.append(f"spindle {number} {spindle_text(then)} (was {before})")
        return found

    def _coolant(self) -> list[str]:
        machine, found = self._machine, []
        for name in ("flood", "mist"):
            then = getattr(self.rehearsal, name)
            if bool(getattr(machine, f"get_external_{name}")()) != then:
                way = "on" if then else "off"
                getattr(machine, f"{name}_{way}")()
                found.append(f"{name} {way}")
        return found

    def _approach(self) -> list[str]:
        """Up, across, and down to where the program assumes the tool."""
        if not self._way:
            return []
        machine, there = self._machine, self.rehearsal.end_point
        here = machine.end_point
        height = max(here[Z], there[Z], self.rehearsal.top + machine.coords.tool[Z])
        axis = machine.config.axes.get(Z)
        if axis is not None:
            height = max(min(height, axis.max_limit), here[Z], there[Z])
        machine.set_motion_control_mode(CANON_EXACT_STOP, 0.0)
        self._rapid((*here[:Z], height, *here[Z + 1 :]))
        self._rapid((*there[:Z], height, *there[Z + 1 :]))
        if machine.linear_feed > 0.0:
            machine.straight_feed(self._line, *machine.coords.to_program(*there))
            machine.flush()
        else:
            self._rapid(there)  # without a feed the program has only made rapids so far
        hand_over_path_mode(self.rehearsal, machine)
        return [f"to {self._describe_point(there)} over Z{height:.4g} (machine coordinates)"]

    def _rapid(self, point: tuple[float, ...]) -> None:
        self._machine.straight_traverse(self._line, *self._machine.coords.to_program(*point))
