"""EMCIO's cycle: takes commands from toolCmd, drives ``iocontrol.0``, reports in toolSts, publishes the tool table.

E-stop chain: ``user-enable-out`` is FALSE while this controller demands an E-stop, ``user-request-enable`` rises when
the user asks to leave it, and whatever hangs between them decides about ``emc-enable-in``, which alone is the truth
that is reported. One command at a time: task waits for the echo before it sends the next.
"""

from __future__ import annotations

from collections.abc import Callable, MutableMapping
from dataclasses import dataclass
from typing import Any

from emcio.changer import Changer
from emcio.sources import ToolSource
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool
from nml import clock
from nml.channel import Channel
from nml.emc import (
    EMC_AUX_ESTOP_OFF,
    EMC_AUX_ESTOP_ON,
    EMC_AUX_ESTOP_RESET,
    EMC_COOLANT_FLOOD_OFF,
    EMC_COOLANT_FLOOD_ON,
    EMC_COOLANT_MIST_OFF,
    EMC_COOLANT_MIST_ON,
    EMC_IO_ABORT,
    EMC_IO_HALT,
    EMC_IO_INIT,
    EMC_IO_STAT,
    EMC_LUBE_OFF,
    EMC_LUBE_ON,
    EMC_OPERATOR_ERROR,
    EMC_SET_DEBUG,
    EMC_TOOL_ABORT,
    EMC_TOOL_HALT,
    EMC_TOOL_INIT,
    EMC_TOOL_LOAD,
    EMC_TOOL_LOAD_TOOL_TABLE,
    EMC_TOOL_PREPARE,
    EMC_TOOL_SET_NUMBER,
    EMC_TOOL_SET_OFFSET,
    EMC_TOOL_START_CHANGE,
    EMC_TOOL_UNLOAD,
)
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.tooltable import EMC_TOOL_TABLE
from nml.message import Message

DONE, EXEC, ERROR = 1, 2, 3
REPORT_S = 0.1  # host time between two reports when nothing changes: the sign of life that task looks at
BUSY_WAIT_S = 0.001  # host time between two looks at the pins while the tool changer is asked for something


@dataclass(slots=True)
class IoChannels:
    """The buffers that io works with."""

    commands: Channel
    status: Channel
    table: Channel
    errors: Channel

    def close(self) -> None:
        """Close them all."""
        for channel in (self.commands, self.status, self.table, self.errors):
            channel.close()


