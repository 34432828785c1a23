"""Program flow: O-words, M98 and M99, the files they lead to.

Each level of calls is a Frame with its own labels. A label of a loop or a condition stands in ``Frame.labels`` while the
program is between its first and its last line: ``Label`` says what it is and where a loop goes back to. Going forward
over lines that are not to be run looks at nothing but O-words.
"""

import os

from libc.math cimport fabs, floor
from libc.string cimport strlen

from nml.errors import InterpError
from rs274ngc.block cimport LINE_MAX, LINE_SIZE
from rs274ngc.scan cimport read_integer, read_name, read_value, skip_comments, strip
from rs274ngc.remapping import begin_python_sub
from rs274ngc.source cimport Source
from rs274ngc.state cimport FEATURE_OWORD_N_ARGS, LOCALS, Frame, State, fail

KEYWORDS = (
    "sub", "endsub", "call", "return", "do", "while", "endwhile", "if", "elseif", "else", "endif", "break", "continue",
    "repeat", "endrepeat",
)
WITHOUT_VALUE = frozenset(("sub", "do", "endwhile", "else", "endif", "break", "continue", "endrepeat"))
BY_LENGTH = sorted(KEYWORDS, key=len, reverse=True)
FILE_SUFFIX = ".ngc"


cdef class Label:
    """A loop or a condition that the program is inside of."""

    cdef str kind           # while, do, repeat, if
    cdef long position      # where the loop goes back to
    cdef int line
    cdef long count         # repeat: turns left, this one included
    cdef bint taken         # if: a branch was run
    cdef int defined        # line of its first line

    def __cinit__(self, str kind, int defined, long position=0, int line=0, long count=0, bint taken=False):
        self.kind, self.defined, self.position, self.line, self.count, self.taken = kind, defined, position, line, count, taken


