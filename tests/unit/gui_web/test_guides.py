"""The example of docs/web-panel.md does what the guide says."""

import asyncio
import re
import textwrap
from pathlib import Path
from types import SimpleNamespace

import pytest

from gui.web.calls import METHODS, CallError
from gui.web.state import State

GUIDE = Path(__file__).parents[3] / "docs" / "web-panel.md"


def block(file):
    """The code block of the guide that begins with the name of a file."""
    blocks = re.findall(r"(?:^    .*\n|^\n)+", GUIDE.read_text(), re.MULTILINE)
    return next(text for text in map(textwrap.dedent, blocks) if text.strip().startswith(f"# {file}"))


@pytest.fixture
def parts():
    scope = {}
    exec(block("gui/web/parts.py"), scope)
    return scope["Parts"](State())


def test_the_guides_state_key_counts_programs(parts):
    for interp_state in (1, 2, 3, 2, 1, 2, 1):
        parts._state.update({"interp_state": interp_state})
    assert parts._state["parts"] == 2


def test_the_guides_method_is_registered_and_checks_its_argument(parts):
    exec(block("gui/web/methods/parts.py"), {})
    row = METHODS.pop("parts.reset")
    caller = SimpleNamespace(server=SimpleNamespace(parts=parts))
    parts._state.update({"parts": 5})
    with pytest.raises(CallError):
        asyncio.run(row.function(caller, **row.arguments({"sure": False})))
    asyncio.run(row.function(caller, **row.arguments({"sure": True})))
    assert parts._state["parts"] == 0
