"""Remapped codes: what REMAP lines may say, NGC procedures, Python functions, and what they see of the interpreter."""

import os
import re
import subprocess
import sys
import textwrap

import pytest

from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile
from rs274ngc import tooltable
from rs274ngc.interp import INTERP_EXECUTE_FINISH, Interpreter
from rs274ngc.remap import parse
from tests.support.machine import ROOT
from tests.unit.rs274ngc.conftest import Recorder


@pytest.fixture
def machine(tmp_path):
    """An interpreter with these REMAP lines, NGC procedures and Python modules."""

    def make(*remaps, python="", oword="", namedparams="", **procedures):
        lines = ["[RS274NGC]", f"SUBROUTINE_PATH={tmp_path}", *(f"REMAP={remap}" for remap in remaps)]
        if python or oword or namedparams:
            lines += ["[PYTHON]", "TOPLEVEL=toplevel.py", f"PATH_PREPEND={tmp_path}"]
            head = "from interpreter import *\nimport emccanon\n"
            for name, text in (("remap", python), ("oword", oword), ("namedparams", namedparams)):
                (tmp_path / f"{name}.py").write_text(head + textwrap.dedent(text))
            (tmp_path / "toplevel.py").write_text("import remap, oword, namedparams\n")
        for name, text in procedures.items():
            (tmp_path / f"{name}.ngc").write_text(f"o<{name}> sub\n{text}\no<{name}> endsub [5]\nm2\n")
        ini = tmp_path / "machine.ini"
        ini.write_text("\n".join(lines) + "\n")
        canon = Recorder(tools=tooltable.DEFAULT)
        interp = Interpreter(canon, IniFile(str(ini)))
        interp.init()
        return interp, canon

    return make


def typed(interp, *lines):
    """Lines typed in, with whatever they call."""
    results = []
    for line in lines:
        results.append(interp.execute_mdi(line))
        while interp.call_level:
            interp.read()
            results.append(interp.execute())
    return results


def messages(canon):
    return [text for (text,) in canon.named("message")]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("N5 ngc=x", "'N5' is no code that can be remapped"),
        ("M400", "either ngc= or python="),
        ("M400 ngc=x python=y", "either ngc= or python="),
        ("M400 ngc=x modalgroup=2", "groups 4 to 10"),
        ("G88.6 ngc=x modalgroup=2", "group 1"),
        ("M400 ngc=x argspec=?", "argspec"),
        ("M400 body=x", "'body=x' is no option"),
    ],
)
def test_a_wrong_line_says_what_would_be_right(text, message):
    with pytest.raises(ConfigError, match=message):
        parse(text)


def test_words_become_named_parameters(machine):
    interp, canon = machine("M400 argspec=Pq ngc=m400", m400="(debug,#<p> #<_remap_level>)\ng0 x#<p>")
    typed(interp, "m400 p3", "(debug,#<_value> #<_remap_level>)")
    assert messages(canon) == ["3.000000 1.000000", "5.000000 0.000000"]
    assert canon.named("straight_traverse")[0][1] == 3.0


def test_words_become_numbered_parameters(machine):
    interp, canon = machine("M400 argspec=@PQr ngc=m400", m400="(debug,#1 #2 #3)")
    typed(interp, "m400 q2 p1")
    assert messages(canon) == ["1.000000 2.000000 0.000000"]


@pytest.mark.parametrize(
    ("argspec", "line", "message"),
    [
        ("PQ", "m400", r"user-defined M400: missing: P,Q$"),
        ("^>", "m400", r"user-defined M400:F>0,S>0,$"),
    ],
)
def test_what_is_missing_is_named(machine, argspec, line, message):
    interp, _ = machine(f"M400 argspec={argspec} ngc=m400", m400="")
    with pytest.raises(InterpError) as refused:
        interp.execute_mdi(line)
    assert refused.match(message.rstrip("$"))


