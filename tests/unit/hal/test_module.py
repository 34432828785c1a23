"""``import hal`` as LinuxCNC's Python programs use it."""

from __future__ import annotations

import pytest

import hal


@pytest.fixture
def comp(own_namespace: str):  # type: ignore[no-untyped-def]
    made = hal.component("c")
    yield made
    made.exit()


def test_pins_are_items_and_attributes(comp: hal.component) -> None:
    comp.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
    comp.newpin("out", hal.HAL_S32, hal.HAL_OUT)
    comp.out = 5
    comp["in"] = 2.5
    assert (comp["out"], comp["in"]) == (5, 2.5)
    assert comp.getpins() == {"in": 2.5, "out": 5}
    assert "in" in comp
    assert "nothing" not in comp


def test_a_pin_knows_itself(comp: hal.component) -> None:
    pin = comp.newpin("a-b", hal.HAL_BIT, hal.HAL_IO)
    pin.set(True)
    assert (pin.get(), pin.value, pin.get_name(), pin.get_type(), pin.get_dir(), pin.is_pin()) == (
        True, True, "c.a-b", hal.HAL_BIT, hal.HAL_IO, True,
    )  # fmt: skip
    assert comp.getpin("a-b") is pin
    assert comp.newparam("p", hal.HAL_U32, hal.HAL_RW).is_pin() is False


def test_a_prefix_names_the_pins(own_namespace: str) -> None:
    with hal.component("c", "other") as comp:
        comp.newpin("x", hal.HAL_BIT, hal.HAL_IN)
        comp.setprefix("third")
        assert comp.newpin("y", hal.HAL_BIT, hal.HAL_IN).get_name() == "third.y"
        assert [info["NAME"] for info in hal.get_info_pins()] == ["other.x", "third.y"]


@pytest.mark.parametrize(("type_", "value"), [(hal.HAL_S32, 2**31), (hal.HAL_U32, -1), (hal.HAL_U64, 2**64)])
def test_a_value_that_does_not_fit_is_refused(comp: hal.component, type_: int, value: int) -> None:
    comp.newpin("x", type_, hal.HAL_IN)
    with pytest.raises(OverflowError):
        comp["x"] = value


def test_ready_is_seen_by_others(comp: hal.component) -> None:
    assert hal.component_exists("c")
    assert not hal.component_is_ready("c")
    comp.ready()
    assert hal.component_is_ready("c")
    comp.unready()
    assert not hal.component_is_ready("c")
    assert not hal.component_exists("nobody")


def test_signals_are_made_connected_and_read(comp: hal.component) -> None:
    comp.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
    comp.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
    hal.new_sig("s", hal.HAL_FLOAT)
    hal.connect("c.out", "s")
    hal.connect("c.in", "s")
    comp["out"] = 7.0
    assert hal.get_value("s") == hal.get_value("c.in") == 7.0
    assert hal.pin_has_writer("c.in")
    assert hal.get_info_signals() == [{"NAME": "s", "VALUE": 7.0, "TYPE": hal.HAL_FLOAT, "DRIVER": "c.out"}]
    hal.disconnect("c.in")
    hal.set_p("c.in", "3")
    assert comp["in"] == 3.0


def test_after_exit_the_component_is_closed(own_namespace: str) -> None:
    comp = hal.component("c")
    comp.newpin("x", hal.HAL_BIT, hal.HAL_IN)
    comp.exit()
    with pytest.raises(AttributeError):
        comp["x"]
    with pytest.raises(hal.error, match="closed"):
        comp.newpin("y", hal.HAL_BIT, hal.HAL_IN)
    comp.exit()


def test_two_components_of_a_name_are_refused(comp: hal.component) -> None:
    with pytest.raises(hal.error, match="already exists"):
        hal.component("c")


def test_waiting_for_a_pin_ends_with_its_value_or_the_time(comp: hal.component) -> None:
    pin = comp.newpin("x", hal.HAL_S32, hal.HAL_IN)
    pin.set(4)
    assert pin.wait(4, timeout=0.0)
    assert not pin.wait(5, timeout=0.0)


def test_a_stream_is_a_lossless_queue(comp: hal.component) -> None:
    writer = hal.stream(comp, 77, 3, "bfsu")
    reader = hal.stream(comp, 77, "bfsu")
    sent = [(True, 0.5 * i, -i, i) for i in range(4)]
    assert [writer.write(sample) for sample in sent] == [True, True, True, False]
    assert (reader.depth, reader.maxdepth, writer.writable, writer.num_overruns) == (3, 3, False, 1)
    assert [reader.read() for _ in range(4)] == [*sent[:3], None]
    assert (reader.sampleno, reader.readable, reader.num_underruns) == (2, False, 1)
    writer.write(sent[0])
    assert reader.read() == sent[0]
    assert reader.sampleno == 4  # one was lost
    with pytest.raises(hal.error, match="has columns 'bfsu'"):
        hal.stream(comp, 77, "f")
    reader.close()
    writer.close()
    with pytest.raises(hal.error, match="no stream"):
        hal.stream(comp, 77)
