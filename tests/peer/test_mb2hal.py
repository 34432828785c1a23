"""Side by side with Debian's mb2hal: the same file makes the same pins, and the same is told of it."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.peer.test_hal_peer import peer, pytestmark  # noqa: F401 - the marks are this module's too
from tests.support.halsession import script

CODES = (
    "02_read_discrete_inputs", "03_read_holding_registers", "04_read_input_registers", "06_write_single_register",
    "15_write_multiple_coils", "16_write_multiple_registers", "01_read_coils", "05_write_single_coil",
)  # fmt: skip
NEW = 2  # so many of them are not in version 1.0
NET = "LINK_TYPE=tcp\nTCP_IP=127.0.0.1\nMB_SLAVE_ID=3\n"
LINE = (
    "LINK_TYPE=serial\nSERIAL_PORT=/dev/nowhere\nSERIAL_BAUD=9600\nSERIAL_BITS=7\nSERIAL_PARITY=odd\nSERIAL_STOP=2\n"
    "SERIAL_DELAY_MS=1\nMB_SLAVE_ID=4\nMB_BYTE_TIMEOUT_MS=20\n"
)
OURS = f"loadusr -Wn mb2hal {sys.executable} -m hal.modbus.program"
CHANGES = re.compile(r"^ *\d+ |unloading HAL module \[\d+\]|\S+(?= +\S+num_errors$)", re.MULTILINE)


def lasting(text: str) -> str:
    """Without identities, counted errors and the widths of columns, which differ from version to version."""
    return re.sub(" +", " ", CHANGES.sub("", text))


def configuration(version: str, debug: int) -> str:
    codes = CODES if version == "1.1" else CODES[:-NEW]
    text = f"[MB2HAL_INIT]\nINIT_DEBUG={debug}\nVERSION={version}\nTOTAL_TRANSACTIONS={len(codes)}\n"
    for number, code in enumerate(codes):
        link = {0: NET, 3: LINE}.get(number, "")
        elements = "PIN_NAMES=one,two\n" if number == 1 else "NELEMENTS=3\n"
        name = f"HAL_TX_NAME=tx-{number}\n" if number % 2 else ""
        text += f"[TRANSACTION_{number:02}]\n{link}MB_TX_CODE=fnct_{code}\nFIRST_ELEMENT={number}\n{elements}{name}"
        text += f"MAX_UPDATE_RATE={number}\nDEBUG=0\n"
    return text


@pytest.mark.parametrize("version", ["1.0", "1.1"])
def test_the_pins_are_the_peers(tmp_path: Path, version: str) -> None:
    ini = configuration(version, 0)
    (tmp_path / "mb2hal.ini").write_text(ini)
    theirs = peer("loadusr -W mb2hal config=mb2hal.ini\nshow pin mb2hal\n", {"mb2hal.ini": ini})
    ours = script(tmp_path, f"{OURS} config=mb2hal.ini\nshow pin mb2hal\n")
    assert "mb2hal.tx-1.one.float" in theirs
    assert lasting(ours.stdout) == lasting(theirs), ours.stderr


@pytest.mark.parametrize("version", ["1.0", "1.1"])
def test_what_is_told_at_the_start_and_the_end_is_what_the_peer_tells(tmp_path: Path, version: str) -> None:
    ini = configuration(version, 3)
    (tmp_path / "mb2hal.ini").write_text(ini)
    theirs = peer("loadusr -W mb2hal config=mb2hal.ini\n", {"mb2hal.ini": ini})
    ours = script(tmp_path, f"{OURS} config=mb2hal.ini\n")
    assert "going to exit!" in theirs
    assert lasting(ours.stdout) == lasting(theirs), ours.stderr
