"""The touch-off calculator: ``10 + 25.4/2``, ``1/8 in``, ``(3 - 0.5) * 2``. Numbers and + - * / ** ( ), nothing
else.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable

from gui.web.calls import CallError

LONGEST = 200  # characters
LARGEST = 1e9
MM = {"mm": 1.0, "cm": 10.0, "in": 25.4, "inch": 25.4, '"': 25.4}

BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
UNARY: dict[type[ast.unaryop], Callable[[float], float]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}
_UNIT = re.compile(r'(\d+\.?\d*|\.\d+)(\s*/\s*\d+)?\s*(mm|cm|inch|in|")', re.IGNORECASE)


def calculate(text: str, mm_per_unit: float) -> float:
    """The value of an expression in units of ``mm_per_unit``; lengths may name their own unit. CallError otherwise."""
    if len(text) > LONGEST:
        raise CallError("argument", "{argument} is too long", argument="text")
    plain = _UNIT.sub(
        lambda match: f"({match[1]}{match[2] or ''}*{MM[match[3].lower()] / mm_per_unit!r})",
        text.replace(",", ".").replace("^", "**"),
    )
    try:
        value = _value(ast.parse(plain.strip(), mode="eval").body)
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError, TypeError):
        raise CallError("argument", "{what} is no number that can be calculated", argument="text", what=text) from None
    return value


def _value(node: ast.expr) -> float:
    """A node's value; ValueError for anything but arithmetic, and for what grows too large."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
        result = float(node.value)
    elif isinstance(node, ast.BinOp) and type(node.op) in BINARY:
        result = BINARY[type(node.op)](_value(node.left), _value(node.right))
    elif isinstance(node, ast.UnaryOp) and type(node.op) in UNARY:
        result = UNARY[type(node.op)](_value(node.operand))
    else:
        raise ValueError
    if isinstance(result, complex) or not math.isfinite(result) or abs(result) > LARGEST:
        raise ValueError
    return result
