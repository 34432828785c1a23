"""What a person has filled in, checked: every number within its range, and nothing that would not start."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from gui.web.wizard.questions import MACHINE_AXES, ROTARY, UNITS, Question, form

INCH_FIELDS = ("min", "max", "velocity", "acceleration", "home", "switch", "search", "latch")
HOME_ORDER = "ZWYVXUABC"  # the tool goes up first


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis with one joint; machine units or degrees, and seconds."""

    letter: str
    joint: int
    min: float
    max: float
    velocity: float
    acceleration: float
    scale: float
    home: float
    switch: float
    search: float
    latch: float
    home_sequence: int

    @property
    def rotary(self) -> bool:
        return self.letter in ROTARY


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine as it was described."""

    name: str
    kind: str
    units: str
    drive: str
    simulated: bool
    base_period: int  # ns
    switches: bool
    spindle_speed: float | None  # rpm; None: no spindle
    manual_tools: bool
    back_tool: bool
    axes: tuple[Axis, ...]

    @property
    def letters(self) -> str:
        return "".join(axis.letter for axis in self.axes)

    @property
    def mm(self) -> float:
        """mm in a machine unit."""
        return UNITS[self.units]


def complete(given: dict[str, Any]) -> dict[str, Any]:
    """The answers, with defaults where nothing was said; lengths of defaults fit the unit."""
    found: dict[str, Any] = {}
    inch = given.get("units") == "inch"
    for question in form():
        value = given.get(question.key)
        if value is None:
            value = question.default
            letter, _, name = question.key.partition(".")
            if inch and name and letter not in ROTARY:
                value = _inch_default(name, value)
        if question.key == "axes" and given.get("axes") is None:
            value = MACHINE_AXES.get(found["machine_type"], ("XYZ",))[0]
        found[question.key] = value
    return found


def _inch_default(name: str, value: float) -> float:
    """A default in mm as a round number of inches; steps per inch for steps per mm."""
    return round(value / 25.0, 3) if name in INCH_FIELDS else value * 25.0


def errors(given: dict[str, Any]) -> list[dict[str, Any]]:
    """What is wrong: ``key`` and ``text`` of each."""
    known = {question.key for question in form()}
    found = [{"key": str(key)[:40], "text": "there is no such question"} for key in given if key not in known]
    answers = complete(given)
    asked = [question for question in form() if question.asked(answers)]
    for question in asked:
        text = _wrong(question, answers[question.key])
        if text:
            found.append({"key": question.key, "text": text})
    if not found:
        found = [*_together(answers)]
    return found


def _wrong(question: Question, value: Any) -> str | None:
    """What is wrong with one answer by itself."""
    if question.kind == "choice":
        return None if value in question.choices else f"one of {', '.join(question.choices)} would be right"
    if question.kind == "yesno":
        return None if isinstance(value, bool) else "yes or no would be right"
    if type(value) not in (int, float) or not math.isfinite(value):
        return "a number would be right"
    if question.minimum is not None and value < question.minimum:
        return f"{question.minimum:g} or more would be right"
    if question.maximum is not None and value > question.maximum:
        return f"{question.maximum:g} or less would be right"
    return None


def _together(answers: dict[str, Any]) -> list[dict[str, Any]]:
    """What is wrong between answers that are each possible."""
    found: list[dict[str, Any]] = []

    def complain(key: str, text: str) -> None:
        found.append({"key": key, "text": text})

    if answers["axes"] not in MACHINE_AXES[answers["machine_type"]]:
        allowed = ", ".join(MACHINE_AXES[answers["machine_type"]])
        complain("axes", f"a {answers['machine_type']} has {allowed}")
        return found
    for axis in machine_of("check", answers).axes:
        if axis.min >= axis.max:
            complain(f"{axis.letter}.max", "the greatest position must be above the least")
        elif not axis.min <= axis.home <= axis.max:
            complain(f"{axis.letter}.home", "the position after homing must be within the limits")
        if answers["drive"] != "none" and axis.scale == 0.0:
            complain(f"{axis.letter}.scale", "steps or counts must not be 0")
        if answers["drive"] == "steps":
            rate = abs(axis.scale) * axis.velocity
            most = 1e6 / (2.0 * answers["base_period"])
            if rate > most:
                text = f"{rate:.0f} steps/s are needed, {most:.0f} are possible with this period of pulses"
                complain(f"{axis.letter}.velocity", text)
        if answers["homing"] == "switches":
            if axis.search == 0.0 or axis.latch == 0.0:
                complain(f"{axis.letter}.search", "search and latch speed must not be 0")
            elif max(abs(axis.search), abs(axis.latch)) > axis.velocity:
                complain(f"{axis.letter}.search", "homing must not be faster than the axis")
    return found


def machine_of(name: str, given: dict[str, Any]) -> Machine:
    """The machine of answers that have no `errors`."""
    answers = complete(given)
    letters: str = answers["axes"]
    order = sorted(letters, key=HOME_ORDER.index)
    axes = []
    for joint, letter in enumerate(letters):
        values = {
            question.key.partition(".")[2]: float(answers[question.key])
            for question in form()
            if question.key.startswith(f"{letter}.")
        }
        axes.append(Axis(letter=letter, joint=joint, home_sequence=order.index(letter), **values))
    return Machine(
        name=name,
        kind=answers["machine_type"],
        units=answers["units"],
        drive=answers["drive"],
        simulated=answers["hardware"] == "simulated",
        base_period=round(answers["base_period"] * 1000.0),
        switches=answers["homing"] == "switches",
        spindle_speed=float(answers["spindle_speed"]) if answers["spindles"] else None,
        manual_tools=answers["tool_change"] == "manual",
        back_tool=bool(answers["back_tool"]),
        axes=tuple(axes),
    )
