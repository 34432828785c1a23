"""Comments that act: MSG, DEBUG, PRINT, LOG, LOGOPEN, LOGAPPEND, LOGCLOSE, PROBEOPEN, PROBECLOSE, ABORT, PYRUN, PYRELOAD.

Only the last comment of a line counts; those that do not act are shown. In DEBUG, PRINT, LOG and ABORT, ``#123`` and
``#<name>`` are replaced by their values, in the format that ``%d``, ``%f`` (4 decimals) or ``%.nf`` set for the rest of the
text. ``;py,STATEMENT`` is a line of its own. The Python ones need a plug-in: without [PYTHON]TOPLEVEL a program runs no Python.
"""

import re

from rs274ngc.block cimport *
from rs274ngc.params cimport get_named, get_numbered, named_exists
from rs274ngc.state cimport PARAMETERS, State, fail

DEBUG_PARAMETER = 5599      # 0: DEBUG is silent

ACTIVE = re.compile(
    r"[ \t]*(?:(msg|debug|print|log|logopen|logappend|logclose|probeopen|probeclose)(?:,|(?=[ )])|$)|(abort|pyrun),|(pyreload)$)(.*)",
    re.I | re.S,
)
STATEMENT = "py,"
SHOWN_MIN = 1e-4    # smaller numbers are shown as 0, as LinuxCNC's are
DIGITS_MAX = 30     # a number this long is not shown
FIELD = re.compile(r"#<([^>]*)>|#(\d+)|%(d|f|\.\df)")


def expand(State s, str text):
    """``text`` with parameters replaced by their values; one that does not exist, or is too long, shows as ``######``."""
    decimals = "6"

    def field(match):
        nonlocal decimals
        cdef double numbered = 0.0
        name, number, style = match.groups()
        if style:
            decimals = "0" if style == "d" else "4" if style == "f" else style[1]
            return ""
        if name is not None:
            name = "".join(name.split()).lower()
            if not named_exists(s, name):
                return "######"
            value = get_named(s, name, -1)
        else:
            if not 0 < int(number) < PARAMETERS:
                return "######"
            get_numbered(s, int(number), &numbered, -1)
            value = numbered
        shown = f"{value if abs(value) >= SHOWN_MIN else 0.0:.{decimals}f}"
        return shown if len(shown) < DIGITS_MAX else "######"

    return FIELD.sub(field, text)


def show_debug(State s, str text):
    """DEBUG"""
    if s.params[5599] != 0.0:
        s.canon.message(expand(s, text))


def abort(State s, str text):
    """ABORT: the program is wrong, and says why."""
    fail(s, expand(s, text) or "aborted by the program")


def run_python_file(State s, str text):
    """PYRUN"""
    if s.plugin is not None:
        s.plugin.run_file(text.strip())


def reload_python(State s, str text):
    """PYRELOAD"""
    if s.plugin is not None:
        s.plugin.reload()


ACTIONS = {
    "abort": abort,
    "pyrun": run_python_file,
    "pyreload": reload_python,
    "msg": lambda s, text: s.canon.message(text),
    "debug": show_debug,
    "print": lambda s, text: s.canon.print_text(expand(s, text)),
    "log": lambda s, text: s.canon.log(expand(s, text)),
    "logopen": lambda s, text: s.canon.logopen(text.strip()),
    "logappend": lambda s, text: s.canon.logappend(text.strip()),
    "logclose": lambda s, text: s.canon.logclose(),
    "probeopen": lambda s, text: s.canon.probeopen(text.strip()),
    "probeclose": lambda s, text: s.canon.probeclose(),
}
"""What each active comment does with the text after it."""


cdef int act_on_comment(State s, Block* b) except -1:
    """Do what the last comment of the line says, or show it."""
    cdef str text = (<bytes>s.text[b.comment:b.comment + b.comment_size]).decode("utf-8", "replace")
    if s.text[b.comment - 1] == c';':
        if s.plugin is not None:
            s.plugin.run_statement(text[len(STATEMENT):])
        return 0
    match = ACTIVE.match(text)
    word = next(filter(None, match.groups()[:3])).lower() if match is not None else ""
    if match is None or word.startswith("probe"):
        s.canon.comment(text.lstrip(" \t"))
    if match is not None:
        ACTIONS[word](s, match.group(4))
    return 0
