"""The reference page of motion is the one that the tables make."""

from pathlib import Path

from emcmot.reference import text

PAGE = Path(__file__).parents[3] / "docs" / "motion-reference.md"


def test_the_reference_page_is_current() -> None:
    assert PAGE.read_text() == text(), "run: python -m emcmot.reference > docs/motion-reference.md"
