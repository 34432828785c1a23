"""The tool data base protocol, with a program of the test's own."""

import sys
import textwrap

import pytest

from emcio.database import DatabaseTools
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool
from nml.errors import ConfigError
from tests.support.machine import wait_until

PROGRAM = """
    import sys
    print("v2.1", flush=True)
    log = open("log", "w")
    for line in sys.stdin:
        print(line.strip(), file=log, flush=True)
        if line == "g\\n":
            print("T1 P17 Z1.5 D3 ;first", "T110 P113 D6", "rubbish", "FINI (all of them)", sep="\\n", flush=True)
        elif line.startswith("u"):
            print("NAK no such tool", flush=True)
        else:
            print("ACK", flush=True)
"""

SLOW = """
    import sys
    print("v2.1", flush=True)
    sys.stdin.readline()
    open("asked", "w").close()
    sys.stdin.readline()
    print("T1 P17", "rubbish", "FINI", sep="\\n", flush=True)
    sys.stdin.read()
"""
"""Answers the first question when it is given another line."""


@pytest.fixture
def tools(tmp_path):
    (tmp_path / "db.py").write_text(textwrap.dedent(PROGRAM))
    source = DatabaseTools([sys.executable, "db.py"], tmp_path)
    yield source
    if source._process.poll() is None:
        source.close()


def test_all_tools_are_asked_for_and_a_wrong_line_is_named(tools):
    store = ToolStore(random=False)
    remarks = tools.load(store)
    assert [store.index_of(1), store.index_of(110), store.pocket_of(2)] == [1, 2, 113]
    assert len(remarks) == 1
    assert "'rubbish'" in remarks[0]


def test_reading_the_tools_anew_does_not_wait_for_a_slow_program(tmp_path):
    (tmp_path / "slow.py").write_text(textwrap.dedent(SLOW))
    source = DatabaseTools([sys.executable, "slow.py"], tmp_path)
    store = ToolStore(random=False)
    assert source.reload(store) == []
    wait_until((tmp_path / "asked").exists, "the program is asked")
    assert (source.busy, source.arrived(store), store.index_of(1)) == (True, None, -1)
    source._process.stdin.write("go on\n")
    source._process.stdin.flush()
    wait_until(lambda: source._fresh is not None, "the answer")
    assert source.busy
    assert len(source.arrived(store)) == 1
    assert (source.busy, store.index_of(1)) == (False, 1)
    source.close()


def test_changes_are_told_in_order_and_a_refusal_is_a_complaint(tools, tmp_path):
    tools.put(Tool(toolno=1, pocketno=17, diameter=4.0))
    tools.spindle("l", 1, 0)
    tools.spindle("u", 0, 0)
    tools.close()
    assert (tmp_path / "log").read_text() == "p T1 P17 D+4.000000\nl T1 P0\nu T0 P0\n"
    assert "NAK no such tool" in tools.failure()
    assert tools.failure() is None
    assert not tools.busy or tools._orders.qsize() == 0


def test_a_program_that_will_not_list_its_tools_is_an_error(tmp_path):
    (tmp_path / "db.py").write_text("print('v2.1', flush=True); input(); print('NAK no', flush=True); input()")
    source = DatabaseTools([sys.executable, "db.py"], tmp_path)
    with pytest.raises(ConfigError, match="refused to list its tools: NAK no"):
        source.load(ToolStore(random=False))
    source.close()


def test_another_version_is_refused(tmp_path):
    (tmp_path / "db.py").write_text("print('v1.0', flush=True); input()")
    with pytest.raises(ConfigError, match=r"speaks 'v1.0'; 'v2.1' is needed"):
        DatabaseTools([sys.executable, "db.py"], tmp_path)


def test_a_program_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ConfigError, match="No such file"):
        DatabaseTools([str(tmp_path / "none")], tmp_path)