def test_a_line_goes_on_after_its_remapped_code(machine):
    interp, canon = machine("M400 modalgroup=5 argspec=P ngc=m400", m400="g1 f10 y#<p>")
    typed(interp, "m400 p2 g0 x1 m5")
    names = [name for name, _ in canon.calls]
    assert names[-3:] == ["straight_feed", "stop_spindle_turning", "straight_traverse"]


def test_a_code_is_the_built_in_one_inside_its_own_procedure(machine):
    interp, canon = machine("M6 modalgroup=6 ngc=change", "F ngc=feed", change="m6\ng0 z9", feed="f99")
    typed(interp, "t1 m6", "f7")
    assert len(canon.named("change_tool")) == 1
    assert canon.named("set_feed_rate")[-1] == (99.0,)


def test_endless_remapping_is_refused(machine):
    interp, _ = machine("M400 ngc=m400", m400="m400")
    with pytest.raises(InterpError, match="maximum nesting of remapped blocks exceeded"):
        typed(interp, "m400")
    assert interp.call_level == 0


def test_a_python_function_sees_the_line_and_calls_the_canon(machine):
    interp, canon = machine(
        "G88.6 modalgroup=1 argspec=XYp python=g886",
        python="""
            def g886(self, **words):
                c = self.blocks[self.remap_level]
                emccanon.MESSAGE(f"{sorted(words.items())} {c.comment} {c.x_flag} {c.g_modes[1]}")
                self.execute("G0 X%f" % words["x"])
                self.params["_result"] = self.current_x * 2
                return INTERP_OK
            """,
    )
    typed(interp, "g88.6 x1 y2 p3 (here)", "(debug,#<_result>)")
    assert messages(canon) == ["[('p', 3.0), ('x', 1.0), ('y', 2.0)] here True 886", "2.000000"]


def test_prolog_and_epilog_share_the_procedures_level(machine):
    interp, canon = machine(
        "M400 prolog=before ngc=m400 epilog=after",
        m400="#<result>=[#<given>*3]",
        python="""
            def before(self, **words):
                self.params["given"] = 4
                return INTERP_OK
            def after(self, **words):
                emccanon.MESSAGE(f"{self.params['result']} {self.return_value} {self.value_returned}")
                return INTERP_OK
            """,
    )
    typed(interp, "m400")
    assert messages(canon) == ["12.0 5.0 1"]


def test_a_generator_waits_for_the_machine(machine):
    interp, canon = machine(
        "M400 python=wait",
        python="""
            def wait(self, **words):
                emccanon.MESSAGE("before")
                yield INTERP_EXECUTE_FINISH
                emccanon.MESSAGE("after")
            """,
    )
    assert interp.execute_mdi("m400 g0 x1") == INTERP_EXECUTE_FINISH
    assert messages(canon) == ["before"]
    interp.synch()
    interp.read()
    interp.execute()
    assert messages(canon) == ["before", "after"]
    assert interp.call_level == 0


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("return 'no tool'", "no tool"),
        ("self.set_errormsg('broken'); return INTERP_ERROR", "broken"),
        ("return 1/0", r"Python exception in remap.m400: ZeroDivisionError: division by zero \(remap.py:4\)"),
        ("self.execute('g1 x1')", "Cannot do g1 with zero feed rate"),
    ],
)
def test_errors_of_functions_are_errors_of_the_program(machine, body, message):
    interp, _ = machine("M400 python=m400", python=f"def m400(self, **words):\n    {body}\n")
    with pytest.raises(InterpError, match=message):
        interp.execute_mdi("m400")
    assert typed(interp, "g0 x1") == [0]


def test_python_functions_are_o_word_subroutines_and_predefined_parameters(machine):
    interp, canon = machine(
        oword="def double(self, x):\n    return 2.0 * x\n",
        namedparams="def _answer(self):\n    return 42\n",
    )
    typed(interp, "o<double> call [21]", "(debug,#<_value> #<_answer>)")
    assert messages(canon) == ["42.000000 42.000000"]


