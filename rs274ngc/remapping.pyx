"""Remapped codes: a line stops at the place of the code in the order of execution, and goes on when the code was done.

``take_over`` looks at each step of a line. Where its code is remapped, the line becomes a Pending with a generator of
what is to be done: Python functions, an NGC procedure between them. The interpreter drives it: ``s.resume`` is the Pending
whose generator is to go on; ``s.remap_stack`` has all that are under way. A code that its own procedure uses again is the
built-in one, where there is one.
"""

from libc.string cimport memcpy, memset

from nml.errors import InterpError
from rs274ngc.block cimport *
from rs274ngc.modal cimport STEP_FEED, STEP_MOTION, STEP_SPEED, STEP_TOOL, g_code, m_code, step_m
from rs274ngc.state cimport FINISH, OK, Frame, State, fail

BODY = -1               # a generator yields it to have the procedure's lines run
LEVELS_MAX = 10         # remapped codes inside one another

LETTERS = {letter: ord(letter) - ord("a") for letter in "abcdefhijklmnpqrstuvwxyz"}


cdef class Pending:
    """A line that waits while its remapped code is done."""


cdef str key_at(Block* b, int step):
    """The key of the code that a step would execute, empty for one that cannot be remapped."""
    if step == STEP_MOTION:
        return f"G{b.motion}"
    if step_m[step] >= 0:
        return f"M{b.m[step_m[step]]}"
    if step == STEP_FEED:
        return "F0"
    if step == STEP_SPEED:
        return "S0"
    return "T0" if step == STEP_TOOL else ""


cdef bint has_builtin(remap):
    """Does the interpreter know the code itself?"""
    cdef int number = remap.number
    if remap.letter == "G":
        return g_code[number].run != NULL
    if remap.letter == "M":
        return number < 200 and m_code[number].run != NULL
    return True


cdef int take_over(State s, Block* b, int step) except -1:
    """1: the code of this step is remapped, and the line waits for it; the steps after it are left in ``b.steps``."""
    cdef Pending pending
    remap = s.remaps.get(key_at(b, step))
    if remap is None:
        return 0
    for pending in s.remap_stack:
        if pending.remap is remap and has_builtin(remap):
            pending.builtin_used = True
            return 0
    if len(s.remap_stack) >= LEVELS_MAX - 1:
        return fail(s, "maximum nesting of remapped blocks exceeded")
    words = words_for(s, b, remap)
    b.steps &= ~((2ULL << step) - 1)
    pending = open_pending(s, b, remap, words)
    pending.steps = perform(s, pending)
    s.resume = pending
    return 1


cdef object open_pending(State s, Block* b, remap, dict words):
    """Put a line aside."""
    cdef Pending pending = Pending()
    pending.block = b[0]
    pending.raw = s.raw[:s.raw_size]
    pending.line = s.line
    pending.remap = remap
    pending.words = words
    pending.sub, pending.arguments = "", []
    s.remap_stack.append(pending)
    return pending


cdef dict words_for(State s, Block* b, remap):
    """What the argspec takes from the line, by letter in its order; an error where something is missing."""
    cdef int word
    words = {}
    missing = []
    conditions = ""
    if remap.argspec and ">" in remap.argspec and s.feed <= 0.0:
        conditions += "F>0,"
    if remap.argspec and "^" in remap.argspec and s.speed[0] <= 0.0:
        conditions += "S>0,"
    for letter in remap.argspec or "":
        if letter in "@^>":
            continue
        if letter in "nN":
            words["n"] = float(s.line)
        else:
            word = LETTERS[letter.lower()]
            if has(b, word):
                words[letter.lower()] = b.value[word]
            elif letter.isupper():
                missing.append(letter)
            elif remap.positional:
                words[letter] = 0.0
    if missing or conditions:
        show_call(s, remap)
        fail(s, f"user-defined {remap.name}:" + (f" missing: {','.join(missing)}" if missing else "") + conditions)
    return words


cdef int show_call(State s, remap) except -1:
    """Have an error show the call of a remapped code's procedure or function, as LinuxCNC's does, in place of the line."""
    cdef bytes text = f"O <{remap.python or remap.ngc}> call ".encode()
    s.raw_size = <int>len(text)
    memcpy(s.raw, <const char*>text, s.raw_size + 1)
    s.error_at = -1
    return 0


def call(State s, str function, Pending pending):
    """The function or prolog of a remapped code."""
    try:
        yield from s.plugin.steps("remap", function, (), pending.words)
    except InterpError:
        show_call(s, pending.remap)
        raise


