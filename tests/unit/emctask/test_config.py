"""What task makes of the INI file."""

from __future__ import annotations

from pathlib import Path

import pytest

from emctask.config import read_config
from nml.inifile import IniFile

MILL = Path(__file__).parents[3] / "configs" / "sim" / "mill" / "mill_mm.ini"


@pytest.mark.parametrize(
    ("written", "debug"), [("0", 0), ("0x7FFFFFFF", 0x7FFFFFFF), ("0xFFFFFFFF", -1), ("0x80000000", -0x80000000)]
)
def test_a_debug_mask_of_32_bits_becomes_the_int_that_carries_it(tmp_path: Path, written: str, debug: int) -> None:
    ini = tmp_path / "machine.ini"
    lines = [line for line in MILL.read_text().splitlines() if not line.startswith("DEBUG")]
    lines.insert(lines.index("[EMC]") + 1, f"DEBUG = {written}")
    ini.write_text("\n".join(lines))
    assert read_config(IniFile(ini)).debug == debug
