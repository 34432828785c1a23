"""Names of everything that a controller creates outside its own memory.

Several complete controllers run on one host side by side: each has a namespace, taken from the environment variable
``PYEMC_NAMESPACE`` (the launcher's ``--namespace`` sets it), and every shared-memory segment, semaphore, socket and
run-time file hangs on it. Nothing in the project builds such a name by any other means.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

VARIABLE = "PYEMC_NAMESPACE"
_ALLOWED = re.compile(r"[A-Za-z0-9_-]{1,40}")


def namespace() -> str:
    """The namespace of this process; ``u<uid>`` where none is set. ValueError if the name is not usable."""
    name = os.environ.get(VARIABLE) or f"u{os.getuid()}"
    if not _ALLOWED.fullmatch(name):
        raise ValueError(f"{VARIABLE}={name!r}: 1 to 40 letters, digits, '_' or '-' are allowed")
    return name


def shm_name(what: str) -> str:
    """POSIX shared-memory (or semaphore) name of ``what`` in this namespace, e.g. ``/pyemc.u1000.hal``."""
    return f"/pyemc.{namespace()}.{what}"


def runtime_dir() -> Path:
    """Folder for sockets, pid files and logs of this namespace; made on first use, for its owner only (mode 0700)."""
    base = Path(os.environ.get("XDG_RUNTIME_DIR") or f"/tmp/pyemc-{os.getuid()}")
    path = base / "pyemc" / namespace()
    path.mkdir(mode=0o700, parents=True, exist_ok=True)
    return path
