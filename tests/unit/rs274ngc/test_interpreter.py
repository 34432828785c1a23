"""The interpreter as its drivers see it: places of errors, limits, parameters on disk, MDI, several at once."""

import os
import re
from pathlib import Path

import pytest

from nml.errors import ConfigError, InterpError
from rs274ngc import __main__ as rs274
from rs274ngc import varfile
from rs274ngc.codes import TABLE
from rs274ngc.interp import INTERP_EXECUTE_FINISH, INTERP_EXIT, INTERP_OK, Interpreter
from rs274ngc.offline import OfflineCanon
from rs274ngc.reference import reference


@pytest.fixture
def interp():
    interp = Interpreter(OfflineCanon())
    interp.init()
    return interp


def test_an_error_names_file_line_and_column(interp, tmp_path):
    program = tmp_path / "wrong.ngc"
    program.write_text("g0 x1\n  g0 y2 q3\n")
    interp.open(program)
    with pytest.raises(InterpError) as caught:
        interp.run_file()
    place = caught.value.place
    assert (place.file, place.line, place.column) == (str(program), 2, 9)
    assert caught.value.message.startswith("Q word with no G5")
    assert caught.value.block == "  g0 y2 q3"


def test_an_error_of_a_typed_line_is_not_one_of_the_program_that_ran_before(interp, tmp_path):
    program = tmp_path / "right.ngc"
    program.write_text("g0 x1\nm2\n")
    interp.open(program)
    interp.run_file()
    with pytest.raises(InterpError) as caught:
        interp.execute_mdi("g0 x1 q3")
    place = caught.value.place
    assert (place.file, place.line, place.column) == ("MDI", 1, 7)


def test_an_error_in_a_subroutine_leaves_the_call(interp, tmp_path):
    program = tmp_path / "call.ngc"
    program.write_text("o1 sub\ng0 x[1/0]\no1 endsub\no1 call\ng0 y7\nm2\n")
    interp.open(program)
    with pytest.raises(InterpError, match="divide by zero"):
        interp.run_file()
    assert interp.call_level == 0
    interp.run_file()
    assert interp.state.position[1] == 7.0


def test_endless_recursion_is_refused(interp, tmp_path):
    program = tmp_path / "deep.ngc"
    program.write_text("o1 sub\no1 call\no1 endsub\no1 call\nm2\n")
    interp.open(program)
    with pytest.raises(InterpError, match="Too many subroutine levels"):
        interp.run_file()


def test_m99_ends_a_main_program_or_begins_it_again_on_a_machine(interp, tmp_path):
    program = tmp_path / "round.ngc"
    program.write_text("g91 g0 x1\nm99\ng0 y5\n")
    interp.open(program)
    assert interp.run_file() == INTERP_EXIT
    assert interp.state.position[:2] == (1.0, 0.0)
    interp.repeats_main = True
    interp.open(program)
    for _ in range(6):
        interp.read()
        assert interp.execute() == INTERP_OK
    assert interp.state.position[:2] == (4.0, 0.0)


@pytest.mark.parametrize("text", ["g0 x" + "[" * 200, "g0 x" + "-" * 200 + "1", "#" * 200 + "1=1"])
def test_deep_nesting_is_refused(interp, text):
    with pytest.raises(InterpError):
        interp.execute_mdi(text)


def test_an_endless_loop_returns_to_its_driver_after_every_line(interp, tmp_path):
    program = tmp_path / "loop.ngc"
    program.write_text("o1 while [1]\no1 endwhile\nm2\n")
    interp.open(program)
    for _ in range(1000):
        assert interp.read() == INTERP_OK
        assert interp.execute() == INTERP_OK


def test_a_line_that_is_too_long_is_refused_and_the_next_is_read(interp, tmp_path):
    program = tmp_path / "long.ngc"
    program.write_text("g0 x1" + " " * 300 + "\ng0 y3\nm2\n")
    interp.open(program)
    with pytest.raises(InterpError, match="Command too long"):
        interp.run_file()
    assert interp.run_file() == INTERP_EXIT
    assert interp.state.position[1] == 3.0


def test_probing_asks_for_a_standing_machine(interp):
    assert interp.execute_mdi("f100 g38.2 z-5") == INTERP_EXECUTE_FINISH
    interp.synch()
    assert interp.parameter(5063) == -5.0


