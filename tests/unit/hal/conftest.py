"""A realtime host inside the test process, and single periods without threads."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from hal._calls import call
from hal.core import Hal
from hal.realtime import REALTIME_VARIABLE, Host

PERIOD_NS = 1_000_000


class Bench:
    """Loads components and runs their functions one period at a time."""

    def __init__(self, host: Host) -> None:
        self.host = host
        self.hal = host.hal

    def load(self, name: str, *words: str) -> None:
        self.host.load(name, list(words))

    def run(self, function: str, periods: int = 1, period_ns: int = PERIOD_NS) -> None:
        funct = self.hal.segment.find_funct(function)
        assert funct is not None, function
        for _ in range(periods):
            call(funct.code, funct.arg, period_ns)

    def set(self, **values: object) -> None:
        """`and2.0` pins by the last part of their names, underscores for dashes: ``set(in0=1)`` after `use`."""
        for name, value in values.items():
            self._item(name).set(value)

    def get(self, name: str) -> float:
        return self._item(name).get()

    def use(self, prefix: str) -> Bench:
        self._prefix = prefix
        return self

    def _item(self, name: str):  # type: ignore[no-untyped-def]
        found = self.hal.find(f"{self._prefix}.{name.rstrip('_').replace('_', '-')}")
        assert found is not None, name
        return found[1]


@pytest.fixture
def host(own_namespace: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Host]:
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    made = Host()
    yield made
    made.close()


@pytest.fixture
def bench(host: Host) -> Bench:
    return Bench(host)


@pytest.fixture
def hal(own_namespace: str) -> Iterator[Hal]:
    made = Hal()
    yield made
    made.close()


@pytest.fixture
def component(bench: Bench) -> Callable[..., Bench]:
    """Load a component with one instance and point the bench at it."""

    def load(name: str, *words: str, instance: str = "") -> Bench:
        bench.load(name, *words)
        return bench.use(instance or f"{name.replace('_', '-')}.0")

    return load
