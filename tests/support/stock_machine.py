"""A simulated mill run by Debian's LinuxCNC, away from everything: own network, shared memory, processes and /tmp.

``session`` starts it as an ordinary user (it refuses to run as root) together with a script for our Python, which is
the only program that can reach it. ``display`` runs a script for Debian's Python as the machine's display.
"""

from __future__ import annotations

import json
import os
import pwd
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest

from nml import namespace
from tests.support import plain_mill, shield
from tests.support.nml_server import SOURCE, remote_text

USER = next((name for name in ("lcnc", "nobody") if name in {entry.pw_name for entry in pwd.getpwall()}), None)
PORT = 5005

ENTER = """\
mkdir "$1/source" && mount --bind "$4" "$1/source" || exit 77
ip link set lo up && mount -t tmpfs tmpfs /tmp || exit 77
mkdir -p "$4" && mount --bind "$1/source" "$4" || exit 77  # the checkout may lie below /tmp
cd "$1"
export HOME="$1" USER={user} PATH=/usr/bin:/bin:/usr/sbin:/sbin
su {user} -s /bin/sh -c 'HOME=$PWD exec linuxcnc machine.ini' > machine.log 2>&1 &
"$2" "$3" > client.log 2>&1
status=$?
echo over > over
wait
exit $status
"""
DISPLAY = "#!/bin/sh\nwhile [ ! -e over ]; do sleep 0.1; done\n"

WAIT_FOR_SERVER = f"""
import json, os, socket, sys, time
sys.path.insert(0, {str(SOURCE)!r})
end = time.monotonic() + 60
while socket.socket().connect_ex(("127.0.0.1", {PORT})):
    assert time.monotonic() < end, "the stock server does not listen"
    time.sleep(0.1)
out = []
"""


def reason_to_skip() -> str | None:
    """Why a stock machine cannot run here; None if it can."""
    if not Path("/usr/bin/milltask").exists():
        return "Debian's LinuxCNC is not installed"
    if USER is None:
        return "there is no ordinary user to run LinuxCNC as"
    return shield.reason_to_skip()


_REASON = reason_to_skip()
needs_stock_machine = pytest.mark.skipif(_REASON is not None, reason=_REASON or "")


def display(script: str, *, changes: dict[str, str] | None = None, seconds: float = 300.0) -> list[Any]:
    """Run ``script`` with Debian's Python as the display of a stock machine: what it put into the list ``out``.

    ``changes``: pieces of the INI file and what stands in their place.
    """
    wait = "import os, time\nwhile not os.path.exists('over') and os.getppid() > 1: time.sleep(0.05)\n"
    return _run(wait, "", seconds, _as_display(script, "/usr/bin/python3"), changes or {})


def ours(folder: Path, script: str, *, changes: dict[str, str] | None = None, seconds: float = 300.0) -> list[Any]:
    """The same script with our Python as the display of a machine of ours with the same files, below ``folder``."""
    folder = Path(tempfile.mkdtemp(dir=folder))
    _write(folder, _as_display(script, sys.executable), changes or {})
    (folder / "server.nml").write_text(re.sub(r"TCP=\d+ xdr", "", Path("/usr/share/linuxcnc/linuxcnc.nml").read_text()))
    done = subprocess.run(
        [sys.executable, "-m", "linuxcnc_start", "machine.ini"],
        cwd=folder,
        env={**os.environ, "HOME": str(folder), "PYTHONPATH": str(SOURCE), namespace.VARIABLE: f"ours{os.getpid()}"},
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )
    assert (folder / "out.json").exists(), done.stdout + done.stderr
    return json.loads((folder / "out.json").read_text())


def _as_display(script: str, python: str) -> str:
    """A program that runs the script and leaves its list ``out`` behind."""
    text = f"#!{python}\nimport json, os, subprocess, sys, time\nimport linuxcnc\nout = []\n{script}\n"
    return text + "open('out.json', 'w').write(json.dumps(out))\nopen('over', 'w').close()\n"


def session(script: str, options: str = "", seconds: float = 300.0, status: str = "") -> list[Any]:
    """Run ``script`` with our Python beside a stock machine: what it put into the list ``out``.

    ``options``: of the clients' process lines; ``status``: of the line of emcStatus.
    """
    client = f"{WAIT_FOR_SERVER}{script}\nopen('out.json', 'w').write(json.dumps(out))\n"
    return _run(client, options, seconds, DISPLAY, {}, status)


def _run(
    client: str, options: str, seconds: float, display: str, changes: dict[str, str], status: str = ""
) -> list[Any]:
    folder = Path(tempfile.mkdtemp(prefix="pyemc-stock-", dir="/var/tmp"))
    try:
        _prepare(folder, client, options, display, changes, status)
        command = [*shield.SHIELD, "--mount", "--kill-child"]
        command += ["sh", "-c", ENTER.format(user=USER), "sh", str(folder), sys.executable, str(folder / "client.py")]
        command += [str(SOURCE)]
        process = subprocess.run(command, timeout=seconds)
        found = [folder / name for name in ("machine.log", "client.log", "linuxcnc_debug.txt")]
        logs = "".join(path.read_text(errors="replace")[-3000:] for path in found if path.exists())
        assert process.returncode == 0, logs
        assert (folder / "out.json").exists(), logs
        return json.loads((folder / "out.json").read_text())
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _prepare(
    folder: Path, client: str, options: str, display: str, changes: dict[str, str], status: str
) -> None:
    nml = Path("/usr/share/linuxcnc/linuxcnc.nml").read_text()
    nml = re.sub(r"^(B emcStatus\s.*)$", rf"\1 {status}", nml, flags=re.MULTILINE)
    _write(folder, display, changes)
    files = {"server.nml": nml, "client.nml": remote_text(nml, options), "client.py": client}
    for name, text in files.items():
        (folder / name).write_text(text)
    for path in (folder, *folder.iterdir()):
        shutil.chown(path, USER)
    folder.chmod(0o755)


def _write(folder: Path, display: str, changes: dict[str, str]) -> None:
    """The machine's own files, but for the NML file."""
    program = folder / "display"
    program.write_text(display)
    program.chmod(0o755)
    plain_mill.write(folder, str(program), changes)
