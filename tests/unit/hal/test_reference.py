"""The component reference in docs/ is that of the declarations."""

from __future__ import annotations

from hal.components import names
from hal.components.reference import TARGET, reference


def test_the_reference_is_up_to_date() -> None:
    assert TARGET.read_text(encoding="utf-8") == reference(), "run: python -m hal.components.reference"


def test_every_component_is_in_it() -> None:
    text = reference()
    assert [name for name in names() if f"## {name}\n" not in text] == []
