"""Namespaces of its own for Debian's LinuxCNC, whose shared memory and ports are the host's otherwise.

``SHIELD`` is the start of a command that runs in them; ``reason_to_skip`` says why this machine does not allow it.
"""

from __future__ import annotations

import functools
import os
import subprocess

SHIELD = ("unshare", "--ipc", "--net", "--pid", "--fork", "--mount-proc")
NOBODY = ("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups")
"""The stock programs refuse to run as root."""


@functools.cache
def reason_to_skip() -> str | None:
    """Why the stock programs cannot be shielded here; None if they can."""
    if os.geteuid() != 0:
        return "shielding the stock programs needs root"
    try:
        done = subprocess.run([*SHIELD, "ip", "link", "set", "lo", "up"], capture_output=True, text=True, check=False)
    except OSError as error:
        return f"shielding the stock programs is not possible: {error}"
    return f"namespaces are not allowed here: {done.stderr.strip()}" if done.returncode else None
