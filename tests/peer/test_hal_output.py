"""Side by side with Debian's halrun: each HAL file of the folder ``hal`` prints the same, byte for byte."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from tests.peer.test_hal_peer import PEER, peer
from tests.support.halsession import script

SCRIPTS = sorted((Path(__file__).parent / "hal").glob("*.hal"))

pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(PEER is None, reason="/usr/bin/halrun (linuxcnc-uspace) is not installed"),
    pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare"), reason="shielding the peer needs root"),
]


@pytest.mark.parametrize("path", SCRIPTS, ids=[path.stem for path in SCRIPTS])
def test_a_hal_file_prints_the_same_under_both(path: Path, tmp_path: Path) -> None:
    text = path.read_text()
    theirs = [line for line in peer(text).splitlines() if not line.startswith("Note:")]
    assert theirs, "the peer did not run"
    ours = script(tmp_path, text)
    assert ours.stdout.splitlines() == theirs, ours.stderr
