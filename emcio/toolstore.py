"""The tools in memory: which are in the table, which is in the spindle, and what a change does to them.

Entry 0 is the spindle; its numbers are -1 as long as nobody knows of a tool there. On a nonrandom changer the other
entries follow each other as the file lists them (their pocket numbers are only remarks of the user), a change
**copies** the tool into entry 0, and tool 0 means an empty spindle. On a random changer the index of an entry is its
pocket, a change **swaps** it with entry 0, and tool 0 is a tool like any other.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable

from emcio.tooltable import Tool, ToolFile
from nml.emc.tooltable import CANON_POCKETS_MAX, EMC_TOOL_TABLE, REMARK_LENGTH

NO_TOOL = NO_POCKET = -1


class ToolStore:
    """The table of one machine."""

    def __init__(self, random: bool) -> None:
        self.random = random
        self.entries = self._empty()
        self.entries[0] = Tool(pocketno=NO_POCKET)
        self._held = 0
        """Number of the tool in a nonrandom spindle: EMC_TOOL_SET_OFFSET may write what it likes into entry 0."""
        self.last_index = 0

    def _empty(self) -> list[Tool]:
        return [Tool(pocketno=index if self.random else 0) for index in range(CANON_POCKETS_MAX)]

    def empty_spindle(self) -> None:
        """The tool was taken out of a nonrandom spindle."""
        self.entries[0] = Tool(toolno=0)
        self._held = 0

    def load(self, tools: Iterable[Tool], file: ToolFile | None = None) -> list[str]:
        """Take over what the file or the data base lists; the tool in a nonrandom spindle gets its new values.

        A random changer's file lists the spindle, too: as pocket 0, or it is empty.

        Tools that this kind of changer cannot hold are left out; the result says which and why.
        """
        entries = self._empty()
        entries[0] = Tool(pocketno=NO_POCKET) if self.random or not self.in_spindle else self.entries[0]
        taken: dict[int, int] = {}
        remarks = []
        for tool in tools:
            index = tool.pocketno if self.random else len(taken) + 1
            problem = self._problem(tool, index, taken)
            if problem:
                remarks.append(f"{file.place(tool.toolno)}: {problem}" if file else problem)
                continue
            entries[index] = tool.copy()
            taken[index] = tool.toolno
        self.entries = entries
        self.last_index = max(taken, default=0)
        home = self.index_of(self._held) if not self.random else -1
        if home > 0:
            self._copy_to_spindle(home)
        return remarks

    def _problem(self, tool: Tool, index: int, taken: dict[int, int]) -> str:
        """Why a tool cannot have this index; empty if it can."""
        last = CANON_POCKETS_MAX - 1
        if tool.toolno < (0 if self.random else 1):
            rule = "from 0" if self.random else "from 1 on a nonrandom changer, T0 is the empty spindle"
            return f"T{tool.toolno} is left out: tool numbers go {rule}"
        if not 0 <= index <= last:
            where = "pockets of a random changer are 0 (spindle)" if self.random else "tables hold tools 1"
            return f"T{tool.toolno} P{tool.pocketno} is left out: {where} to {last}"
        if index in taken:
            return f"T{tool.toolno} is left out: pocket {index} holds T{taken[index]} already"
        return ""

    @property
    def in_spindle(self) -> int:
        """Number of the tool in the spindle; none is 0, on a random changer, where 0 is a tool, -1."""
        return self.entries[0].toolno if self.random else self._held

    def index_of(self, toolno: int) -> int:
        """Index of a tool; -1: not in the table. The empty spindle of a nonrandom changer is index 0."""
        if not self.random and toolno == 0:
            return 0
        first = 0 if self.random else 1
        for index in range(first, self.last_index + 1):
            if self.entries[index].toolno == toolno:
                return index
        return -1

    def pocket_of(self, index: int) -> int:
        """The changer's pocket of entry ``index``."""
        return index if self.random else self.entries[index].pocketno if index else 0

    def load_spindle(self, index: int) -> bool:
        """The changer put tool ``index`` into the spindle; True when the table file must be written."""
        if not self.random:
            if index:
                self._copy_to_spindle(index)
            else:
                self.empty_spindle()
            return False
        entries = self.entries
        entries[0], entries[index] = entries[index], entries[0]
        entries[0].pocketno = 0
        entries[index].pocketno = index
        return True

    def _copy_to_spindle(self, index: int) -> None:
        self.entries[0] = self.entries[index].copy()
        self._held = self.entries[0].toolno

    def write(self, index: int, tool: Tool) -> None:
        """G10 L1, L10, L11: new values for entry ``index``; the copy in a nonrandom spindle follows."""
        entry = self.entries[index]
        tool.pocketno, tool.remark = entry.pocketno, entry.remark
        self.entries[index] = tool
        if not self.random and index and tool.toolno == self._held:
            self._copy_to_spindle(index)

    def listed(self) -> list[Tool]:
        """The tools that belong into the file."""
        first = 0 if self.random else 1
        return [tool for tool in self.entries[first : self.last_index + 1] if tool.toolno != NO_TOOL]

    def fill(self, message: EMC_TOOL_TABLE) -> None:
        """Write the table into the message of the ``toolTable`` buffer."""
        message.random = int(self.random)
        message.last_index = self.last_index
        base, remarks = (EMC_TOOL_TABLE.field(name)[1] for name in ("tools", "remarks"))
        for index, tool in enumerate(self.entries):
            _ENTRY.pack_into(
                message.data,
                base + index * _ENTRY.size,
                tool.toolno,
                tool.pocketno,
                *tool.offset,
                tool.diameter,
                tool.frontangle,
                tool.backangle,
                tool.orientation,
            )
            text = tool.remark.encode()[: REMARK_LENGTH - 1].decode(errors="ignore").encode()
            _REMARK.pack_into(message.data, remarks + index * _REMARK.size, text)


_ENTRY = struct.Struct("<ii12di4x")
_REMARK = struct.Struct(f"{REMARK_LENGTH}s")
