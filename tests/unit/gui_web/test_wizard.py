"""The wizard's form and its answers, without a machine."""

import pytest

from gui.web.wizard import answers, halfile, inifile, make, questions
from nml.errors import ConfigError


def test_no_answers_at_all_make_a_machine():
    assert answers.errors({}) == []
    machine = answers.machine_of("m", {})
    assert machine.letters == "XYZ"
    assert "JOINTS = 3" in inifile.text(machine)
    assert "loadrt [KINS]KINEMATICS" in halfile.text(machine)


def test_defaults_fit_the_unit():
    machine = answers.machine_of("m", {"units": "inch"})
    assert machine.axes[0].max == 4.0
    assert machine.axes[0].scale == 2500.0


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"machine_type": "boat"}, "machine_type"),
        ({"axes": "XZ"}, "axes"),
        ({"X.min": 5.0, "X.max": -5.0}, "X.max"),
        ({"X.home": 500.0}, "X.home"),
        ({"X.velocity": 0.0}, "X.velocity"),
        ({"X.velocity": "fast"}, "X.velocity"),
        ({"X.velocity": float("nan")}, "X.velocity"),
        ({"X.max": True}, "X.max"),
        ({"drive": "steps", "X.scale": 0.0}, "X.scale"),
        ({"drive": "steps", "X.scale": 1000.0}, "X.velocity"),
        ({"homing": "switches", "Y.search": 0.0}, "Y.search"),
        ({"homing": "switches", "Y.search": -500.0}, "Y.search"),
        ({"wheels": 4}, "wheels"),
    ],
)
def test_answers_that_would_not_start_are_named(given, key):
    assert key in [wrong["key"] for wrong in answers.errors(given)]


def test_what_is_not_asked_is_not_judged():
    assert answers.errors({"Z.velocity": -1.0, "axes": "XY"}) == []


def test_the_tool_goes_up_before_anything_else_homes():
    order = {axis.letter: axis.home_sequence for axis in answers.machine_of("m", {"axes": "XYZA"}).axes}
    assert order["Z"] == 0 < min(order["X"], order["Y"], order["A"])


@pytest.mark.parametrize("name", ["", "../x", "a b", "1st", "x" * 50, "ü"])
def test_names_that_are_no_folders_are_refused(name, tmp_path):
    with pytest.raises(ConfigError, match="name"):
        make.generate({}, name, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_machine_is_left_alone(tmp_path):
    (tmp_path / "mill").mkdir()
    with pytest.raises(ConfigError, match="there already"):
        make.generate({}, "mill", tmp_path)


def test_every_question_reaches_the_page_with_what_it_needs():
    for question in questions.as_maps():
        assert {"key", "kind", "text", "default", "when"} <= set(question)
        assert question["kind"] != "choice" or question["default"] in question["choices"]
