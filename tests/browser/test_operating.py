"""What an operator does by hand, in a browser, with a machine that really moves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.browser.screen import SLOW_JOG
from tests.support.machine import wait_until
from tests.support.webclient import WebClient, web_mill


@pytest.fixture
def mill(tmp_path: Path) -> Any:
    with web_mill(tmp_path) as (_, port):
        yield port


def test_the_machine_is_switched_on_and_homed_from_the_header_and_the_manual_page(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.wait_state("E-stop")
    screen.page.wait_for_selector("#power:disabled")
    screen.page.click("#estop:enabled")
    screen.wait_state("Machine off")
    screen.page.click("#power:enabled")
    screen.wait_state("Not homed")
    screen.page.click(".homing [data-joint='0']")
    screen.page.wait_for_selector(".readout:has(tr[data-axis=X][data-state=homed]) tr[data-axis=Y][data-state=unhomed]")
    screen.page.click("#home-all")
    screen.wait_state("Ready")


def test_the_e_stop_button_stops_a_machine_in_motion(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.send_mdi("G1 X250 F60")
    wait_until(lambda: screen.position("X") > 1, "moving")
    screen.page.click("#estop")
    screen.wait_state("E-stop")
    assert screen.position("X") < 200


def test_a_jog_lasts_as_long_as_the_button_is_held(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, preferences=SLOW_JOG)
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.hold_until("[data-jog='X+']", lambda: screen.position("X") > 5, observer)
        screen.let_go()
        observer.wait(lambda state: not state["jog"] and state["inpos"], "jog ended")
        rest = observer.state["position"][0]
        screen.wait_position("X", rest)
        assert 5 < rest < 200


def test_an_increment_makes_one_step_for_each_press(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.press("1 mm", ".increments")
    screen.page.click("[data-jog='Y+']")
    screen.wait_position("Y", 1.0)
    screen.page.click("[data-jog='Z-']")
    screen.wait_position("Z", -1.0)
    screen.page.click("[data-jog='Y-']")
    screen.wait_position("Y", 0.0)


def test_touch_off_takes_sums_and_inches(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.page.click("[data-touchoff=X]")
    screen.type_expression("10 + 5/2")
    screen.wait_text("= 12.5")
    screen.page.keyboard.press("Enter")
    screen.wait_position("X", 12.5)
    screen.page.click("[data-touchoff=Y]")
    screen.type_expression("")
    for key in ("1", "0", "-", "4"):
        screen.press(key, "dialog[open] .keys")
    screen.press("Touch off", "dialog[open]")
    screen.wait_position("Y", 6.0)
    screen.page.click("[data-touchoff=Z]")
    screen.type_expression("2*")
    screen.wait_text("Not a number")
    screen.page.keyboard.press("Enter")
    assert screen.page.is_visible("dialog[open]"), "what is no number is not sent"
    screen.page.keyboard.press("Escape")


def test_a_loaded_tool_is_measured_by_touch_off(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.page.wait_for_selector("[data-touchoff=tool]:disabled")
    screen.go("tools")
    screen.page.click("tr[data-tool='3'] button:has-text('Load')")
    screen.wait_text("T3 in the spindle")
    screen.go("manual")
    screen.page.click("[data-touchoff=tool]:enabled")
    screen.type_expression("-4")
    screen.press("Touch off", "dialog[open]")
    screen.wait_position("Z", -4.0)
    screen.go("tools")
    screen.page.wait_for_selector("tr[data-tool='3'] td:has-text('4.000')")


def test_an_mdi_line_is_checked_before_it_is_sent(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.go("mdi")
    screen.page.fill("#mdi-line", "G1 X10 Q")
    screen.page.wait_for_selector(".verdict[data-kind=danger]")
    screen.page.click("#mdi-send")
    screen.page.wait_for_selector("#mdi-line[aria-invalid=true]")
    assert screen.page.input_value("#mdi-line") == "G1 X10 Q", "a wrong line stays, to be corrected"
    assert screen.position("X") == 0
    screen.page.fill("#mdi-line", "G0 X400")
    screen.page.wait_for_selector(".verdict[data-kind=warn]:has-text('limits')")
    screen.page.fill("#mdi-line", "G0 X10 Y-5")
    screen.page.wait_for_selector(".verdict[data-kind=ok]")
    screen.page.keyboard.press("Enter")
    screen.wait_position("X", 10)
    screen.wait_position("Y", -5)
    screen.page.click(".history button:has-text('G0 X10 Y-5')")
    assert screen.page.input_value("#mdi-line") == "G0 X10 Y-5"


def test_spindle_coolant_and_overrides_follow_their_controls(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.page.fill(".spindle input", "1500")
        screen.page.click(".spindle button:has-text('M3')")
        observer.wait(lambda state: state["spindle"][0]["speed"] == 1500, "spindle turns")
        screen.page.wait_for_selector(".spindle button[aria-pressed=true]:has-text('M3')")
        screen.page.click("[data-coolant=flood]")
        observer.wait(lambda state: state["flood"], "flood on")
        screen.page.get_by_role("slider", name="Feed", exact=True).fill("0.5")
        observer.wait(lambda state: state["feedrate"] == pytest.approx(0.5), "feed override")
        screen.press("Reset Feed")
        observer.wait(lambda state: state["feedrate"] == pytest.approx(1.0), "feed override back")
        screen.page.click(".spindle button:has-text('M5')")
        observer.wait(lambda state: state["spindle"][0]["direction"] == 0, "spindle stands")


def test_work_offsets_are_edited_in_their_table(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.go("offsets")
    field = screen.page.get_by_label("G55 X", exact=True)
    field.fill("25+0.4")
    field.press("Enter")
    with WebClient(mill, name="observer") as observer:
        wait_until(
            lambda: observer.call("offsets.read")["systems"][1]["offset"][0] == pytest.approx(25.4), "offset written"
        )
    wait_until(lambda: field.input_value() == "25.400", "the table shows what was written")
    screen.page.click("tr:has(th:text-is('G55')) button:has-text('Use')")
    screen.wait_position("X", -25.4)


def test_the_tool_table_is_edited_one_tool_at_a_time(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.go("tools")
    screen.page.get_by_role("button", name="Edit T4").click()
    screen.page.get_by_label("Offset Z").fill("36.5")
    screen.page.get_by_label("Remark").fill("5 mm drill, new")
    screen.press("Save", "dialog[open]")
    screen.page.wait_for_selector("tr[data-tool='4']:has-text('36.500'):has-text('new')")
    with WebClient(mill, name="observer") as observer:
        tool = next(tool for tool in observer.call("tools.read")["tools"] if tool["tool"] == 4)
        assert tool["offset"][2] == pytest.approx(36.5)


def test_a_tool_that_was_opened_before_somebody_else_changed_the_table_is_not_saved(
    mill: int, open_screen: Any, tmp_path: Path
) -> None:
    table = tmp_path / "mill_mm.tbl"
    screen = open_screen(mill)
    screen.power_up()
    screen.go("tools")
    screen.page.get_by_role("button", name="Edit T4").click()
    screen.page.get_by_label("Remark").fill("of the older table")
    table.write_text(f"{table.read_text()}T77 P77 ;from elsewhere\n")
    screen.page.wait_for_selector("tr[data-tool='77']")
    screen.press("Save", "dialog[open]")
    screen.page.wait_for_selector("#toasts [data-kind=error]:has-text('the tool table was changed meanwhile')")
    assert "T77 P77 ;from elsewhere" in table.read_text()
    assert "of the older table" not in table.read_text()
