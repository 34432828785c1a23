"""Every text of the page goes through the catalogues, and German has all of them."""

from __future__ import annotations

import re
import string
from pathlib import Path

import polib
import pytest

from gui import web
from gui.web.wizard.questions import form

FOLDER = Path(web.__file__).parent
PAGE = FOLDER / "page"
CALL = re.compile(r"(?<![\w.$])_\(\s*(\"(?:[^\"\\]|\\.)*\")?")
VENDOR = "vendor"


def modules() -> list[Path]:
    return [path for path in sorted(PAGE.rglob("*.js")) if VENDOR not in path.parts]


def texts(path: Path) -> list[str]:
    """Literal texts of a module; a computed one would escape the catalogues."""
    found = []
    for match in CALL.finditer(path.read_text()):
        if path.name == "i18n.js":
            continue  # defines it
        assert match[1], (
            f"{path.name}: _() around something that is not a literal: {match.string[match.start() :][:60]}"
        )
        found.append(re.sub(r"\\(.)", r"\1", match[1][1:-1]))
    return found


def page_texts() -> set[str]:
    return {text for path in modules() for text in texts(path)}


def server_texts() -> set[str]:
    """Questions of the wizard and their choices of words, which the page looks up when it has got them."""
    asked = form()
    words = {choice for question in asked for choice in question.choices if choice.islower() and len(choice) > 2}
    return {question.text for question in asked} | words - {"inch"}


def catalogues() -> list[Path]:
    return sorted((FOLDER / "locale").glob("*.po"))


def test_the_page_speaks_german_besides_english() -> None:
    assert "de.po" in [path.name for path in catalogues()]
    assert len(page_texts()) > 100


@pytest.mark.parametrize("path", catalogues(), ids=lambda path: path.stem)
def test_a_catalogue_has_every_text_of_the_page(path: Path) -> None:
    catalogue = {entry.msgid: entry.msgstr for entry in polib.pofile(str(path))}
    assert not sorted(
        (page_texts() | server_texts()) - {text for text, translation in catalogue.items() if translation}
    )


@pytest.mark.parametrize("path", catalogues(), ids=lambda path: path.stem)
def test_a_translation_has_the_same_values_as_its_text(path: Path) -> None:
    def values(text: str) -> set[str]:
        return {name for _, name, _, _ in string.Formatter().parse(text) if name}

    wrong = [
        entry.msgid
        for entry in polib.pofile(str(path))
        if entry.msgid in page_texts() and values(entry.msgid) != values(entry.msgstr)
    ]
    assert not wrong


def test_no_module_shows_a_text_of_letters_without_the_catalogue() -> None:
    """Texts that a person reads are written ``_("…")``; a bare capitalised sentence in a call of ``h`` is a slip."""
    bare = re.compile(r"""h\("[a-z0-9]+", (?:null|\{[^{}]*\}), "([A-Z][a-z]+ [^"]*)"\)""")
    assert not [(path.name, text) for path in modules() for text in bare.findall(path.read_text())]
