"""The form: what must be known of a machine, in the order in which a person is asked. Pure data."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

MACHINE_AXES = {
    "mill": ("XYZ", "XY", "XYZA", "XYZAB", "XYZABC", "XYZB"),
    "lathe": ("XZ", "XYZ", "XZC"),
    "foam": ("XYUV",),
}
ROTARY = "ABC"
ALL_LETTERS = "XYZABCUVW"
UNITS = {"mm": 1.0, "inch": 25.4}
MM_DEFAULTS = {
    "min": -100.0, "max": 100.0, "velocity": 50.0, "acceleration": 500.0, "scale": 100.0, "home": 0.0,
    "switch": -95.0, "search": -20.0, "latch": 2.0,
}  # fmt: skip
ROTARY_DEFAULTS = {
    "min": -3600.0, "max": 3600.0, "velocity": 60.0, "acceleration": 300.0, "scale": 50.0, "home": 0.0,
    "switch": -10.0, "search": -10.0, "latch": 1.0,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Question:
    """One field of the form; ``when`` names the answers that make it worth asking: key to the values."""

    key: str
    kind: str
    """choice, number or yesno"""
    text: str
    default: Any
    unit: str = ""
    choices: tuple[str, ...] = ()
    minimum: float | None = None
    maximum: float | None = None
    when: dict[str, tuple[Any, ...]] = field(default_factory=dict)

    def asked(self, answers: dict[str, Any]) -> bool:
        """Whether the other answers make this a question."""
        return all(answers.get(key) in values for key, values in self.when.items())


def general() -> list[Question]:
    """Questions about the whole machine."""
    every = tuple(dict.fromkeys(axes for group in MACHINE_AXES.values() for axes in group))
    return [
        Question("machine_type", "choice", "What kind of machine is it?", "mill", choices=tuple(MACHINE_AXES)),
        Question("axes", "choice", "Which axes does it have?", "XYZ", choices=every),
        Question("units", "choice", "Which unit of length do its drawings use?", "mm", choices=tuple(UNITS)),
        Question("drive", "choice", "How are the axes driven?", "none", choices=("none", "steps", "encoders")),
        Question("hardware", "choice", "Where do the signals go?", "simulated", choices=("simulated", "card")),
        Question(
            "base_period", "number", "How often can step pulses be made?", 100.0, "µs", minimum=10.0, maximum=1000.0,
            when={"drive": ("steps",)},
        ),
        Question("homing", "choice", "How does the machine find its home?", "place", choices=("place", "switches")),
        Question("spindles", "yesno", "Has it a spindle?", True),
        Question(
            "spindle_speed", "number", "How fast does the spindle turn at most?", 12000.0, "rpm", minimum=1.0,
            maximum=200000.0, when={"spindles": (True,)},
        ),
        Question("tool_change", "choice", "How are tools changed?", "manual", choices=("manual", "at once")),
        Question("back_tool", "yesno", "Is the tool behind the spindle?", False, when={"machine_type": ("lathe",)}),
    ]  # fmt: skip


def of_axis(letter: str) -> list[Question]:
    """Questions about one axis; lengths in mm where the machine is in mm, else inches."""
    rotary = letter in ROTARY
    unit, values = ("°", ROTARY_DEFAULTS) if rotary else ("unit", MM_DEFAULTS)
    with_axis = {"axes": tuple(axes for group in MACHINE_AXES.values() for axes in group if letter in axes)}
    driven = with_axis | {"drive": ("steps", "encoders")}
    switched = with_axis | {"homing": ("switches",)}

    def number(name: str, text: str, unit: str, when: dict[str, Any], low: float | None = None) -> Question:
        return Question(f"{letter}.{name}", "number", text, values[name], unit, minimum=low, maximum=1e6, when=when)

    return [
        number("min", "Least position", unit, with_axis, -1e6),
        number("max", "Greatest position", unit, with_axis, -1e6),
        number("velocity", "Highest speed", f"{unit}/s", with_axis, 1e-3),
        number("acceleration", "Highest acceleration", f"{unit}/s²", with_axis, 1e-3),
        number("scale", "Steps or counts for one unit of length or angle", f"1/{unit}", driven, -1e6),
        number("home", "Position after homing", unit, with_axis, -1e6),
        number("switch", "Position of the home switch", unit, switched, -1e6),
        number("search", "Speed towards the switch; its sign is the direction", f"{unit}/s", switched, -1e6),
        number("latch", "Speed when the switch is measured", f"{unit}/s", switched, -1e6),
    ]


def form() -> list[Question]:
    """All questions."""
    return [*general(), *(question for letter in ALL_LETTERS for question in of_axis(letter))]


def as_maps() -> list[dict[str, Any]]:
    """The form for the page."""
    return [{name: value for name, value in asdict(question).items() if value is not None} for question in form()]
