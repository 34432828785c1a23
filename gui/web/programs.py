"""The loaded program: opened by clients, indexed for them, watched for changes; and the check before a run from a
line.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
from pathlib import Path
from typing import Any, Protocol

import linuxcnc
from gui.web.calls import CallError
from gui.web.loaded import ProgramText
from gui.web.machine import Machine
from gui.web.programfolder import ProgramFolder, version_of
from gui.web.state import State
from linuxcnc.filters import filtered
from nml.errors import PyemcError
from nml.inifile import IniFile

LOOK = 1.0  # s between looks at files that other programs may change
LONGEST_FILE_NAME = 254  # bytes, of task


class Rehearsal(Protocol):
    """Finds the state that a program has at a line; see ``gui.web.preview``."""

    async def state_at(self, path: Path, line: int) -> dict[str, Any]: ...


class Programs:
    """The program that task has loaded, as clients see it."""

    def __init__(
        self, ini: IniFile, machine: Machine, state: State, folder: ProgramFolder, rehearsal: Rehearsal
    ) -> None:
        self.text: ProgramText | None = None
        self._ini = ini
        self._loop = asyncio.get_running_loop()
        self._machine = machine
        self._state = state
        self._folder = folder
        self._rehearsal = rehearsal
        self._checked: dict[str, Any] | None = None
        self._newest = 0.0
        self._lock = asyncio.Lock()
        state.update({"program": None, "programs": 1, "run_from": None, "opening": None})
        state.listen(self._state_changed)
        self._tasks: set[asyncio.Task[None]] = set()

    async def open(self, file: Path) -> None:
        """Have task load a file."""
        if self._machine.values["interp_state"] != linuxcnc.INTERP_IDLE:
            raise CallError("state", "a program runs")
        program = await self._through_filter(file)
        if len(str(program).encode()) > LONGEST_FILE_NAME:
            raise CallError("file", "the file's path is too long for the machine")
        await self._machine.mode(linuxcnc.MODE_AUTO)
        await self._machine.order("program_open", str(program))
        await self.index(str(program))

    async def _through_filter(self, file: Path) -> Path:
        """What [FILTER] makes of a file, with its progress in the state; most files are programs themselves."""

        def progress(percent: int) -> None:
            self._loop.call_soon_threadsafe(self._state.update, {"opening": {"name": file.name, "percent": percent}})

        try:
            return await asyncio.to_thread(filtered, self._ini, file, progress)
        except PyemcError as reason:
            raise CallError("file", "{reason}", reason=str(reason)) from None
        finally:
            self._state.update({"opening": None})

    async def changed(self, relative: str) -> None:
        """A client has written a file: the loaded one is loaded again."""
        self._state.bump("programs")
        path = self._folder.resolve(relative)
        if self.text is not None and self.text.path == path:
            if self._machine.values["interp_state"] == linuxcnc.INTERP_IDLE:
                await self._machine.order("program_open", str(path))
            await self.index(str(path))

    def _state_changed(self, changed: dict[str, Any]) -> None:
        if "file" in changed:
            task = asyncio.create_task(self.index(changed["file"]))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)

    async def index(self, file: str) -> None:
        """Publish a program under the name that task gives it."""
        async with self._lock:
            path = Path(file) if file else None
            if self.text is not None and path == self.text.path and version_of(self.text.path) == self.text.version:
                return
            self.text = None
            if path is not None:
                with contextlib.suppress(OSError):
                    self.text = await asyncio.to_thread(ProgramText, path)
            self._checked = None
            card = self.text and self.text.card(self._folder.relative(self.text.path))
            self._state.update({"program": card, "run_from": None})

    async def watch(self) -> None:
        """Notice what other programs do to the folder and to the loaded file, until cancelled."""
        while True:
            await asyncio.sleep(LOOK)
            newest = await asyncio.to_thread(self._folder_time)
            if newest != self._newest:
                self._newest = newest
                self._state.bump("programs")
            if self.text is not None and version_of(self.text.path) != self.text.version:
                await self.index(str(self.text.path))

    def _folder_time(self) -> float:
        try:
            return self._folder.root.stat().st_mtime
        except OSError:
            return 0.0

    # --- run from a line -------------------------------------------------------------------------------------------

    async def check_run_from(self, line: int) -> dict[str, Any]:
        """What differs between the machine and the state that the program would have at a line."""
        assert self.text is not None
        wanted = await self._rehearsal.state_at(self.text.path, line)
        now = {name: self._machine.values[name] for name in ("gcode_text", "mcode_text", "tool_in_spindle", "position")}
        found = differences(now, wanted)
        self._checked = {
            "token": secrets.token_hex(8),
            "line": line,
            "version": self.text.version,
            "machine": now,
            "wanted": wanted,
            "differences": found,
            "blocked": wanted.get("blocked"),
        }
        self._state.update({"run_from": {"line": line, "differences": found, "blocked": wanted.get("blocked")}})
        return self._checked

    async def redeem(self, line: int, token: str | None) -> None:
        """CallError unless this line's difference was shown just before, and nothing it says has changed since."""
        checked = self._checked
        if checked is None or token != checked["token"] or line != checked["line"]:
            raise CallError("state", "look at the difference first, then run from the line")
        if checked["blocked"]:
            raise CallError("state", "{reason}", reason=checked["blocked"])
        assert self.text is not None
        if checked["version"] != version_of(self.text.path):
            raise CallError("conflict", "{path} was changed meanwhile", path=self.text.path.name, version=None)
        now = {name: self._machine.values[name] for name in checked["machine"]}
        if now != checked["machine"]:
            raise CallError("conflict", "the machine was changed meanwhile; look at the difference again", version=None)
        self._checked = None
        self._state.update({"run_from": None})


def differences(now: dict[str, Any], wanted: dict[str, Any]) -> list[dict[str, Any]]:
    """What an operator must know before the program goes on there: code by code, tool, place."""
    found = []
    for what, key in (("G codes", "gcodes"), ("M codes", "mcodes")):
        mine = now["gcode_text" if key == "gcodes" else "mcode_text"]
        extra = [code for code in wanted.get(key, []) if code not in mine]
        if extra:
            found.append({"what": what, "now": " ".join(mine), "wanted": " ".join(extra)})
    tool = wanted.get("tool")
    if tool is not None and tool != now["tool_in_spindle"]:
        found.append({"what": "tool", "now": f"T{now['tool_in_spindle']}", "wanted": f"T{tool}"})
    for what, key in (("feed", "feed"), ("spindle speed", "speed")):
        if wanted.get(key):
            found.append({"what": what, "now": "", "wanted": f"{wanted[key]:g}"})
    place = wanted.get("position")
    if place is not None and any(abs(a - b) > 1e-5 for a, b in zip(place, now["position"], strict=True)):
        found.append({"what": "position", "now": _numbers(now["position"]), "wanted": _numbers(place)})
    return found


def _numbers(position: list[float]) -> str:
    return " ".join(f"{letter}{value:.4f}" for letter, value in zip("XYZABCUVW", position, strict=True) if value)
