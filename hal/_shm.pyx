"""The records of the HAL's segment: components, pins, parameters, signals, functions and threads.

`Segment` makes and finds them in the mapped memory (``hal._mapping``), and each has a typed view here. ``hal.core`` keeps
the rules.
"""

from libc.stdint cimport int32_t, int64_t, uint8_t, uint32_t, uint64_t
from libc.string cimport memcpy, memset, strcmp, strncpy

from hal._mapping cimport (
    ARGS_SIZE, MAX_CALLS, MAX_COMPS, MAX_FUNCTS, MAX_PARAMS, MAX_PINS, MAX_SIGNALS, MAX_THREADS, NAME_SIZE, load_state,
    announce, point, store_link, store_state, word_of,
)
from hal.port cimport hal_port

from nml.errors import HalError

# The type and direction numbers of LinuxCNC's hal.h
BIT, FLOAT, S32, U32, PORT, S64, U64 = 1, 2, 3, 4, 5, 6, 7
IN, OUT, IO = 16, 32, 48
RO, RW = 64, 192
PIN, PARAM = 0, 1
USER, REALTIME, THREAD_COMP = 0, 1, 2


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


cdef class Segment(Mapping):
    """The mapped segment of this process's namespace, as tables; as a context manager it holds the mutex."""

    def used(self) -> dict:
        """By table: records in use, slots ever used, bytes of a record."""
        return {
            "components": (len(self.comps()), self.at.used_comps, sizeof(hal_comp)),
            "pins": (len(self.items(PIN)), self.at.used_pins, sizeof(hal_item)),
            "parameters": (len(self.items(PARAM)), self.at.used_params, sizeof(hal_item)),
            "signals": (len(self.signals()), self.at.used_signals, sizeof(hal_signal)),
            "functions": (len(self.functs()), self.at.used_functs, sizeof(hal_funct)),
            "threads": (len(self.threads()), self.at.used_threads, sizeof(hal_thread)),
        }

    cdef hal_record* _slot(self, hal_record* first, size_t stride, int32_t* used, int limit, str what) except NULL:
        """A free slot of a table, cleared."""
        cdef hal_record* record = first
        cdef int i
        for i in range(used[0]):
            record = <hal_record*>(<char*>first + i * stride)
            if not record.state:
                memset(record, 0, stride)
                return record
        if used[0] >= limit:
            raise HalError(f"no room for another {what}: {limit} exist", -12)
        record = <hal_record*>(<char*>first + used[0] * stride)
        memset(record, 0, stride)
        used[0] += 1
        return record

    cdef hal_record* _find(self, hal_record* first, size_t stride, int used, str name):
        cdef bytes raw = name.encode()
        cdef const char* text = raw
        cdef uint32_t wanted = hash_name(text)
        cdef hal_record* record
        cdef int i
        for i in range(used):
            record = <hal_record*>(<char*>first + i * stride)
            if record.hash == wanted and load_state(&record.state) and strcmp(record.name, text) == 0:
                return record
        return NULL

    # pins and parameters

    cdef Item _item(self, hal_item* item):
        cdef Item view = Item.__new__(Item)
        view.segment, view.item, view.head, view.word = self, item, &item.head, word_of(self.at, item)
        return view

    def new_item(self, int kind, str name, int type, int dir, int owner) -> Item:
        """A pin or parameter of value 0; the caller holds the mutex and has checked that the name is free."""
        cdef hal_item* item
        if kind == PIN:
            item = <hal_item*>self._slot(&self.at.pins[0].head, sizeof(hal_item), &self.at.used_pins, MAX_PINS, "pin")
        else:
            item = <hal_item*>self._slot(
                &self.at.params[0].head, sizeof(hal_item), &self.at.used_params, MAX_PARAMS, "parameter")
        set_name(item.head.name, &item.head.hash, name)
        item.type, item.dir, item.owner = type, dir, owner
        word_of(self.at, item).cell.k = 0
        point(self.at, item, 0)
        store_state(&item.head.state, 1)
        return self._item(item)

    def find_item(self, int kind, str name):
        """The pin or parameter of that name or alias; None where there is none."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        cdef hal_item* found = <hal_item*>self._find(&first[0].head, sizeof(hal_item), used, name)
        if found != NULL:
            return self._item(found)
        cdef bytes raw = name.encode()
        cdef uint32_t wanted = hash_name(raw)
        for i in range(used):
            if first[i].alias_hash == wanted and first[i].head.state and strcmp(first[i].alias, raw) == 0:
                return self._item(&first[i])
        return None

    def items(self, int kind) -> list:
        """All pins or parameters, sorted by the name that they show."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        return sorted([self._item(&first[i]) for i in range(used) if load_state(&first[i].head.state)], key=shown_name)

    # signals

    cdef Signal _signal(self, hal_signal* signal):
        cdef Signal view = Signal.__new__(Signal)
        view.segment, view.signal, view.head = self, signal, &signal.head
        view.cell = &self.at.cells[signal - &self.at.signals[0]]
        return view

    def new_signal(self, str name, int type) -> Signal:
        cdef hal_signal* signal = <hal_signal*>self._slot(
            &self.at.signals[0].head, sizeof(hal_signal), &self.at.used_signals, MAX_SIGNALS, "signal")
        set_name(signal.head.name, &signal.head.hash, name)
        signal.type = type
        self.at.cells[signal - &self.at.signals[0]].k = 0
        store_state(&signal.head.state, 1)
        return self._signal(signal)

    def find_signal(self, str name):
        found = <size_t>self._find(&self.at.signals[0].head, sizeof(hal_signal), self.at.used_signals, name)
        return self._signal(<hal_signal*><size_t>found) if found else None

    def signals(self) -> list:
        """All signals, sorted by name."""
        return sorted([self._signal(&self.at.signals[i]) for i in range(self.at.used_signals)
                       if load_state(&self.at.signals[i].head.state)], key=record_name)

    # components

    cdef Comp _comp(self, hal_comp* comp):
        cdef Comp view = Comp.__new__(Comp)
        view.segment, view.comp, view.head = self, comp, &comp.head
        return view

    def new_comp(self, str name, int kind, int pid, uint64_t start) -> Comp:
        cdef hal_comp* comp = <hal_comp*>self._slot(
            &self.at.comps[0].head, sizeof(hal_comp), &self.at.used_comps, MAX_COMPS, "component")
        set_name(comp.head.name, &comp.head.hash, name)
        comp.id, comp.kind, comp.pid, comp.start = self.new_id(), kind, pid, start
        store_state(&comp.head.state, 1)
        return self._comp(comp)

    def find_comp(self, str name):
        found = <size_t>self._find(&self.at.comps[0].head, sizeof(hal_comp), self.at.used_comps, name)
        return self._comp(<hal_comp*><size_t>found) if found else None

    def comps(self) -> list:
        """All components, newest first."""
        return sorted([self._comp(&self.at.comps[i]) for i in range(self.at.used_comps)
                       if load_state(&self.at.comps[i].head.state)], key=newest_first)

    # functions

    cdef Funct _funct(self, hal_funct* funct):
        cdef Funct view = Funct.__new__(Funct)
        view.segment, view.funct, view.head = self, funct, &funct.head
        return view

    def new_funct(self, str name, int owner, uint64_t code, uint64_t arg, bint uses_fp, bint reentrant) -> Funct:
        cdef hal_funct* funct = <hal_funct*>self._slot(
            &self.at.functs[0].head, sizeof(hal_funct), &self.at.used_functs, MAX_FUNCTS, "function")
        set_name(funct.head.name, &funct.head.hash, name)
        funct.owner, funct.code, funct.arg, funct.uses_fp, funct.reentrant = owner, code, arg, uses_fp, reentrant
        store_state(&funct.head.state, 1)
        return self._funct(funct)

    def find_funct(self, str name):
        found = <size_t>self._find(&self.at.functs[0].head, sizeof(hal_funct), self.at.used_functs, name)
        return self._funct(<hal_funct*><size_t>found) if found else None

    def functs(self) -> list:
        """All functions, sorted by name."""
        return sorted([self._funct(&self.at.functs[i]) for i in range(self.at.used_functs)
                       if load_state(&self.at.functs[i].head.state)], key=record_name)

    # threads

    cdef Thread _thread(self, hal_thread* thread):
        cdef Thread view = Thread.__new__(Thread)
        view.segment, view.thread, view.head = self, thread, &thread.head
        return view

    def new_thread(self, str name, int owner, int64_t period_ns, bint uses_fp) -> Thread:
        cdef hal_thread* thread = <hal_thread*>self._slot(
            &self.at.threads[0].head, sizeof(hal_thread), &self.at.used_threads, MAX_THREADS, "thread")
        set_name(thread.head.name, &thread.head.hash, name)
        thread.owner, thread.period_ns, thread.uses_fp = owner, period_ns, uses_fp
        store_state(&thread.head.state, 1)
        return self._thread(thread)

    def find_thread(self, str name):
        found = <size_t>self._find(&self.at.threads[0].head, sizeof(hal_thread), self.at.used_threads, name)
        return self._thread(<hal_thread*><size_t>found) if found else None

    def threads(self) -> list:
        """All threads, in the order in which they were made."""
        return [self._thread(&self.at.threads[i]) for i in range(self.at.used_threads)
                if load_state(&self.at.threads[i].head.state)]


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
    if type == FLOAT:
        return cell.f
    if type == BIT:
        return cell.b != 0
    if type == S32:
        return cell.s
    if type == U32:
        return cell.u
    if type == S64:
        return cell.l
    if type == U64:
        return cell.k
    return 0 if cell.l == 0 else port_at(cell).size


