"""Messages that HAL pins bring up, and the manual tool change: questions that the machine asks its operator.

[DISPLAY] MESSAGE_TEXT, MESSAGE_BOLDTEXT, MESSAGE_DETAILS, MESSAGE_TYPE, MESSAGE_PINNAME and MESSAGE_ICON, each
repeated once for each message, make pins ``web.NAME``; a MULTIMESSAGE_ID makes one number pin ``web.NAME`` that
chooses among texts. A dialog holds ``web.NAME-waiting`` while it is open, a yes/no dialog sets ``web.NAME-
response``. Tool changes go by the pins of ``hal_manualtoolchange``, which another program brings.
"""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import hal
from gui.web.state import State
from nml.errors import HalError
from nml.inifile import IniFile

log = logging.getLogger(__name__)

COMPONENT = "web"
CHANGER = "hal_manualtoolchange"
KINDS = ("status", "okdialog", "yesnodialog", "nonedialog")


@dataclass(frozen=True, slots=True)
class Question:
    """One text that a pin brings up."""

    pin: str
    number: int  # the pin's value that means this one; 1 for a bit
    kinds: frozenset[str]
    title: str
    text: str
    details: str
    icon: str

    @property
    def dialog(self) -> str | None:
        """How it is answered: ok, yesno; None for one that is only shown."""
        if "yesnodialog" in self.kinds:
            return "yesno"
        return "ok" if "okdialog" in self.kinds else None


def questions(ini: IniFile) -> list[Question]:
    """All messages of the INI file; ConfigError for a kind that there is not."""
    return [*_single(ini), *_multiple(ini)]


def _kinds(ini: IniFile, key: str, text: str) -> frozenset[str]:
    found = frozenset(text.lower().replace(",", " ").split())
    for word in sorted(found - set(KINDS)):
        raise ini.error("DISPLAY", key, f"{word} is no kind of message; {', '.join(KINDS)} would be right")
    return found or frozenset({"status"})


def _single(ini: IniFile) -> list[Question]:
    names = ini.findall("DISPLAY", "MESSAGE_PINNAME")
    columns = {key: ini.findall("DISPLAY", f"MESSAGE_{key}") for key in ("TEXT", "BOLDTEXT", "DETAILS", "TYPE", "ICON")}

    def entry(key: str, row: int) -> str:
        return columns[key][row] if row < len(columns[key]) else ""

    return [
        Question(
            name, 1, _kinds(ini, "MESSAGE_TYPE", entry("TYPE", row)), entry("BOLDTEXT", row), entry("TEXT", row),
            entry("DETAILS", row), entry("ICON", row),
        )
        for row, name in enumerate(names)
    ]  # fmt: skip


def _multiple(ini: IniFile) -> list[Question]:
    found = []
    for name in ini.findall("DISPLAY", "MULTIMESSAGE_ID"):
        columns = {
            key: ini.findall("DISPLAY", f"MULTIMESSAGE_{name}_{key}")
            for key in ("NUMBER", "TYPE", "TITLE", "TEXT", "DETAILS", "ICON")
        }
        for row, number in enumerate(columns["NUMBER"]):
            if not number.strip().isdecimal():
                raise ini.error("DISPLAY", f"MULTIMESSAGE_{name}_NUMBER", f"{number!r} is no number", row + 1)
            entry = {key: values[row] if row < len(values) else "" for key, values in columns.items()}
            kinds = _kinds(ini, f"MULTIMESSAGE_{name}_TYPE", entry["TYPE"])
            found.append(
                Question(name, int(number), kinds, entry["TITLE"], entry["TEXT"], entry["DETAILS"], entry["ICON"])
            )
    return found


@dataclass(slots=True)
class Open:
    """A question that is on the screens."""

    id: int
    question: Question
    answered: bool = False


