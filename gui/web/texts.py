"""Texts in the client's language: gettext catalogues in ``locale/LANG.po``, read as they are, for server and page.

English is the text itself. The files are plain .po files, so any translator's program edits them; there is no build
step.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import polib

FOLDER = Path(__file__).with_name("locale")
ENGLISH = "en"
NAMES = {"en": "English", "de": "Deutsch"}


def codes() -> list[str]:
    """Every language that there is a catalogue for, English first."""
    return [ENGLISH, *sorted(path.stem for path in FOLDER.glob("*.po"))]


def languages() -> list[dict[str, str]]:
    """The languages with their own names, for the page."""
    return [{"code": code, "name": NAMES.get(code, code)} for code in codes()]


@cache
def catalogue(language: str) -> dict[str, str]:
    """Translations by English text; empty for English and for unknown languages. Fuzzy ones do not count."""
    if language == ENGLISH or language not in codes():
        return {}
    entries = polib.pofile(str(FOLDER / f"{language}.po"), encoding="utf-8").translated_entries()
    return {entry.msgid: entry.msgstr for entry in entries}


def translate(language: str, text: str) -> str:
    """A text in a language, or itself."""
    return catalogue(language).get(text) or text


def fill(language: str, text: str, values: Mapping[str, Any]) -> str:
    """A text in a language with its {places} filled in, as far as there are values for all."""
    translated = translate(language, text)
    with contextlib.suppress(KeyError, IndexError, ValueError):
        return translated.format(**values)
    return translated
