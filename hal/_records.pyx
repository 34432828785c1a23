"""Views of the HAL's records: pins, parameters, signals, components, functions and threads, and what a cell's bytes mean.

A view holds the mapped memory and points at one record. ``hal._shm`` makes and finds records; ``hal.core`` keeps the rules.
"""

cimport cython
from libc.stdint cimport int64_t, uint8_t, uint32_t
from libc.string cimport memcpy, memset, strncpy

from hal._mapping cimport (
    ARGS_SIZE, MAX_CALLS, NAME_SIZE, announce, hal_segment, point, store_link, store_state, word_of,
)

from nml.errors import HalError

# The type and direction numbers of LinuxCNC's hal.h
BIT, FLOAT, S32, U32, PORT, S64, U64 = TYPE_BIT, TYPE_FLOAT, TYPE_S32, TYPE_U32, TYPE_PORT, TYPE_S64, TYPE_U64
IN, OUT, IO = DIR_IN, DIR_OUT, DIR_IO
RO, RW = 64, 192


cdef uint32_t hash_name(const char* name) noexcept nogil:
    cdef uint32_t h = 2166136261
    while name[0]:
        h = (h ^ <uint8_t>name[0]) * 16777619
        name += 1
    return h


cdef int set_name(char* field, uint32_t* hash, str name) except -1:
    cdef bytes raw = name.encode()
    if len(raw) >= NAME_SIZE:
        raise HalError(f"name '{name}' is too long: {len(raw)} characters, {NAME_SIZE - 1} are allowed", -22)
    memset(field, 0, NAME_SIZE)
    memcpy(field, <const char*>raw, len(raw))
    hash[0] = hash_name(<const char*>raw)
    return 0


cdef Item view_item(Mapping mapping, hal_item* item):
    cdef Item view = Item.__new__(Item)
    view.mapping, view.item, view.head, view.word = mapping, item, &item.head, word_of(mapping.at, item)
    return view


cdef Signal view_signal(Mapping mapping, hal_signal* signal):
    cdef Signal view = Signal.__new__(Signal)
    view.mapping, view.signal, view.head = mapping, signal, &signal.head
    view.cell = &mapping.at.cells[signal - &mapping.at.signals[0]]
    return view


cdef Comp view_comp(Mapping mapping, hal_comp* comp):
    cdef Comp view = Comp.__new__(Comp)
    view.mapping, view.comp, view.head = mapping, comp, &comp.head
    return view


cdef Funct view_funct(Mapping mapping, hal_funct* funct):
    cdef Funct view = Funct.__new__(Funct)
    view.mapping, view.funct, view.head = mapping, funct, &funct.head
    return view


cdef Thread view_thread(Mapping mapping, hal_thread* thread):
    cdef Thread view = Thread.__new__(Thread)
    view.mapping, view.thread, view.head = mapping, thread, &thread.head
    return view


def record_name(Record record):
    """Sort key: the name."""
    return record.head.name


def shown_name(Item item):
    """Sort key: the alias where there is one, else the name."""
    return item.item.alias if item.item.alias[0] else item.head.name


def newest_first(Comp comp):
    """Sort key: components in falling order of number."""
    return -comp.comp.id


cdef hal_port* port_at(hal_cell* cell) noexcept:
    """The buffer that a port's cell names; NULL where it has none."""
    return NULL if cell.l == 0 else <hal_port*>(<char*>cell + cell.l)


cdef object cell_value(hal_cell* cell, int type):
    """A cell as a Python number."""
    if type == TYPE_FLOAT:
        return cell.f
    if type == TYPE_BIT:
        return cell.b != 0
    if type == TYPE_S32:
        return cell.s
    if type == TYPE_U32:
        return cell.u
    if type == TYPE_S64:
        return cell.l
    if type == TYPE_U64:
        return cell.k
    return 0 if cell.l == 0 else port_at(cell).size


cdef int set_cell(hal_cell* cell, int type, object value) except -1:
    """Store a Python number; OverflowError where it does not fit the type."""
    if type == TYPE_FLOAT:
        cell.f = value
    elif type == TYPE_BIT:
        cell.b = 1 if value else 0
    elif type == TYPE_S32:
        cell.s = value
    elif type == TYPE_U32:
        cell.u = value
    elif type == TYPE_S64:
        cell.l = value
    elif type == TYPE_U64:
        cell.k = value
    else:
        raise HalError("a port has no value to set; 'sets' gives its signal a size")
    return 0


