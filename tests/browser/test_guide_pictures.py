"""Makes the pictures of docs/operator.md on a real machine, so that the guide shows what there is.

They land in ``artefacts/browser/guide``. ``PYEMC_GUIDE_PICTURES=1 pytest tests/browser/test_guide_pictures.py`` also
puts them into ``docs/pictures``, as WebP.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.browser.screen import ARTEFACTS, PHONE, Screen
from tests.browser.test_programs import BY_HAND, TOOLS
from tests.support.machine import PROGRAMS, ROOT, wait_until
from tests.support.webclient import web_mill

GUIDE = ROOT / "docs" / "operator.md"
PICTURES = ROOT / "docs" / "pictures"
WANTED = re.compile(r"\(pictures/(operator_\w+)\.webp\)")
QUALITY = 82  # of WebP; text stays sharp


def take(screen: Screen, name: str) -> None:
    """One picture of the guide."""
    folder = ARTEFACTS / "guide"
    folder.mkdir(parents=True, exist_ok=True)
    screen.page.wait_for_timeout(500)  # the tool path is drawn a moment after its data came
    screen.page.screenshot(path=folder / f"operator_{name}.png")
    if os.environ.get("PYEMC_GUIDE_PICTURES"):
        image = pytest.importorskip("PIL.Image").open(folder / f"operator_{name}.png")
        image.convert("RGB").save(PICTURES / f"operator_{name}.webp", quality=QUALITY, method=6)


def test_the_guide_shows_what_the_pages_look_like(tmp_path: Path, open_screen: Any) -> None:
    shutil.rmtree(ARTEFACTS / "guide", ignore_errors=True)
    with web_mill(tmp_path, hal=BY_HAND, tools=TOOLS) as (_, port):
        for path in PROGRAMS.glob("*.ngc"):
            shutil.copy(path, tmp_path / "nc")
        screen = open_screen(port, preferences={"name": '"Bench"'})
        screen.wait_state("E-stop")
        take(screen, "start")
        screen.power_up()
        screen.open_program("contour_pockets.ngc")
        screen.page.wait_for_selector(".path-notice[data-state=whole]")
        take_the_hands(screen)
        take_the_program(screen)
        take_the_tables(screen)
        take_the_inside(screen)
        phone = open_screen(port, size=PHONE, touch=True, theme="light", lang="de")
        phone.page.wait_for_selector("#operator[aria-label=Bench]")
        take(phone, "phone")
    wanted = set(WANTED.findall(GUIDE.read_text()))
    made = {path.stem for path in (ARTEFACTS / "guide").glob("operator_*.png")}
    assert wanted
    assert wanted == made


def take_the_hands(screen: Screen) -> None:
    """Manual page, touch-off, MDI."""
    screen.go("manual")
    take(screen, "manual")
    screen.page.click("[data-touchoff=X]")
    screen.type_expression("10+25.4/2")
    take(screen, "touchoff")
    screen.page.keyboard.press("Enter")
    screen.wait_position("X", 22.7)
    screen.go("mdi")
    screen.page.fill("#mdi-line", "G0 X400")
    screen.page.wait_for_selector(".verdict[data-kind=warn]")
    take(screen, "mdi")
    screen.send_mdi("G0 X0 Y0 Z20")
    screen.wait_position("Z", 20)


def take_the_program(screen: Screen) -> None:
    """A program that asks for a tool, runs, is stopped, and is taken up again from a line."""
    screen.go("program")
    screen.page.click("#run:enabled")
    screen.page.wait_for_selector("dialog[open] .tool-number")
    take(screen, "tool_change")
    screen.press("Tool is in", "dialog[open]")
    wait_until(lambda: screen.position("Z") < 0, "cutting")
    take(screen, "program")
    screen.page.click("#stop")
    screen.wait_state("Ready")
    screen.open_program("tools.ngc")
    screen.page.click(".program-text .line[data-line='5']:has-text('G1 X0')")
    screen.page.click("#run-from:enabled")
    screen.page.wait_for_selector("dialog[open] .differences")
    take(screen, "run_from")
    screen.press("Cancel", "dialog[open]")


def take_the_tables(screen: Screen) -> None:
    """Offsets and tools."""
    screen.go("offsets")
    screen.page.wait_for_selector("table.offsets tr.current")
    take(screen, "offsets")
    screen.go("tools")
    screen.page.get_by_role("button", name="Edit T4").click()
    take(screen, "tool_edit")
    screen.press("Cancel", "dialog[open]")


def take_the_inside(screen: Screen) -> None:
    """HAL, scope, system."""
    screen.go("hal")
    screen.page.fill("#hal-filter", "joint.0")
    screen.page.wait_for_selector(".hal-item[data-name='joint.0.pos-cmd']")
    take(screen, "hal")
    screen.go("scope")
    screen.page.click("#scope-start")
    screen.page.wait_for_selector(".uplot canvas")
    take(screen, "scope")
    screen.go("system")
    screen.page.get_by_role("table", name="NML buffers").get_by_text("emcStatus").wait_for()
    take(screen, "system")
