"""``import hal`` as LinuxCNC's Python programs use it."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

import hal
from hal.core import Hal
from hal.halrun import unload_everything
from hal.module import door


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
        True, True, "a-b", hal.HAL_BIT, hal.HAL_IO, True,
    )  # fmt: skip
    assert comp.getpin("a-b") is pin
    assert comp.newparam("p", hal.HAL_U32, hal.HAL_RW).is_pin() is False


def test_a_prefix_names_the_pins(own_namespace: str) -> None:
    with hal.component("c", "other") as comp:
        comp.newpin("x", hal.HAL_BIT, hal.HAL_IN)
        comp.setprefix("third")
        assert comp.newpin("y", hal.HAL_BIT, hal.HAL_IN).get_name() == "y"
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
    hal.set_p("c.in", 4.5)
    assert hal.get_p("c.in") == 4.5
    hal.disconnect("c.out")
    hal.set_s("s", 2)
    assert hal.get_s("s") == 2.0


def test_what_is_done_is_false_and_what_failed_is_true_with_the_reason(
    comp: hal.component, capsys: pytest.CaptureFixture[str]
) -> None:
    comp.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
    done = [hal.new_sig("s", hal.HAL_FLOAT), hal.new_sig("t", hal.HAL_FLOAT), hal.connect("c.out", "s")]
    assert not any(done)
    assert not hal.disconnect("c.out")
    assert capsys.readouterr().err == ""
    assert hal.connect("c.nothing", "s")
    assert hal.new_sig("s", hal.HAL_FLOAT)
    assert capsys.readouterr().err == "HAL: ERROR: pin 'c.nothing' not found\nHAL: ERROR: duplicate signal 's'\n"


def test_refusals_are_the_exceptions_that_linuxcnc_raises(comp: hal.component) -> None:
    comp.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
    for wrong in (
        lambda: hal.set_p("c.out", "1"),
        lambda: hal.set_p("nothing", "1"),
        lambda: hal.get_value("nothing"),
        lambda: hal.get_s("nothing"),
        lambda: hal.get_p("nothing"),
        lambda: hal.new_sig("s", 99),
    ):
        with pytest.raises(RuntimeError):
            wrong()
    with pytest.raises(NameError):
        hal.pin_has_writer("nothing")
    with pytest.raises(ValueError, match="Duplicate pin name 'out'"):
        comp.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)


def test_types_and_directions_have_names(comp: hal.component) -> None:
    assert (hal.Type.BOOL, hal.Type.REAL, hal.Type.SINT, hal.Type.UINT) == (
        hal.HAL_BIT, hal.HAL_FLOAT, hal.HAL_S32, hal.HAL_U32,
    )  # fmt: skip
    pin = comp.newpin("x", hal.Type.SINT, hal.Dir.IN)
    assert (pin.get_type(), pin.get_dir()) == (hal.HAL_S32, hal.HAL_IN)
    assert hal.Dir.RW == hal.HAL_RW


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
    assert not pin.wait_change(timeout=0.0)


def test_waiting_ends_when_another_process_sets_the_pin(comp: hal.component) -> None:
    pin = comp.newpin("x", hal.HAL_S32, hal.HAL_IN)
    child = os.fork()
    if child == 0:
        hal.set_p("c.x", "7")
        os._exit(0)
    try:
        assert pin.wait(7, timeout=30.0)
    finally:
        os.waitpid(child, 0)


def test_waiting_looks_again_only_when_something_has_changed(comp: hal.component) -> None:
    pin, other = (comp.newpin(name, hal.HAL_S32, hal.HAL_IN) for name in ("x", "y"))
    segment = door().segment
    seen = segment.changes()
    assert segment.changes() == seen
    other.set(1)
    assert segment.changes() == seen + 1
    pin.set(1)
    assert segment.changes() == seen + 2


def test_a_port_carries_bytes_in_order_once_it_has_a_size(comp: hal.component) -> None:
    writer = comp.newpin("out", hal.HAL_PORT, hal.HAL_OUT)
    reader = comp.newpin("in", hal.HAL_PORT, hal.HAL_IN)
    hal.new_sig("p", hal.HAL_PORT)
    hal.connect("c.out", "p")
    hal.connect("c.in", "p")
    assert (writer.size(), writer.writable(), writer.write(b"a"), reader.read(1)) == (0, 0, False, False)
    hal.set_s("p", 16)
    assert (writer.size(), writer.writable(), reader.readable()) == (16, 15, 0)
    for _ in range(5):  # round the ring
        assert writer.write("hello world")
        assert not writer.write(b"too much")
        assert (reader.readable(), reader.peek(5), reader.peek(5)) == (11, b"hello", b"hello")
        assert reader.peek_commit(6)
        assert (reader.read(5), reader.read(1), reader.peek_commit(1)) == (b"world", False, False)
    writer.write(b"rest")
    reader.clear()
    assert (reader.readable(), writer.writable()) == (0, 15)
    with pytest.raises(hal.error, match="has no value"):
        writer.set(1)


def test_only_ports_move_bytes(comp: hal.component) -> None:
    with pytest.raises(hal.error, match="is no port"):
        comp.newpin("x", hal.HAL_S32, hal.HAL_OUT).write(b"1")


def test_a_port_has_one_reader_and_one_size(comp: hal.component, capsys: pytest.CaptureFixture[str]) -> None:
    comp.newpin("in", hal.HAL_PORT, hal.HAL_IN)
    comp.newpin("in2", hal.HAL_PORT, hal.HAL_IN)
    with pytest.raises(hal.error, match="either HAL_IN or HAL_OUT"):
        comp.newpin("io", hal.HAL_PORT, hal.HAL_IO)
    hal.new_sig("p", hal.HAL_PORT)
    hal.connect("c.in", "p")
    assert hal.connect("c.in2", "p")
    assert "one reader only" in capsys.readouterr().err
    hal.set_s("p", 100)
    with pytest.raises(RuntimeError, match="already allocated with 100 bytes"):
        hal.set_s("p", 50)
    hal.disconnect("c.in")
    assert comp["in"] == 0


def test_the_room_of_deleted_ports_is_used_again(own_namespace: str) -> None:
    made = Hal()
    for size in (600_000, 900_000, 1_000_000, 16):
        made.new_signal("p", hal.HAL_PORT)
        made.set_signal("p", str(size))
        with pytest.raises(hal.error, match="no room for a port"):
            made.new_signal("q", hal.HAL_PORT) and made.set_signal("q", str(2**20))
        made.delete_signal("q")
        made.delete_signal("p")
    made.close()


def test_a_stream_is_a_lossless_queue(comp: hal.component) -> None:
    writer = hal.stream(comp, 77, 4, "bfsu")
    reader = hal.stream(comp, 77, "bfsu")
    sent = [(True, 0.5 * i, -i, i) for i in range(4)]
    for sample in sent[:3]:
        writer.write(sample)
    with pytest.raises(OSError, match="full"):
        writer.write(sent[3])
    assert (reader.depth, reader.maxdepth, writer.writable, writer.num_overruns) == (3, 3, False, 1)
    assert [reader.read() for _ in range(4)] == [*sent[:3], None]
    assert (reader.sampleno, reader.readable, reader.num_underruns) == (3, False, 1)
    writer.write(sent[0])
    assert reader.read() == sent[0]
    assert reader.sampleno == 5  # one was lost
    with pytest.raises(hal.error, match="has columns 'bfsu'"):
        hal.stream(comp, 77, "f")
    reader.close()
    writer.close()
    with pytest.raises(hal.error, match="no stream"):
        hal.stream(comp, 77)


def test_a_program_that_was_there_before_the_machine_sees_the_components_of_the_machine():
    assert not hal.component_exists("later")
    assert unload_everything() == 0
    other = "import hal; c = hal.component('later'); c.ready(); print(flush=True); input()"
    command = [sys.executable, "-c", other]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        assert hal.component_is_ready("later")
        process.communicate(b"\n")