cdef class Record:
    """A view of one record; two views are equal where they show the same record."""

    @property
    def name(self) -> str:
        return self.head.name.decode()

    @property
    def exists(self) -> bool:
        return self.head.state != 0

    @property
    def address(self) -> int:
        return <size_t>self.head

    def free(self) -> None:
        """Give the slot back; the caller holds the mutex and has undone what points here."""
        store_state(&self.head.state, 0)

    def __eq__(self, other):
        return isinstance(other, Record) and (<Record>other).head == self.head

    def __hash__(self):
        return hash(<size_t>self.head)

    def __repr__(self):
        return f"<{type(self).__name__} {self.name}>"


cdef class Item(Record):
    """A pin or a parameter."""

    @property
    def address(self) -> int:
        """What native code takes as its `hal_pin`."""
        return <size_t>&self.word.link

    cdef hal_cell* cell(self) noexcept:
        return <hal_cell*>(<char*>&self.word.link + self.word.link)

    def show_same(self, Item other) -> None:
        """Become a view of what another one shows; for subclasses."""
        self.mapping, self.head, self.item, self.word = other.mapping, other.head, other.item, other.word

    @property
    def type(self) -> int:
        return self.item.type

    @property
    def dir(self) -> int:
        return self.item.dir

    @property
    def owner(self) -> int:
        return self.item.owner

    @property
    def alias(self) -> str:
        return self.item.alias.decode()

    @alias.setter
    def alias(self, str text):
        self.item.alias_hash = 0
        if text:
            set_name(self.item.alias, &self.item.alias_hash, text)
        else:
            memset(self.item.alias, 0, NAME_SIZE)

    @property
    def shown(self) -> str:
        """The name that listings show: the alias where there is one."""
        return self.item.alias.decode() if self.item.alias[0] else self.name

    @cython.binding(False)
    def get(self):
        return cell_value(<hal_cell*>(<char*>&self.word.link + self.word.link), self.item.type)

    @cython.binding(False)
    def set(self, value) -> None:
        set_cell(<hal_cell*>(<char*>&self.word.link + self.word.link), self.item.type, value)
        announce(self.mapping.at)

    value = property(get, set)

    def set_safe(self, value) -> None:
        """The value that the pin takes when its owner dies."""
        set_cell(&self.item.safe, self.item.type, value)
        self.item.has_safe = 1

    def fall_safe(self) -> None:
        """Take the declared safe value, if there is one."""
        if self.item.has_safe:
            self.cell()[0] = self.item.safe
            announce(self.mapping.at)

    @property
    def signal(self):
        """The signal that this pin is linked to, or None."""
        if not self.item.signal:
            return None
        return view_signal(self.mapping, &self.mapping.at.signals[self.item.signal - 1])

    def link(self, Signal signal) -> None:
        self.item.signal = <int>(signal.signal - self.mapping.at.signals) + 1
        point(self.mapping.at, self.item, self.item.signal)

    def show_to(self, size_t variable) -> None:
        """Keep the pointer that lies at this address, in the segment, aimed at the cell in use: a C component's pin."""
        self.item.base = <size_t>self.mapping.at
        self.item.pointer = variable - self.item.base
        point(self.mapping.at, self.item, self.item.signal)

    def lie_at(self, size_t variable) -> None:
        """Let the value be at this address, in the segment: a C component's parameter."""
        store_link(&self.word.link, <int64_t>variable - <int64_t><size_t>&self.word.link)

    def unlink(self) -> None:
        """Cut the pin off; it keeps the signal's last value."""
        if self.item.signal:
            if self.item.type == TYPE_PORT:
                self.word.cell.k = 0  # the buffer is the signal's
            else:
                self.word.cell = self.cell()[0]
            point(self.mapping.at, self.item, 0)
            self.item.signal = 0


