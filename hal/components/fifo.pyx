"""``sampler``, ``streamer`` and ``scope``: HAL pins to a queue in shared memory and back, every period.

The other ends are ``halsampler``, ``halstreamer`` (``hal.sampling``) and ``hal.capture``.
"""

from libc.stdint cimport int32_t, uint8_t

from hal.cell cimport hal_at as at, hal_cell, hal_pin
from hal.stream cimport (
    MAX_COLUMNS, Stream, fifo_depth, fifo_next, fifo_publish, fifo_release, fifo_room, hal_fifo,
)

from hal._calls import Memory
from hal._shm import BIT, IN, IO, OUT, S32
from hal.stream import LETTERS, TYPE_LETTERS, check_types
from nml.errors import HalError

DEFAULT_DEPTH = 100
MAX_CHANNELS = 8


cdef struct Sampler:
    hal_fifo* fifo
    hal_pin full, enable, curr_depth, overruns, sample_num
    hal_pin pins[MAX_COLUMNS]


cdef void sample(Sampler* s, long period) noexcept nogil:
    cdef hal_cell* cell
    cdef unsigned int i
    if not at(s.enable).b:
        return
    s.fifo.attempts = at(s.sample_num).u
    cell = fifo_room(s.fifo)
    at(s.sample_num).u = <int32_t>s.fifo.attempts
    at(s.full).b = cell == NULL
    if cell == NULL:
        at(s.overruns).s += 1
    else:
        for i in range(s.fifo.columns):
            cell[i] = at(s.pins[i])[0]
        fifo_publish(s.fifo)
    at(s.curr_depth).s = fifo_depth(s.fifo)


cdef struct Streamer:
    hal_fifo* fifo
    hal_pin empty, enable, curr_depth, underruns, clock, clock_mode
    hal_pin pins[MAX_COLUMNS]
    uint8_t old_clock


cdef bint clocked(Streamer* s) noexcept nogil:
    """Whether this period takes a sample: every one, or at the edges that clock-mode chooses."""
    cdef uint8_t now = at(s.clock).b, before = s.old_clock
    cdef int mode = at(s.clock_mode).s
    s.old_clock = now
    if mode == 1:
        return before and not now
    if mode == 2:
        return now and not before
    return mode != 3 or now != before


cdef void stream(Streamer* s, long period) noexcept nogil:
    cdef hal_cell* cell
    cdef unsigned int i
    cdef bint due = clocked(s)
    if not at(s.enable).b or not due:
        return
    cell = fifo_next(s.fifo)
    at(s.empty).b = cell == NULL
    if cell == NULL:
        at(s.underruns).s += 1
    else:
        for i in range(s.fifo.columns):
            at(s.pins[i])[0] = cell[i + 1]
        fifo_release(s.fifo)
    at(s.curr_depth).s = fifo_depth(s.fifo)


def channels(str name, dict args) -> list:
    """[(column types, depth)] of ``cfg=`` and ``depth=``."""
    unknown = sorted(set(args) - {"cfg", "depth"})
    if unknown:
        raise HalError(f"{name}: unknown parameter '{unknown[0]}'; cfg and depth are known")
    configs = [check_types(text) for text in args.get("cfg", "").split(",") if text]
    if not configs:
        raise HalError(f"{name}: cfg= is required: a letter for each pin, f b s u l k, with commas between channels")
    if len(configs) > MAX_CHANNELS:
        raise HalError(f"{name}: {len(configs)} channels; up to {MAX_CHANNELS} are possible")
    depths = args.get("depth", "").split(",")
    try:
        numbers = [int(text, 0) for text in depths if text]
    except ValueError:
        raise HalError(f"{name}: depth={args['depth']}: whole numbers would be right") from None
    numbers += [DEFAULT_DEPTH] * (len(configs) - len(numbers))
    if min(numbers) < 1:
        raise HalError(f"{name}: depth={args['depth']}: at least 1 would be right")
    return list(zip(configs, numbers))


cdef void put_columns(comp, hal_pin* pins, str prefix, str types, int direction):
    cdef size_t address
    for i, letter in enumerate(types):
        address = comp.pin(f"{prefix}.pin.{i}", TYPE_LETTERS[letter], direction).address
        pins[i] = <hal_pin>address


cdef hal_pin pin_of(comp, str name, int type_, int direction, value = 0):
    cdef size_t address = comp.pin(name, type_, direction, value).address
    return <hal_pin>address


