"""The realtime host's inside: modules, functions and threads of this process, on behalf of ``hal.host``.

Realtime modules (``hal.components``, motmod, kinematics, Python components) make a `Component` with a `Host`:

    def load(host: Host, args: dict[str, str]) -> None:
        comp = host.component("mine")
        pin = comp.pin("mine.in", HAL_FLOAT, HAL_IN)
        comp.function("mine", function_address, argument_address)
        comp.ready()
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from functools import partial
from typing import Any

from hal import _shm
from hal._calls import PythonCall
from hal._records import Comp, Funct, Item
from hal._shm import BIT, IN, IO, OUT, PORT, REALTIME, RO, RW, S32, THREAD_COMP
from hal._threads import NativeThread, Scheduler, lock_memory
from hal.components import find as find_component
from hal.core import LOCK_CONFIG, LOCK_LOAD, Hal
from hal.finder import name_of, native_library, realtime_module
from nml import clock
from nml.errors import HalError

REALTIME_VARIABLE = "PYEMC_REALTIME"  # 0: ordinary threads even where realtime priority is allowed
LATENCY_FILE = "/dev/cpu_dma_latency"
TOP_PRIORITY = 90  # of the fastest thread; slower ones follow below
NOTES_KEPT = 100  # of those that nobody has asked for
HAL_BIT, HAL_FLOAT, HAL_S32, HAL_U32 = _shm.BIT, _shm.FLOAT, _shm.S32, _shm.U32
HAL_S64, HAL_U64, HAL_PORT = _shm.S64, _shm.U64, _shm.PORT
HAL_IN, HAL_OUT, HAL_IO, HAL_RO, HAL_RW = IN, OUT, IO, RO, RW


class Component:
    """A realtime component in this process: makes its pins, parameters and functions."""

    def __init__(self, host: Host, record: Comp) -> None:
        self.host = host
        self.record = record
        self.name = record.name
        self._kept: list[Any] = []
        self._on_unload: list[Callable[[], None]] = []

    def pin(self, name: str, type_: int, direction: int, value: Any = 0) -> Item:
        """A pin; its ``address`` is the ``hal_pin`` of native code."""
        pin = self.host.hal.add_pin(self.record, name, type_, direction)
        if type_ != PORT:
            pin.set(value)
        return pin

    def param(self, name: str, type_: int, direction: int, value: Any = 0) -> Item:
        """A parameter; native code reads and writes it as it does a pin."""
        param = self.host.hal.add_param(self.record, name, type_, direction)
        param.set(value)
        return param

    def function(self, name: str, code: int, arg: int = 0, *, uses_fp: bool = True, reentrant: bool = False) -> Funct:
        """Export native code (``hal_function``) with its time pin and tmax parameters, in ns."""
        return self.host.export(self, name, code, arg, uses_fp, reentrant)

    def python_function(self, name: str, function: Callable[[int], object]) -> Funct:
        """Export a Python function of the period in ns. It is stopped, and says so, at its first exception."""
        call = PythonCall(function, lambda error: self._report(name, error))
        self.keep(call)
        return self.function(name, call.code, call.arg)

    def _report(self, name: str, error: BaseException) -> None:
        text = "".join(traceback.format_exception(error))
        print(text, file=sys.stderr, flush=True)
        self.host.note(f"HAL: function '{name}' raised {type(error).__name__}: {error}; it is not called again")

    def keep(self, thing: Any) -> None:
        """Hold a reference until the component is unloaded."""
        self._kept.append(thing)

    def on_unload(self, action: Callable[[], None]) -> None:
        """Call this when the component goes, after its functions have left their threads; the last one first."""
        self._on_unload.append(action)

    def ready(self) -> None:
        self.record.ready = True

    def close(self) -> None:
        for action in reversed(self._on_unload):
            action()


class HostThread:
    """A HAL thread with the scheduler that runs it and the component that stands for it."""

    def __init__(self, native: NativeThread, scheduler: Scheduler, comp: Component, owner: Component | None) -> None:
        self.native, self.scheduler, self.comp, self.owner = native, scheduler, comp, owner


class Host:
    """All realtime things of this process. One object, used by one Python thread."""

    def __init__(self) -> None:
        self.hal = Hal()
        self.notes: list[str] = []  # lines for whoever asked next
        self._components: dict[str, list[Component]] = {}  # by module, in order of loading
        self._threads: dict[str, HostThread] = {}
        self._provided: dict[str, Any] = {}
        self._calls: dict[str, tuple[int, int, int, int, int]] = {}
        self._loading: list[Component] | None = None
        self._never_freed: list[Any] = []
        self._awake: int | None = None
        self._simulated: Scheduler | None = None
        self._realtime = self._try_realtime()

    def note(self, text: str) -> None:
        """For the log (standard error), and for whoever asks next."""
        print(text, file=sys.stderr, flush=True)
        self.notes = [*self.notes, text][-NOTES_KEPT:]

    # ---- what the system allows ----

    @property
    def realtime(self) -> bool:
        """Whether threads have realtime priority."""
        return self._realtime

    def _try_realtime(self) -> bool:
        """Whether threads get realtime priority; one note says what was refused."""
        if os.environ.get(REALTIME_VARIABLE) == "0" or clock.speed() != 1.0:
            return False
        refused = []
        try:
            probe = Scheduler(1.0, TOP_PRIORITY)
            probe.close()
        except HalError:
            refused.append("realtime priority (SCHED_FIFO)")
        if not refused and not lock_memory():
            refused.append("locked memory")
        if refused:
            self.note(f"Note: the system does not allow {' and '.join(refused)}; timing depends on its load")
        if not refused:
            self._awake = stay_awake()
        return "realtime priority (SCHED_FIFO)" not in refused

    def _scheduler(self) -> tuple[Scheduler, int]:
        """A scheduler for the next thread and its priority."""
        if self._realtime:
            priority = max(1, TOP_PRIORITY - len(self._threads))
            return Scheduler(1.0, priority, self._realtime_cpu()), priority
        if self._simulated is None:
            self._simulated = Scheduler(clock.speed())
        return self._simulated, 0

    @staticmethod
    def _realtime_cpu() -> int:
        """The last isolated processor, if the system sets any aside; -1 for any."""
        try:
            with open("/sys/devices/system/cpu/isolated") as file:
                isolated = file.read().strip()
        except OSError:
            return -1
        return int(isolated.replace(",", "-").split("-")[-1]) if isolated else -1

    # ---- modules ----

    def load(self, name: str, words: list[str]) -> None:
        """``loadrt name words...``; whatever was made is taken back when the module refuses."""
        module_name = name_of(name)
        if self.hal.segment.locks & LOCK_LOAD:
            raise HalError("HAL is locked, loading of programs is not permitted", -1)
        if module_name in self._components:
            raise HalError(f"{module_name}: already exists", -17)
        load = self._loader(name)
        self.hal.segment.skip_ids(2)
        self._loading = []
        try:
            load(self, split_arguments(module_name, words))
            unready = [comp.name for comp in self._loading if not comp.record.ready]
            if unready:
                raise HalError(f"component '{unready[0]}' did not become ready")
        except BaseException:
            self._drop(self._loading)
            raise
        finally:
            made, self._loading = self._loading, None
        self._components[module_name] = made
        for comp in made:
            if comp.name == module_name:
                comp.record.args = " ".join(words)

    @staticmethod
    def _loader(name: str) -> Callable[[Host, dict[str, str]], None]:
        """What loads a module; an installed component in C goes before a built-in one of its name."""
        library = native_library(name)
        if library is not None:
            from hal import native

            return partial(native.load, library)
        return find_component(name) or realtime_module(name).load

    def component(self, name: str) -> Component:
        """Register a component in this process; called from a module's ``load``."""
        comp = Component(self, self.hal.add_component(name, REALTIME))
        if self._loading is not None:
            self._loading.append(comp)
        return comp

    def loaded(self) -> list[str]:
        """Modules, in order of loading."""
        return list(self._components)

    def unload(self, name: str) -> None:
        """Unload a module; its functions have left their threads before anything of it goes away."""
        if name not in self._components:
            raise HalError(f"component '{name}' is not loaded{_suggest(name, self._components)}")
        self._drop(self._components.pop(name))

    def _drop(self, components: list[Component]) -> None:
        for comp in reversed(components):
            for name in [n for n, t in self._threads.items() if t.owner is comp or t.comp is comp]:
                self._drop_thread(name)
            mine = {funct.name for funct in self.hal.segment.functs() if funct.owner == comp.record.id}
            if not self._take_out(mine):
                self._never_freed.append(comp)
            comp.close()
            self.hal.remove_component(comp.record)
            for funct in mine:
                self._calls.pop(funct, None)
        self._provided = {k: v for k, v in self._provided.items() if v[0] not in components}

    def _take_out(self, functs: set[str]) -> bool:
        """Remove functions from all threads; False where one of them does not return."""
        fine = True
        for thread in self._threads.values():
            record = thread.native.record
            called = record.functs()
            kept = [funct for funct in called if funct.name not in functs]
            if len(kept) != len(called):
                fine = self._call(thread, kept) and fine
        return fine

    def provide(self, what: str, thing: Any) -> None:
        """Offer something (a kinematics) to the modules loaded later; it goes with the module that is loading."""
        self._provided[what] = (self._loading[-1] if self._loading else None, thing)

    def provided(self) -> list[str]:
        """What can be required now."""
        return list(self._provided)

    def require(self, what: str, default: Any = None) -> Any:
        """What another module provided, else ``default``; HalError where there is neither."""
        _, thing = self._provided.get(what, (None, default))
        if thing is None:
            raise HalError(f"no {what} is loaded; a module that provides it must be loaded before this one")
        return thing

    # ---- functions ----

    def export(self, comp: Component, name: str, code: int, arg: int, uses_fp: bool, reentrant: bool) -> Funct:
        segment = self.hal.segment
        with segment:
            if segment.find_funct(name) is not None:
                raise HalError(f"duplicate function '{name}'")
            time = comp.pin(f"{name}.time", S32, OUT)
            tmax = comp.param(f"{name}.tmax", S32, RW)
            increased = comp.param(f"{name}.tmax-increased", BIT, RO)
            funct = segment.new_funct(name, comp.record.id, code, arg, uses_fp, reentrant)
        self._calls[name] = (code, arg, time.address, tmax.address, increased.address)
        return funct

    def _call(self, thread: HostThread, functs: list[Funct]) -> bool:
        """Make a thread call these functions, in this order."""
        fine = thread.native.set_calls([self._calls[funct.name] for funct in functs])
        with self.hal.segment:
            thread.native.record.set_functs(functs)
        return fine

    def add_function(self, funct_name: str, thread_name: str, position: int = -1) -> None:
        """``addf``: 1 is the first place, -1 the last, -2 the one before it."""
        funct, thread = self._funct(funct_name), self._thread(thread_name)
        self._unlocked()
        if funct.users and not funct.reentrant:
            raise HalError(f"function '{funct_name}' may only be added to one thread")
        functs = thread.native.record.functs()
        place = position - 1 if position > 0 else len(functs) + 1 + position
        if position == 0:
            raise HalError("bad position: 0; 1 is the first place, -1 the last")
        if place > len(functs):
            raise HalError(f"position '{position}' is too high; thread '{thread_name}' has {len(functs)} functions")
        if place < 0:
            raise HalError(f"position '{position}' is too low; thread '{thread_name}' has {len(functs)} functions")
        self._call(thread, [*functs[:place], funct, *functs[place:]])

    def remove_function(self, funct_name: str, thread_name: str) -> None:
        """``delf``; on return the thread is out of the function."""
        funct, thread = self._funct(funct_name), self._thread(thread_name)
        self._unlocked()
        if not funct.users:
            raise HalError(f"function '{funct_name}' is not in use")
        functs = thread.native.record.functs()
        if funct not in functs:
            raise HalError(f"thread '{thread_name}' doesn't use function '{funct_name}'")
        functs.remove(funct)
        self._call(thread, functs)

    def _unlocked(self) -> None:
        if self.hal.segment.locks & LOCK_CONFIG:
            raise HalError("HAL is locked, changing threads is not permitted; 'unlock all' would allow it", -1)

    def _funct(self, name: str) -> Funct:
        funct = self.hal.segment.find_funct(name)
        if funct is None:
            raise HalError(f"function '{name}' not found{_suggest(name, self._calls)}")
        return funct

    def _thread(self, name: str) -> HostThread:
        if name not in self._threads:
            raise HalError(f"thread '{name}' not found{_suggest(name, self._threads)}")
        return self._threads[name]

    # ---- threads ----

    def thread(self, name: str, period_ns: int, uses_fp: bool = True) -> HostThread:
        """A new thread of this period. Faster threads are made before slower ones, and so have higher priority."""
        slowest = max((t.native.record.period_ns for t in self._threads.values()), default=0)
        if name in self._threads:
            raise HalError(f"duplicate thread name '{name}'")
        if period_ns < 1:
            raise HalError(f"thread '{name}': a period of {period_ns} ns is not possible")
        if period_ns < slowest:
            raise HalError(f"thread '{name}' of {period_ns} ns must be made before the slower one of {slowest} ns")
        owner = self._loading[-1] if self._loading else None
        comp = Component(self, self.hal.add_component(f"__{name}", THREAD_COMP))
        segment = self.hal.segment
        with segment:
            record = segment.new_thread(name, comp.record.id, period_ns, uses_fp)
            time = comp.pin(f"{name}.time", S32, OUT)
            tmax = comp.param(f"{name}.tmax", S32, RW)
            beat = comp.pin(f"{name}.threadbeat", S32, OUT)
        comp.ready()
        scheduler, record.priority = self._scheduler()
        native = NativeThread(segment, record, time.address, tmax.address, beat.address)
        scheduler.add(native)
        made = self._threads[name] = HostThread(native, scheduler, comp, owner)
        return made

    def overworked(self) -> list[tuple[str, str]]:
        """Threads whose functions need more processor time than a period has: name, and what is wrong."""
        found = []
        for name, thread in self._threads.items():
            record, needed = thread.native.record, thread.native.overworked_ns
            if needed:
                times = {funct.name: int(self.hal.value(f"{funct.name}.tmax")) for funct in record.functs()}
                longest = max(times, key=lambda funct: times[funct], default="")
                slowest = f", of which '{longest}' took {times[longest]} ns once" if times else ""
                text = f"thread '{name}' cannot keep its period of {record.period_ns} ns: its functions need"
                found.append((name, f"{text} {needed} ns{slowest}"))
        return found

    def _drop_thread(self, name: str) -> None:
        thread = self._threads.pop(name)
        thread.scheduler.remove(thread.native)
        if thread.scheduler is not self._simulated:
            thread.scheduler.close()
        self.hal.remove_component(thread.comp.record)

    def close(self) -> None:
        """Stop the threads and unload everything, the last loaded first."""
        self.hal.halt_threads()
        for name in reversed(self.loaded()):
            self.unload(name)
        if self._simulated is not None:
            self._simulated.close()
        if self._awake is not None:
            os.close(self._awake)
        self.hal.close()


def stay_awake() -> int | None:
    """Keep the processors out of the sleep that they wake from late and with cold caches, while this file is open."""
    try:
        file = os.open(LATENCY_FILE, os.O_WRONLY | os.O_CLOEXEC)
    except OSError:
        return None
    os.write(file, bytes(4))  # the latency allowed: 0 us
    return file


def _suggest(name: str, known: Any) -> str:
    from hal.core import suggest

    return suggest(name, known)


def split_arguments(module: str, words: list[str]) -> dict[str, str]:
    """``["a=1", "b=x,y"]`` as a dictionary; HalError for a word without ``=``."""
    args = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals or not key:
            raise HalError(f"{module}: parameter '{word}' has no value; NAME=VALUE would be right")
        args[key] = value.strip('"')
    return args
