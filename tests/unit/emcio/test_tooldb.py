"""``tooldb``: a data base program that is written with LinuxCNC's module works for io."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from emcio.database import DatabaseTools
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool
from tests.support.halsession import CHECKOUT
from tests.support.machine import wait_until

PROGRAM = f"""
import sys
sys.path.insert(0, {str(CHECKOUT)!r})
from tooldb import tooldb_callbacks, tooldb_loop, tooldb_tools

def told(kind):
    def callback(number, line):
        open("told", "a").write(f"{{kind}} {{number}} {{line}}\\n")
        if number == 13:
            raise ValueError("unlucky")
    return callback

tooldb_tools(range(4, 6))
tooldb_callbacks(lambda number: f"T{{number}} P{{number}} Z{{number / 2}}", told("put"), told("load"), told("unload"))
tooldb_loop()
"""


@pytest.fixture
def source(tmp_path: Path) -> Iterator[DatabaseTools]:
    (tmp_path / "db.py").write_text(PROGRAM)
    source = DatabaseTools([sys.executable, "db.py"], tmp_path)
    yield source
    source.close()


def test_its_tools_are_there(source: DatabaseTools) -> None:
    store = ToolStore(random=False)
    assert source.load(store) == []
    assert [store.entries[store.index_of(number)].offset[2] for number in (4, 5)] == [2.0, 2.5]


def test_its_functions_learn_of_changes_and_of_the_spindle(source: DatabaseTools, tmp_path: Path) -> None:
    source.put(Tool(toolno=4, pocketno=4))
    source.spindle("l", 4, 0)
    source.spindle("u", 0, 0)
    wait_until(lambda: not source.busy, "all is told")
    put, load, unload = (tmp_path / "told").read_text().splitlines()
    assert put.startswith("put 4 T4 P4")
    assert (load, unload) == ("load 4 T4 P0", "unload 0 T0 P0")
    assert source.failure() is None


def test_a_function_that_raises_is_a_complaint_and_the_program_goes_on(source: DatabaseTools) -> None:
    source.spindle("l", 13, 0)
    source.spindle("l", 4, 0)
    wait_until(lambda: not source.busy, "all is told")
    failure = source.failure()
    assert failure is not None
    assert "ValueError: unlucky" in failure
