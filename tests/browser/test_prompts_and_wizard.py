"""Messages that HAL pins bring up, and the page that makes configurations where no machine runs."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from nml import namespace
from tests.browser.screen import TIMEOUT_MS
from tests.support.machine import ROOT, wait_until
from tests.support.webclient import web_mill

MESSAGES = """RELATIVE
MESSAGE_BOLDTEXT = Door
MESSAGE_TEXT = Is the door closed?
MESSAGE_DETAILS = The spindle waits for it.
MESSAGE_TYPE = yesnodialog
MESSAGE_PINNAME = door
MESSAGE_BOLDTEXT = Oil
MESSAGE_TEXT = The oil is low
MESSAGE_DETAILS =
MESSAGE_TYPE = status
MESSAGE_PINNAME = oil"""


def halcmd(*words: str) -> str:
    command = [sys.executable, "-m", "hal.halcmd", *words]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout.strip()


def test_a_question_of_a_hal_pin_is_answered_on_the_screen(tmp_path: Path, open_screen: Any) -> None:
    with web_mill(tmp_path, changes={"DISPLAY.POSITION_OFFSET": MESSAGES}) as (_, port):
        screen = open_screen(port)
        screen.power_up()
        halcmd("setp", "web.door", "1")
        screen.page.wait_for_selector("dialog[open]:has-text('Is the door closed?')")
        assert halcmd("getp", "web.door-waiting") == "TRUE"
        screen.press("Yes", "dialog[open]")
        screen.page.wait_for_selector("dialog[open]", state="detached")
        wait_until(lambda: halcmd("getp", "web.door-response") == "TRUE", "the answer is on the pin")
        halcmd("setp", "web.oil", "1")
        screen.page.wait_for_selector("#toasts .notice:has-text('The oil is low')")
        halcmd("setp", "web.oil", "0")
        screen.page.wait_for_selector("#toasts .notice:has-text('The oil is low')", state="detached")


def test_the_wizard_makes_a_configuration_that_starts(tmp_path: Path, open_screen: Any) -> None:
    environment = os.environ | {"HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "gui.web", "--wizard", "--port", "0", "--no-browser"]
    process = subprocess.Popen(command, env=environment, cwd=tmp_path, start_new_session=True)
    try:
        path = namespace.runtime_dir() / "web.port"
        wait_until(lambda: process.poll() is not None or (path.exists() and path.read_text().strip()), "wizard")
        screen = open_screen(int(path.read_text()), panel="wizard")
        page = screen.page
        screen.go("samples")
        page.wait_for_selector("[data-sample]")
        screen.go("wizard")
        page.get_by_label("X: Least position").fill("500")
        page.get_by_label("X: Greatest position").fill("100")
        page.click("#wizard-make")
        page.wait_for_selector(".wizard-form .error:not(:empty)")
        page.get_by_label("X: Least position").fill("-10")
        page.get_by_label("Name of the folder").fill("from-the-page")
        screen.picture("wizard.png", full_page=True)
        page.click("#wizard-make")
        page.wait_for_selector("text=The configuration is in")
        made = next(tmp_path.rglob("from-the-page/*.ini"))
        assert {file.suffix for file in made.parent.iterdir()} >= {".ini", ".hal", ".tbl"}
    finally:
        process.terminate()
        process.wait(TIMEOUT_MS / 1000)