@dataclass(slots=True)
class Dialogs:
    """The component ``web``: its pins and the questions that are open."""

    questions: list[Question]
    state: State
    message: Callable[[str, str], None]
    component: Any = None
    _open: dict[tuple[str, int], Open] = field(default_factory=dict)
    _next: int = 1

    def create_pins(self) -> None:
        """Make the component; without HAL (a machine on another computer) there are no dialogs."""
        self.state.update({"dialogs": []})
        multiple = {question.pin for question in self.questions if question.number != 1} | {
            question.pin
            for question in self.questions
            if sum(other.pin == question.pin for other in self.questions) > 1
        }
        try:
            self.component = hal.component(COMPONENT)
            for name in dict.fromkeys(question.pin for question in self.questions):
                kinds = frozenset().union(*(question.kinds for question in self.questions if question.pin == name))
                self.component.newpin(name, hal.HAL_S32 if name in multiple else hal.HAL_BIT, hal.HAL_IO)
                if kinds & {"okdialog", "yesnodialog"}:
                    self.component.newpin(f"{name}-waiting", hal.HAL_BIT, hal.HAL_OUT)
                if "yesnodialog" in kinds:
                    self.component.newpin(f"{name}-response", hal.HAL_BIT, hal.HAL_OUT)
            self.component.ready()
        except (HalError, hal.error) as reason:
            log.warning("no dialogs: %s", reason)
            self.component = None

    def look(self) -> None:
        """Open and close questions as the pins say; called at the display's rate."""
        if self.component is None or not self.questions:
            return
        before = {key: one.answered for key, one in self._open.items()}
        for question in self.questions:
            key = (question.pin, question.number)
            wanted = int(self.component[question.pin]) == question.number
            if wanted and key not in self._open:
                self._open[key] = Open(self._next, question)
                self._next += 1
                self._set(question, "waiting", question.dialog is not None)
                if "status" in question.kinds:
                    self.message("text", ": ".join(filter(None, (question.title, question.text))))
            elif not wanted and key in self._open:
                del self._open[key]
                self._set(question, "waiting", False)
        if {key: one.answered for key, one in self._open.items()} != before:
            self._publish()

    def answer(self, number: int, answer: bool) -> bool:
        """An operator's answer; false when the question is not open."""
        for key, one in self._open.items():
            if one.id == number and one.question.dialog is not None and not one.answered:
                self._set(one.question, "response", answer)
                self._set(one.question, "waiting", False)
                self.component[key[0]] = 0
                self._open[key].answered = True
                self._publish()
                return True
        return False

    def _set(self, question: Question, name: str, value: bool) -> None:
        with contextlib.suppress(AttributeError, KeyError, hal.error):
            self.component[f"{question.pin}-{name}"] = value

    def _publish(self) -> None:
        self.state.update(
            {
                "dialogs": [
                    {
                        "id": one.id, "title": one.question.title, "text": one.question.text,
                        "details": one.question.details, "icon": one.question.icon,
                        "kind": one.question.dialog or "status",
                    }
                    for one in self._open.values()
                    if not one.answered
                ]
            }
        )  # fmt: skip


class ToolChange:
    """The request of ``hal_manualtoolchange``, shown to the operators and confirmed for them."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._pressed = False
        self.present = hal.component_exists(CHANGER)
        state.update({"toolchange": None})

    def look(self) -> None:
        """Follow the pins; called at the display's rate."""
        if not self.present:
            return
        try:
            wanted = hal.get_value(f"{CHANGER}.change") and not hal.get_value(f"{CHANGER}.changed")
            if self._pressed and not wanted:
                self._press(False)
            tool = hal.get_value(f"{CHANGER}.number")
        except (HalError, hal.error):
            wanted, tool = False, 0
        asked = {"tool": tool, "pocket": self._state.get("pocket_prepped"), "text": ""} if wanted else None
        self._state.update({"toolchange": asked})

    def confirm(self) -> bool:
        """The tool is in; false when nobody asks for one or another program has the button."""
        if self._state["toolchange"] is None:
            return False
        try:
            self._press(True)
        except (HalError, hal.error) as reason:
            log.warning("tool change: %s", reason)
            return False
        return True

    def _press(self, down: bool) -> None:
        hal.set_p(f"{CHANGER}.change_button", str(int(down)))
        self._pressed = down
