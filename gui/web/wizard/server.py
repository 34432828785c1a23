"""The wizard in a browser: the same site and page as a machine's, with no machine behind it yet."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gui.web.wizard.methods  # noqa: F401  registers what clients may call
import linuxcnc
from gui.web import settings, texts
from gui.web.access import Access
from gui.web.hub import Hub
from gui.web.messages import Messages
from gui.web.settings import Settings
from gui.web.state import State

PORT_VARIABLE = settings.PORT_VARIABLE


class NoJogs:
    """There is nothing to jog."""

    def beat(self, client: Any, number: Any) -> None:
        """Beats that a page sends all the same mean nothing."""


class WizardServer:
    """What clients of the wizard see and call."""

    def __init__(self, chosen: Settings, place: Path, finish: Callable[[], None]) -> None:
        self.settings = chosen
        self.place = place
        self.access = Access(chosen)
        self.state = State()
        self.messages = Messages(None, lambda message: self.hub.tell_message(message))
        self.hub = Hub(self.state, self.messages.notice)
        self.jogging = NoJogs()
        self.programs = None
        self.config: dict[str, Any] = {
            "wizard": True,
            "title": "LinuxCNC",
            "machine": "",
            "languages": texts.languages(),
            "embed_tabs": [],
            "version": linuxcnc.version,
            "folder": str(place),
        }
        self._finish = finish
        self.state.update({"machine": "no machine runs"})

    def greeting(self, language: str) -> dict[str, Any]:
        """What hello brings besides the client's own."""
        return {
            "config": self.config, "status": self.state.values, "messages": self.messages.newest(language),
            "preferences": {}, "history": [],
        }  # fmt: skip

    async def start(self) -> None:
        """Nothing has to be followed."""

    async def stop(self) -> None:
        """Say goodbye to everybody."""
        for client in list(self.hub.clients.values()):
            await client.dismiss()

    def start_machine(self, ini: Path, port: int) -> None:
        """Hand over to ``linuxcnc INI``, whose display takes the same port, and end."""
        subprocess.Popen(
            [sys.executable, "-P", "-m", "linuxcnc_start", str(ini)],
            env={**os.environ, PORT_VARIABLE: str(port)},
            cwd=ini.parent,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
        )
        asyncio.get_running_loop().call_later(0.2, self._finish)
