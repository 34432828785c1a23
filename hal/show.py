"""What ``show``, ``list``, ``save`` and ``status`` print, with LinuxCNC 2.10's widths and words: scripts read them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase

from hal._records import Item, Signal
from hal._shm import IN, OUT, PARAM, PIN, RW, USER
from hal.core import LOCK_CONFIG, LOCK_LOAD, LOCK_PARAMS, LOCK_RUN, Hal
from hal.values import PARAM_DIR_NAMES, PIN_ARROWS, PIN_DIR_NAMES, SIGNAL_ARROWS, TYPE_NAMES, TYPES, show_value

Lines = Iterator[str]
VALUE_WIDTH = 20
TYPED = ("pin", "sig", "signal", "param", "parameter")  # what `list` and `show` limit to a data type


def matches(name: str, patterns: list[str]) -> bool:
    """Whether a name begins with one of the patterns or fits one as a shell glob; all do where there are none."""
    return not patterns or any(name.startswith(pattern) or fnmatchcase(name, pattern) for pattern in patterns)


def of_type(patterns: list[str]) -> tuple[int | None, list[str]]:
    """The data type that patterns begin with, ``-tfloat`` or ``-t float``, and the rest; None: any or unknown."""
    if not patterns or not patterns[0].startswith("-t"):
        return None, patterns
    word, rest = (patterns[0][2:], patterns[1:]) if len(patterns[0]) > 2 else ("".join(patterns[1:2]), patterns[2:])
    return TYPES.get(word), rest


def padded(item: Item | Signal) -> str:
    return f"{show_value(item.type, item.get()):>{VALUE_WIDTH}}"


class Show:
    """The ``show`` command; ``script``: without titles, on single lines."""

    def __init__(self, hal: Hal, script: bool = False) -> None:
        self.segment = hal.segment
        self.script = script
        self.tables: dict[str, Callable[[list[str]], Lines]] = {
            "comp": self.comps,
            "pin": self.pins,
            "alias": self.aliases,
            "sig": self.signals,
            "signal": self.signals,
            "param": self.params,
            "parameter": self.params,
            "funct": self.functs,
            "function": self.functs,
            "thread": self.threads,
        }

    def all(self, patterns: list[str]) -> Lines:
        for table in ("comp", "pin", "pin alias", "sig", "param", "param alias", "funct", "thread"):
            if table.endswith("alias"):
                yield from self._alias_table(PIN if table.startswith("pin") else PARAM, patterns)
            else:
                yield from self.tables[table](patterns)

    def _title(self, *lines: str) -> Lines:
        if not self.script:
            yield from lines

    def _owners(self) -> dict[int, str]:
        comps = self.segment.comps()
        return {comp.id: comp.name if self.script else f"{comp.id:6d}" for comp in comps}

    def comps(self, patterns: list[str]) -> Lines:
        yield from self._title("Loaded HAL Components:", f"{'ID':8}{'Type':6}{'Name':48}PID   State")
        for comp in self.segment.comps():
            if matches(comp.name, patterns):
                kind, pid = ("User", f"{comp.pid:5d}") if comp.kind == USER else ("RT", " " * 5)
                state = "ready" if comp.ready else "initializing"
                yield f"{comp.id:6d}  {kind:<4}  {comp.name:<47} {pid} {state}"
        yield ""

    def pins(self, patterns: list[str]) -> Lines:
        yield from self._items("Component Pins:", PIN, PIN_DIR_NAMES, patterns)

    def params(self, patterns: list[str]) -> Lines:
        yield from self._items("Parameters:", PARAM, PARAM_DIR_NAMES, patterns)

    def _items(self, title: str, kind: int, directions: dict[int, str], patterns: list[str]) -> Lines:
        yield from self._title(title, f"{'Owner':8}{'Type':6}{'Dir':5}{'Value':>{VALUE_WIDTH}}  Name")
        owners = self._owners()
        wanted, patterns = of_type(patterns)
        for item in self.segment.items(kind):
            if not matches(item.shown, patterns) or wanted not in (None, item.type):
                continue
            signal = item.signal
            link = f" {PIN_ARROWS[item.dir]} {signal.name}" if signal else ""
            owner, type_, direction = owners.get(item.owner, "?"), TYPE_NAMES[item.type], directions[item.dir]
            if self.script:
                yield f"{owner} {type_:<5} {direction} {show_value(item.type, item.get())} {item.shown}{link}"
            else:
                yield f"{owner}  {type_:<5} {direction:<3}  {padded(item)}  {item.shown}{link}"
        yield ""

    def aliases(self, patterns: list[str]) -> Lines:
        yield from self._alias_table(PIN, patterns)
        yield from self._alias_table(PARAM, patterns)

    def _alias_table(self, kind: int, patterns: list[str]) -> Lines:
        title = "Pin Aliases:" if kind == PIN else "Parameter Aliases:"
        yield from self._title(title, f" {'Alias':<47}  Original Name")
        for item in self.segment.items(kind):
            if item.alias and (matches(item.alias, patterns) or matches(item.name, patterns)):
                yield f"{item.alias}  {item.name}" if self.script else f" {item.alias:<47}  {item.name}"
        yield ""

    def signals(self, patterns: list[str]) -> Lines:
        yield from self._title("Signals:", f"{'Type':7}{'Value':>{VALUE_WIDTH}}  Name     (linked to)")
        wanted, patterns = of_type(patterns)
        for signal in self.segment.signals():
            if not matches(signal.name, patterns) or wanted not in (None, signal.type):
                continue
            links = [f"{SIGNAL_ARROWS[pin.dir]} {pin.shown}" for pin in signal.pins()]
            type_ = TYPE_NAMES[signal.type]
            if self.script:
                yield f"{type_:<5}  {show_value(signal.type, signal.get())}  " + " ".join([signal.name, *links])
            else:
                yield f"{type_:<5}  {padded(signal)}  {signal.name}"
                yield from (" " * (VALUE_WIDTH + 13) + link for link in links)
        yield ""

    def functs(self, patterns: list[str]) -> Lines:
        yield from self._title("Exported Functions:", "Owner   CodeAddr  Arg       FP   Users  Name")
        names = {comp.id: comp.name for comp in self.segment.comps()}
        for funct in self.segment.functs():
            if not matches(funct.name, patterns):
                continue
            fp = "YES" if funct.uses_fp else "NO"
            if self.script:
                yield f"{names[funct.owner]} {funct.code:08x} {funct.arg:08x} {fp:<3}{funct.users:3d} {funct.name}"
            else:
                yield f" {funct.owner:05d}  {funct.code:08x}  {funct.arg:08x}  {fp:<3}  {funct.users:5d}   {funct.name}"
        yield ""

    def threads(self, patterns: list[str]) -> Lines:
        yield from self._title("Realtime Threads:", "     Period  FP     Name               (     Time, Max-Time )")
        for thread in reversed(self.segment.threads()):
            if not matches(thread.name, patterns):
                continue
            time, tmax = (self._value(kind, f"{thread.name}.{of}") for kind, of in ((PIN, "time"), (PARAM, "tmax")))
            fp = "YES" if thread.uses_fp else "NO"
            called = [funct.name for funct in thread.functs()]
            if self.script:
                yield " ".join([f"{thread.period_ns} {fp} {thread.name} {time:8d} {tmax}", *called])
            else:
                yield f"{thread.period_ns:11d}  {fp:<3}  {thread.name:>20} ( {time:8d}, {tmax:8d} )"
                yield from (f"{place:19d} {name}" for place, name in enumerate(called, 1))
        yield ""

    def _value(self, kind: int, name: str) -> int:
        item = self.segment.find_item(kind, name)
        return int(item.get()) if item else 0


def list_names(hal: Hal, what: str, patterns: list[str]) -> list[str] | None:
    """Names of items, as ``list`` prints them; None: there are no items of that kind."""
    segment = hal.segment
    tables: dict[str, Callable[[], list]] = {
        "comp": segment.comps,
        "pin": lambda: segment.items(PIN),
        "sig": segment.signals,
        "signal": segment.signals,
        "param": lambda: segment.items(PARAM),
        "parameter": lambda: segment.items(PARAM),
        "funct": segment.functs,
        "function": segment.functs,
        "thread": lambda: segment.threads()[::-1],
    }
    if what not in tables:
        return None
    wanted, patterns = of_type(patterns) if what in TYPED else (None, patterns)
    records = [r for r in tables[what]() if wanted is None or r.type == wanted]
    names = [r.shown if isinstance(r, Item) else r.name for r in records]
    return [name for name in names if matches(name, patterns)]


class Save:
    """The ``save`` command: the session as HAL commands."""

    ALL = ("comp", "alias", "sigu", "netla", "param", "thread")

    def __init__(self, hal: Hal) -> None:
        self.segment = hal.segment
        self.tables: dict[str, Callable[[], Lines]] = {
            "comp": self.comps,
            "alias": self.aliases,
            "sig": self.signals,
            "signal": self.signals,
            "sigu": lambda: self.signals(unlinked_only=True),
            "link": self.links,
            "linka": lambda: self.links(arrows=True),
            "net": self.nets,
            "neta": lambda: self.nets(arrows=True),
            "netl": self.net_lines,
            "netla": lambda: self.net_lines(arrows=True),
            "netal": lambda: self.net_lines(arrows=True),
            "param": self.params,
            "parameter": self.params,
            "thread": self.threads,
            "unconnectedinpins": self.unconnected,
            "all": self.all,
            "allu": lambda: self.all(unconnected=True),
        }

    def all(self, unconnected: bool = False) -> Lines:
        for table in self.ALL:
            yield from self.tables[table]()
            if unconnected and table == "param":
                yield from self.unconnected()

    def comps(self) -> Lines:
        yield "# components"
        for comp in reversed(self.segment.comps()):
            if comp.kind == USER:
                continue
            if comp.name.startswith("__"):
                yield f"#loadrt {comp.name}  (not loaded by loadrt, no args saved)"
            else:
                yield f"loadrt {comp.name} {comp.args}" + (" " if comp.args else "")

    def aliases(self) -> Lines:
        for kind, title, word in ((PIN, "pin", "pin"), (PARAM, "param", "param")):
            yield f"# {title} aliases"
            yield from (f"alias {word} {item.name} {item.alias}" for item in self.segment.items(kind) if item.alias)

    def signals(self, unlinked_only: bool = False) -> Lines:
        yield "# signals"
        for signal in self.segment.signals():
            if not (unlinked_only and signal.pins()):
                yield f"newsig {signal.name} {TYPE_NAMES[signal.type]:<5}"

    def links(self, arrows: bool = False) -> Lines:
        yield "# links"
        for pin in self.segment.items(PIN):
            signal = pin.signal
            if signal:
                yield f"linkps {pin.shown} {PIN_ARROWS[pin.dir] if arrows else ''} {signal.name}"

    def nets(self, arrows: bool = False) -> Lines:
        yield "# nets"
        for signal in self.segment.signals():
            yield f"newsig {signal.name} {TYPE_NAMES[signal.type]:<5}"
            for pin in signal.pins():
                yield f"linksp {signal.name} {SIGNAL_ARROWS[pin.dir] if arrows else ''} {pin.shown}"

    def net_lines(self, arrows: bool = False) -> Lines:
        yield "# nets"
        for signal in self._linked():
            pins = signal.pins()
            if not arrows:
                yield " ".join(["net", signal.name, *(pin.shown for pin in pins)])
                continue
            sources = [pin.shown for pin in pins if pin.dir != IN]  # one output, or inputs that are outputs too
            readers = " ".join(pin.shown for pin in pins if pin.dir == IN)
            yield f"net {signal.name} " + " => ".join(part for part in (" <=> ".join(sources), readers) if part)

    def _linked(self) -> list[Signal]:
        return [signal for signal in self.segment.signals() if signal.pins()]

    def params(self) -> Lines:
        yield "# parameter values"
        yield from (
            f"setp {param.shown} {padded(param)}" for param in self.segment.items(PARAM) if param.dir == RW
        )

    def unconnected(self) -> Lines:
        yield "# unconnected pin values"
        for pin in self.segment.items(PIN):
            if pin.dir != OUT and pin.signal is None:
                yield f"setp {pin.shown} {padded(pin)}"

    def threads(self) -> Lines:
        yield "# realtime thread/function links"
        for thread in reversed(self.segment.threads()):
            yield from (f"addf {funct.name} {thread.name}" for funct in thread.functs())


_LOCK_TEXTS = (
    (LOCK_LOAD, "  HAL_LOCK_LOAD    - loading of new components is locked"),
    (LOCK_CONFIG, "  HAL_LOCK_CONFIG  - link and addf is locked"),
    (LOCK_PARAMS, "  HAL_LOCK_PARAMS  - setting params is locked"),
    (LOCK_RUN, "  HAL_LOCK_RUN     - running/stopping HAL is locked"),
)


def lock_status(hal: Hal) -> Lines:
    locks = hal.segment.locks
    yield "HAL locking status:"
    yield f"  current lock value {locks} ({locks:02x})"
    if not locks:
        yield "  HAL_LOCK_NONE - nothing is locked"
    yield from (text for bit, text in _LOCK_TEXTS if locks & bit)


def memory_status(hal: Hal) -> Lines:
    """How much of the segment is in use."""
    used = hal.segment.used()
    total = sum(count * size for _, count, size in used.values())
    aliases = sum(1 for kind in (PIN, PARAM) for item in hal.segment.items(kind) if item.alias)
    rows = {name: (count, ever - count) for name, (count, ever, _) in used.items()}
    ordered = ["components", "pins", "parameters", "aliases", "signals", "functions", "threads"]
    rows["aliases"] = (aliases, 0)
    yield "HAL memory status"
    yield f"  used/total shared memory:   {total}/{hal.segment.size}"
    for name in ordered:
        active, recycled = rows[name]
        yield f"  active/recycled {name + ':':<11} {active}/{recycled}"
