"""``from pyhal import *``: values through signals, bytes through ports, and what it refuses."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import hal
import pyhal


@pytest.fixture
def comp(own_namespace: str) -> Iterator[pyhal.component]:
    made = pyhal.component("c")
    yield made
    made.exit()


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        (pyhal.halType.SIGNED, -100),
        (pyhal.halType.UNSIGNED, 65535),
        (pyhal.halType.FLOAT, 333.25),
        (pyhal.halType.BIT, True),
    ],
)
def test_a_value_goes_through_a_signal(comp: pyhal.component, kind: pyhal.halType, value: float) -> None:
    there = comp.pinNew("there", kind, pyhal.pinDir.OUT)
    here = comp.pinNew("here", kind, pyhal.pinDir.IN)
    comp.ready()
    comp.sigNew("wire", kind)
    for pin in (there, here):
        comp.sigLink(pin.fullname, "wire")
    there.value = value
    assert here.value == value


def test_bytes_go_through_a_port_and_too_many_do_not(comp: pyhal.component) -> None:
    out = comp.pinNew("out", pyhal.halType.PORT, pyhal.pinDir.OUT)
    into = comp.pinNew("in", pyhal.halType.PORT, pyhal.pinDir.IN)
    assert isinstance(out, pyhal.port)
    assert isinstance(into, pyhal.port)
    comp.ready()
    comp.sigNew("bytes", pyhal.halType.PORT)
    for name in ("c.out", "c.in"):
        comp.sigLink(name, "bytes")
    assert (into.size(), out.size()) == (0, 0)
    hal.set_s("bytes", "9")
    assert (into.size(), out.writable(), into.readable()) == (9, 8, 0)
    out.waitWritable(8)
    assert out.write("hello")
    assert not out.write("world")
    into.waitReadable(5)
    assert (into.read(2), into.peek(10), into.peek(3), into.readable()) == (b"he", "", b"llo", 3)
    assert into.peek_commit(3)
    assert into.read(1) == ""
    assert out.write(b"12345678")
    into.clear()
    assert (into.readable(), out.writable()) == (0, 8)


def test_what_cannot_be_made_or_linked_is_an_error(comp: pyhal.component) -> None:
    comp.pinNew("on", pyhal.halType.BIT, pyhal.pinDir.OUT)
    comp.ready()
    comp.sigNew("light", pyhal.halType.BIT)
    with pytest.raises(pyhal.HalException, match="light"):
        comp.sigNew("light", pyhal.halType.BIT)
    with pytest.raises(pyhal.HalException, match=r"c\.off"):
        comp.sigLink("c.off", "light")