@pytest.mark.parametrize("edit", ["; a line more\n", ""])
def test_a_subroutine_file_that_was_edited_between_two_calls_is_read_anew(machine, tmp_path, edit):
    interp, canon = machine(part="(msg,first)")
    typed(interp, "o<part> call")
    (tmp_path / "part.ngc").write_text(f"{edit}o<part> sub\n{edit}(msg,second and more)\no<part> endsub\nm2\n")
    typed(interp, "o<part> call", "o<part> call")
    assert messages(canon) == ["first", "second and more", "second and more"]


def test_a_python_subroutine_has_a_level_of_its_own_and_sees_what_it_was_called_with(machine):
    interp, canon = machine(
        oword="""
        def look(self, *args):
            here = self.blocks[self.remap_level]
            self.params["own"] = 1.0
            entry = self.sub_context[1].named_params[0]
            self.params["_seen"] = (
                here.params == list(args) and here.param_cnt == 3 and here.o_name == "look"
                and here.m_modes[0] == here.g_modes[0] == -1
                and self.call_level == 1 == self.params["_call_level"] and self.remap_level == 0
                and self.params.locals() == ["own"] and "main" in self.params.globals()
                and (entry.key(), entry.data().value) == ("own", 1.0)
            )
            return 4.0
        """
    )
    typed(interp, "#<main> = 3", "o<look> call [1] [2.5] [#<main>]", "(debug,#<_seen> #<_value> #<_call_level>)")
    assert messages(canon) == ["1.000000 4.000000 0.000000"]
    with pytest.raises(InterpError, match="own"):
        typed(interp, "#1 = #<own>")


