"""Which blocks make task look at the stored offsets again: those that may change them, and no plain assignment."""

import pytest

from emctask.plan import MAY_OFFSET

CHANGING = ("G10L2P1X1", "g92x0", "G55", "#5221=3", "#[5220+1]=3", "##1=3", "M2", "G28.1", "g52x1")
PLAIN = ("#1=5", "G1X#1Y[#2+1]", "#<depth>=[#<depth>-1]", "#31=5221", "o1while[#1lt5]", "M3S100")


@pytest.mark.parametrize("block", CHANGING)
def test_a_block_that_may_change_offsets_is_noticed(block):
    assert MAY_OFFSET.search(block)


@pytest.mark.parametrize("block", PLAIN)
def test_a_plain_assignment_is_not(block):
    assert not MAY_OFFSET.search(block)