def test_active_codes_follow_the_program(interp):
    interp.execute_mdi("g20 g18 g91 g55 f7 m3 s12 m8")
    codes = interp.active_g_codes()
    assert {180, 200, 910, 550, 940} <= set(codes)
    assert len(codes) == 17
    assert interp.active_m_codes()[2] == 3
    assert interp.active_settings()[1:3] == (7.0, 12.0)


def test_interpreters_do_not_share_anything(interp):
    other = Interpreter(OfflineCanon())
    other.init()
    interp.execute_mdi("#<_shared>=1")
    with pytest.raises(InterpError):
        other.execute_mdi("g0 x#<_shared>")


def test_parameters_survive_on_disk_with_their_backup(interp, tmp_path):
    path = tmp_path / "machine.var"
    interp.execute_mdi("g10 l2 p2 x12")
    interp.save_parameters(path)
    first = path.read_text()
    interp.execute_mdi("g10 l2 p2 x13")
    interp.save_parameters(path)
    assert Path(f"{path}.bak").read_text() == first
    fresh = Interpreter(OfflineCanon())
    fresh.load_parameters(path)
    assert fresh.parameter(5241) == pytest.approx(interp.parameter(5241), abs=1e-6)
    assert os.listdir(tmp_path) == ["machine.var", "machine.var.bak"] or len(os.listdir(tmp_path)) == 2


def test_a_parameter_file_out_of_order_is_refused(tmp_path):
    path = tmp_path / "wrong.var"
    path.write_text("5220 1\n5161 0\n")
    with pytest.raises(ConfigError, match=r"wrong.var:2: Parameter file out of order"):
        varfile.load(path, 5603)


def test_every_code_has_a_summary():
    assert len({row[0] for row in TABLE}) == len(TABLE) > 100
    assert all(row[3] for row in TABLE)


def test_the_reference_of_codes_is_current():
    page = Path(__file__).parents[3] / "docs" / "gcode.md"
    assert page.read_text() == reference()


def test_the_command_closes_its_output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text("g0 x1\nm2\n")
    before = os.listdir("/proc/self/fd")
    assert rs274.main(["-g", "part.ngc", "output"]) == 0
    assert os.listdir("/proc/self/fd") == before
    assert "STRAIGHT_TRAVERSE(1.0000" in (tmp_path / "output").read_text()


def test_the_command_reports_an_error_as_programs_expect_it_and_its_place_when_asked(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text("g0 x1\ng1 x1\nm2\n")
    message = "Cannot do g1 with zero feed rate\ng1 x1\n"
    assert rs274.main(["-g", "part.ngc"]) == 1
    assert capfd.readouterr().err == f"executing\n{message}"
    assert rs274.main(["-g", "-s", "part.ngc"]) == 1
    assert re.fullmatch(rf"executing\npart\.ngc:2(:\d+)?:\n{message}", capfd.readouterr().err)


def test_without_its_tool_table_a_program_runs_and_has_no_tools(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text("g0 x1\nm2\n")
    assert rs274.main(["-t", "none.tbl", "-g", "part.ngc"]) == 0
    shown = capfd.readouterr()
    assert "STRAIGHT_TRAVERSE(1.0000" in shown.out
    assert shown.err.startswith("none.tbl: Cannot open none.tbl (No such file or directory); there are no tools\n")
    (tmp_path / "part.ngc").write_text("t1 m6\nm2\n")
    assert rs274.main(["-t", "none.tbl", "-g", "part.ngc"]) == 1
    assert "tool 1 not found" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("ini", "active", "first"),
    [(None, 1.0, 2.0), ("", 1.0, 2.0), ("DISABLE_G92_PERSISTENCE = 1", 0.0, 0.0)],
    ids=["no INI file", "not disabled", "disabled"],
)
def test_g92_outlives_the_program_unless_the_ini_file_forbids_it(tmp_path, monkeypatch, capfd, ini, active, first):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text("(print,#5210 #5211)\nm2\n")
    (tmp_path / "kept.var").write_text("5210 1\n5211 2\n5220 1\n")
    (tmp_path / "machine.ini").write_text(f"[RS274NGC]\n{ini}\n")
    options = ["-g", "-v", "kept.var"] if ini is None else ["-g", "-v", "kept.var", "-i", "machine.ini"]
    for _ in range(2):
        assert rs274.main([*options, "part.ngc"]) == 0
        assert f"{active:.6f} {first:.6f}" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("ini", "shown"),
    [("OWORD_NARGS = 1", ["3.000000", "1.000000", "0.000000"]), ("FEATURES = 2", ["######"] * 3)],
    ids=["switched on", "not switched on"],
)
def test_a_subroutine_can_ask_how_many_arguments_it_got(tmp_path, monkeypatch, capfd, ini, shown):
    monkeypatch.chdir(tmp_path)
    calls = "o1 call [4] [5] [6]\no1 call [7]\no1 call\n"
    (tmp_path / "part.ngc").write_text(f"o1 sub\n(print,#<n_args> #2 #30)\no1 endsub\n#2=9 #30=9\n{calls}m2\n")
    (tmp_path / "machine.ini").write_text(f"[RS274NGC]\n{ini}\n")
    assert rs274.main(["-g", "-i", "machine.ini", "part.ngc"]) == 0
    printed = [line for line in capfd.readouterr().out.splitlines() if line.endswith("0.000000")]
    second = ["5.000000", "0.000000", "0.000000"]
    assert printed == [f"{number} {other} 0.000000" for number, other in zip(shown, second, strict=True)]


