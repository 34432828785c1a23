"""What must not happen: a machine that goes on when its operator is gone, or obeys two of them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.browser.cable import Cable
from tests.browser.screen import SLOW_JOG, jog_until
from tests.support.machine import wait_until
from tests.support.webclient import WebClient, web_mill

LONG_WAY = 10.0  # mm; longer than a slow jog goes on without signs of life
TOKENS = "operator 0123456789abcdef-operator\nreader 0123456789abcdef-reader\n"


@pytest.fixture
def mill(tmp_path: Path) -> Iterator[int]:
    with web_mill(tmp_path) as (_, port):
        yield port


def far(observer: WebClient) -> bool:
    """Whether the jog has gone on for longer than it would without signs of life."""
    return observer.state["position"][0] > LONG_WAY


def jog_ended(observer: WebClient) -> None:
    """The machine stands, and short of its limit."""
    observer.wait(lambda state: not state["jog"] and state["inpos"], "jog ended")
    assert observer.state["position"][0] < 290, "stopped by the loss, not by the limit"


def test_a_jog_stops_when_the_network_is_lost(mill: int, open_screen: Any) -> None:
    cable = Cable(mill)
    screen = open_screen(cable.port, preferences=SLOW_JOG)
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.hold_until("[data-jog='X+']", lambda: far(observer), observer)
        cable.cut()
        jog_ended(observer)
        screen.page.wait_for_selector("#offline:visible")
        screen.picture("no-connection.png")
        cable.mend()
        screen.page.wait_for_selector("#offline", state="hidden")
        jog_ended(observer)
        assert not observer.state["jog"], "a button that is still held does not start it again"
    cable.close()


def test_a_jog_stops_when_the_window_loses_the_focus(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, preferences=SLOW_JOG)
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.hold_until("[data-jog='X+']", lambda: far(observer), observer)
        screen.page.evaluate("window.dispatchEvent(new Event('blur'))")
        jog_ended(observer)


def test_a_jog_stops_when_the_page_is_closed(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, preferences=SLOW_JOG)
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.hold_until("[data-jog='X+']", lambda: far(observer), observer)
        screen.page.close()
        jog_ended(observer)
        observer.wait(lambda state: state["control"] is None, "the controls are free again")


def test_keys_jog_only_after_they_were_switched_on_and_stop_when_let_go(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, preferences=SLOW_JOG)
    screen.power_up()
    keyboard = screen.page.keyboard
    with WebClient(mill, name="observer") as observer:
        screen.page.focus("body")
        keyboard.down("ArrowRight")
        keyboard.up("ArrowRight")
        screen.page.click("#keyboard-jog")
        assert observer.state["position"][0] == 0
        key = "ArrowRight"
        jog_until(lambda: far(observer), observer, lambda: keyboard.down(key), lambda: keyboard.up(key))
        keyboard.up(key)
        jog_ended(observer)
        there = observer.state["position"][0]
        screen.page.focus(".spindle input")
        keyboard.down("ArrowRight")
        keyboard.up("ArrowRight")
        screen.page.click("#keyboard-jog")
        assert observer.state["position"][0] == there, "keys belong to the field that has the focus"


def test_a_second_operator_sees_who_has_the_controls_and_asks_for_them(mill: int, open_screen: Any) -> None:
    first = open_screen(mill, preferences={"name": '"Bench"'})
    first.power_up()
    second = open_screen(mill, preferences={"name": '"Office"'})
    second.page.wait_for_selector("#operator:has-text('Bench')")
    second.page.wait_for_selector("[data-jog='X+']:disabled")
    second.page.wait_for_selector("#power:disabled")
    second.page.wait_for_selector("#estop:enabled")  # stopping is always allowed
    second.page.wait_for_selector("#stop:enabled")
    second.page.click("#operator")
    second.press("Ask for them", "dialog[open]")
    first.wait_text("Office asks for the controls.")
    first.press("Hand over", "dialog[open]")
    second.page.wait_for_selector("#operator:has-text('You have the controls')")
    first.page.wait_for_selector("#operator:has-text('Office')")
    first.page.wait_for_selector("[data-jog='X+']:disabled")


def test_a_reader_sees_everything_and_can_do_nothing(tmp_path: Path, open_screen: Any) -> None:
    token_file = tmp_path / "tokens"
    token_file.write_text(TOKENS)
    token_file.chmod(0o600)
    with web_mill(tmp_path, extra=f"[WEB]\nTOKEN_FILE = {token_file}") as (_, port):
        worker = open_screen(port, token="0123456789abcdef-operator")
        worker.power_up()
        worker.send_mdi("G0 X7")
        worker.wait_position("X", 7)
        reader = open_screen(port, token="0123456789abcdef-reader")
        reader.wait_position("X", 7)
        reader.page.wait_for_selector("#operator:has-text('Watching')")
        assert "token" not in reader.page.url, "the token does not stay in the address bar"
        for control in ("#estop", "#power", "#home-all", "[data-jog='X+']", "#run", "#stop"):
            reader.page.wait_for_selector(f"{control}:disabled")


def test_without_the_right_token_nothing_is_shown(tmp_path: Path, open_screen: Any) -> None:
    token_file = tmp_path / "tokens"
    token_file.write_text(TOKENS)
    token_file.chmod(0o600)
    with web_mill(tmp_path, extra=f"[WEB]\nTOKEN_FILE = {token_file}") as (_, port):
        screen = open_screen(port, wait=False)
        screen.wait_text("This machine asks for a token")
        assert screen.page.locator("#rail [role=tab]").count() == 0
        screen.page.fill("#offline input", "0123456789abcdef-operator")
        screen.press("Connect", "#offline")
        screen.wait_state("E-stop")
        screen.wait_loaded()


def test_an_abort_from_one_screen_stops_what_another_started(mill: int, open_screen: Any) -> None:
    first = open_screen(mill)
    first.power_up()
    second = open_screen(mill)
    first.send_mdi("G1 X250 F60")
    wait_until(lambda: second.position("X") > 2, "moving")
    second.page.click("#stop")
    second.wait_state("Ready")
    assert second.position("X") < 240


def test_a_gamepad_jogs_only_while_its_deadman_button_is_held(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, preferences=SLOW_JOG)
    screen.page.evaluate("""() => {
      const buttons = Array.from({length: 16}, () => ({pressed: false, value: 0}));
      window.pad = {connected: true, axes: [0, 0, 0, 0], buttons};
      navigator.getGamepads = () => [window.pad];
    }""")
    screen.power_up()
    with WebClient(mill, name="observer") as observer:
        screen.page.click("#gamepad-jog")
        screen.page.evaluate("window.pad.axes[0] = 0.8")
        screen.send_mdi("G0 Y1")
        screen.wait_position("Y", 1)
        screen.go("manual")
        assert observer.state["position"][0] == 0, "the stick alone does nothing"
        jog_until(lambda: far(observer), observer, lambda: deadman(screen, True), lambda: deadman(screen, False))
        deadman(screen, False)
        jog_ended(observer)


def deadman(screen: Any, held: bool) -> None:
    """The button of the gamepad without which its sticks do nothing."""
    screen.page.evaluate(f"window.pad.buttons[4].pressed = {'true' if held else 'false'}")
