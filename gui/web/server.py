"""The web server of one machine: everything that belongs together, made, connected, and ended in order."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import logging
import sys
from pathlib import Path
from typing import Any

import gui.web.methods  # noqa: F401  registers what clients may call
import linuxcnc
from gui.web import dialogs, displaykeys, texts
from gui.web.access import Access
from gui.web.client import Client
from gui.web.forecast import Forecast
from gui.web.halview import NO_FEEDBACK, HalView
from gui.web.hub import Hub
from gui.web.jogging import BEAT_INTERVAL, BEAT_TIMEOUT, Jogging
from gui.web.machine import Machine
from gui.web.messages import Messages
from gui.web.preview import Preview
from gui.web.programfolder import ProgramFolder
from gui.web.programs import Programs
from gui.web.scope import Scope
from gui.web.settings import Settings
from gui.web.state import State
from gui.web.store import MdiHistory, Preferences
from gui.web.system import Processes
from hal.module import door
from nml.errors import HalError
from nml.inifile import IniFile

log = logging.getLogger(__name__)

FILES_LOOK = 0.5  # s between looks at the tool table and the parameter file
PINS_LOOK = 0.1  # s between looks at the pins of dialogs


class Server:
    """What a client's calls work on. Made inside the event loop."""

    def __init__(self, ini: IniFile, settings: Settings) -> None:
        self.ini = ini
        self.settings = settings
        self.config = displaykeys.configuration(ini, settings) | {"wizard": False}
        self.access = Access(settings)
        self.state = State()
        self.messages = Messages(settings.log_file, lambda message: self.hub.tell_message(message))
        self.hub = Hub(self.state, self.messages.notice)
        self.state.update({"machine": "task does not answer", "tools": 1, "offsets": 1, "preferences": 1})
        self.machine = Machine(self.config["cycle_time"], self._show_status, self.messages.add)
        self.jogging = Jogging(self.machine, self.state)
        self.hub.on_release(self.jogging.client_left)
        self.folder = ProgramFolder.of(settings.program_folder, self.config["program_extensions"])
        self.preview = Preview(ini.file.resolve(), self.config, self.state)
        self.forecast = Forecast(ini.file.resolve(), self.state, self.preview)
        self.programs = Programs(ini, self.machine, self.state, self.folder, self.preview)
        self.history = MdiHistory(settings.mdi_history_file)
        self.preferences = Preferences(settings.preference_file)
        self.tool_file: Path | None = (
            ini.path("EMCIO", "TOOL_TABLE", None) if not ini.find("EMCIO", "DB_PROGRAM") else None
        )
        self.parameter_file: Path | None = ini.path("RS274NGC", "PARAMETER_FILE", None)
        self.dialogs = dialogs.Dialogs(dialogs.questions(ini), self.state, self.messages.add)
        self.toolchange = dialogs.ToolChange(self.state)
        self.hal = self._hal_view()
        self.scope: Scope | None = None
        self.scope_owner: Client | None = None
        self.processes = Processes()
        self._tasks: list[asyncio.Task[None]] = []

    def _hal_view(self) -> HalView | None:
        """The HAL of this computer; none where only the NML buffers of a machine elsewhere are in reach."""
        try:
            return HalView(door(), self.settings.hal_write)
        except HalError as reason:
            log.warning("no HAL pages: %s", reason)
            return None

    async def start(self) -> None:
        """Begin to follow the machine; then run the HAL files that wait for the display's pins."""
        self.dialogs.create_pins()
        self.config |= {
            "languages": texts.languages(),
            "jog_heartbeat": {"interval": BEAT_INTERVAL, "timeout": BEAT_TIMEOUT},
            "manual_tool_change": self.toolchange.present,
            "version": linuxcnc.version,
        }
        await self._post_gui()
        self.machine.start()
        self._tasks = [
            asyncio.create_task(work) for work in (self.programs.watch(), self._watch_files(), self._watch_pins())
        ]

    async def stop(self) -> None:
        """Stop what moves, say goodbye to everybody, end every thread and worker."""
        with contextlib.suppress(Exception):
            async with asyncio.timeout(1.0):
                await self.jogging.stop()
        for client in list(self.hub.clients.values()):
            with contextlib.suppress(Exception):
                async with asyncio.timeout(0.5):
                    await client.dismiss()
        for task in self._tasks:
            task.cancel()
        await self.preview.close()
        self.forecast.stop()
        if self.scope is not None:
            await asyncio.to_thread(self.scope.stop)
        await asyncio.to_thread(self.machine.stop)

    def greeting(self, language: str) -> dict[str, Any]:
        """What hello brings besides the client's own."""
        return {
            "config": self.config,
            "status": self.state.values,
            "messages": self.messages.newest(language),
            "preferences": self.preferences.values,
            "history": self.history.lines,
        }

    def _show_status(self, values: dict[str, Any]) -> None:
        for number, spindle in enumerate(values.get("spindle", [])):
            spindle |= self.hal.spindle(number) if self.hal is not None else NO_FEEDBACK
        self.state.update(values)

    async def _post_gui(self) -> None:
        """[HAL]POSTGUI_HALFILE and POSTGUI_HALCMD, in this order, each with what is wrong as a message."""
        files = self.ini.findall("HAL", "POSTGUI_HALFILE")
        jobs: list[tuple[str, ...]] = [("-f", str(self.ini.resolve(file))) for file in files]
        jobs += [tuple(text.split()) for text in self.ini.findall("HAL", "POSTGUI_HALCMD")]
        for words in jobs:
            process = await asyncio.create_subprocess_exec(
                sys.executable, "-P", "-m", "hal.halcmd", "-i", str(self.ini.file), *words,
                stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT,
            )  # fmt: skip
            output, _ = await process.communicate()
            if process.returncode:
                self.messages.add(
                    "error", output.decode(errors="replace").strip() or f"halcmd {' '.join(words)} failed"
                )

    async def _watch_files(self) -> None:
        """Notice new tool tables and coordinate systems, whoever wrote them."""
        known = await asyncio.to_thread(self._file_contents)
        while True:
            await asyncio.sleep(FILES_LOOK)
            found = await asyncio.to_thread(self._file_contents)
            for key, value in found.items():
                if value != known[key]:
                    self.state.bump(key)
            known = found

    def _file_contents(self) -> dict[str, Any]:
        return {"tools": _fingerprint(self.tool_file), "offsets": _fingerprint(self.parameter_file)}

    async def _watch_pins(self) -> None:
        while True:
            await asyncio.sleep(PINS_LOOK)
            self.dialogs.look()
            self.toolchange.look()


def _fingerprint(path: Path | None) -> bytes | None:
    """Changes with the content of a file; None where there is none that can be read."""
    try:
        return hashlib.blake2b(path.read_bytes()).digest() if path is not None else None
    except OSError:
        return None
