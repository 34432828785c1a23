"""The tools in memory: nonrandom changers copy, random changers swap."""

import pytest

from emcio.toolstore import ToolStore
from emcio.tooltable import Tool
from nml.emc.tooltable import EMC_TOOL_TABLE

TOOLS = [Tool(toolno=1, pocketno=17, diameter=1.0), Tool(toolno=5, pocketno=3, diameter=5.0)]


def make(random: bool) -> ToolStore:
    store = ToolStore(random)
    store.load(TOOLS)
    return store


def test_nonrandom_entries_follow_the_file_and_keep_their_pocket_number():
    store = make(random=False)
    assert [store.index_of(1), store.index_of(5), store.index_of(2)] == [1, 2, -1]
    assert store.pocket_of(1) == 17
    assert store.last_index == 2


def test_random_entries_lie_at_their_pocket():
    store = make(random=True)
    assert [store.index_of(1), store.index_of(5)] == [17, 3]


def test_a_nonrandom_change_copies_and_the_file_stays_as_it_is():
    store = make(random=False)
    assert store.load_spindle(2) is False
    assert store.in_spindle == 5
    assert store.entries[2].toolno == 5
    assert [t.toolno for t in store.listed()] == [1, 5]


def test_tool_zero_empties_a_nonrandom_spindle():
    store = make(random=False)
    store.load_spindle(2)
    assert store.index_of(0) == 0
    store.load_spindle(0)
    assert store.in_spindle == 0


def test_a_random_change_swaps_and_must_be_saved():
    store = make(random=True)
    store.load_spindle(17)
    assert store.load_spindle(3) is True
    assert (store.in_spindle, store.entries[3].toolno) == (5, 1)
    assert {t.toolno: t.pocketno for t in store.listed()} == {5: 0, 1: 3}


def test_tool_zero_of_a_random_changer_is_a_tool_like_any_other():
    store = ToolStore(random=True)
    store.load([Tool(toolno=0, pocketno=4)])
    assert store.index_of(0) == 4
    assert make(random=True).index_of(0) == -1


def test_new_values_reach_the_copy_in_a_nonrandom_spindle():
    store = make(random=False)
    store.load_spindle(1)
    store.write(1, Tool(toolno=1, offset=[0, 0, 9.5, 0, 0, 0, 0, 0, 0]))
    assert store.entries[0].offset[2] == 9.5
    assert store.entries[1].pocketno == 17


def test_reloading_gives_the_tool_in_the_spindle_its_new_values():
    store = make(random=False)
    store.load_spindle(2)
    store.load([Tool(toolno=5, pocketno=3, diameter=6.5)])
    assert (store.in_spindle, store.entries[0].diameter) == (5, 6.5)


@pytest.mark.parametrize(
    ("random", "tool", "complaint"),
    [
        (False, Tool(toolno=0, pocketno=1), "T0 is left out"),
        (True, Tool(toolno=8, pocketno=1001), "T8 P1001 is left out"),
        (True, Tool(toolno=8, pocketno=17), "T8 is left out: pocket 17 holds T1 already"),
    ],
)
def test_a_tool_that_does_not_suit_the_changer_is_left_out_with_a_reason(random, tool, complaint):
    store = ToolStore(random)
    remarks = store.load([*TOOLS, tool])
    assert len(remarks) == 1
    assert remarks[0].startswith(complaint)
    assert store.index_of(5) > 0


def test_a_thousand_pockets_fit_and_one_more_does_not():
    store = ToolStore(random=False)
    assert store.load([Tool(toolno=n, pocketno=n) for n in range(1, 1001)]) == []
    assert store.index_of(1000) == 1000
    assert len(store.load([Tool(toolno=n, pocketno=n) for n in range(1, 1002)])) == 1


def test_a_random_changer_starts_with_the_tool_of_pocket_zero_in_its_spindle():
    store = ToolStore(random=True)
    store.load([Tool(toolno=4, pocketno=0, diameter=4.0), *TOOLS])
    assert (store.in_spindle, store.index_of(4)) == (4, 0)


def test_a_random_spindle_is_what_the_table_says_also_after_reading_it_anew():
    store = ToolStore(random=True)
    store.load([Tool(toolno=4, pocketno=0), *TOOLS])
    store.load(TOOLS)
    assert (store.in_spindle, store.entries[0].toolno) == (-1, -1)


def test_nobody_knows_of_a_tool_in_a_nonrandom_spindle_at_start():
    assert (make(random=False).entries[0].toolno, make(random=False).entries[0].pocketno) == (-1, -1)


def test_the_published_message_tells_what_the_store_holds():
    store = make(random=True)
    message = EMC_TOOL_TABLE()
    store.fill(message)
    entry = message.tools[17]
    assert (message.random, message.last_index) == (1, 17)
    assert (entry.toolno, entry.pocketno, entry.diameter) == (1, 17, 1.0)
    assert message.tools[16].toolno == -1


def test_the_message_has_each_tool_with_its_remark():
    store = ToolStore(random=False)
    store.load([Tool(toolno=5, diameter=3.0, remark="long drill"), Tool(toolno=6, remark="é" * 30)])
    message = EMC_TOOL_TABLE()
    store.fill(message)
    assert (message.tools[1].toolno, message.tools[1].diameter, message.remarks[1].text) == (5, 3.0, "long drill")
    assert message.remarks[2].text == "é" * 19  # what fits, and no half letters