def load_sampler(host, dict args):
    """Queue pins every period for `halsampler`. `cfg=ffb,s` makes a channel of two floats and a bit and one of an s32, on
    pins `sampler.N.pin.M`; letters are f b s u l (s64) k (u64). `depth=` samples each. Function `sampler.N`; pins
    `sampler.N.enable`, `.full`, `.curr-depth`, `.overruns` and `.sample-num`.
    """
    comp = host.component("sampler")
    cdef Sampler* s
    cdef Stream fifo
    cdef size_t address
    for i, (types, depth) in enumerate(channels("sampler", args)):
        fifo, memory, name = Stream(f"sampler.{i}", depth, types), Memory(sizeof(Sampler)), f"sampler.{i}"
        comp.keep(memory)
        comp.on_unload(fifo.close)
        address = memory.address
        s = <Sampler*>address
        s.fifo = fifo.fifo
        put_columns(comp, s.pins, name, types, IN)
        s.full = pin_of(comp, f"{name}.full", BIT, OUT)
        s.enable = pin_of(comp, f"{name}.enable", BIT, IN, True)
        s.curr_depth = pin_of(comp, f"{name}.curr-depth", S32, OUT)
        s.overruns = pin_of(comp, f"{name}.overruns", S32, IO)
        s.sample_num = pin_of(comp, f"{name}.sample-num", S32, IO)
        comp.function(name, <size_t>&sample, address, uses_fp="f" in types)
    comp.ready()


def load_streamer(host, dict args):
    """Put samples of `halstreamer` on pins `streamer.N.pin.M`, one each period or, by `streamer.N.clock-mode`, at edges of
    `streamer.N.clock` (1 falling, 2 rising, 3 both). `cfg=` and `depth=` as for sampler. Function `streamer.N`; pins
    `streamer.N.enable`, `.empty`, `.curr-depth` and `.underruns`.
    """
    comp = host.component("streamer")
    cdef Streamer* s
    cdef Stream fifo
    cdef size_t address
    for i, (types, depth) in enumerate(channels("streamer", args)):
        fifo, memory, name = Stream(f"streamer.{i}", depth, types), Memory(sizeof(Streamer)), f"streamer.{i}"
        comp.keep(memory)
        comp.on_unload(fifo.close)
        address = memory.address
        s = <Streamer*>address
        s.fifo = fifo.fifo
        put_columns(comp, s.pins, name, types, OUT)
        s.empty = pin_of(comp, f"{name}.empty", BIT, OUT, True)
        s.enable = pin_of(comp, f"{name}.enable", BIT, IN, True)
        s.curr_depth = pin_of(comp, f"{name}.curr-depth", S32, OUT)
        s.underruns = pin_of(comp, f"{name}.underruns", S32, IO)
        s.clock = pin_of(comp, f"{name}.clock", BIT, IN)
        s.clock_mode = pin_of(comp, f"{name}.clock-mode", S32, IN)
        comp.function(name, <size_t>&stream, address, uses_fp="f" in types)
    comp.ready()


cdef struct Scope:
    hal_fifo* fifo
    hal_pin pins[MAX_COLUMNS]


cdef void look(Scope* s, long period) noexcept nogil:
    cdef hal_cell* cell = fifo_room(s.fifo)
    cdef unsigned int i
    if cell != NULL:
        for i in range(s.fifo.columns):
            cell[i] = at(s.pins[i])[0]
        fifo_publish(s.fifo)


def load_scope(host, dict args):
    """Queue pins and parameters of other components as they are, for `halscope`: `pins=name,...` and `depth=`. Function
    `scope.capture`.
    """
    comp = host.component("scope")
    items = [host.hal.item(name)[1] for name in args.get("pins", "").split(",") if name]
    if not 1 <= len(items) <= MAX_COLUMNS:
        raise HalError(f"scope: pins= is required, 1 to {MAX_COLUMNS} names")
    types = "".join(LETTERS[item.type] for item in items)
    cdef Stream fifo = Stream("scope", int(args.get("depth", "10000")), types)
    cdef size_t address
    comp.on_unload(fifo.close)
    memory = Memory(sizeof(Scope))
    comp.keep(memory)
    address = memory.address
    cdef Scope* s = <Scope*>address
    s.fifo = fifo.fifo
    for i, item in enumerate(items):
        address = item.address
        s.pins[i] = <hal_pin>address
    comp.function("scope.capture", <size_t>&look, <size_t>s)
    comp.ready()