def perform(State s, Pending pending):
    """Do a remapped code: yields FINISH where the machine has to come to rest, BODY where the procedure is to run."""
    remap = pending.remap
    cdef Frame frame
    if remap.python is not None:
        yield from call(s, remap.python, pending)
        return
    s.interp.flow.enter(remap.ngc, list(pending.words.values()) if remap.positional else [])
    frame = s.frame
    frame.remap = pending
    if not remap.positional:
        frame.named.update(pending.words)
    if remap.prolog is not None:
        yield from call(s, remap.prolog, pending)
    yield BODY
    if remap.epilog is not None:
        yield from s.plugin.steps("remap", remap.epilog, (), pending.words)
    s.interp.flow.pop()


def begin_python_sub(State s, str name, list arguments):
    """``O<name> call`` of a function in the oword module of the Python plug-in."""
    cdef Block b
    cdef Pending pending
    memset(&b, 0, sizeof(b))
    pending = open_pending(s, &b, None, {})
    pending.sub, pending.arguments = name, arguments
    pending.scope = Frame()
    pending.scope.sub, pending.scope.file = name, s.frame.file
    s.return_value, s.value_returned = 0.0, False
    pending.steps = s.plugin.steps("oword", name, arguments, {})
    s.resume = pending


def go_on(State s):
    """Let the generator of ``s.resume`` go on: FINISH, or OK; when it is done, the line's rest is the state's block again."""
    cdef Pending pending = s.resume
    s.resume = None
    s.block.steps = 0
    what = next_step(s, pending)
    if what == FINISH:
        s.resume = pending
        return FINISH
    if what is None:
        s.remap_stack.remove(pending)
        s.block = pending.block
        s.raw_size = <int>len(pending.raw)
        memcpy(s.raw, <const char*>pending.raw, s.raw_size + 1)
        s.line = pending.line
    return OK


cdef object next_step(State s, Pending pending):
    """What the generator yields next; a Python O-word subroutine runs on a level of its own, like any subroutine."""
    if pending.scope is None:
        return next(pending.steps, None)
    caller = s.frame
    levels = len(s.frames)
    s.frames.append(pending.scope)
    s.frame = pending.scope
    try:
        return next(pending.steps, None)
    finally:
        del s.frames[levels:]
        s.frame = caller


class BlockView:
    """A line as Python remaps see it: ``c.p_flag``, ``c.p_number``, ``c.g_modes`` and the rest of LinuxCNC's names."""

    def __init__(self, values):
        self.__dict__.update(values)


cdef object block_view(State s, Pending pending):
    """The line of a pending code, or the one in work."""
    cdef Block* b = &s.block if pending is None else &pending.block
    cdef int word, k
    values = {}
    for letter, word in LETTERS.items():
        values[f"{letter}_flag"] = has(b, word)
        values[f"{letter}_number"] = b.value[word] if has(b, word) else -1.0
    for letter in "thl":
        word = LETTERS[letter]
        values[f"{letter}_number"] = <int>b.value[word] if has(b, word) else -1
    sub = pending is not None and bool(pending.sub)
    values["g_modes"] = [-1 if sub else b.g[k] for k in range(G_GROUPS)]
    values["m_modes"] = [-1 if sub else b.m[k] for k in range(M_GROUPS)]
    values["o_name"] = pending.sub if sub else ""
    values["params"] = list(pending.arguments) if sub else []
    values["param_cnt"] = len(values["params"])
    values["motion_to_be"] = b.motion
    values["dollar_number"] = b.value[W_DOLLAR] if has(b, W_DOLLAR) else 0.0
    raw = (pending.raw if pending is not None else s.raw[:s.raw_size]).decode("utf-8", "replace")
    start, end = raw.rfind("("), raw.rfind(")")
    values["comment"] = raw[start + 1:end] if 0 <= start < end else ""
    values["line_number"] = pending.line if pending is not None else s.line
    values["executing_remap"] = pending.remap if pending is not None else None
    values["builtin_used"] = pending.builtin_used if pending is not None else False
    return BlockView(values)


def remap_level(State s):
    """How many remapped codes are under way inside one another."""
    return sum(1 for pending in s.remap_stack if not pending.sub)


def view(State s, int level):
    """``self.blocks[level]``: 0 is the line in work, 1 the one whose remapped code was begun first.

    While a Python O-word subroutine runs, the line that called it is the one of the present remap level.
    """
    cdef Pending shown = None, innermost = None
    for innermost in s.remap_stack:
        pass
    remaps = [pending for pending in s.remap_stack if not pending.sub]
    if innermost is not None and innermost.sub and level == len(remaps):
        shown = innermost
    elif 0 < level <= len(remaps):
        shown = remaps[level - 1]
    return block_view(s, shown)