cdef int set_cell(hal_cell* cell, int type, object value) except -1:
    """Store a Python number; OverflowError where it does not fit the type."""
    if type == FLOAT:
        cell.f = value
    elif type == BIT:
        cell.b = 1 if value else 0
    elif type == S32:
        cell.s = value
    elif type == U32:
        cell.u = value
    elif type == S64:
        cell.l = value
    elif type == U64:
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
        self.segment, self.head, self.item, self.word = other.segment, other.head, other.item, other.word

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

    def get(self):
        return cell_value(<hal_cell*>(<char*>&self.word.link + self.word.link), self.item.type)

    def set(self, value) -> None:
        set_cell(<hal_cell*>(<char*>&self.word.link + self.word.link), self.item.type, value)
        announce(self.segment.at)

    value = property(get, set)

    def set_safe(self, value) -> None:
        """The value that the pin takes when its owner dies."""
        set_cell(&self.item.safe, self.item.type, value)
        self.item.has_safe = 1

    def fall_safe(self) -> None:
        """Take the declared safe value, if there is one."""
        if self.item.has_safe:
            self.cell()[0] = self.item.safe
            announce(self.segment.at)

    @property
    def signal(self):
        """The signal that this pin is linked to, or None."""
        if not self.item.signal:
            return None
        return self.segment._signal(&self.segment.at.signals[self.item.signal - 1])

    def link(self, Signal signal) -> None:
        self.item.signal = <int>(signal.signal - self.segment.at.signals) + 1
        point(self.segment.at, self.item, self.item.signal)

    def show_to(self, size_t variable) -> None:
        """Keep the pointer that lies at this address, in the segment, aimed at the cell in use: a C component's pin."""
        self.item.base = <size_t>self.segment.at
        self.item.pointer = variable - self.item.base
        point(self.segment.at, self.item, self.item.signal)

    def lie_at(self, size_t variable) -> None:
        """Let the value be at this address, in the segment: a C component's parameter."""
        store_link(&self.word.link, <int64_t>variable - <int64_t><size_t>&self.word.link)

    def unlink(self) -> None:
        """Cut the pin off; it keeps the signal's last value."""
        if self.item.signal:
            if self.item.type == PORT:
                self.word.cell.k = 0  # the buffer is the signal's
            else:
                self.word.cell = self.cell()[0]
            point(self.segment.at, self.item, 0)
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
        announce(self.segment.at)

    value = property(get, set)

    def allot(self, uint32_t size) -> None:
        """Give a port its buffer; the caller holds the mutex."""
        cdef hal_port* port = self.segment.new_port(size)
        store_link(&self.cell.l, <char*>port - <char*>self.cell)

    def free(self) -> None:
        """As of any record; a port's buffer is free again."""
        if self.signal.type == PORT and self.cell.l != 0:
            port_at(self.cell).size = 0
            self.cell.l = 0
        Record.free(self)

    def pins(self) -> list:
        """The pins linked to it, sorted by shown name."""
        cdef int number = <int>(self.signal - self.segment.at.signals) + 1
        cdef hal_segment* at = self.segment.at
        cdef list found = []
        cdef int i
        for i in range(at.used_pins):
            if at.pins[i].signal == number and at.pins[i].head.state:
                found.append(self.segment._item(&at.pins[i]))
        return sorted(found, key=shown_name)

    def writer(self):
        """The output pin that drives it, or None."""
        for pin in self.pins():
            if pin.dir == OUT:
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
        return [self.segment._funct(&self.segment.at.functs[self.thread.call[i]]) for i in range(self.thread.calls)]

    def set_functs(self, list functs) -> None:
        """Replace the list that is shown; the host replaces the one that is called."""
        cdef Funct funct
        cdef int i
        if len(functs) > MAX_CALLS:
            raise HalError(f"thread '{self.name}' has no room for more than {MAX_CALLS} functions", -12)
        for i in range(self.thread.calls):
            self.segment.at.functs[self.thread.call[i]].users -= 1
        for i, funct in enumerate(functs):
            self.thread.call[i] = <int>(funct.funct - self.segment.at.functs)
            funct.funct.users += 1
        self.thread.calls = len(functs)
