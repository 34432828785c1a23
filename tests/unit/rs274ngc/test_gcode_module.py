"""``gcode`` and ``rs274``: the modules that LinuxCNC's previews use, alone and beside Debian's."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import gcode
from rs274.interpret import ArcsToSegmentsMixin, PrintCanon, StatMixin, Translated

ROOT = Path(__file__).parents[3]
PEER = Path("/usr/lib/python3/dist-packages/gcode.cpython-311-x86_64-linux-gnu.so")
PROGRAM = """\
g0 x1 y2 z3
g1 f100 x2
g2 x4 i1
(msg,hello)
g10 l2 p1 x1 y2 r10
g2 x3 y5 r10 z2 a5
g18 g3 x6 z4 r3
g17
g92 x1
g4 p.5
m3 s100
g1 x2 u1
g3 x3 y4 r.8
g33.1 z1 k1
m2
"""


class Display(Translated, ArcsToSegmentsMixin):
    """Writes down what it is told, points in machine coordinates."""

    def __init__(self, parameter_file=""):
        self.lo = (0.0,) * 9
        self.heard = []
        self.line = 0
        self.parameter_file = parameter_file

    def hear(self, what, *values):
        self.heard.append([what, self.line, *(round(v, 6) + 0.0 if isinstance(v, float) else v for v in values)])

    def next_line(self, code):
        self.line = code.sequence_number
        self.hear("codes", code.motion_mode, code.plane, code.units, code.feed_rate, code.origin)

    def straight_traverse_translated(self, *point):
        self.hear("rapid", *point)
        self.lo = point

    def straight_feed_translated(self, *point):
        self.hear("feed", *point)
        self.lo = point

    def straight_arcsegments(self, points):
        self.hear("arc", len(points), *points[0], *points[-1])
        self.lo = points[-1]

    def set_feed_rate(self, rate):
        self.hear("rate", rate)

    def dwell(self, seconds):
        self.hear("dwell", seconds)

    def message(self, text):
        self.hear("message", text)

    def rigid_tap(self, *point):
        self.hear("tap", *point)

    def straight_probe(self, *point):
        self.hear("probe", *point)

    def user_defined_function(self, *words):
        self.hear("user", *words)

    def tool_offset(self, *offset):
        self.hear("offset", *offset)

    def comment(self, *_):
        pass

    set_traverse_rate = set_feed_mode = change_tool = set_spindle_rate = set_spindle_speed = comment

    def check_abort(self):
        return False

    def get_tool(self, index):
        return (-1, *(0.0,) * 12, 0)

    def get_external_length_units(self):
        return 1.0

    def get_external_angular_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0x1FF

    def get_block_delete(self):
        return False


@pytest.fixture
def program(tmp_path):
    def write(text):
        path = tmp_path / "program.ngc"
        path.write_text(text)
        return str(path)

    return write


def test_lengths_are_inches_in_machine_coordinates(program):
    display = Display()
    assert gcode.parse(program("g0 x25.4\ng10 l2 p1 x25.4\ng0 x50.8\nm2\n"), display, "G21", "G40 G49") == (1, 4)
    rapids = [heard for heard in display.heard if heard[0] == "rapid"]
    assert [rapid[1:3] for rapid in rapids] == [[1, 1.0], [3, 3.0]]


def test_an_error_has_its_line_and_its_text(program):
    result, line = gcode.parse(program("g0 x1\ng2 x2\nm2\n"), Display(), "", "", "")
    assert result > gcode.MIN_ERROR
    assert (line, gcode.strerror(result)) == (2, "R i j k words all missing for arc")


def test_a_display_can_abort(program):
    display = Display()
    display.check_abort = lambda: len(display.heard) > 50
    with pytest.raises(KeyboardInterrupt):
        gcode.parse(program("o1 while [1]\ng0 x1\no1 endwhile\nm2\n"), display)


def test_a_display_is_not_asked_about_a_short_program(program):
    display = Display()
    display.check_abort = lambda: pytest.fail("a second has not gone by")
    assert gcode.parse(program("g0 x1\nm2\n"), display)[0] == 1


def test_a_canon_without_methods_is_enough(program):
    assert gcode.parse(program("g0 x1\nt0 m6\nm2\n"), object()) == (1, 3)


def test_extents_are_found_with_and_without_tool_offsets():
    feeds = [(1, (0, 0, 0, 1, 1, 1, 0, 0, 0), (1, 2, 3, 0, 0, 0, 0, 0, 0), 100.0, (0, 0, 1))]
    rapids = [(1, (0, 0, 0, 0, 0, 0, 0, 0, 0), (5, -2, 3, 0, 0, 0, 0, 0, 0), (0, 0, 1))]
    assert gcode.calc_extents(feeds, rapids) == ([0, -2, 0], [5, 2, 3], [0, -2, 1], [5, 2, 4])


def test_an_arc_of_several_turns_has_the_points_of_all():
    points = gcode.arc_to_segments(Display(), 0.0, 0.0, 1.0, 0.0, 2, 4.0, *(0.0,) * 6, 64)
    assert len(points) == 4 * 64
    assert points[127][:3] == pytest.approx((0.0, 0.0, 2.0))


def test_the_status_answers_for_the_machine():
    class Stat:
        tool_table = ((0,) * 14, (5, *(0.0,) * 12, 0))
        linear_units, angular_units, axis_mask, block_delete = 1.0, 1.0, 7, True

    answers = StatMixin(Stat(), False)
    answers.change_tool(1)
    assert answers.get_tool(0)[0] == 5
    assert answers.get_tool(99)[0] == -1
    assert (answers.get_axis_mask(), answers.get_block_delete(), answers.get_external_length_units()) == (7, True, 1.0)


def test_the_printing_canon_shows_the_calls(program, capsys):
    gcode.parse(program("g0 x25.4\nm2\n"), PrintCanon(), "G21")
    assert "straight_traverse 1.0 0.0" in capsys.readouterr().out


@pytest.mark.peer
@pytest.mark.skipif(not PEER.exists(), reason="Debian's linuxcnc-uspace is not installed")
def test_debians_module_tells_the_same(program, tmp_path):
    path, parameters = program(PROGRAM), tmp_path / "display.var"
    parameters.write_text("")
    source = Path(__file__).read_text()
    script = source[source.index("class Display") : source.index("@pytest.fixture")]
    code = (
        "import sys, json, gcode\nfrom rs274.interpret import Translated, ArcsToSegmentsMixin\n"
        f"{script}\nd = Display({str(parameters)!r})\n"
        f"result = gcode.parse({path!r}, d, 'G21', 'G40 G49', '')\nprint(json.dumps([result, d.heard]))\n"
    )
    outputs = []
    for command, where in ((["/usr/bin/python3"], "/"), ([sys.executable], str(ROOT))):
        done = subprocess.run(
            [*command, "-c", code], cwd=where, capture_output=True, text=True, timeout=60, check=False
        )
        outputs.append(json.loads(done.stdout.splitlines()[-1]))
    theirs, ours = ([heard for heard in output[1] if heard[1] > 0] for output in outputs)
    assert outputs[1][0] == outputs[0][0]
    assert ours == theirs
