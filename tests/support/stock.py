"""Debian's LinuxCNC as a peer: its Python module in a process of its own, as a client of our server."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from tests.support.nml_server import remote_text

PYTHON = Path("/usr/bin/python3")
MODULE_FOUND = any(Path("/usr/lib/python3/dist-packages").glob("linuxcnc*.so"))
TOOL_MAP_BYTES = 16 + 1001 * 112

needs_module = pytest.mark.skipif(not MODULE_FOUND, reason="Debian's linuxcnc module is not installed")

DRIVE = """
s = linuxcnc.stat(); s.poll(); c = linuxcnc.command(); e = linuxcnc.error_channel()
def do(name, *args):
    getattr(c, name)(*args)
    result = c.wait_complete(60)
    s.poll()
    return result
def until(condition, seconds=60):
    end = time.monotonic() + seconds
    s.poll()
    while not condition():
        assert time.monotonic() < end, 'timeout'
        time.sleep(0.01)
        s.poll()
def ready():
    do("state", linuxcnc.STATE_ESTOP_RESET); do("state", linuxcnc.STATE_ON)
    do("home", -1); until(lambda: all(s.homed[:3]))
"""
"""Helpers of scripts that drive a machine, for either module."""

_PRELUDE = """
import json, sys, time
import linuxcnc
linuxcnc.nmlfile = sys.argv[1]
out = []
"""


class StockClient:
    """Runs scripts for the stock module; a script puts what it finds into the list ``out``."""

    def __init__(self, folder: Path, nml_file: Path) -> None:
        self.home = folder / "home"
        self.home.mkdir(exist_ok=True)
        (self.home / ".tool.mmap").write_bytes(bytes(TOOL_MAP_BYTES))
        self.file = folder / "stock.nml"
        self.file.write_text(remote_text(nml_file.read_text()))

    def environment(self) -> dict[str, str]:
        """For programs that must not meet the project's own modules."""
        return {"HOME": str(self.home), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"}

    def start(self, script: str) -> subprocess.Popen[str]:
        """The script as a process; it prints ``out`` as its last line."""
        text = _PRELUDE + script + "\nprint(json.dumps(out))\n"
        return subprocess.Popen(
            [str(PYTHON), "-c", text, str(self.file)],
            cwd=self.home,
            env=self.environment(),
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, script: str, seconds: float = 300.0) -> list[Any]:
        """What the script put into ``out``."""
        process = self.start(script)
        text, _ = process.communicate(timeout=seconds)
        assert process.returncode == 0, f"the stock client ended with {process.returncode}"
        return json.loads(text.splitlines()[-1])
