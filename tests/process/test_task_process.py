"""Task in a whole machine: modes, MDI, programs, stops, errors, tools, abort, as a client sees them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, ERROR, Desk, at_desk
from tests.support.machine import PATIENCE, wait_until

pytestmark = pytest.mark.process


@pytest.fixture
def changes() -> dict[str, str]:
    """INI lines that a test wants otherwise."""
    return {}


@pytest.fixture
def desk(tmp_path: Path, changes: dict[str, str]) -> Iterator[Desk]:
    with at_desk(tmp_path, changes=changes) as desk:
        yield desk


def x(desk: Desk) -> float:
    return round(desk.look().position[0], 6)


def test_commands_are_refused_with_a_reason_while_they_cannot_be_done(desk):
    status = desk.look()
    assert (status.task_state, status.task_mode, status.interp_state) == (1, linuxcnc.MODE_MANUAL, 1)
    assert (status.exec_state, status.inpos, status.state, status.rapidrate) == (2, True, DONE, 1.0)
    assert desk.mdi("G0 X1") == ERROR
    assert desk.texts[-1].endswith("until the machine is out of E-stop and turned on")
    assert desk.do(desk.command.state, linuxcnc.STATE_ON) == DONE  # as in LinuxCNC, which says nothing
    assert "reset the E-stop first" in desk.texts[-1]
    assert desk.stat.task_state == linuxcnc.STATE_ESTOP
    desk.ready(linuxcnc.MODE_MANUAL)
    assert desk.mdi("G0 X1") == ERROR
    assert desk.texts[-1] == "Must be in MDI mode to issue MDI command"
    assert desk.do(desk.command.jog, linuxcnc.JOG_CONTINUOUS, False, 8, 1.0) == DONE
    assert "axis 8 cannot be jogged" in desk.texts[-1]


def test_mdi_lines_queue_and_run_in_order_and_feed_survives_an_abort(desk):
    desk.ready(linuxcnc.MODE_MDI)
    for number in range(8):
        desk.command.mdi(f"G1 X{number % 3} F3000")
    assert desk.command.wait_complete(PATIENCE) == DONE
    assert x(desk) == 1.0
    for mode, feed in (("g94", 234.5), ("g95", 0.5)):
        assert desk.mdi(mode) == DONE
        assert desk.mdi(f"f{feed}") == DONE
        assert desk.do(desk.command.abort) == DONE
        assert desk.stat.settings[1] == feed


def test_a_typed_line_that_could_be_joined_with_a_next_one_is_carried_out_at_once(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.mdi("G64 P0.1 Q0.05") == DONE
    for target in (1.0, 2.0):
        assert desk.mdi(f"G1 X{target} F3000") == DONE
        assert x(desk) == target


def test_feed_and_tolerances_show_in_the_units_of_the_program_as_soon_as_these_change(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.look().settings[3] == pytest.approx(0.001 * 25.4)
    assert desk.mdi("F600") == DONE
    assert desk.mdi("G64 P0.254 Q0.127") == DONE
    assert desk.mdi("G20") == DONE
    assert desk.look().settings[1:5] == pytest.approx((600 / 25.4, 0.0, 0.01, 0.005))
    assert desk.mdi("G21") == DONE
    assert desk.look().settings[1:5] == pytest.approx((600.0, 0.0, 0.254, 0.127))


def test_offsets_and_tools_show_in_the_status_and_survive_in_their_files(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.mdi("G10 L2 P1 X5 Y6") == DONE
    assert desk.mdi("G92 Z2") == DONE
    assert desk.mdi("T2 M6 G43") == DONE
    status = desk.stat
    assert status.g5x_offset[:3] == (5.0, 6.0, 0.0)
    assert status.g92_offset[2] == -2.0
    assert (status.tool_in_spindle, status.pocket_prepped, status.tool_offset[2]) == (2, -1, -12.5)
    assert (status.tool_table[0].id, status.tool_table[0].diameter) == (2, 6.0)
    assert desk.mdi("G10 L1 P2 Z3.25") == DONE
    assert desk.stat.tool_table[2].zoffset == 3.25
    assert (desk.folder / "mill_mm.tbl").read_text() == "T1 P1 D3 Z1\nT2 P2 D6 Z+3.250000\n"
    assert desk.mdi("T9") == ERROR
    saved = desk.folder / "mill_mm.var"
    wait_until(lambda: saved.exists() and "5221\t5.0" in saved.read_text(), "the parameters are saved")


def test_a_program_stops_resumes_steps_and_skips_as_the_operator_wants(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F6000\nG1 X1\nM1\nX2\nM0\n/X30\nX4\nM2\n")
    desk.run()
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED, "M1")
    assert x(desk) == 1.0
    desk.command.auto(linuxcnc.AUTO_RESUME)
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_PAUSED and x(desk) == 2.0, "M0")
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RESUME) == DONE
    assert x(desk) == 4.0
    desk.do(desk.command.set_optional_stop, 0)
    desk.do(desk.command.set_block_delete, 0)
    seen = []
    serial = desk.look().echo_serial_number
    desk.command.auto(linuxcnc.AUTO_STEP)
    desk.until(lambda s: s.echo_serial_number > serial, "the step is taken")
    ends = (linuxcnc.INTERP_PAUSED, linuxcnc.INTERP_IDLE)
    for _ in range(40):
        desk.until(lambda s: s.interp_state in ends and s.inpos, "the end of a step")
        if desk.stat.interp_state == linuxcnc.INTERP_IDLE:
            break
        if not seen or seen[-1] != x(desk):
            seen.append(x(desk))
        serial = desk.stat.echo_serial_number
        desk.command.auto(linuxcnc.AUTO_STEP)
        desk.until(lambda s, before=serial: s.echo_serial_number > before, "the step is taken")
    assert seen in ([1.0, 2.0, 30.0, 4.0], [4.0, 1.0, 2.0, 30.0, 4.0])


def test_a_pause_holds_a_dwell_and_moves_and_an_abort_agrees_with_everybody(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F120\nG1 X100\nG1 X0\nM2\n")
    desk.run()
    desk.until(lambda s: s.position[0] > 2.0, "cutting")
    desk.command.auto(linuxcnc.AUTO_PAUSE)
    desk.until(lambda s: s.paused and s.current_vel == 0.0, "the hold")
    assert desk.do(desk.command.mode, linuxcnc.MODE_MANUAL) == ERROR
    held = x(desk)
    assert desk.do(desk.command.abort) == DONE
    assert (desk.stat.interp_state, desk.stat.paused, x(desk)) == (linuxcnc.INTERP_IDLE, False, held)
    assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
    assert desk.mdi("G91 G1 X1") == DONE, desk.texts
    assert x(desk) == pytest.approx(held + 1.0)


def test_a_wrong_line_ends_the_program_after_what_came_before_it(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F6000\nG1 X1\nX2\nG1 X3 Z\nX4\nM2\n")
    desk.run()
    assert desk.command.wait_complete(PATIENCE) == ERROR
    desk.until(lambda _: desk.texts, "the reason")
    assert x(desk) == 2.0
    assert desk.stat.interp_state == linuxcnc.INTERP_IDLE
    assert desk.texts[-1].startswith(f"{desk.folder / 'part.ngc'}:4:")
    desk.program("M2\n")
    assert desk.do(desk.command.auto, linuxcnc.AUTO_RUN, 0) == DONE


def test_a_move_beyond_a_limit_names_its_line_and_ends_the_program(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F6000\nG1 X1\nG1 X9999\nM2\n")
    desk.run()
    assert desk.command.wait_complete(PATIENCE) == ERROR
    desk.until(lambda _: desk.texts, "the reason")
    assert "line 3" in desk.texts[-1]
    assert desk.stat.interp_state == linuxcnc.INTERP_IDLE


def test_nothing_behind_a_move_beyond_a_limit_is_done(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F3000\nG0 X1\nG1 X900\nG0 X2\nG0 Y5\nM2\n")
    desk.run()
    desk.until(lambda s: s.interp_state == linuxcnc.INTERP_IDLE and s.inpos and desk.texts, "the end")
    assert desk.look().state == ERROR
    assert desk.stat.position[0] <= 1.0
    assert desk.stat.position[1] == 0.0
    (text,) = desk.texts
    assert text.startswith("Linear move on line 3 would exceed")


def test_a_typed_stop_has_nothing_to_hold_and_does_not_keep_the_next_line_waiting(desk):
    desk.ready(linuxcnc.MODE_MDI)
    for line in ("M0", "M1", "M60"):
        assert desk.mdi(line) == DONE
        assert not desk.stat.paused
    assert desk.mdi("G0 X1") == DONE
    assert x(desk) == 1.0


def test_the_executing_move_is_known_by_its_line(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F300\nG1 X1\nG1 X1.5\nM8\nG1 X100\nM2\n")
    desk.run()
    desk.until(lambda s: s.position[0] > 2.0, "the last move")
    assert (desk.stat.motion_line, desk.stat.motion_id) == (5, 5)
    assert [codes[0] for codes in (desk.stat.gcodes, desk.stat.mcodes, desk.stat.settings)] == [5, 5, 5.0]
    assert 8 in desk.stat.mcodes
    assert desk.do(desk.command.abort) == DONE
    assert desk.stat.motion_line == desk.stat.motion_id == 0


@pytest.mark.parametrize("changes", [{"RS274NGC.SUBROUTINE_PATH": "."}])
def test_probing_waiting_and_subroutines_of_mdi_lines_give_the_same_result_every_time(desk):
    desk.ready(linuxcnc.MODE_MDI)
    (desk.folder / "twice.ngc").write_text("o<twice> sub\nG1 X[#1 * 2] F6000\nM66 P0 L3 Q0.02\no<twice> endsub\n")
    for number in range(1, 6):
        desk.texts.clear()
        assert desk.mdi("G38.3 X1 F6000") == DONE
        assert desk.mdi("M66 P1 L3 Q0.02") == DONE
        assert desk.stat.input_timeout
        assert desk.mdi(f"o<twice> call [{number}]") == DONE, desk.texts
        assert x(desk) == 2.0 * number
        assert desk.mdi("(DEBUG, #5399 #5420)") == DONE
        assert desk.texts[-1].split() == ["-1.000000", f"{2.0 * number:.6f}"]
    assert desk.mdi("G38.2 X50 F6000") == ERROR
    assert "without making contact" in desk.texts[-1]


@pytest.mark.parametrize("changes", [{"RS274NGC.SUBROUTINE_PATH": ".", "DISPLAY.PROGRAM_PREFIX": "."}])
def test_user_m_codes_run_programs_and_their_failure_ends_the_line(desk):
    desk.ready(linuxcnc.MODE_MDI)
    note = desk.folder / "note"
    for number, text in ((100, f"#!/bin/sh\necho $1 $2 > {note}\n"), (101, "#!/bin/sh\nexit 3\n")):
        script = desk.folder / f"M{number}"
        script.write_text(text)
        script.chmod(0o755)
    assert desk.mdi("M100 P1.5 Q-2") == DONE, desk.texts
    assert note.read_text() == "1.500000 -2.000000\n"
    assert desk.mdi("M101") == ERROR
    assert "M101 failed with exit code 3" in desk.texts[-1]


def test_an_estop_while_cutting_stops_everything_and_the_machine_starts_again(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 F120\nM3 S100\nM8\nG1 X100\nM2\n")
    desk.run()
    desk.until(lambda s: s.position[0] > 2.0 and s.flood == 1, "cutting with coolant")
    assert desk.do(desk.command.state, linuxcnc.STATE_ESTOP) == DONE
    status = desk.stat
    assert (status.task_state, status.task_mode, status.interp_state) == (1, linuxcnc.MODE_AUTO, 1)
    desk.until(lambda s: s.flood == 0 and s.spindle[0]["direction"] == 0, "coolant and spindle off")
    assert desk.do(desk.command.state, linuxcnc.STATE_ESTOP_RESET) == DONE
    assert desk.do(desk.command.state, linuxcnc.STATE_ON) == DONE


def test_ten_clients_at_once_are_all_served(desk):
    desk.ready(linuxcnc.MODE_MDI)
    clients = [linuxcnc.command() for _ in range(10)]
    for number in range(50):
        clients[number % 10].feedrate(0.5 + number / 100)
    assert clients[9].wait_complete(PATIENCE) == DONE
    assert desk.look().feedrate == 0.99


def test_offsets_and_modes_that_were_only_read_are_not_in_force_after_an_abort(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program(
        "G21 G90 G94 F120\nG1 X1\nG1 X100\nG92 X7\nG10 L2 P1 Y9\nG10 L2 P2 X3\nG20 G91 G55\nG43.1 Z2\nG1 X1\nM0\nM2\n"
    )
    desk.run()
    desk.until(lambda s: s.position[0] > 3.0 and s.read_line >= 9, "cutting, read ahead")
    assert desk.do(desk.command.abort) == DONE
    here = x(desk)
    assert here < 99.0
    assert desk.do(desk.command.mode, linuxcnc.MODE_MDI) == DONE
    status = desk.look()
    assert (status.g5x_index, status.g5x_offset, status.g92_offset, status.tool_offset) == (1, *((0.0,) * 9,) * 3)
    assert {10, 210, 900, 540, 922, 490}.issubset(status.gcodes)
    assert desk.mdi("(DEBUG, #5222 #5241 #5210 #5211 #5420)") == DONE
    assert [float(word) for word in desk.texts[-1].split()] == pytest.approx([0.0, 0.0, 0.0, 0.0, here], abs=1e-5)
    assert desk.mdi("F3000 X50") == DONE, desk.texts
    assert x(desk) == 50.0


def test_offsets_that_were_executed_stay_after_an_abort(desk):
    desk.ready(linuxcnc.MODE_AUTO)
    desk.program("G21 G90 G94 F600\nG10 L2 P2 X3\nG55\nG92 Y4\nG43.1 Z2\nG4 P500\nG54\nM2\n")
    desk.run()
    desk.until(lambda s: s.exec_state == linuxcnc.EXEC_WAITING_FOR_DELAY, "the dwell")
    assert desk.do(desk.command.abort) == DONE
    status = desk.look()
    assert (status.g5x_index, status.g5x_offset[0], status.g92_offset[1], status.tool_offset[2]) == (2, 3.0, -4.0, 2.0)


def test_a_spindle_that_an_abort_stopped_is_not_started_by_an_s_word(desk):
    desk.ready(linuxcnc.MODE_MDI)
    assert desk.mdi("M3 S500") == DONE
    assert desk.stat.spindle[0]["direction"] == 1
    assert desk.do(desk.command.abort) == DONE
    assert desk.mdi("S800") == DONE
    assert desk.mdi("G0 X1") == DONE
    assert (desk.stat.spindle[0]["direction"], desk.stat.spindle[0]["speed"]) == (0, 0.0)
