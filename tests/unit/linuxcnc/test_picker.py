"""Choosing a configuration in the terminal, and the note of the one started last."""

import pytest

from linuxcnc import lastused, picker
from nml.errors import ConfigError


@pytest.fixture
def offered(tmp_path):
    for name in ("mill/inch.ini", "mill/mm.ini", "lathe/mm.ini", "lathe/readme.txt"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.touch()
    return picker.offers([tmp_path, tmp_path / "none"])


def choice(offered, *answers):
    """What the answers choose, and what was shown before each of them."""
    given, shown = iter(answers), []

    def ask(prompt):
        try:
            return next(given)
        except StopIteration:
            raise EOFError from None

    return picker.choose(offered, ask, shown.append), shown


def test_the_list_is_grouped_by_folder_and_numbered(offered, tmp_path):
    path, (listing,) = choice(offered, "3")
    assert path == tmp_path / "mill/mm.ini"
    assert listing.splitlines() == [
        str(tmp_path / "lathe"),
        "  1  mm.ini",
        str(tmp_path / "mill"),
        "  2  inch.ini",
        "  3  mm.ini",
    ]


def test_words_narrow_the_list_and_leave_the_numbers(offered, tmp_path):
    path, shown = choice(offered, "MILL mm", "3")
    assert path == tmp_path / "mill/mm.ini"
    assert shown[1].splitlines() == [str(tmp_path / "mill"), "  3  mm.ini"]


def test_words_that_fit_nothing_leave_the_list_as_it_was(offered):
    _, shown = choice(offered, "mill", "plasma", "2")
    assert shown[1] == shown[3]
    assert "plasma" in shown[2]


def test_enter_shows_the_whole_list_again(offered):
    _, shown = choice(offered, "mill", "", "2")
    assert shown[2] == shown[0]


@pytest.mark.parametrize("answers", [(), ("q",), ("lathe", "Quit")])
def test_one_can_leave_without_choosing(offered, answers):
    with pytest.raises(picker.NothingChosen):
        choice(offered, *answers)


def test_our_samples_are_offered():
    assert "mill_mm.ini" in {offer.path.name for offer in picker.offers(picker.folders())}


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def test_the_configuration_started_last_is_remembered(home):
    first, second = home / "first.ini", home / "second.ini"
    first.touch(), second.touch()
    assert lastused.recall() is None
    lastused.remember(first)
    lastused.remember(second)
    assert lastused.recall_or_refuse() == second


def test_what_else_is_noted_stays(home):
    (home / ".linuxcncrc").write_text("[OTHER]\nKEY = 1\n[PICKCONFIG]\nTHEME = plain\n")
    (home / "a.ini").touch()
    lastused.remember(home / "a.ini")
    assert (home / ".linuxcncrc").read_text().splitlines() == [
        "[OTHER]",
        "KEY = 1",
        "[PICKCONFIG]",
        f"LAST_CONFIG = {home / 'a.ini'}",
        "THEME = plain",
    ]


def test_without_a_configuration_started_last_a_name_is_asked_for(home):
    with pytest.raises(ConfigError, match="no INI file was started before"):
        lastused.recall_or_refuse()
    lastused.remember(home / "gone.ini")
    with pytest.raises(ConfigError, match="is gone"):
        lastused.recall_or_refuse()
