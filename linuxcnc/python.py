"""The command ``linuxcnc-python``: the Python that our modules belong to, for the first line of a machine's scripts."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Become that Python, with the same arguments."""
    os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
