"""Programs in the browser: upload, edit, run, pause, override, step, abort, run from here, tool change, long ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import linuxcnc
from tests.support.machine import wait_until
from tests.support.webclient import WebClient, web_mill

SQUARE = """(a square)
G21 G90 G94 G17
G0 X0 Y0 Z5
G1 Z0 F1200
G1 X60 F1200
G1 Y60
G1 X0
G1 Y0
G0 Z5
M2
"""
SLOW = "G21 G90\nG1 X60 F120\nM2\n"
TOOLS = """G21 G90
T2 M6
G1 X5 F600
T3 M6
G1 X0 F600
M2
"""
BY_HAND = """
delsig tool-change-loop
loadusr -W hal_manualtoolchange
net tool-change iocontrol.0.tool-change => hal_manualtoolchange.change
net tool-changed hal_manualtoolchange.changed => iocontrol.0.tool-changed
net tool-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number
"""
LONG = 200_000  # lines
REDRAW = """
async () => {
  document.querySelector(".program-text").dispatchEvent(new Event("scroll"));
  for (let frame = 0; frame < 3; frame += 1) await new Promise(requestAnimationFrame);
}
"""


@pytest.fixture
def mill(tmp_path: Path) -> Iterator[int]:
    with web_mill(tmp_path, square=SQUARE, slow=SLOW) as (_, port):
        yield port


def test_a_program_is_uploaded_opened_and_run(mill: int, open_screen: Any, tmp_path: Path) -> None:
    program = tmp_path / "uploaded.ngc"
    program.write_text(SQUARE)
    screen = open_screen(mill)
    screen.power_up()
    screen.go("program")
    screen.page.click("#program-open")
    screen.page.set_input_files("#upload-file", program)
    screen.wait_text("uploaded.ngc is here now.")
    screen.page.click(".file button:has-text('uploaded.ngc'):enabled")
    screen.page.wait_for_selector("#run-state:has-text('uploaded.ngc')")
    screen.page.click("#run:enabled")
    screen.wait_state("Program running")
    screen.page.wait_for_selector(".program-text .line[data-active]")
    screen.wait_state("Ready")
    screen.wait_position("Z", 5)
    assert not screen.errors()


def test_an_upload_asks_before_it_replaces_a_program(mill: int, open_screen: Any, tmp_path: Path) -> None:
    program = tmp_path / "square.ngc"
    program.write_text("G0 X1\nM2\n")
    screen = open_screen(mill)
    screen.go("program")
    screen.page.click("#program-open")
    screen.page.set_input_files("#upload-file", program)
    screen.press("Replace", "dialog[open] >> nth=-1")
    screen.wait_text("square.ngc is here now.")
    assert (tmp_path / "nc" / "square.ngc").read_text() == program.read_text()


def test_a_running_program_is_paused_overridden_resumed_and_aborted(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("slow.ngc")
    with WebClient(mill, name="observer") as observer:
        screen.page.click("#run:enabled")
        wait_until(lambda: screen.position("X") > 1, "cutting")
        screen.page.click("#pause:enabled")
        screen.wait_state("Paused")
        observer.wait(lambda state: state["position"][0] > 1 and abs(state["current_vel"]) < 1e-9, "at rest")
        rest = observer.state["position"][0]
        assert 1 < rest < 60
        screen.page.get_by_role("slider", name="Feed", exact=True).fill("0.4")
        observer.wait(lambda state: state["feedrate"] == pytest.approx(0.4), "override")
        screen.page.click("#pause:has-text('Resume')")
        screen.wait_state("Program running")
        observer.wait(lambda state: state["current_vel"] == pytest.approx(0.4 * 2, rel=0.01), "40 % of F120")
        screen.page.click("#stop")
        screen.wait_state("Ready")
        observer.wait(lambda state: state["interp_state"] == 1 and state["inpos"], "aborted")
        assert not screen.errors(), "stopping is no mistake"


def test_a_program_is_stepped_through(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("square.ngc")
    status, places = linuxcnc.stat(), []
    while not places or places[-1][0] < 60.0:
        assert len(places) < 20, places
        before = status.echo_serial_number
        screen.page.click("#step:enabled")
        wait_until(lambda before=before: status.poll() or status.echo_serial_number > before, "the step is taken")
        wait_until(lambda: status.poll() or (status.inpos and status.interp_state == linuxcnc.INTERP_PAUSED), "held")
        places.append(tuple(round(place, 6) for place in status.position[:3]))
    assert list(dict.fromkeys(places))[-3:] == [(0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (60.0, 0.0, 0.0)]
    screen.wait_position("X", 60)
    screen.page.click("#stop")
    screen.wait_state("Ready")
    screen.wait_position("Y", 0)


def test_run_from_here_shows_the_difference_before_it_moves(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("square.ngc")
    screen.page.wait_for_selector("#run-from:disabled")
    screen.page.hover(".program-text .line[data-line='7']:has-text('G1 X0')")
    screen.page.mouse.down()
    screen.page.evaluate(REDRAW)
    screen.page.mouse.up()  # the press is of that line although the text was drawn anew meanwhile
    screen.page.click("#run-from:enabled")
    screen.page.wait_for_selector("dialog[open] .differences")
    screen.picture("run-from-here.png")
    assert screen.position("Y") == 0
    screen.press("Run from here", "dialog[open]")
    screen.wait_state("Program running")
    screen.wait_state("Ready")
    screen.wait_position("Z", 5)


def test_a_wrong_program_shows_its_errors_at_their_lines(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("square.ngc")
    screen.page.click("#program-edit:enabled")
    screen.page.fill("#editor-text", "G21\nG1 X10 F600\nG1 X[10+\nM2\n")
    screen.page.wait_for_selector(".editor .grow:text-is('square.ngc ●')")
    screen.page.click("#editor-save:enabled")
    screen.page.wait_for_selector(".editor .grow:text-is('square.ngc')")
    screen.page.wait_for_selector(".editor .errors button:has-text('Line 3')")
    screen.page.fill("#editor-text", "G21\nG1 X10 F600\nG1 X[10+1]\nM2\n")
    screen.page.wait_for_selector(".editor .errors", state="hidden")
    screen.page.click("#editor-open:enabled")
    screen.page.wait_for_selector("#run-state:has-text('of 4')")
    screen.page.click("#run:enabled")
    screen.wait_position("X", 11)


def test_a_new_program_is_written_in_the_browser(mill: int, open_screen: Any, tmp_path: Path) -> None:
    screen = open_screen(mill)
    screen.go("program")
    screen.page.click("#program-open")
    screen.press("New", "dialog[open]")
    screen.page.fill("#editor-text", "G0 X3\nM2\n")
    screen.page.click("#editor-save")
    screen.page.fill("dialog[open] input", "new.ngc")
    screen.press("OK", "dialog[open]")
    saved = tmp_path / "nc" / "new.ngc"
    wait_until(lambda: saved.exists() and saved.read_text() == "G0 X3\nM2\n", "saved")


def test_a_tool_is_changed_by_hand_when_the_program_asks(tmp_path: Path, open_screen: Any) -> None:
    with web_mill(tmp_path, hal=BY_HAND, tools=TOOLS) as (_, port):
        screen = open_screen(port)
        screen.power_up()
        screen.open_program("tools.ngc")
        screen.page.click("#run:enabled")
        screen.page.wait_for_selector("dialog[open]:has-text('T2')")
        assert screen.position("X") == 0
        screen.picture("tool-change.png")
        screen.press("Tool is in", "dialog[open]")
        screen.page.wait_for_selector("dialog[open]:has-text('T3')")
        screen.wait_position("X", 5)
        screen.press("Tool is in", "dialog[open]")
        screen.wait_state("Ready")
        screen.go("tools")
        screen.wait_text("T3 in the spindle")


def test_a_long_program_stays_handy(tmp_path: Path, open_screen: Any) -> None:
    lines = ["G21 G90 G1 F6000"] + [f"X{n % 100} Y{n // 100 % 100}" for n in range(LONG - 2)] + ["M2"]
    with web_mill(tmp_path, long="\n".join(lines)) as (_, port):
        screen = open_screen(port)
        screen.power_up()
        screen.open_program("long.ngc")
        screen.wait_text(f"{LONG} lines")
        assert screen.page.locator(".program-text .line").count() < 100, "only the lines in sight exist"
        screen.page.evaluate("document.querySelector('.program-text').scrollTop = 1e9")
        screen.page.wait_for_selector(f".program-text .line[data-line='{LONG}']:has-text('M2')")
        screen.page.wait_for_selector(".path-notice[data-state=whole]")