class IoController:
    """One io process; ``run`` returns after ``running`` has become False."""

    def __init__(
        self,
        pins: MutableMapping[str, Any],
        store: ToolStore,
        source: ToolSource,
        channels: IoChannels,
        cycle_s: float,
        changer: Changer,
    ) -> None:
        self.pins = pins
        self.store = store
        self.source = source
        self.channels = channels
        self.cycle_s = cycle_s
        self.changer = changer
        self.running = True
        self.status = EMC_IO_STAT(status=DONE, cycleTime=cycle_s)
        self.table = EMC_TOOL_TABLE()
        self._failed = False
        self._raise_request = False
        self._last_report = 0.0
        self._reported = b""
        self._handlers: dict[int, Callable[[Any], None]] = {
            EMC_TOOL_INIT.TYPE_ID: self._nothing,
            EMC_TOOL_HALT.TYPE_ID: self._halt,
            EMC_TOOL_ABORT.TYPE_ID: self._abort,
            EMC_TOOL_PREPARE.TYPE_ID: lambda command: self.changer.prepare(command.tool),
            EMC_TOOL_START_CHANGE.TYPE_ID: lambda command: self.changer.start_change(),
            EMC_TOOL_LOAD.TYPE_ID: lambda command: self.changer.load(),
            EMC_TOOL_UNLOAD.TYPE_ID: lambda command: self.changer.unload(),
            EMC_TOOL_SET_NUMBER.TYPE_ID: lambda command: self.changer.set_number(command.tool),
            EMC_TOOL_SET_OFFSET.TYPE_ID: self._set_offset,
            EMC_TOOL_LOAD_TOOL_TABLE.TYPE_ID: self._load_table,
            EMC_AUX_ESTOP_ON.TYPE_ID: self._estop_on,
            EMC_AUX_ESTOP_OFF.TYPE_ID: self._estop_off,
            EMC_AUX_ESTOP_RESET.TYPE_ID: self._estop_off,
            EMC_COOLANT_MIST_ON.TYPE_ID: lambda command: self._coolant("mist", True),
            EMC_COOLANT_MIST_OFF.TYPE_ID: lambda command: self._coolant("mist", False),
            EMC_COOLANT_FLOOD_ON.TYPE_ID: lambda command: self._coolant("flood", True),
            EMC_COOLANT_FLOOD_OFF.TYPE_ID: lambda command: self._coolant("flood", False),
            EMC_LUBE_ON.TYPE_ID: lambda command: self._lube(True),
            EMC_LUBE_OFF.TYPE_ID: lambda command: self._lube(False),
            EMC_IO_INIT.TYPE_ID: self._nothing,
            EMC_IO_HALT.TYPE_ID: self._halt,
            EMC_IO_ABORT.TYPE_ID: self._abort,
            EMC_SET_DEBUG.TYPE_ID: self._set_debug,
        }

    def run(self) -> None:
        """Serve until told to stop; then leave the machine in E-stop with everything off."""
        while self.running:
            self.cycle()
            self.channels.commands.wait(self._wait_s())
        self._all_off()
        self.source.close()
        self._report()

    def cycle(self) -> None:
        """Take a command, look at the pins, report what changed."""
        while (command := self.channels.commands.read()) is not None:
            self._take(command)
        if self._raise_request:
            self.pins["user-request-enable"] = True
            self._raise_request = False
        elif self.pins["user-request-enable"] and self.pins["emc-enable-in"]:
            self.pins["user-request-enable"] = False
        self.changer.poll()
        self._follow_table()
        failure = self.changer.take_problem() or self.source.failure()
        if failure:
            self._complain(failure)
        self._fill_status()
        if self._changed() or clock.host_now() - self._last_report >= REPORT_S:
            self._report()

    def _wait_s(self) -> float:
        if self.changer.busy or self.source.busy or self._raise_request:
            return BUSY_WAIT_S
        return min(self.cycle_s / clock.speed(), 0.01)

    # --- Commands

    def _take(self, command: Message) -> None:
        self._failed = False
        self.status.command_type = command.TYPE_ID
        self.status.echo_serial_number = command.serial_number  # type: ignore[attr-defined]
        handler = self._handlers.get(command.TYPE_ID)
        try:
            if handler is None:
                raise ValueError(f"io does not know the command {type(command).__name__}")
            handler(command)
        except ValueError as error:  # ConfigErrors are, too
            self._complain(str(error))

    def _complain(self, text: str) -> None:
        """Tell the operator; by the number task finds out which order the text belongs to."""
        self._failed = True
        self.channels.errors.write(EMC_OPERATOR_ERROR(id=-self.status.echo_serial_number, error=text[:254]))

    def _nothing(self, command: Message) -> None:
        """A command that needs no action."""

    def _halt(self, command: Message) -> None:
        self.running = False

    def _abort(self, command: EMC_TOOL_ABORT | EMC_IO_ABORT) -> None:
        self.changer.abort(command.reason if isinstance(command, EMC_TOOL_ABORT) else Reason.TASK_ABORT)
        self._coolant("mist", False)
        self._coolant("flood", False)

    def _set_offset(self, command: EMC_TOOL_SET_OFFSET) -> None:
        if not 0 <= command.pocket < len(self.store.entries):
            raise ValueError(f"index {command.pocket}: the tool table ends at {len(self.store.entries) - 1}")
        pose = command.offset
        tool = Tool(
            command.toolno,
            0,
            [pose.tran.x, pose.tran.y, pose.tran.z, pose.a, pose.b, pose.c, pose.u, pose.v, pose.w],
            command.diameter,
            command.frontangle,
            command.backangle,
            command.orientation,
        )
        self.store.write(command.pocket, tool)
        self.source.put(tool)
        self.changer.table_changed = self.changer.must_save = True

    def _load_table(self, command: EMC_TOOL_LOAD_TOOL_TABLE) -> None:
        self._took_over(self.source.reload(self.store, command.file))

    def _took_over(self, remarks: list[str]) -> None:
        """The store holds other tools than before, but for those that were left out."""
        for remark in remarks:
            self._complain(remark)
        self.pins["tool-number"] = self.store.in_spindle
        self.changer.table_changed = True

    def _estop_on(self, command: Message) -> None:
        self.pins["user-enable-out"] = False
        self.pins["user-request-enable"] = False

    def _estop_off(self, command: Message) -> None:
        self.pins["user-enable-out"] = True
        self.pins["user-request-enable"] = False
        self._raise_request = True

    def _coolant(self, kind: str, on: bool) -> None:
        self.pins[f"coolant-{kind}"] = on

    def _lube(self, on: bool) -> None:
        self.pins["lube"] = on

    def _set_debug(self, command: EMC_SET_DEBUG) -> None:
        self.status.debug = command.debug

    def _all_off(self) -> None:
        for name in ("user-enable-out", "user-request-enable", "coolant-mist", "coolant-flood", "lube"):
            self.pins[name] = False
        self.changer.abort(Reason.TASK_STATE_ESTOP)

    # --- Reports

    def _follow_table(self) -> None:
        changer = self.changer
        remarks = self.source.arrived(self.store)
        if remarks is not None:
            self._took_over(remarks)
        for event in changer.spindle_events:
            self.source.spindle(*event)
        changer.spindle_events.clear()
        if changer.must_save:
            changer.must_save = False
            self.source.save(self.store)
        if changer.table_changed:
            changer.table_changed = False
            self.store.fill(self.table)
            self.channels.table.write(self.table)

    def _fill_status(self) -> None:
        status = self.status
        busy = self.changer.busy or self.source.busy
        status.status = ERROR if self._failed else EXEC if busy else DONE
        status.aux.estop = int(not self.pins["emc-enable-in"])
        status.coolant.mist = int(self.pins["coolant-mist"])
        status.coolant.flood = int(self.pins["coolant-flood"])
        status.lube.on = int(self.pins["lube"])
        status.lube.level = int(self.pins["lube_level"])
        status.fault, status.reason = self.changer.fault, self.changer.reason
        status.tool.pocketPrepped = self.changer.prepared
        status.tool.toolInSpindle = self.changer.in_spindle
        status.tool.toolFromPocket = self.changer.from_pocket

    def _changed(self) -> bool:
        return bytes(self.status.data) != self._reported

    def _report(self) -> None:
        self._last_report = clock.host_now()
        self.status.heartbeat = (self.status.heartbeat + 1) & 0xFFFFFFFF
        self.channels.status.write(self.status)
        self._reported = bytes(self.status.data)
