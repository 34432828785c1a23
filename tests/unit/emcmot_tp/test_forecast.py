"""The forecast names the time of a job, by tool and operation, and where it loses time."""

import json

import numpy as np
import pytest

from emcmot.forecast import forecast, main, report
from emcmot.forecast_machine import Machine
from nml.errors import ConfigError, InterpError
from nml.inifile import IniFile

INI = """
[EMCMOT]
SERVO_PERIOD = 1000000
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
MAX_LINEAR_VELOCITY = 100
[AXIS_X]
MAX_VELOCITY = 80
MAX_ACCELERATION = 500
[AXIS_Y]
MAX_VELOCITY = 100
MAX_ACCELERATION = 500
[AXIS_Z]
MAX_VELOCITY = 50
MAX_ACCELERATION = 200
[JOINT_2]
HOME = 5
"""


@pytest.fixture
def run(tmp_path):
    def job(text, **options):
        (tmp_path / "machine.ini").write_text(INI)
        (tmp_path / "job.ngc").write_text(text)
        ini = IniFile(tmp_path / "machine.ini")
        return forecast(ini, tmp_path / "job.ngc", Machine.from_ini(ini), **options)

    return job


def test_a_straight_move_takes_its_length_over_the_feed_and_the_ramps(run):
    assert run("G21 G90\nG1 X100 F3000\nM2\n").seconds == pytest.approx(100 / 50 + 50 / 500, abs=0.003)


def test_a_rapid_runs_at_the_limit_of_its_axis(run):
    assert run("G21 G90\nG0 X80\nM2\n").seconds == pytest.approx(80 / 80 + 80 / 500, abs=0.003)


def test_time_is_counted_by_tool_and_operation_and_pauses_apart(run):
    text = "G21 G90\n(first)\nG1 X50 F1200\n(second)\nG1 X0\nG4 P1.5\nM2\n"
    result = run(text)
    by_name = {operation: (motion, pauses) for _, operation, motion, pauses in result.sections}
    assert by_name["first"][0] == pytest.approx(2.5, abs=0.1)
    assert by_name["second"][0] == pytest.approx(2.5, abs=0.1)
    assert by_name["second"][1] == 1.5
    assert result.seconds == pytest.approx(sum(motion + pauses for motion, pauses in by_name.values()), abs=0.01)


def test_lost_time_is_blamed_on_the_axis_and_the_line(run):
    result = run("G21 G90 G61.1\n" + "".join(f"G1 X{k % 2} F4000\n" for k in range(1, 30)) + "M2\n")
    assert result.reasons[0][0] == "acceleration of X"
    assert next(iter(result.line_lost)) > 1


def test_each_slow_line_says_what_it_waited_for(run):
    result = run("G21 G90 G61.1\nG1 X1 F6000\nG1 X0\nG1 Z0\nM2\n")
    assert result.line_reason[2] == "acceleration of X"
    assert result.line_reason[4] == "acceleration of Z"


def test_lines_come_with_the_time_at_which_they_end(run):
    result = run("G21 G90 G61.1\nG1 X10 F600\nG1 X20\nG4 P1\nG1 Y5\nM2\n")
    assert [line for line, _ in result.run] == [2, 3, 5]
    assert [end for _, end in result.run] == pytest.approx([1.02, 2.04, 2.56], abs=0.01)


@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_the_path_error_is_within_the_tolerance_and_more_than_nothing(run, tolerance):
    text = f"G21 G90 F3000\nG64 P{tolerance}\nG1 X20\nG1 Y20\nG3 X0 Y20 I-10\nG1 X0 Y0\nM2\n"
    error = run(text, trace=True).path_error
    assert 0.2 * tolerance < error <= tolerance


def test_a_spline_is_cut_smoothly_at_the_programmed_feed(run):
    text = "G21 G90 G64 P0.02 F1200\nG1 X10\nG5 X40 Y20 I15 J0 P-15 Q0\nG5 X70 Y40 I15 J0 P-15 Q0\nG1 X80\nM2\n"
    result = run(text, trace=True)
    assert result.path_error <= 0.02
    speed = np.linalg.norm(result.trace.arrays()["velocity"], axis=1)
    assert speed[60:-60].min() > 0.99 * 20.0
    assert np.abs(result.trace.arrays()["acceleration"]).max() <= 500.001


def test_without_a_tolerance_to_use_the_path_is_kept_exactly(run):
    result = run("G21 G90 G61.1 F3000\nG1 X20\nG2 X20 Y20 Z3 J10 P2\nG1 X0 Y0\nM2\n", trace=True)
    assert result.path_error < 1e-9


def test_moves_without_a_tolerance_have_no_path_error(run):
    text = "G21 G90 F3000\nG64\nG1 X20\nG1 Y20\nG61.1\nG1 X0\nG1 Y0\nG64\nG1 X20\nM2\n"
    result = run(text, trace=True)
    assert result.unbounded == 3
    assert result.path_error < 1e-9  # of the moves in G61.1
    assert "3 moves in G64 without P" in report(result)
    nothing = run("G21 G90 F3000\nG64\nG1 X20\nG1 Y20\nM2\n", trace=True)
    assert nothing.path_error is None
    assert "n/a (2 moves" in report(nothing)


