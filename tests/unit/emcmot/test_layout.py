"""A compiled module of an older build does not load beside newer ones."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import emcmot.motmod  # noqa: F401  (imports everything that reports a size)
from emcmot.layout import same_size

PACKAGE = Path(__file__).parents[3] / "emcmot"


@pytest.mark.parametrize("structure", ["Motion", "TpSegment", "TpStatus", "Kinematics"])
def test_another_size_of_a_shared_structure_ends_the_import(structure: str) -> None:
    with pytest.raises(ImportError, match=f"emcmot.old was built with 8 bytes for {structure}.*build the package"):
        same_size("emcmot.old", structure, 8)


def test_every_module_that_works_on_the_memory_of_motion_reports_its_size() -> None:
    silent = []
    for path in sorted(PACKAGE.glob("*.pyx")):
        source = path.read_text()
        if re.search(r"\bMotion\* m\b", source) and 'same_size(__name__, "Motion"' not in source:
            silent.append(path.name)
    assert silent == []
