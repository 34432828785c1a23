"""``hal.query``: what it says of pins, parameters, signals, components, functions and threads."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import hal
from hal import query
from hal.realtime import REALTIME_VARIABLE, Host


@pytest.fixture
def host(own_namespace: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Host]:
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    made = Host()
    made.load("threads", ["name1=fast", "period1=1000000"])
    made.load("and2", ["count=1"])
    made.hal.net("wire", ["and2.0.out", "and2.0.in1"])
    yield made
    made.close()


def test_a_pin_and_a_parameter_say_what_they_are_and_whose(host: Host) -> None:
    owner = {"comp": "and2", "comp_id": host.hal.component("and2").id}
    assert query.pin("and2.0.out") == {
        "haltype": "pin", "name": "and2.0.out", "type": hal.Type.BOOL, "dir": hal.Dir.OUT, "value": False,
        "alias": None, "signal": "wire",
    } | owner  # fmt: skip
    assert query.param("and2.0.tmax") == {
        "haltype": "parameter", "name": "and2.0.tmax", "type": hal.Type.SINT, "dir": hal.Dir.RW, "value": 0,
        "alias": None,
    } | owner  # fmt: skip


def test_an_alias_is_named_and_finds_its_pin(host: Host) -> None:
    host.hal.alias(query.PIN, "and2.0.in0", "button")
    found = query.pin("button")
    assert found is not None
    assert (found["name"], found["alias"], found["signal"]) == ("and2.0.in0", "button", None)
    assert "and2.0.in0" in query.pins()


def test_a_signal_counts_its_pins_and_names_its_driver(host: Host) -> None:
    assert query.signals() == {
        "wire": {
            "haltype": "signal", "name": "wire", "type": hal.Type.BOOL, "value": False, "writers": 1, "readers": 1,
            "bidirs": 0, "driver": "and2.0.out",
        }
    }  # fmt: skip
    assert list(query.signalpins("wire") or {}) == ["and2.0.in1", "and2.0.out"]


def test_components_are_found_by_name_and_number_the_last_first(host: Host) -> None:
    with hal.component("screen") as own:
        own.ready()
        assert list(query.comps())[:2] == ["screen", "and2"]
        screen, gate = query.comp("screen"), query.comp(host.hal.component("and2").id)
    assert screen is not None
    assert gate is not None
    assert (screen["type"], gate["type"]) == (hal.CompType.USER, hal.CompType.REALTIME)
    assert (gate["name"], gate["pid"], gate["ready"], gate["insmod"]) == ("and2", 0, True, "count=1")
    assert screen["pid"] > 0


def test_a_thread_lists_its_functions_in_the_order_of_their_calls(host: Host) -> None:
    host.load("or2", ["count=1"])
    for name in ("or2.0", "and2.0"):
        host.add_function(name, "fast")
    fast, gate = query.thread("fast"), query.functs()["and2.0"]
    assert fast is not None
    assert (fast["comp"], fast["period"], fast["priority"]) == ("__fast", 1_000_000, 0)
    assert [(each["name"], each["index"]) for each in fast["functions"]] == [("or2.0", 0), ("and2.0", 1)]
    assert (gate["comp"], gate["users"], gate["reentrant"]) == ("and2", 1, False)


def test_of_what_is_not_there_nothing_is_said(host: Host) -> None:
    for find in (query.pin, query.param, query.signal, query.comp, query.funct, query.thread, query.signalpins):
        assert find("nothing") is None
    assert query.comp(65534) is None