cdef class Flow:
    """Where the program is, and how it gets elsewhere."""

    def __init__(self, State s):
        self.s = s
        self.search_path = []
        self.defined = {}

    # --- Lines

    cdef int read_raw(self) except -2:
        """The next line of the file into the state: its length, -1 at the end of the file."""
        cdef State s = self.s
        cdef int size
        self.line_start = self.source.position
        size = self.source.next_line(s.raw, LINE_SIZE, LINE_MAX)
        s.line = self.source.line
        if size == -1:
            return size         # what the state has is the last line: an error at the end of the file shows it
        s.raw_size = max(size, 0)
        if size == -2:
            s.raw_size = <int>strlen(s.raw)     # the error shows as much of it
            s.size = 0
            return fail(s, "Command too long")
        return size

    cdef int jump(self, long position, int line) except -1:
        self.source.position = position
        self.source.line = line
        return 0

    cdef tuple read_head(self, int* at):
        """Label and keyword of the O-word at ``at``; the keyword is empty for a bare program number."""
        cdef State s = self.s
        cdef int number, start = at[0]
        cdef char c
        at[0] += 1
        c = s.text[at[0]]
        if c == c'<':
            label = read_name(s, at)
        else:
            read_integer(s, at, &number)
            label = str(number)
        rest = s.text[at[0]:s.size].decode("latin-1")
        for word in BY_LENGTH:
            if rest.startswith(word):
                at[0] += len(word)
                return label, word
        if rest and rest[0] not in "(;":
            fail(s, "Unknown control command in o word" if rest[0].isalpha() else "Unexpected character after O-word", at[0])
        return label, ""

    def skip_to(self, str label, tuple keywords):
        """Go on to the line with this label and one of these keywords; True if there is one, its tail is at ``self.tail``."""
        cdef State s = self.s
        cdef int size, i, number_end, at
        cdef int from_line = s.line
        cdef char c
        while True:
            size = self.read_raw()
            if size == -1:
                return -1
            i = self.o_word_at(size)
            if i < 0:
                continue
            strip(s)
            at = skip_number(s)
            try:
                found, keyword = self.read_head(&at)
            except InterpError:
                if s.text[at] == c'<' or c'0' <= s.text[at] <= c'9':
                    raise
                continue        # a computed label whose parameters are not there yet
            if found == label and keyword in ONCE and keyword not in keywords and "sub" not in keywords:
                self.define(label, keyword, at)
            if keyword == "sub" and "endsub" in keywords:
                fail(s, "Nested subroutine definition", at)
            if found == label and keyword in keywords:
                return at, keyword

    cdef int o_word_at(self, int size) noexcept:
        """Where the raw line has its O-word, -1 if it has none."""
        cdef State s = self.s
        cdef int i = 0
        cdef bint number = False
        cdef char c
        while i < size:
            c = s.raw[i]
            if c == c'o' or c == c'O':
                return i
            if c == c'n' or c == c'N':
                number = True
            elif not (c == c' ' or c == c'\t' or c == c'/' or (number and (c'0' <= c <= c'9' or c == c'.'))):
                return -1
            i += 1
        return -1

    def must_skip_to(self, str label, tuple keywords):
        """``skip_to``, and an error when there is no such line."""
        cdef int line = self.s.line
        found = self.skip_to(label, keywords)
        if found == -1:
            fail(self.s, f"EOF in file:{self.source.path} seeking o-word: o<{label}> from line: {line}")
        return found

    # --- One O-line

    cdef int o_line(self, int at) except -1:
        """Do what the O-word at ``at`` of the stripped line says."""
        label, keyword = self.read_head(&at)
        if not keyword:
            return self.bare(label, at)
        if self.source is None and keyword != "call":
            return fail(self.s, f"'{keyword}' needs a program", at)
        if keyword in WITHOUT_VALUE:
            self.end_of_line(at)
        ACTIONS[keyword](self, label, at)
        return 0

    cdef int bare(self, str label, int at) except -1:
        """``O1234``: the beginning of a program or of a subprogram that ends with M99."""
        if not self.s.fanuc_subs:
            return fail(self.s, "DISABLE_FANUC_STYLE_SUB disabled in INI file, but found bare O-word", at)
        return 0

    cdef double value(self, int* at, str keyword) except? -1.0e300:
        """The expression after a keyword."""
        cdef double result
        if self.s.text[at[0]] != c'[':
            fail(self.s, f"Left bracket missing after '{keyword}'", at[0])
        read_value(self.s, at, &result)
        return result

    cdef int end_of_line(self, int at) except -1:
        """Nothing but a comment may follow."""
        if skip_comments(self.s, &at):
            fail(self.s, "Unexpected character after O-word", at)
        return 0

    def do_sub(self, str label, int at):
        """A definition that the program runs into: remember it, step over it."""
        cdef State s = self.s
        if len(s.frames) > 1 and s.frame.sub:
            fail(s, "Nested subroutine definition", at)
        self.remember(label, False)
        found = self.skip_to(label, ("endsub",))
        if found == -1:
            fail(s, "File ended with no percent sign or program end")
        try:
            self.read_return(found[0])      # as if it had been called, as in LinuxCNC
        except InterpError as error:
            if not error.message.startswith("Named parameter"):     # it may be one that only a call defines
                raise

    def do_endsub(self, str label, int at):
        self.leave(label, at)

    def do_return(self, str label, int at):
        self.leave(label, at)

    def do_call(self, str label, int at):
        cdef State s = self.s
        cdef int i = at
        cdef double value
        arguments = []
        while s.text[i] == c'[':
            read_value(s, &i, &value)
            arguments.append(value)
            if len(arguments) > ARGUMENTS_MAX:
                fail(s, "Too many subroutine parameters", i)
        self.end_of_line(i)
        if s.plugin is not None and s.plugin.has("oword", label):
            begin_python_sub(s, label, arguments)
        else:
            self.enter(label, arguments)

    def define(self, str label, str keyword, int at):
        """A label of a condition or loop: it may stand at one line of the program or of the subroutine only."""
        cdef State s = self.s
        if self.s.frame.sub == "" and s.frame.source is None and self.source is None:
            return      # typed in: no line of anything
        line = self.defined.setdefault((s.frame.sub, label), s.line)
        if line == s.line:
            return
        block = s.interp.block_text
        if keyword == "if":
            fail(s, f"{s.line}: duplicate O-word label - already defined in line {line}: '{block}'", at)
        fail(s, f"{s.line}: duplicate O-word label: '{block}' - defined in line {line}", at)

    def do_while(self, str label, int at):
        cdef Label known = self.s.frame.labels.get(label)
        cdef Source source = self.source
        cdef int i = at
        cdef double condition
        if known is not None and known.kind == "do":
            condition = self.value(&i, "while")
            if condition != 0.0:
                self.jump(known.position, known.line)
            else:
                del self.s.frame.labels[label]
            return
        self.define(label, "while", at)
        start = self.line_start
        condition = self.value(&i, "while")
        if condition != 0.0:
            self.s.frame.labels[label] = Label("while", self.s.line, start, source.line - 1)
        else:
            self.s.frame.labels.pop(label, None)
            self.must_skip_to(label, ("endwhile",))

    def do_endwhile(self, str label, int at):
        cdef Label known = self.known(label, ("while",), "", at)
        self.jump(known.position, known.line)

    def do_do(self, str label, int at):
        self.defined[self.s.frame.sub, label] = self.s.line
        self.s.frame.labels[label] = Label("do", self.s.line, self.source.position, self.source.line)

    def do_repeat(self, str label, int at):
        cdef int i = at
        cdef double times
        self.define(label, "repeat", at)
        times = self.value(&i, "repeat")
        if times > 2.0e9:
            fail(self.s, "Too many repetitions", at)
        if times < 0.5:
            self.must_skip_to(label, ("endrepeat",))
        else:
            self.s.frame.labels[label] = Label("repeat", self.s.line, self.source.position, self.source.line, <long>floor(times + 0.5))

    def do_endrepeat(self, str label, int at):
        cdef Label known = self.known(label, ("repeat",), "", at)
        known.count -= 1
        if known.count > 0:
            self.jump(known.position, known.line)
        else:
            del self.s.frame.labels[label]

    def do_break(self, str label, int at):
        cdef Label known = self.known(label, ("while", "do"), "while/do ", at)
        self.must_skip_to(label, LOOP_END[known.kind])
        del self.s.frame.labels[label]

    def do_continue(self, str label, int at):
        cdef Label known = self.known(label, ("while", "do"), "while/do ", at)
        if known.kind == "while":
            self.jump(known.position, known.line)
        else:
            i, keyword = self.must_skip_to(label, LOOP_END[known.kind])
            ACTIONS[keyword](self, label, i)

    def do_if(self, str label, int at):
        cdef int i = at
        cdef bint taken
        self.define(label, "if", at)
        taken = self.value(&i, "if") != 0.0
        self.s.frame.labels[label] = Label("if", self.s.line, taken=taken)
        if not taken:
            self.next_branch(label)

    def next_branch(self, str label):
        """Go to the next branch of a condition, and decide there."""
        at, keyword = self.must_skip_to(label, ("elseif", "else", "endif"))
        self.branch(label, at, keyword)

    def branch(self, str label, int at, str keyword):
        cdef Label known = self.known(label, ("if",), "'if' ", at)
        cdef int i = at
        while True:
            if keyword == "endif":
                del self.s.frame.labels[label]
                return
            if not known.taken and (keyword == "else" or self.value(&i, "elseif") != 0.0):
                known.taken = True
                return
            at, keyword = self.must_skip_to(label, ("elseif", "else", "endif"))
            i = at

    def do_elseif(self, str label, int at):
        self.branch(label, at, "elseif")

    def do_else(self, str label, int at):
        self.branch(label, at, "else")

    def do_endif(self, str label, int at):
        self.branch(label, at, "endif")

    def known(self, str label, tuple kinds, str name, int at):
        cdef Label found = self.s.frame.labels.get(label)
        line, block = self.s.line, self.s.interp.block_text
        if found is None:
            fail(self.s, f"{line}: undefined O-word label: '{block}'", at)
        if found.kind not in kinds:
            fail(self.s, f"{line}: no matching {name}label: '{block}' (found '{found.kind}' in line {found.defined})", at)
        return found

    # --- Calls

    def enter(self, str label, list arguments, bint fanuc=False, long repeats=1):
        """Call a subroutine: of this file, or of a file of its name."""
        cdef State s = self.s
        cdef Frame frame, caller = s.frame
        cdef int k
        if len(s.frames) >= LEVELS_MAX:
            fail(s, "Too many subroutine levels")
        caller.source = self.source
        if self.source is not None:
            caller.position, caller.line = self.source.position, self.source.line
        self.find(label, fanuc)
        frame = Frame()
        frame.sub = label
        frame.fanuc = fanuc
        frame.file = self.source.path
        frame.repeats = repeats
        frame.body, frame.body_line = self.source.position, self.source.line
        if not fanuc:
            for k in range(1, LOCALS + 1):
                caller.locals[k] = s.params[k]
                if k <= len(arguments):
                    s.params[k] = arguments[k - 1]
                else:
                    s.params[k] = 0.0
        if s.features & FEATURE_OWORD_N_ARGS:
            frame.named["n_args"] = float(len(arguments))
        s.frames.append(frame)
        s.frame = frame

    def find(self, str label, bint fanuc):
        """Be at the first line of a subroutine's body."""
        cdef State s = self.s
        cdef Source source
        if self.known_place(label, fanuc):
            return
        from_line = s.line
        source = self.source
        if source is not None and self.find_here(label, fanuc):
            return
        path = self.sub_file(label)
        if path is None:
            self.source = s.frame.source
            if self.source is not None:
                self.jump(s.frame.position, s.frame.line)
                s.line = from_line
                fail(s, f"EOF in file:{self.source.path} seeking o-word: o<{label}> from line: {from_line}")
            fail(s, f"Unable to open file <{label}{FILE_SUFFIX}>")
        self.source = Source(path)
        if not self.find_here(label, fanuc):
            fail(s, f"EOF in file:{path} seeking o-word: o<{label}> from line: {from_line}")

    def remember(self, str label, bint numbered):
        """This is where the body of a subroutine begins, as long as its file stays as it is."""
        cdef Source source = self.source
        self.s.subs[label] = (source.path, source.version, source.position, source.line, numbered)

    def known_place(self, str label, bint fanuc):
        """Go where a subroutine was found before; False if it never was, or if its file has been edited since."""
        cdef State s = self.s
        cdef Source source = self.source
        known = s.subs.get(label)
        if known is None:
            return False
        path, version, position, line, numbered = known
        if source is None or source.path != path:
            if not os.path.isfile(path):
                del s.subs[label]
                return False
            source = Source(path)
        if source.version != version:
            del s.subs[label]
            return False
        if fanuc and not numbered:
            return False        # the search will say so, at its line
        self.source = source
        self.jump(position, line)
        return True

    def find_here(self, str label, bint fanuc):
        """Look for a subroutine from here to the end of the file, then from its beginning."""
        cdef State s = self.s
        for start in (None, 0):
            if start is not None:
                self.jump(0, 0)
            found = self.skip_to(label, ("sub", ""))
            if found != -1:
                if fanuc and found[1]:
                    fail(s, "'O.... sub' subroutine must be called with 'O.... call'")
                if not fanuc and not found[1]:
                    fail(s, "Fanuc 'O....' subroutine must be called with 'M98'")
                self.remember(label, fanuc)
                return True
        return False

    def sub_file(self, str label):
        """Path of a subroutine file, None if there is none."""
        for folder in self.search_path:
            path = os.path.join(folder, label + FILE_SUFFIX)
            if os.path.isfile(path):
                return path
        return None

    def leave(self, str label, int at):
        """endsub and return"""
        cdef State s = self.s
        if s.frame.fanuc:
            fail(s, "Fanuc 'O....' subroutine definition must end with 'M99'", at)
        if not s.frame.sub:
            fail(s, f"{s.line}: not in a subroutine definition: '{s.interp.block_text}'", at)
        self.read_return(at)
        if s.frame.remap is not None:       # its epilog is still to see this level
            s.resume = s.frame.remap
            s.frame.remap = None
        else:
            self.pop()

    def read_return(self, int at):
        """The value behind endsub or return, which stays until the next of them."""
        cdef State s = self.s
        cdef double value = 0.0
        cdef bint given = s.text[at] == c'['
        if given:
            read_value(s, &at, &value)
        self.end_of_line(at)
        s.return_value, s.value_returned = value, given

    def pop(self):
        """Back to the caller."""
        cdef State s = self.s
        cdef Frame done = s.frames.pop(), caller
        cdef int k
        caller = s.frames[len(s.frames) - 1]
        s.frame = caller
        self.source = caller.source
        if self.source is not None:
            self.jump(caller.position, caller.line)
        elif len(s.frames) == 1:
            self.defined.clear()        # typed in: the file may be another by the next call
        if not done.fanuc:
            for k in range(1, LOCALS + 1):
                s.params[k] = caller.locals[k]
        if done.restore:
            s.interp.restore_context(done.saved)

    def unwind(self):
        """After an error or an abort: back to the line after the outermost call."""
        self.s.resume = None
        self.s.remap_stack.clear()
        while len(self.s.frames) > 1:
            self.s.frame.restore = False
            self.pop()

    def end_subprogram(self):
        """M99: the caller, or the next of its repetitions, goes on; in the main program its first line.

        False: it ends the main program, for this interpreter does not repeat programs.
        """
        cdef State s = self.s
        if s.frame.sub and not s.frame.fanuc:
            fail(s, "'O.... endsub' or 'O.... return' must follow 'O.... sub' subroutine definition")
        if not s.frame.sub:
            if self.source is not None:
                if not s.interp.repeats_main:
                    return False
                self.jump(0, 0)
                s.frame.labels.clear()
            return True
        s.frame.repeats -= 1
        if s.frame.repeats > 0:
            s.frame.labels.clear()
            self.jump(s.frame.body, s.frame.body_line)
        else:
            self.pop()
            s.return_value, s.value_returned = 0.0, False
        return True


ONCE = ("if", "while", "repeat")
"""O-words whose label is defined where they stand."""
LOOP_END = {"while": ("endwhile",), "do": ("while",)}
ACTIONS = {word: getattr(Flow, "do_" + word) for word in KEYWORDS}
"""What each O-word does: called with the Flow, the label and the place after the keyword."""


cdef int skip_number(State s) except -1:
    """Where the stripped line goes on after a slash and its line number."""
    cdef int i = 0
    if s.text[i] == c'/':
        i += 1
    if s.text[i] == c'n':
        i += 1
        while c'0' <= s.text[i] <= c'9' or s.text[i] == c'.':
            i += 1
    return i
