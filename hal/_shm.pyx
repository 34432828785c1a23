"""The tables of the HAL's segment: components, pins, parameters, signals, functions and threads.

`Segment` makes and finds records in the mapped memory (``hal._mapping``); ``hal._records`` has a typed view for each kind,
and the numbers of types and directions. ``hal.core`` keeps the rules.
"""

from libc.stdint cimport int32_t, int64_t, uint32_t, uint64_t
from libc.string cimport memset, strcmp

from hal._mapping cimport (
    MAX_COMPS, MAX_FUNCTS, MAX_PARAMS, MAX_PINS, MAX_SIGNALS, MAX_THREADS, hal_comp, hal_funct, hal_item, hal_signal,
    hal_thread, load_state, point, store_state, word_of,
)
from hal._records cimport (
    Comp, Funct, Item, Signal, Thread, hash_name, set_name, view_comp, view_funct, view_item, view_signal, view_thread,
)

from hal._records import BIT, FLOAT, IN, IO, OUT, PORT, RO, RW, S32, S64, U32, U64, newest_first, record_name, shown_name
from nml.errors import HalError

PIN, PARAM = 0, 1
USER, REALTIME, THREAD_COMP = 0, 1, 2


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
        return view_item(self, item)

    def find_item(self, int kind, str name):
        """The pin or parameter of that name or alias; None where there is none."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        cdef hal_item* found = <hal_item*>self._find(&first[0].head, sizeof(hal_item), used, name)
        if found != NULL:
            return view_item(self, found)
        cdef bytes raw = name.encode()
        cdef uint32_t wanted = hash_name(raw)
        for i in range(used):
            if first[i].alias_hash == wanted and first[i].head.state and strcmp(first[i].alias, raw) == 0:
                return view_item(self, &first[i])
        return None

    def items(self, int kind) -> list:
        """All pins or parameters, sorted by the name that they show."""
        cdef hal_item* first = &self.at.pins[0] if kind == PIN else &self.at.params[0]
        cdef int used = self.at.used_pins if kind == PIN else self.at.used_params
        return sorted([view_item(self, &first[i]) for i in range(used) if load_state(&first[i].head.state)], key=shown_name)

    # signals

    def new_signal(self, str name, int type) -> Signal:
        cdef hal_signal* signal = <hal_signal*>self._slot(
            &self.at.signals[0].head, sizeof(hal_signal), &self.at.used_signals, MAX_SIGNALS, "signal")
        set_name(signal.head.name, &signal.head.hash, name)
        signal.type = type
        self.at.cells[signal - &self.at.signals[0]].k = 0
        store_state(&signal.head.state, 1)
        return view_signal(self, signal)

    def find_signal(self, str name):
        found = <size_t>self._find(&self.at.signals[0].head, sizeof(hal_signal), self.at.used_signals, name)
        return view_signal(self, <hal_signal*><size_t>found) if found else None

    def signals(self) -> list:
        """All signals, sorted by name."""
        return sorted([view_signal(self, &self.at.signals[i]) for i in range(self.at.used_signals)
                       if load_state(&self.at.signals[i].head.state)], key=record_name)

    # components

    def new_comp(self, str name, int kind, int pid, uint64_t start) -> Comp:
        cdef hal_comp* comp = <hal_comp*>self._slot(
            &self.at.comps[0].head, sizeof(hal_comp), &self.at.used_comps, MAX_COMPS, "component")
        set_name(comp.head.name, &comp.head.hash, name)
        comp.id, comp.kind, comp.pid, comp.start = self.new_id(), kind, pid, start
        store_state(&comp.head.state, 1)
        return view_comp(self, comp)

    def find_comp(self, str name):
        found = <size_t>self._find(&self.at.comps[0].head, sizeof(hal_comp), self.at.used_comps, name)
        return view_comp(self, <hal_comp*><size_t>found) if found else None

    def comps(self) -> list:
        """All components, newest first."""
        return sorted([view_comp(self, &self.at.comps[i]) for i in range(self.at.used_comps)
                       if load_state(&self.at.comps[i].head.state)], key=newest_first)

    # functions

    def new_funct(self, str name, int owner, uint64_t code, uint64_t arg, bint uses_fp, bint reentrant) -> Funct:
        cdef hal_funct* funct = <hal_funct*>self._slot(
            &self.at.functs[0].head, sizeof(hal_funct), &self.at.used_functs, MAX_FUNCTS, "function")
        set_name(funct.head.name, &funct.head.hash, name)
        funct.owner, funct.code, funct.arg, funct.uses_fp, funct.reentrant = owner, code, arg, uses_fp, reentrant
        store_state(&funct.head.state, 1)
        return view_funct(self, funct)

    def find_funct(self, str name):
        found = <size_t>self._find(&self.at.functs[0].head, sizeof(hal_funct), self.at.used_functs, name)
        return view_funct(self, <hal_funct*><size_t>found) if found else None

    def functs(self) -> list:
        """All functions, sorted by name."""
        return sorted([view_funct(self, &self.at.functs[i]) for i in range(self.at.used_functs)
                       if load_state(&self.at.functs[i].head.state)], key=record_name)

    # threads

    def new_thread(self, str name, int owner, int64_t period_ns, bint uses_fp) -> Thread:
        cdef hal_thread* thread = <hal_thread*>self._slot(
            &self.at.threads[0].head, sizeof(hal_thread), &self.at.used_threads, MAX_THREADS, "thread")
        set_name(thread.head.name, &thread.head.hash, name)
        thread.owner, thread.period_ns, thread.uses_fp = owner, period_ns, uses_fp
        store_state(&thread.head.state, 1)
        return view_thread(self, thread)

    def find_thread(self, str name):
        found = <size_t>self._find(&self.at.threads[0].head, sizeof(hal_thread), self.at.used_threads, name)
        return view_thread(self, <hal_thread*><size_t>found) if found else None

    def threads(self) -> list:
        """All threads, in the order in which they were made."""
        return [view_thread(self, &self.at.threads[i]) for i in range(self.at.used_threads)
                if load_state(&self.at.threads[i].head.state)]
