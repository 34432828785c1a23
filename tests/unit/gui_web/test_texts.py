"""Everything that the server says to an operator is there in every language, with the same places to fill in."""

import ast
import string
from pathlib import Path

import polib
import pytest

import gui.web
from gui.web import texts
from gui.web.wizard import questions

ROOT = Path(gui.web.__file__).parent
UNTRANSLATED = {"{reason}"}  # the machine's own words


def spoken():
    """The texts of all refusals and notices, and of the wizard's form."""
    found = {question.text for question in questions.form()}
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "CallError" and len(node.args) > 1:
                text = node.args[1]
                branches = [text.body, text.orelse] if isinstance(text, ast.IfExp) else [text]
                found |= {branch.value for branch in branches if isinstance(branch, ast.Constant)}
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in ("notice", "_notice") and node.args:
                found |= {node.args[0].value} if isinstance(node.args[0], ast.Constant) else set()
    return found - UNTRANSLATED


def places(text):
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


@pytest.mark.parametrize("language", [code for code in texts.codes() if code != texts.ENGLISH])
def test_every_refusal_is_translated(language):
    known = texts.catalogue(language)
    assert sorted(spoken() - set(known)) == []


@pytest.mark.parametrize("language", [code for code in texts.codes() if code != texts.ENGLISH])
def test_translations_fill_in_the_same_places(language):
    wrong = {text for text, other in texts.catalogue(language).items() if places(text) != places(other)}
    assert wrong == set()


@pytest.mark.parametrize("path", sorted(texts.FOLDER.glob("*.po")), ids=lambda path: path.stem)
def test_catalogues_say_everything_once(path):
    ids = [entry.msgid for entry in polib.pofile(str(path))]
    assert len(ids) == len(set(ids))


def test_places_are_filled_in_after_translation():
    taken = "{name} took the controls from {other}"
    assert texts.fill("de", taken, {"name": "Anna", "other": "Bert"}) == "Anna hat Bert die Bedienung abgenommen"
    assert texts.fill("de", "joint {0} at 5 {", {}) == "joint {0} at 5 {"


def test_unknown_languages_are_english():
    assert texts.translate("xx", "aborted") == "aborted"
    assert texts.translate("../de", "aborted") == "aborted"
    assert texts.translate("de", "aborted") == "abgebrochen"
