"""The rules of pins, signals, parameters and components."""

from __future__ import annotations

import os
import signal

import pytest

from hal._shm import BIT, FLOAT, IN, IO, OUT, PIN, RO, RW, S32
from hal.core import LOCK_ALL, LOCK_TUNE, Hal
from nml.errors import HalError
from nml.namespace import shm_name


def make(hal: Hal, *pins: tuple[str, int, int], comp: str = "c") -> None:
    record = hal.segment.find_comp(comp) or hal.add_component(comp)
    for name, type_, direction in pins:
        hal.add_pin(record, name, type_, direction)


def test_a_linked_pin_reads_its_signal(hal: Hal) -> None:
    make(hal, ("c.in", FLOAT, IN))
    hal.net("s", ["c.in"])
    hal.set_signal("s", "2.5")
    assert hal.value("c.in") == 2.5


def test_the_first_pin_of_a_signal_brings_its_value(hal: Hal) -> None:
    make(hal, ("c.in", FLOAT, IN), ("c.late", FLOAT, IN))
    hal.set_item("c.in", "7")
    hal.set_item("c.late", "8")
    hal.net("s", ["c.in"])
    hal.net("s", ["c.late"])
    assert hal.value("s") == 7.0


def test_an_unlinked_pin_keeps_the_last_value_of_its_signal(hal: Hal) -> None:
    make(hal, ("c.in", FLOAT, IN))
    hal.net("s", ["c.in"])
    hal.set_signal("s", "3")
    hal.unlink("c.in")
    hal.set_signal("s", "4")
    assert hal.value("c.in") == 3.0


@pytest.mark.parametrize(
    ("first", "second", "allowed"),
    [(OUT, OUT, False), (OUT, IO, False), (IO, OUT, False), (IO, IO, True), (OUT, IN, True), (IO, IN, True)],
)
def test_one_output_drives_a_signal_alone(hal: Hal, first: int, second: int, allowed: bool) -> None:
    make(hal, ("c.a", BIT, first), ("c.b", BIT, second))
    hal.net("s", ["c.a"])
    if allowed:
        hal.net("s", ["c.b"])
        assert len(hal.signal("s").pins()) == 2
    else:
        with pytest.raises(HalError, match=r"'s' can not add .* pin 'c.b', it already has .* pin 'c.a'"):
            hal.net("s", ["c.b"])


def test_net_changes_nothing_unless_all_of_it_fits(hal: Hal) -> None:
    make(hal, ("c.out", BIT, OUT), ("c.in", BIT, IN), ("c.float", FLOAT, IN))
    with pytest.raises(HalError, match=r"'s' of type 'bit' cannot add pin 'c.float' of type 'float'"):
        hal.net("s", ["c.out", "c.in", "c.float"])
    assert hal.segment.signals() == []
    assert hal.pin("c.out").signal is None


def test_a_signal_cannot_be_named_like_a_pin(hal: Hal) -> None:
    make(hal, ("c.out", BIT, OUT), ("c.in", BIT, IN))
    with pytest.raises(HalError, match="Did you omit the signal name"):
        hal.net("c.out", ["c.in"])


def test_setting_refuses_what_something_else_drives(hal: Hal) -> None:
    make(hal, ("c.out", BIT, OUT), ("c.in", BIT, IN))
    hal.add_param(hal.component("c"), "c.ro", S32, RO)
    hal.net("s", ["c.out", "c.in"])
    for name, reason in (("c.out", "not writable"), ("c.in", "connected to a signal"), ("c.ro", "not writable")):
        with pytest.raises(HalError, match=reason):
            hal.set_item(name, "1")
    with pytest.raises(HalError, match=r"already has writer\(s\): pin 'c.out'"):
        hal.set_signal("s", "1")


def test_a_parameter_goes_before_a_pin_of_its_name(hal: Hal) -> None:
    make(hal, ("c.x", S32, IN))
    hal.add_param(hal.component("c"), "c.x", S32, RW)
    hal.set_item("c.x", "5")
    assert hal.value("c.x") == 5
    assert hal.pin("c.x").get() == 0


def test_an_alias_is_a_second_name(hal: Hal) -> None:
    make(hal, ("c.in", BIT, IN))
    hal.alias(PIN, "c.in", "start-button")
    hal.set_item("start-button", "1")
    assert hal.value("c.in") is True
    hal.unalias(PIN, "start-button")
    with pytest.raises(HalError, match="not found"):
        hal.item("start-button")


