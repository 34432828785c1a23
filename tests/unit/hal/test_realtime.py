"""The host's modules, functions and threads."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from hal.realtime import Host
from nml.errors import HalError

PYTHON_COMPONENT = """
from hal.realtime import HAL_FLOAT, HAL_IN, HAL_OUT

def load(host, args):
    comp = host.component("doubler")
    source = comp.pin("doubler.in", HAL_FLOAT, HAL_IN, 3.0)
    out = comp.pin("doubler.out", HAL_FLOAT, HAL_OUT)

    def update(period_ns):
        if source.get() < 0:
            raise ValueError("negative")
        out.set(2 * source.get())

    comp.python_function("doubler", update)
    comp.ready()
"""


def wait_cycles(host: Host, count: int = 3) -> None:
    """Let that many more periods of the first thread end."""
    thread = host.hal.segment.threads()[0]
    end = thread.cycles + count
    while thread.cycles < end:
        pass


@pytest.fixture
def running(host: Host) -> Host:
    host.load("threads", ["name1=t", "period1=100000"])
    host.load("and2", ["count=4"])
    return host


def order(host: Host) -> list[str]:
    return [funct.name for funct in host.hal.segment.threads()[0].functs()]


@pytest.mark.parametrize(
    ("position", "expected"),
    [
        (-1, ["and2.0", "and2.1", "and2.2", "and2.3"]),
        (1, ["and2.3", "and2.0", "and2.1", "and2.2"]),
        (2, ["and2.0", "and2.3", "and2.1", "and2.2"]),
        (4, ["and2.0", "and2.1", "and2.2", "and2.3"]),
        (-2, ["and2.0", "and2.1", "and2.3", "and2.2"]),
        (-4, ["and2.3", "and2.0", "and2.1", "and2.2"]),
    ],
)
def test_addf_puts_a_function_at_its_place(running: Host, position: int, expected: list[str]) -> None:
    for n in range(3):
        running.add_function(f"and2.{n}", "t")
    running.add_function("and2.3", "t", position)
    assert order(running) == expected


@pytest.mark.parametrize(("position", "reason"), [(5, "too high"), (-5, "too low"), (0, "bad position")])
def test_a_place_that_does_not_exist_is_refused(running: Host, position: int, reason: str) -> None:
    for n in range(3):
        running.add_function(f"and2.{n}", "t")
    with pytest.raises(HalError, match=reason):
        running.add_function("and2.3", "t", position)


def test_a_function_is_in_one_thread_only(running: Host) -> None:
    running.add_function("and2.0", "t")
    with pytest.raises(HalError, match="may only be added to one thread"):
        running.add_function("and2.0", "t")
    running.remove_function("and2.0", "t")
    with pytest.raises(HalError, match="not in use"):
        running.remove_function("and2.0", "t")


def test_functions_run_only_between_start_and_stop(running: Host) -> None:
    running.add_function("and2.0", "t")
    hal = running.hal
    hal.set_item("and2.0.in0", "1")
    hal.set_item("and2.0.in1", "1")
    wait_cycles(running)
    assert hal.value("and2.0.out") is False
    hal.start_threads()
    wait_cycles(running)
    assert hal.value("and2.0.out") is True
    assert hal.value("and2.0.tmax") >= hal.value("and2.0.time") >= 0
    hal.stop_threads()
    hal.set_item("and2.0.in0", "0")
    wait_cycles(running)
    assert hal.value("and2.0.out") is True


def test_lists_change_while_the_thread_runs(running: Host) -> None:
    running.hal.start_threads()
    for _ in range(50):
        for n in range(4):
            running.add_function(f"and2.{n}", "t", 1)
        for n in (2, 0, 3, 1):
            running.remove_function(f"and2.{n}", "t")
    running.unload("and2")
    wait_cycles(running)
    assert order(running) == []


def test_threads_keep_the_ratio_of_their_periods(host: Host) -> None:
    host.load("threads", ["name1=fast", "period1=200000", "name2=slow", "period2=1000000"])
    fast, slow = host.hal.segment.threads()

    def cycles() -> tuple[int, int]:
        """Of both at one time: the slow one has not moved while the fast one was read."""
        while True:
            slowly = slow.cycles
            quickly = fast.cycles
            if slow.cycles == slowly:
                return quickly, slowly

    begin = end = cycles()
    while end[1] < begin[1] + 20:
        time.sleep(0.001)
        end = cycles()
    assert abs((end[0] - begin[0]) - 5 * (end[1] - begin[1])) <= 5


def test_a_slower_thread_cannot_come_first(host: Host) -> None:
    with pytest.raises(HalError, match="must be made before the slower one"):
        host.load("threads", ["name1=a", "period1=1000000", "name2=b", "period2=100000"])
    assert host.hal.segment.threads() == []
    assert host.hal.segment.comps() == []


@pytest.mark.parametrize(
    ("module", "words", "reason"),
    [
        ("and2", ["foo=3"], "unknown parameter 'foo'"),
        ("and2", ["count"], "has no value"),
        ("and2", ["count=0x"], "whole numbers"),
        ("and2", ["count=1", "names=a"], "cannot be given together"),
        ("and3", [], "no realtime module 'and3'; did you mean 'and2'"),
        ("sampler", [], "cfg= is required"),
        ("sampler", ["cfg=fx"], "'x' in 'fx' is no column type"),
        ("stepgen", [], "step_type= is required"),
        ("stepgen", ["step_type=99"], "none of 0 to 14"),
        ("pid", ["num_chan=17"], "from 1 to 16"),
        ("threads", ["period1=x"], "whole number"),
    ],
)
def test_wrong_arguments_are_named_and_nothing_stays(host: Host, module: str, words: list[str], reason: str) -> None:
    with pytest.raises(HalError, match=reason):
        host.load(module, words)
    assert host.hal.segment.comps() == []


def test_a_module_is_loaded_once(running: Host) -> None:
    with pytest.raises(HalError, match="and2: already exists"):
        running.load("and2", [])


def test_a_python_component_runs_in_a_native_thread(host: Host, tmp_path: Path) -> None:
    path = tmp_path / "doubler.py"
    path.write_text(PYTHON_COMPONENT)
    host.load("threads", ["period1=1000000"])
    host.load(str(path), [])
    host.add_function("doubler", "thread1")
    host.hal.start_threads()
    import time

    end = time.monotonic() + 60.0
    while host.hal.value("doubler.out") != 6.0:
        time.sleep(0.001)  # gives the GIL to the thread
        assert time.monotonic() < end
    host.unload("doubler")
    assert host.loaded() == ["threads"]


def test_a_python_component_that_raises_is_stopped_and_named(
    host: Host, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "doubler.py"
    path.write_text(PYTHON_COMPONENT)
    host.load(str(path), [])
    host.hal.set_item("doubler.in", "-1")
    funct = host.hal.segment.find_funct("doubler")
    assert funct is not None
    from hal._calls import call

    for _ in range(3):
        call(funct.code, funct.arg, 1000)
    errors = capfd.readouterr().err
    assert errors.count("HAL: function 'doubler' raised ValueError: negative; it is not called again") == 1
    assert "Traceback" in errors


def test_what_a_module_provides_goes_with_it(host: Host, tmp_path: Path) -> None:
    path = tmp_path / "giver.py"
    path.write_text(
        "def load(host, args):\n    comp = host.component('giver')\n    host.provide('thing', 42)\n    comp.ready()\n"
    )
    with pytest.raises(HalError, match="no thing is loaded"):
        host.require("thing")
    host.load(str(path), [])
    assert host.require("thing") == 42
    host.unload("giver")
    with pytest.raises(HalError, match="no thing is loaded"):
        host.require("thing")


def test_a_waiter_is_woken_by_what_a_native_thread_writes(host: Host) -> None:
    from hal import module

    host.load("threads", ["name1=t", "period1=1000000"])
    host.load("updown", [])
    with module.component("watcher") as watcher:
        count = watcher.newpin("count", module.HAL_S32, module.HAL_IN)
        module.new_sig("counted", module.HAL_S32)
        module.connect("updown.0.count", "counted")
        module.connect("watcher.count", "counted")
        host.add_function("updown.0", "t")
        host.hal.start_threads()
        host.hal.set_item("updown.0.countup", "1")
        assert count.wait(1, timeout=30.0)
        assert host.hal.value("t.threadbeat") > 0


def _busy(period_ns: int) -> None:
    end = time.thread_time_ns() + 2 * period_ns
    while time.thread_time_ns() < end:
        pass


def _held_up(period_ns: int) -> None:
    time.sleep(2e-9 * period_ns)


def _periods_of(host: Host, function: Callable[[int], None]) -> None:
    host.load("threads", ["name1=t", "period1=10000000"])
    comp = host.component("long")
    comp.python_function("long", function)
    comp.ready()
    host.add_function("long", "t")
    host.hal.start_threads()
    wait_cycles(host, 6)


def test_a_thread_whose_functions_need_more_than_its_period_is_named_with_the_slowest(host: Host) -> None:
    _periods_of(host, _busy)
    [(name, text)] = host.overworked()
    assert name == "t"
    assert text.startswith("thread 't' cannot keep its period of 10000000 ns: its functions need ")
    assert ", of which 'long' took " in text


def test_a_thread_that_was_merely_held_up_is_not_blamed(host: Host) -> None:
    _periods_of(host, _held_up)
    [thread] = host.hal.segment.threads()
    assert host.hal.value("long.tmax") > thread.period_ns
    assert host.overworked() == []
