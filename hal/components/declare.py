"""How a native component is declared: pins, parameters, functions and texts in one table, for loading and for the docs.

A component is a C struct whose first members are ``hal_pin``, one for each pin and parameter in the order of the table
(an array member for a table entry with ``count``), then its own state, all zero at first; and functions of that struct:

    cdef struct And2:
        hal_pin in0, in1, out

    cdef void and2(And2* s, long period) noexcept nogil:
        at(s.out).b = at(s.in0).b and at(s.in1).b

    declare("and2", "Two-input AND gate", sizeof(And2), [
        pin_in(BIT, "in0"), pin_in(BIT, "in1"), pin_out(BIT, "out", "true when both inputs are true"),
    ], {"": <size_t>&and2})

A key of the functions is the name's part after the instance's; "" is the instance itself. `loadrt` takes ``count=`` or
``names=``, as for LinuxCNC's components.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from hal._calls import Memory
from hal._shm import BIT, FLOAT, IN, IO, OUT, RO, RW, S32, S64, U32, U64
from hal.values import TYPE_NAMES
from nml.errors import HalError

if TYPE_CHECKING:
    from hal.realtime import Component, Host

WORD = 8  # bytes of a hal_pin
DECLARED: dict[str, Declaration] = {}


@dataclass(frozen=True)
class Entry:
    """A pin or parameter; ``count`` of them where the name has a field: ``{}``, ``{:02}``, ``{letter}`` for A to E.

    ``{type}`` in a name is the type's name, where that depends on the personality; ``{word}`` is one of ``words``;
    ``{row}`` and ``{column}`` are the number's in a table that is as wide as ``columns`` says.
    """

    is_pin: bool
    type: int
    dir: int
    name: str
    doc: str = ""
    default: Any = 0
    count: int = 1
    words: tuple[str, ...] = ()
    personal: Callable[[int], int] | None = None  # how many of ``count`` exist for a personality
    type_of: Callable[[int], int] | None = None  # the type for a personality
    default_of: Callable[[int, int], Any] | None = None  # the default for a number and a personality
    dir_of: Callable[[int], int] | None = None  # the direction for a personality
    columns: Callable[[int], int] | None = None  # by personality

    def items(self, personality: int) -> Iterator[tuple[str, int, Any]]:
        """Name, type and default of each that exists for the personality."""
        type_ = self.type_of(personality) if self.type_of else self.type
        for i in range(self.personal(personality) if self.personal else self.count):
            word = self.words[i] if self.words else ""
            row, column = divmod(i, self.columns(personality)) if self.columns else (0, 0)
            name = self.name.format(
                i, letter="ABCDE"[i % 5], type=TYPE_NAMES[type_], word=word, row=row, column=column
            )  # fmt: skip
            yield name, type_, self.default_of(i, personality) if self.default_of else self.default


def pin_in(type_: int, name: str, doc: str = "", default: Any = 0, **more: Any) -> Entry:
    return Entry(True, type_, IN, name, doc, default, **more)


def pin_out(type_: int, name: str, doc: str = "", default: Any = 0, **more: Any) -> Entry:
    return Entry(True, type_, OUT, name, doc, default, **more)


def pin_io(type_: int, name: str, doc: str = "", default: Any = 0, **more: Any) -> Entry:
    return Entry(True, type_, IO, name, doc, default, **more)


def param_rw(type_: int, name: str, doc: str = "", default: Any = 0, **more: Any) -> Entry:
    return Entry(False, type_, RW, name, doc, default, **more)


def param_ro(type_: int, name: str, doc: str = "", default: Any = 0, **more: Any) -> Entry:
    return Entry(False, type_, RO, name, doc, default, **more)


@dataclass
class Declaration:
    """One component, as `declare` was given it."""

    name: str
    doc: str
    size: int
    entries: list[Entry]
    functions: dict[str, int]
    shared: dict[str, int] = field(default_factory=dict)
    counted_by: str = "count"
    default_count: int = 1
    most: int | None = None
    takes_names: bool = True
    uses_fp: bool | Callable[[int], bool] = True  # or by personality
    integer: tuple[str, ...] = ()  # functions without floating point, where others have it
    separator: str = "."
    personality: int | None = None  # the default, for components whose pins depend on it
    sizes: bool = False  # `counted_by` takes a list, a personality for each instance
    names_beside: bool = False  # `names=` has a name for each of that list
    options: tuple[str, ...] = ()  # further parameters, which `decode` understands
    decode: Callable[[dict[str, str]], list[int]] | None = None  # personalities from the parameters
    state: tuple[int, ...] = ()  # machine words behind the pins
    keep_personality: bool = False  # as one more such word
    set_up: Callable[[int], None] | None = None  # called with the address of each new instance
    instance: str = ""  # an instance's name with a field for its number, where it is not the component's
    shared_prefix: str | None = None  # of the functions for all instances, where it is not the component's

    def load(self, host: Host, args: dict[str, str]) -> None:
        """``loadrt``: make every instance."""
        self._check(args)
        comp = host.component(self.name)
        memories = []
        personalities = self._personalities(args)
        for i, instance in enumerate(self.instances(args)):
            personality = personalities[i] if i < len(personalities) else self.personality or 0
            memories.append(self._instance(comp, instance, personality))
        self._export_shared(comp, memories)
        comp.ready()

    def _check(self, args: dict[str, str]) -> None:
        allowed = [self.counted_by, *(["names"] if self.takes_names else []), *self.options]
        allowed += ["personality"] if self.personality is not None else []
        for key in args:
            if key not in allowed:
                raise HalError(f"{self.name}: unknown parameter '{key}'; {', '.join(allowed)} are known")
        if self.counted_by in args and "names" in args and not self.names_beside:
            raise HalError(f"{self.name}: {self.counted_by}= and names= cannot be given together")

    def instances(self, args: dict[str, str]) -> list[str]:
        """The instances' names; ``names=`` without any is not given, where a count may be left out too."""
        if args.get("names") or ("names" in args and self.counted_by != "count"):
            names = [name for name in args["names"].split(",") if name]
            if not names:
                raise HalError(f"{self.name}: names={args['names']}: at least one name would be right")
            if self.most is not None and len(names) > self.most:
                raise HalError(f"{self.name}: {len(names)} names; up to {self.most} are possible")
            return names
        count = self._count(args)
        if count < 1 or (self.most is not None and count > self.most):
            most = "" if self.most is None else f" to {self.most}"
            given = args.get(self.counted_by, "")
            raise HalError(f"{self.name}: {self.counted_by}={given}: from 1{most} would be right")
        return [(self.instance or f"{self.prefix}.{{}}").format(i) for i in range(count)]

    def _count(self, args: dict[str, str]) -> int:
        """How many instances; 0 counts as not given where it could be names instead."""
        if self.sizes:
            return len(self._personalities(args))
        counts = numbers(self.name, args, self.counted_by) or [self.default_count]
        if len(counts) != 1:
            return 0
        return counts[0] or (self.default_count if self.takes_names else 0)

    def _personalities(self, args: dict[str, str]) -> list[int]:
        if self.decode is not None:
            return self.decode(args)
        return numbers(self.name, args, self.counted_by if self.sizes else "personality")

    @property
    def prefix(self) -> str:
        return self.name.replace("_", "-")

    def _instance(self, comp: Component, instance: str, personality: int) -> Memory:
        memory = Memory(self.size)
        comp.keep(memory)
        offset = 0
        for entry in self.entries:
            make = comp.pin if entry.is_pin else comp.param
            direction = entry.dir_of(personality) if entry.dir_of else entry.dir
            for i, (name, type_, default) in enumerate(entry.items(personality)):
                item = make(f"{instance}{self.separator}{name}", type_, direction, default)
                memory.put(offset + i * WORD, item.address)
            offset += entry.count * WORD
        for i, word in enumerate((*self.state, personality) if self.keep_personality else self.state):
            memory.put(offset + i * WORD, word)
        if self.set_up is not None:
            self.set_up(memory.address)
        for suffix, code in self.functions.items():
            name = f"{instance}.{suffix}" if suffix else instance
            comp.function(name, code, memory.address, uses_fp=self._fp(personality))
        return memory

    def _fp(self, personality: int) -> bool:
        return self.uses_fp if isinstance(self.uses_fp, bool) else self.uses_fp(personality)

    def _export_shared(self, comp: Component, memories: list[Memory]) -> None:
        """Functions for all instances at once; their argument is a count and that many addresses."""
        if not self.shared:
            return
        everyone = Memory((len(memories) + 1) * WORD)
        comp.keep(everyone)
        everyone.put(0, len(memories))
        for i, memory in enumerate(memories):
            everyone.put((i + 1) * WORD, memory.address)
        for suffix, (name, code) in zip(self.shared, self.shared_functions(), strict=True):
            comp.function(name, code, everyone.address, uses_fp=self._fp(0) and suffix not in self.integer)

    def shared_functions(self) -> list[tuple[str, int]]:
        """Names and addresses of the functions for all instances."""
        prefix = f"{self.prefix}." if self.shared_prefix is None else self.shared_prefix
        return [(f"{prefix}{suffix}", code) for suffix, code in self.shared.items()]


def numbers(component: str, args: dict[str, str], key: str) -> list[int]:
    """The numbers of a list with commas; none where it is not given."""
    try:
        return [int(word, 0) for word in args.get(key, "").split(",") if word]
    except ValueError:
        raise HalError(f"{component}: {key}={args[key]}: whole numbers with commas would be right") from None


def declare(name: str, doc: str, size: int, entries: list[Entry], functions: dict[str, int], **more: Any) -> None:
    """Make a component known; the struct must begin with the pins of the table."""
    words = sum(entry.count for entry in entries)
    if size < words * WORD:
        raise AssertionError(f"{name}: a struct of {size} bytes has no room for {words} pins")
    DECLARED[name] = Declaration(name, doc, size, entries, functions, **more)


__all__ = [
    "BIT", "FLOAT", "S32", "S64", "U32", "U64",
    "declare", "numbers", "param_ro", "param_rw", "pin_in", "pin_io", "pin_out",
]  # fmt: skip
