"""Motion's commands REVERSE and FORWARD run the joints back along the path and on again."""

import pytest

from nml.emc.emcmot import MotCommand as C
from tests.support.mill import line, mill


def test_reverse_runs_to_the_start_and_forward_to_the_end():
    m = mill("coord")
    for n, end in enumerate([(20, 0), (20, 20), (0, 20)], 1):
        line(m, *end, id=n, vel=50.0, tolerance=0.01)
    m.step(900)
    m.send(C.PAUSE)
    m.step(200)
    assert m.send(C.REVERSE) == 0
    m.send(C.RESUME)
    m.step(300)
    assert m.status.reverse_run
    m.step(1500)
    assert (m["joint.0.pos-cmd"], m["joint.1.pos-cmd"]) == (0.0, 0.0)
    assert m["motion.tp-reverse"]
    m.send(C.PAUSE)
    m.step()
    assert m.send(C.FORWARD) == 0
    m.send(C.RESUME)
    m.run_until_rest()
    assert (m["joint.0.pos-cmd"], m["joint.1.pos-cmd"]) == pytest.approx((0.0, 20.0))
    assert not m.status.reverse_run
    assert m.errors() == []


def test_reverse_is_refused_with_a_message_while_the_machine_moves():
    m = mill("coord")
    line(m, 50)
    m.step(500)
    assert m.send(C.REVERSE) != 0
    m.send(C.PAUSE)
    m.step()
    assert m.send(C.REVERSE) != 0
    assert len(m.errors()) == 2
