"""The tool changer of iov2: start of a change, aborts that are acknowledged, faults that end a request."""

from collections import defaultdict

import pytest

from emcio.changer2 import FaultingChanger
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool


@pytest.fixture
def pins():
    return defaultdict(int)


def make(pins, announces=False):
    store = ToolStore(random=False)
    store.load([Tool(toolno=1, pocketno=17), Tool(toolno=5, pocketno=3)])
    return FaultingChanger(store, pins, announces)


def prepared(pins, announces=False):
    changer = make(pins, announces)
    changer.prepare(5)
    pins["tool-prepared"] = True
    changer.poll()
    pins["tool-prepared"] = False
    return changer


def fault(changer, pins, reason):
    pins["toolchanger-reason"] = reason
    pins["toolchanger-fault"] = True
    changer.poll()


def test_a_change_that_is_announced_waits_for_the_acknowledgement(pins):
    changer = prepared(pins, announces=True)
    changer.start_change()
    changer.poll()
    assert (pins["start-change"], changer.busy) == (True, True)
    pins["start-change-ack"] = True
    changer.poll()
    assert (pins["start-change"], changer.busy) == (False, False)


def test_a_change_is_not_announced_without_the_option(pins):
    changer = prepared(pins)
    changer.start_change()
    assert (pins["start-change"], changer.busy) == (0, False)


def test_an_abort_stands_until_it_is_acknowledged(pins):
    changer = make(pins)
    changer.prepare(5)
    changer.abort(3)
    changer.poll()
    assert (pins["emc-abort"], pins["emc-reason"], pins["tool-prepare"]) == (True, 3, False)
    pins["emc-abort-ack"] = True
    changer.poll()
    assert pins["emc-abort"] is False


def test_a_benign_fault_ends_the_request_and_the_program_finds_its_reason(pins):
    changer = prepared(pins)
    changer.load()
    fault(changer, pins, 7)
    assert (changer.busy, pins["tool-change"], changer.in_spindle) == (False, False, 0)
    assert (changer.fault, changer.reason, changer.take_problem()) == (1, 7, "")
    assert (pins["toolchanger-fault-ack"], pins["toolchanger-faulted"]) == (True, 0)
    pins["toolchanger-fault"] = False
    changer.poll()
    assert pins["toolchanger-fault-ack"] is False


def test_a_grave_fault_fails_the_command_and_every_change_until_it_is_cleared(pins):
    changer = prepared(pins)
    changer.load()
    fault(changer, pins, -2)
    assert "fault -2 during tool-change" in changer.take_problem()
    assert changer.take_problem() == ""
    with pytest.raises(ValueError, match="in fault -2"):
        changer.load()
    pins["toolchanger-fault"] = False
    pins["toolchanger-clear-fault"] = True
    changer.poll()
    changer.load()
    assert changer.busy