def test_unknown_names_get_a_suggestion(hal: Hal) -> None:
    make(hal, ("spindle.speed-out", FLOAT, OUT))
    with pytest.raises(HalError, match=r"'spindle.sped-out' not found; did you mean 'spindle.speed-out'\?"):
        hal.pin("spindle.sped-out")


@pytest.mark.parametrize("name", ["", "a" * 48, "a b", "a#b", "tab\t"])
def test_names_that_no_hal_file_can_hold_are_refused(hal: Hal, name: str) -> None:
    with pytest.raises(HalError):
        hal.new_signal(name, BIT)


def test_a_name_of_47_characters_is_allowed(hal: Hal) -> None:
    assert hal.new_signal("n" * 47, BIT).name == "n" * 47


def test_locks_stop_what_they_name(hal: Hal) -> None:
    make(hal, ("c.in", BIT, IN))
    hal.segment.locks = LOCK_TUNE
    with pytest.raises(HalError, match="locked"):
        hal.net("s", ["c.in"])
    hal.set_item("c.in", "1")
    hal.segment.locks = LOCK_ALL
    with pytest.raises(HalError, match="locked"):
        hal.set_item("c.in", "0")
    with pytest.raises(HalError, match="locked"):
        hal.start_threads()


def test_a_component_takes_its_pins_with_it(hal: Hal) -> None:
    make(hal, ("c.in", BIT, IN))
    hal.net("s", ["c.in"])
    hal.remove_component(hal.component("c"))
    assert hal.segment.items(PIN) == []
    assert hal.signal("s").pins() == []


def test_a_living_component_keeps_its_name(hal: Hal) -> None:
    make(hal, ("c.in", BIT, IN))
    with pytest.raises(HalError, match="component 'c' already exists"):
        hal.add_component("c")


def die_with_component(name: str, safe: float, signal_name: str) -> None:
    """In a child: make a component with one output on a signal, and die."""
    child = os.fork()
    if child == 0:
        other = Hal()
        pin = other.add_pin(other.add_component(name), f"{name}.out", FLOAT, OUT)
        pin.set_safe(safe)
        other.net(signal_name, [f"{name}.out"])
        pin.set(100.0)
        os.kill(os.getpid(), signal.SIGKILL)
    os.waitpid(child, 0)


def test_the_pins_of_a_killed_component_take_their_safe_values(hal: Hal) -> None:
    die_with_component("victim", 1.5, "s")
    assert hal.value("s") == 100.0
    assert hal.reap() == ["victim"]
    assert hal.value("s") == 1.5
    assert hal.segment.find_comp("victim") is None


def test_the_name_of_a_killed_component_can_be_taken_again(hal: Hal) -> None:
    die_with_component("victim", 0.0, "s")
    assert hal.add_component("victim").pid == os.getpid()


def test_a_process_killed_with_the_mutex_does_not_stop_the_others(hal: Hal) -> None:
    make(hal, ("c.in", BIT, IN))
    child = os.fork()
    if child == 0:
        other = Hal()
        with other.segment:
            os.kill(os.getpid(), signal.SIGKILL)
    os.waitpid(child, 0)
    hal.net("s", ["c.in"])
    assert hal.segment.recoveries == 1
    assert hal.pin("c.in").signal == hal.signal("s")


def test_the_segment_is_private_and_goes_with_its_last_user(own_namespace: str) -> None:
    path = "/dev/shm" + shm_name("hal")
    first, second = Hal(), Hal()
    assert os.stat(path).st_mode & 0o777 == 0o600
    first.close()
    assert os.path.exists(path)
    second.close()
    assert not os.path.exists(path)


def test_a_forked_child_does_not_end_its_parents_session(own_namespace: str) -> None:
    hal = Hal()
    child = os.fork()
    if child == 0:
        hal.close()
        os._exit(0)
    os.waitpid(child, 0)
    assert os.path.exists("/dev/shm" + shm_name("hal"))
    other = Hal()
    other.new_signal("s", BIT)
    assert hal.value("s") is False
    other.close()
    hal.close()
    assert not os.path.exists("/dev/shm" + shm_name("hal"))


def test_slots_are_used_again(hal: Hal) -> None:
    for _ in range(3):
        make(hal, ("c.a", BIT, IN), ("c.b", BIT, IN))
        hal.remove_component(hal.component("c"))
    assert hal.segment.used()["pins"][1] == 2
