"""Comparisons of two running machines: their scripts read at moments that a busy computer may shift.

A difference between the machines comes every time, one of the moment does not.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

from tests.support import stock_machine

ATTEMPTS = 3
T = TypeVar("T")


def each_time(test: Callable[..., None]) -> Callable[..., None]:
    """A test that fails if its comparison fails in every attempt."""

    @functools.wraps(test)
    def attempts(*arguments: Any, **fixtures: Any) -> None:
        for _ in range(ATTEMPTS - 1):
            try:
                return test(*arguments, **fixtures)
            except AssertionError:
                continue
        return test(*arguments, **fixtures)

    return attempts


def first_same(compare: Callable[[], T], differences: Callable[[T], object]) -> T:
    """What a comparison found, the first time that it found no differences, or at last."""
    for _ in range(ATTEMPTS - 1):
        found = compare()
        if not differences(found):
            return found
    return compare()


def on_both(folder: Path, script: str, differences: Callable[[list[tuple[Any, Any]]], object]) -> list[tuple[Any, Any]]:
    """Each step of a script, a display, on Debian's machine and on ours, which has its files below ``folder``."""

    def compare() -> list[tuple[Any, Any]]:
        with ThreadPoolExecutor(1) as pool:
            theirs = pool.submit(stock_machine.display, script)
            ours = stock_machine.ours(folder, script)
            return list(zip(theirs.result(), ours, strict=True))

    return first_same(compare, differences)
