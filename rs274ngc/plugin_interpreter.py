"""The module ``interpreter`` that Python remaps import: results, constants, the exception of ``self.execute``."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from rs274ngc import plugin_canon


class Result(int):
    """A result of a function, apart from any other number."""


INTERP_OK, INTERP_EXIT, INTERP_EXECUTE_FINISH, INTERP_ENDFILE = map(Result, range(4))
INTERP_FILE_NOT_OPEN, INTERP_ERROR = Result(4), Result(5)
INTERP_MIN_ERROR = 3
TOLERANCE_EQUAL = 0.0001
UNITS_PER_MINUTE, INVERSE_TIME, UNITS_PER_REVOLUTION = 0, 1, 2
CONSTANT_RPM, CONSTANT_SURFACE = 0, 1
R_PLANE, OLD_Z = 0, 1
MODE_ABSOLUTE, MODE_INCREMENTAL = 0, 1
OFF, RIGHT, LEFT = 0, 1, 2
NOT_CALLED, CALLED = 0, 1


class InterpreterException(Exception):
    """``self.execute`` met an error."""

    def __init__(self, error_message: str, line_number: int, line_text: str) -> None:
        super().__init__(error_message)
        self.error_message, self.line_number, self.line_text = error_message, line_number, line_text


def equal(one: float, other: float) -> bool:
    """The same number within the interpreter's tolerance?"""
    return abs(one - other) < TOLERANCE_EQUAL


def module(this: Any) -> ModuleType:
    """The module, as ``from interpreter import *`` needs it: with ``emccanon`` and the interpreter, ``this``, in it."""
    made = ModuleType("interpreter", __doc__)
    made.__dict__.update(
        {
            name: value
            for name, value in globals().items()
            if name.isupper() or name in ("InterpreterException", "equal")
        }
    )
    made.__dict__.update(throw_exceptions=1, emccanon=plugin_canon.module(), this=this)
    return made
