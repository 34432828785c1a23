"""How scripts that name the system's Python find our modules: displays, filters, changers written for LinuxCNC.

``#!/usr/bin/python3`` is not our interpreter. Where it is of our version, it gets our packages first, so that ``import
hal`` is ours, and what these import (``posix_ipc``, ...) last, so that a script's numpy stays the one that its other
modules were built for.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import posix_ipc

import nml
from nml import LIBRARIES, namespace

SYSTEM_PYTHON = Path("/usr/bin/python3")
DISTRIBUTION = "pyemc"
PACKAGES = Path(nml.__file__).parent.parent
OTHERS = Path(posix_ipc.__file__).parent
LINKS = "python"
"""Folder of links to our packages, in the machine's run-time folder."""


def is_ours() -> bool:
    """Whether the system's Python can load our native modules."""
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return os.path.realpath(SYSTEM_PYTHON).endswith(version)


def environment() -> dict[str, str]:
    """PYTHONPATH, and the variable of what our packages import."""
    folder = PACKAGES if PACKAGES != OTHERS else _links(namespace.runtime_dir() / LINKS)
    found = {"PYTHONPATH": os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))}
    if is_ours():
        found[LIBRARIES] = str(OTHERS)
    return found


def _links(folder: Path) -> Path:
    """A folder with our packages alone, where they are installed among others."""
    from importlib import metadata  # 17 ms, which only installations of this kind wait for

    folder.mkdir(exist_ok=True)
    for name in {file.parts[0] for file in metadata.files(DISTRIBUTION) or ()}:
        module = name.endswith(".py") or name.isidentifier()
        if module and not name.startswith("__") and not (folder / name).is_symlink():
            (folder / name).symlink_to(PACKAGES / name)
    return folder