cdef class Signal(Record):
    """A signal: a named cell that pins are linked to."""

    @property
    def type(self) -> int:
        return self.signal.type

    def get(self):
        return cell_value(self.cell, self.signal.type)

    def set(self, value) -> None:
        set_cell(self.cell, self.signal.type, value)
        announce(self.mapping.at)

    value = property(get, set)

    def allot(self, uint32_t size) -> None:
        """Give a port its buffer; the caller holds the mutex."""
        cdef hal_port* port = self.mapping.new_port(size)
        store_link(&self.cell.l, <char*>port - <char*>self.cell)

    def free(self) -> None:
        """As of any record; a port's buffer is free again."""
        if self.signal.type == TYPE_PORT and self.cell.l != 0:
            port_at(self.cell).size = 0
            self.cell.l = 0
        Record.free(self)

    def pins(self) -> list:
        """The pins linked to it, sorted by shown name."""
        cdef int number = <int>(self.signal - self.mapping.at.signals) + 1
        cdef hal_segment* at = self.mapping.at
        cdef list found = []
        cdef int i
        for i in range(at.used_pins):
            if at.pins[i].signal == number and at.pins[i].head.state:
                found.append(view_item(self.mapping, &at.pins[i]))
        return sorted(found, key=shown_name)

    def writer(self):
        """The output pin that drives it, or None."""
        for pin in self.pins():
            if (<Item>pin).item.dir == DIR_OUT:
                return pin
        return None


cdef class Comp(Record):
    """A component: a user process, a realtime module or a thread."""

    @property
    def id(self) -> int:
        return self.comp.id

    @property
    def kind(self) -> int:
        return self.comp.kind

    @property
    def pid(self) -> int:
        return self.comp.pid

    @property
    def start(self) -> int:
        return self.comp.start

    @property
    def ready(self) -> bool:
        return self.comp.ready != 0

    @ready.setter
    def ready(self, bint value):
        self.comp.ready = value

    @property
    def args(self) -> str:
        """What loadrt was given, as `save` prints it."""
        return self.comp.args.decode()

    @args.setter
    def args(self, str text):
        cdef bytes raw = text.encode()[: ARGS_SIZE - 1]
        strncpy(self.comp.args, raw, ARGS_SIZE)


cdef class Funct(Record):
    """A realtime function that `addf` puts into a thread."""

    @property
    def owner(self) -> int:
        return self.funct.owner

    @property
    def users(self) -> int:
        return self.funct.users

    @property
    def uses_fp(self) -> bool:
        return self.funct.uses_fp != 0

    @property
    def reentrant(self) -> bool:
        return self.funct.reentrant != 0

    @property
    def code(self) -> int:
        return self.funct.code

    @property
    def arg(self) -> int:
        return self.funct.arg


cdef class Thread(Record):
    """A realtime thread and the functions that it calls in order."""

    @property
    def owner(self) -> int:
        return self.thread.owner

    @property
    def period_ns(self) -> int:
        return self.thread.period_ns

    @property
    def uses_fp(self) -> bool:
        return self.thread.uses_fp != 0

    @property
    def priority(self) -> int:
        return self.thread.priority

    @priority.setter
    def priority(self, int value):
        self.thread.priority = value

    @property
    def cycles(self) -> int:
        """Periods since the thread was made, running or stopped."""
        return self.thread.cycles

    @property
    def overruns(self) -> int:
        """Periods that began more than one period late."""
        return self.thread.overruns

    @property
    def running(self) -> bool:
        """Whether it is inside its functions now."""
        return self.thread.running != 0

    def functs(self) -> list:
        return [view_funct(self.mapping, &self.mapping.at.functs[self.thread.call[i]]) for i in range(self.thread.calls)]

    def set_functs(self, list functs) -> None:
        """Replace the list that is shown; the host replaces the one that is called."""
        cdef Funct funct
        cdef int i
        if len(functs) > MAX_CALLS:
            raise HalError(f"thread '{self.name}' has no room for more than {MAX_CALLS} functions", -12)
        for i in range(self.thread.calls):
            self.mapping.at.functs[self.thread.call[i]].users -= 1
        for i, funct in enumerate(functs):
            self.thread.call[i] = <int>(funct.funct - self.mapping.at.functs)
            funct.funct.users += 1
        self.thread.calls = len(functs)