def test_joints_that_are_one_axis_lower_its_limits(run, monkeypatch):
    usual = run("G21 G90\nG0 X80\nM2\n")
    monkeypatch.setitem(globals(), "INI", INI + "[JOINT_0]\nMAX_VELOCITY = 20\nMAX_ACCELERATION = 100\n")
    assert usual.seconds < 1.3
    assert run("G21 G90\nG0 X80\nM2\n").seconds == pytest.approx(80 / 20 + 20 / 100, abs=0.003)


COREXY = """
[KINS]
KINEMATICS = corexykins
JOINTS = 3
[JOINT_0]
MAX_VELOCITY = 40
MAX_ACCELERATION = 250
[JOINT_1]
MAX_VELOCITY = 40
MAX_ACCELERATION = 250
"""


def test_joints_of_other_kinematics_hold_their_limits(run, monkeypatch):
    monkeypatch.setitem(globals(), "INI", INI + COREXY)
    result = run("G21 G90\nG0 X80 Y80\nG0 X80 Y160\nM2\n", trace=True)
    motors = result.trace.positions[:, :2] @ np.array([[1.0, 1.0], [1.0, -1.0]])  # x + y and x - y
    speed = np.abs(np.diff(motors, axis=0)).max(axis=0) / result.trace.period
    assert speed == pytest.approx([40.0, 40.0], abs=1e-3)
    assert np.abs(np.diff(motors, 2, axis=0)).max() / result.trace.period**2 <= 250 * 1.0001
    assert result.seconds == pytest.approx(160 / 40 + 80 / 40, abs=0.5)


def test_the_hal_files_say_how_the_kinematics_is_built(tmp_path):
    (tmp_path / "machine.hal").write_text("loadrt x\nsetp scarakins.D2 [ARM]LENGTH\nsetp scarakins.D4 150.5\n")
    ini = "[HAL]\nHALFILE = machine.hal\n[ARM]\nLENGTH = 321\n[KINS]\nKINEMATICS = scarakins\nJOINTS = 4\n"
    (tmp_path / "machine.ini").write_text(ini + "[TRAJ]\nCOORDINATES = X Y Z C\n[JOINT_1]\nHOME = 90\n")
    machine = Machine.from_ini(IniFile(tmp_path / "machine.ini"))
    values = machine.kinematics.parameter_values()
    assert (values["D2"], values["D4"]) == (321.0, 150.5)
    assert machine.start[1] == pytest.approx(150.5 + values["D6"], abs=1e-9)
    assert len(machine.joints) == 4


def test_an_unknown_kinematics_is_named(tmp_path):
    (tmp_path / "machine.ini").write_text("[TRAJ]\nCOORDINATES = X Y\n[KINS]\nKINEMATICS = nokins\n")
    with pytest.raises(ConfigError, match="nokins"):
        Machine.from_ini(IniFile(tmp_path / "machine.ini"))


def test_a_machine_with_jerk_limits_takes_longer(run, monkeypatch):
    text = "G21 G90 G64 P0.05 F3000\nG1 X20\nG1 Y20\nM2\n"
    usual = run(text)
    limited = INI.replace("[TRAJ]", "[TRAJ]\nPLANNER_TYPE = 1\nMAX_LINEAR_JERK = 5000")
    monkeypatch.setitem(globals(), "INI", limited)
    result = run(text, trace=True)
    jerk = np.abs(result.trace.arrays()["jerk"]).max()
    assert result.seconds > 1.1 * usual.seconds
    assert 2000 < jerk <= 5000.01


def test_traces_hold_every_servo_period(run):
    result = run("G21 G90\nG64 P0.01\nG1 X10 F3000\nG1 Y10\nM2\n", trace=True)
    traced = result.trace.arrays()
    assert len(traced["time"]) == round(result.seconds / 0.001)
    assert np.allclose(traced["position"][-1, :3], [10, 10, 5])
    assert np.abs(traced["acceleration"]).max() <= 500.001
    assert set(traced["line"]) <= {0, 3, 4}


def test_subprograms_arcs_and_drilling_cycles_are_run(run):
    text = "G21 G90 F600\no1 sub\nG2 X10 Y0 I5\nG3 X0 Y0 I-5\no1 endsub\no1 call\no1 call\n"
    text += "G81 X5 Y5 Z-5 R2 F300\nG80\nM2\n"
    assert run(text).seconds > 4 * np.pi * 5 / 10 + 7 / 5


def test_a_wrong_program_is_an_error_with_its_line(run):
    with pytest.raises(InterpError, match="2"):
        run("G21\nG1 X10 Q\nM2\n")


def test_the_command_prints_the_time_and_writes_the_traces(tmp_path, capsys):
    (tmp_path / "machine.ini").write_text(INI)
    (tmp_path / "job.ngc").write_text("G21 G90 G61\nG1 X10 F600\nM2\n")
    assert main([str(tmp_path / "machine.ini"), str(tmp_path / "job.ngc"), "--trace", str(tmp_path / "out.npz")]) == 0
    assert "time 0:00:01.0" in capsys.readouterr().out
    assert np.load(tmp_path / "out.npz")["position"].shape[1] == 9
    assert main([str(tmp_path / "machine.ini"), str(tmp_path / "job.ngc"), "--png", str(tmp_path / "out.png")]) == 0
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    capsys.readouterr()
    assert main([str(tmp_path / "machine.ini"), str(tmp_path / "job.ngc"), "--json", "-", "--path-error"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["seconds"] == pytest.approx(1.02, abs=0.01)
    assert told["lines"][0][0] == 2
    assert told["path_error"] < 1e-9
    assert main([str(tmp_path / "none.ini"), str(tmp_path / "job.ngc")]) == 1
