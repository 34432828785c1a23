"""Whatever a line is, the interpreter takes it or refuses it with an InterpError: no third thing."""

import os
from contextlib import suppress

from hypothesis import given, settings
from hypothesis import strategies as st

from nml.errors import InterpError
from rs274ngc.interp import Interpreter
from rs274ngc.offline import OfflineCanon

EXAMPLES = int(os.environ.get("PYEMC_RS274_EXAMPLES", "150"))

PIECES = st.sampled_from((
    "g0", "g1", "g2", "g3", "g4", "g5", "g10", "g17", "g18", "g20", "g28", "g33", "g38.2", "g41.1", "g43", "g53",
    "g55", "g61", "g64", "g76", "g81", "g83", "g91", "g92", "g93", "g96", "m3", "m6", "m66", "m70", "m72", "m98",
    "x", "y", "z", "a", "i", "j", "k", "l", "p", "q", "r", "d", "e", "f", "s", "t", "h", "$", "@", "^", "#", "[",
    "]", "<", ">", "=", "/", "*", "**", "mod", "sin", "atan", "exists", "(", ")", ";", "%", "o1", "o<a>", "if",
    "sub", "call", "while", "endif", "return", "1", "2", "0", "-1", ".5", "1e9", "99999999999999999999", "#1",
    "#<a>", "#<_x>", "[1+1]", "-",
))  # fmt: skip
LINES = st.one_of(st.lists(PIECES, max_size=12).map(" ".join), st.text(max_size=80))


@settings(max_examples=EXAMPLES, deadline=None)
@given(st.lists(LINES, max_size=6))
def test_any_line_is_taken_or_refused(lines):
    interp = Interpreter(OfflineCanon())
    interp.init()
    for line in lines:
        with suppress(InterpError):
            interp.execute_mdi(line)


@settings(max_examples=EXAMPLES, deadline=None)
@given(st.lists(LINES, max_size=10))
def test_any_file_is_taken_or_refused(tmp_path_factory, lines):
    path = tmp_path_factory.mktemp("fuzz") / "program.ngc"
    path.write_text("\n".join(lines), errors="replace")
    interp = Interpreter(OfflineCanon())
    interp.init()
    with suppress(InterpError):
        interp.open(path)
        for _ in range(200):
            if interp.read():
                break
            interp.execute()
