"""The handshake with the tool changer over HAL pins."""

from collections import defaultdict

import pytest

from emcio import changer as module
from emcio.changer import Changer
from emcio.toolstore import ToolStore
from emcio.tooltable import Tool


@pytest.fixture
def pins():
    return defaultdict(int)


@pytest.fixture
def changer(pins):
    store = ToolStore(random=False)
    store.load([Tool(toolno=1, pocketno=17), Tool(toolno=5, pocketno=3)])
    return Changer(store, pins)


def change(changer, pins, toolno):
    for start, answer in ((lambda: changer.prepare(toolno), "tool-prepared"), (changer.load, "tool-changed")):
        start()
        pins[answer] = True
        changer.poll()
        pins[answer] = False


def test_prepare_tells_number_pocket_and_index_and_waits_for_the_answer(changer, pins):
    changer.prepare(5)
    assert pins["tool-prepare"]
    assert (pins["tool-prep-number"], pins["tool-prep-pocket"], pins["tool-prep-index"]) == (5, 3, 2)
    changer.poll()
    assert (changer.busy, changer.prepared) == (True, -1)
    pins["tool-prepared"] = True
    changer.poll()
    assert (changer.busy, changer.prepared, pins["tool-prepare"]) == (False, 2, False)


def test_change_updates_spindle_and_pins_when_the_changer_answers(changer, pins):
    change(changer, pins, 5)
    assert (changer.in_spindle, pins["tool-number"], pins["tool-from-pocket"]) == (5, 5, 3)
    assert (changer.prepared, pins["tool-prep-number"], pins["tool-prep-pocket"]) == (-1, 0, 0)
    assert changer.spindle_events == [("l", 5, 0)]


def test_a_tool_that_is_in_the_spindle_is_not_changed_again(changer, pins):
    change(changer, pins, 5)
    changer.prepare(5)
    pins["tool-prepared"] = True
    changer.poll()
    changer.load()
    assert not pins["tool-change"]


def test_tool_zero_is_changed_for_an_empty_spindle(changer, pins):
    change(changer, pins, 5)
    change(changer, pins, 0)
    assert (changer.in_spindle, pins["tool-number"]) == (0, 0)
    assert changer.spindle_events[-1] == ("u", 0, 0)


def test_an_empty_spindle_came_from_no_pocket(changer, pins):
    change(changer, pins, 5)
    changer.set_number(0)
    assert (pins["tool-from-pocket"], changer.from_pocket) == (0, 0)


def test_the_empty_spindle_is_prepared_as_soon_as_it_is_asked_for(changer, pins):
    change(changer, pins, 5)
    changer.prepare(0)
    assert (changer.prepared, changer.busy, pins["tool-prepare"]) == (0, True, True)


def test_tool_zero_of_a_random_changer_came_from_no_pocket(pins):
    store = ToolStore(random=True)
    store.load([Tool(toolno=3, pocketno=0), Tool(toolno=0, pocketno=2)])
    changer = Changer(store, pins)
    change(changer, pins, 0)
    assert (changer.in_spindle, pins["tool-from-pocket"], store.entries[2].toolno) == (0, 0, 3)


def test_an_unknown_tool_and_a_change_without_preparation_are_refused(changer):
    with pytest.raises(ValueError, match="T9 is not in the tool table"):
        changer.prepare(9)
    with pytest.raises(ValueError, match="T word must come before M6"):
        changer.load()


def test_an_abort_takes_the_request_back_and_leaves_the_spindle_as_it_was(changer, pins):
    change(changer, pins, 1)
    changer.prepare(5)
    pins["tool-prepared"] = True
    changer.poll()
    changer.load()
    changer.abort(0)
    pins["tool-changed"] = True
    changer.poll()
    assert (pins["tool-change"], changer.in_spindle, changer.busy) == (False, 1, False)


def test_a_request_waits_until_the_answer_to_the_last_one_has_gone(changer, pins):
    pins["tool-prepared"] = True
    changer.prepare(5)
    changer.poll()
    assert not pins["tool-prepare"]
    pins["tool-prepared"] = False
    changer.poll()
    assert pins["tool-prepare"]


def test_a_pin_that_is_tied_to_true_only_delays_the_request(changer, pins, monkeypatch):
    now = [0.0]
    monkeypatch.setattr(module.clock, "host_now", lambda: now[0])
    pins["tool-prepared"] = True
    changer.prepare(5)
    now[0] = 10.0
    changer.poll()
    changer.poll()
    assert changer.prepared == 2


def test_m61_names_the_tool_in_the_spindle_without_a_request(changer, pins):
    changer.set_number(2)
    assert (changer.in_spindle, pins["tool-number"], pins["tool-change"]) == (5, 5, 0)
    changer.set_number(0)
    assert (changer.in_spindle, pins["tool-from-pocket"]) == (0, 0)
    with pytest.raises(ValueError, match="no tool"):
        changer.set_number(500)


def test_a_random_changer_reports_what_left_the_spindle_and_what_entered_it(pins):
    store = ToolStore(random=True)
    store.load([Tool(toolno=1, pocketno=0), Tool(toolno=5, pocketno=3)])
    changer = Changer(store, pins)
    change(changer, pins, 5)
    assert changer.spindle_events == [("u", 1, 3), ("l", 5, 0)]
    assert changer.must_save
    assert pins["tool-from-pocket"] == 3