def test_what_a_function_prints_stands_between_the_canonical_calls_around_it(tmp_path):
    files = {
        "machine.ini": "[RS274NGC]\nSUBROUTINE_PATH = .\n[PYTHON]\nTOPLEVEL = top.py\nPATH_PREPEND = .\n",
        "top.py": "import oword\n",
        "oword.py": """
import emccanon
def talk(self):
    print("one")
    emccanon.COMMENT("two")
    print("three")
    self.execute("(debug,four)")
    print("five")
""",
        "part.ngc": "(debug,before)\no<talk> call\n(debug,after)\nm2\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    command = [sys.executable, "-m", "rs274ngc", "-i", "machine.ini", "-g", "part.ngc"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)
    words = re.findall(r"before|after|one|two|three|four|five", done.stdout)
    assert words == ["before", "one", "two", "three", "four", "five", "after"], done.stdout + done.stderr


def test_a_function_sees_the_speed_of_each_spindle_and_none_beyond(machine):
    interp, canon = machine(
        oword="""
        def speeds(self):
            try:
                self.speed[len(self.speed)]
            except IndexError:
                self.params["_beyond"] = 1
            return sum(self.speed)
        """
    )
    typed(interp, "s100 m3", "o<speeds> call", "(debug,#<_value> #<_beyond>)")
    assert messages(canon) == ["100.000000 1.000000"]


def test_a_function_sees_the_tools_and_the_offset_that_applies(machine):
    interp, canon = machine(
        oword="""
        def tools(self):
            tool = self.tool_table[0]
            same = tool.toolno == self.current_tool and tool.diameter == self.params[5410]
            return same and tool.offset.z == self.params[5403] and self.tool_offset.x + self.tool_offset.z
        """
    )
    typed(interp, "g43.1 x2 z5", "o<tools> call", "(debug,#<_value>)")
    assert messages(canon) == ["7.000000"]


def test_named_parameters_of_a_level_are_found_by_name_and_say_what_they_are(machine):
    interp, canon = machine(
        oword="""
        def attributes(self):
            named = self.sub_context[0].named_params
            bits = [named[name].attr for name in ("_wide", "_motion_mode", "_mine")]
            assert [item.data().value for item in named if item.key() == "_wide"] == [3.0], bits
            assert "own" in self.sub_context[0].named_params and "none" not in named
            return bits[0] * 10000 + bits[1] * 100 + bits[2]
        """,
        namedparams="def _mine(self): return 1.0\n",
    )
    typed(interp, "#<_wide> = 3 #<own> = 4", "o<attributes> call", "(debug,#<_value>)")
    assert messages(canon) == ["21135.000000"]


@pytest.mark.parametrize(
    ("remap", "line", "block"),
    [
        ("M400 argspec=P ngc=m400", "m400", "O <m400> call "),
        ("M400 prolog=wrong ngc=m400", "m400 p1", "O <m400> call "),
        ("M400 py=wrong", "m400 p1", "O <wrong> call "),
        ("M400 epilog=wrong ngc=m400", "m400 p1", "o<m400> endsub [5]"),
        ("M400 ngc=m400", "m400 p1", "g1 x1"),
    ],
)
def test_an_error_shows_the_call_of_the_remapped_code_or_the_line_of_its_procedure(machine, remap, line, block):
    procedure = "g1 x1" if block == "g1 x1" else "g0 x1"
    interp, _ = machine(remap, python="def wrong(self, **words): return 'wrong'\n", m400=procedure)
    with pytest.raises(InterpError) as error:
        typed(interp, line)
    assert error.value.block == block


def test_a_statement_of_python_stands_in_a_line_of_its_own(machine, tmp_path):
    interp, _ = machine(python="seen = []\n")
    (tmp_path / "more.py").write_text("remap.seen.append('file')\n")
    typed(interp, ";py,remap.seen.append(1)", "(pyrun,more.py)", "(pyrun,none.py)", "g0 x1 ;py,remap.seen.append(2)")
    typed(interp, ";py,from interpreter import *", ";py,remap.seen.append(this.call_level)")
    assert interp.state.plugin.namespace["remap"].seen == [1, "file", 0]
    with pytest.raises(InterpError, match=r"py_execute\(1/0\): ZeroDivisionError"):
        typed(interp, ";py,1/0")


def test_a_program_runs_no_python_where_no_plug_in_is_set_up(run, capfd):
    run(";py,print('run')\n(pyrun,more.py)\n(pyreload)\nm2\n")
    assert "run" not in capfd.readouterr().out


def test_the_toplevel_script_is_run_again_when_a_program_asks(machine, tmp_path):
    interp, _ = machine(python="mark = 0\n")
    typed(interp, ";py,remap.mark = 1")
    (tmp_path / "toplevel.py").write_text("import remap, oword, namedparams\nremap.again = remap.mark\n")
    typed(interp, "(pyreload)")
    assert interp.state.plugin.namespace["remap"].again == 1


def test_the_feed_mode_is_one_of_the_interpreter_modules_names(machine):
    interp, canon = machine(
        oword="""
        def mode(self):
            return (UNITS_PER_MINUTE, INVERSE_TIME, UNITS_PER_REVOLUTION).index(self.feed_mode)
        """
    )
    typed(interp, "g94", "o<mode> call", "(debug,#<_value>)", "g93", "o<mode> call", "(debug,#<_value>)")
    assert messages(canon) == ["0.000000", "1.000000"]


@pytest.mark.parametrize(
    "options", ["prolog=there ngc=x epilog=gone", "prolog=gone ngc=x", "ngc=x epilog=gone", "python=gone"]
)
def test_a_remap_that_names_a_function_which_is_not_there_is_refused_at_once(machine, options):
    with pytest.raises(ConfigError, match="REMAP=M400: 'gone' is no function of the Python module remap"):
        machine(f"M400 modalgroup=10 {options}", python="def there(self, **words):\n    return INTERP_OK\n")


def test_the_toplevel_script_hears_of_the_end(machine):
    interp, _ = machine(oword="def nothing(self):\n    pass\n")
    top = interp.state.plugin.namespace
    ends = []
    top["__delete__"] = lambda self: ends.append(self.remap_level)
    interp.exit()
    assert ends == [0]