@pytest.mark.parametrize(
    ("program", "status"),
    [("g0 x1\nm99\ng0 x2\n", 0), ("o1 sub\nm99\no1 endsub\no1 call\nm2\n", 1)],
    ids=["main", "sub"],
)
def test_without_fanuc_subprograms_m99_ends_the_main_program_only(tmp_path, monkeypatch, capfd, program, status):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text(program)
    (tmp_path / "machine.ini").write_text("[RS274NGC]\nDISABLE_FANUC_STYLE_SUB = 1\n")
    assert rs274.main(["-g", "-i", "machine.ini", "part.ngc"]) == status
    output = capfd.readouterr()
    assert ("PROGRAM_END" in output.out, "but found m99" in output.err) == (status == 0, status == 1)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("g28.2", "G28.2 needs a P word: P0, P1 and so on home one joint, P-1 homes them all"),
        ("g28.2 p-2", "The P word of G28.2 must be the number of a joint, or P-1 for all joints"),
        ("g28.2 p1.5", "The P word of G28.2 must be the number of a joint, or P-1 for all joints"),
        ("g0\ng28.2 p0 x1", "G28.2 takes no axis words: P is the number of a joint"),
        ("g41.1 d1\ng28.2 p0", "Cannot home with cutter radius compensation on"),
    ],
)
def test_what_is_wrong_with_a_homing_line_is_said(interp, lines, message):
    *before, line = lines.splitlines()
    for text in before:
        interp.execute_mdi(text)
    with pytest.raises(InterpError) as caught:
        interp.execute_mdi(line)
    assert caught.value.message == message


def test_after_a_homing_line_nothing_is_read_before_it_is_done(run):
    canon = run("g28.2 p1\ng28.2 p-1\nm2\n")
    assert canon.calls[:2] == [("home_cycle_joint", (1,)), ("home_cycle", ())]
    interp = Interpreter(OfflineCanon())
    interp.init()
    assert interp.execute_mdi("g28.2 p-1") == INTERP_EXECUTE_FINISH


def test_the_calls_under_way_are_named_with_the_places_of_the_calls(interp, tmp_path):
    program, sub = tmp_path / "main.ngc", tmp_path / "deep.ngc"
    program.write_text("o1 sub\n\no<deep> call\no1 endsub\ng0 x1\no1 call\nm2\n")
    sub.write_text("o<deep> sub\ng0 x2\no<deep> endsub\n")
    interp.state.subroutine_path = [str(tmp_path)]
    interp.open(program)
    seen = set()
    while interp.read() == INTERP_OK and interp.execute() != INTERP_EXIT:
        assert len(interp.calls) == interp.call_level
        seen.add(interp.calls)
    first = ("1", str(program), 6)
    assert {(), (first,), (first, ("deep", str(program), 3))} <= seen
    assert interp.calls == ()
