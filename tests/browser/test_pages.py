"""The other pages, other sizes, other languages, and people who see or press differently."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from gui.web import displaykeys
from gui.web.wizard import make
from nml.inifile import IniFile
from tests.browser.screen import PHONE, TABLET
from tests.support.machine import ROOT, running, wait_until
from tests.support.webclient import WebClient, web_mill, web_port

PANELS = ["manual", "program", "mdi", "path", "offsets", "tools", "messages", "hal", "scope", "system"]
SQUARE = "G21 G90 G0 X0 Y0\nG1 X60 F1200\nY60\nX0\nY0\nM2\n"
OUTSIDE = "G21 G90 G0 X0 Y0\nG1 X60 F1200\nX310\nX0\nM2\n"
SMALLEST_TARGET = 44  # CSS pixels
# The names of what is pressed; marks inside a control are not controls.
SMALL_TARGETS = """
() => [...document.querySelectorAll("button, select, input:not([type=checkbox]):not([type=file]), [role=tab], summary")]
  .filter((element) => element.checkVisibility() && !element.closest("[hidden]"))
  .map((element) => [element.id || element.textContent.trim(), element.getBoundingClientRect()])
  .filter(([, box]) => box.width > 0 && (box.height < SIZE || box.width < SIZE))
  .map(([name, box]) => `${name}: ${box.width} x ${box.height}`)
""".replace("SIZE", str(SMALLEST_TARGET - 0.5))

# The store tells its watchers in one frame, and the text draws its choice in the next.
CHOSEN_LINE = """
async () => {
  for (let frame = 0; frame < 3; frame += 1) await new Promise(requestAnimationFrame);
  return document.querySelector(".program-text .line[aria-selected=true]")?.dataset.line;
}
"""


@pytest.fixture
def mill(tmp_path: Path) -> Iterator[int]:
    with web_mill(tmp_path, square=SQUARE, outside=OUTSIDE) as (_, port):
        yield port


def axe(screen: Any, part: str = "html", **options: Any) -> list[str]:
    """What axe-core finds wrong in a part of the screen now."""
    playwright_axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    wanted = {"resultTypes": ["violations"], **options}
    found = playwright_axe.Axe().run(screen.page, context=part, options=wanted).response["violations"]
    return [f"{one['id']}: {node['target']} {node['failureSummary']}" for one in found for node in one["nodes"]]


def test_no_page_has_accessibility_errors(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("square.ngc")
    problems = {"the whole page": axe(screen)}
    for panel in PANELS:
        screen.go(panel)
        problems[panel] = axe(screen, f"#panel-{panel}")
    assert not {place: found for place, found in problems.items() if found}


def test_the_light_theme_has_enough_contrast_too(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, theme="light")
    screen.power_up()
    contrast = {"runOnly": {"type": "rule", "values": ["color-contrast"]}}
    problems = {}
    for panel in PANELS:
        screen.go(panel)
        problems[panel] = axe(screen, "html" if panel == PANELS[0] else f"#panel-{panel}", **contrast)
    assert not {place: found for place, found in problems.items() if found}


def test_dialogs_have_no_accessibility_errors(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.page.click("[data-touchoff=X]")
    screen.page.wait_for_selector("dialog[open]:has-text('Touch off X')")
    assert not axe(screen)
    screen.page.keyboard.press("Escape")
    screen.page.click("#settings")
    screen.page.wait_for_selector("dialog[open]:has-text('Display settings')")
    assert not axe(screen)
    screen.page.keyboard.press("Escape")
    screen.go("tools")
    screen.page.get_by_role("button", name="Edit T4").click()
    screen.page.wait_for_selector("dialog[open]:has-text('Tool T4')")
    assert not axe(screen)


@pytest.mark.parametrize("size", [TABLET, PHONE], ids=["tablet", "phone"])
def test_everything_that_is_pressed_is_large_enough_for_gloves(mill: int, open_screen: Any, size: Any) -> None:
    screen = open_screen(mill, size=size, touch=True)
    screen.power_up()
    small = {}
    for panel in PANELS:
        screen.go(panel)
        if found := screen.page.evaluate(SMALL_TARGETS):
            small[panel] = found
    assert not small


def test_a_phone_shows_every_page_without_scrolling_sideways(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, size=PHONE, touch=True)
    screen.power_up()
    screen.open_program("square.ngc")
    for panel in PANELS:
        screen.go(panel)
        screen.picture(f"phone-{panel}.png")
        width = screen.page.evaluate("document.documentElement.scrollWidth")
        assert width <= PHONE[0], f"{panel} is {width} wide"
        assert screen.page.is_visible("#estop")
        assert screen.page.is_visible("#stop")


def test_german_replaces_every_english_word_of_the_frame(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill, lang="de")
    screen.wait_state("Not-Halt")
    assert screen.page.get_attribute("html", "lang") == "de"
    tabs = screen.page.locator("#rail [role=tab]").all_inner_texts()
    assert [tab.strip() for tab in tabs][:4] == ["Hand", "Programm", "MDI", "Bahn"]
    screen.page.click("#estop")
    screen.wait_state("Maschine aus")
    screen.go("mdi")
    screen.picture("german-mdi.png")


def test_the_keyboard_alone_reaches_every_control(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.wait_state("E-stop")
    page = screen.page
    page.wait_for_selector("#estop:enabled")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "estop"
    page.keyboard.press("Enter")
    screen.wait_state("Machine off")
    page.wait_for_selector("#power:enabled")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "power"
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert outline == "solid", "the focus is visible"
    page.keyboard.press("Space")
    screen.wait_state("Not homed")
    page.focus("#tab-manual")
    page.keyboard.press("ArrowDown")
    page.wait_for_selector("#panel-program:visible")
    page.keyboard.press("ArrowUp")
    page.wait_for_selector("#panel-manual:visible")
    page.focus("#home-all:enabled")
    page.keyboard.press("Enter")
    screen.wait_state("Ready")
    screen.press("1 mm", ".increments")
    page.focus("[data-jog='X+']:enabled")
    page.keyboard.press("Enter")
    screen.wait_position("X", 1)


def test_the_tool_path_shows_the_program_and_finds_a_line(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("square.ngc")
    screen.page.wait_for_selector(".path-notice[data-state=whole]:has-text('Within the limits')")
    screen.press("View Z")

    def chosen() -> str | None:
        """The line that the first click on something across the middle chooses."""
        box = screen.page.locator(".canvas").bounding_box()
        assert box is not None
        for x in range(int(box["x"]) + 4, int(box["x"] + box["width"]) - 4, 6):
            screen.page.mouse.click(x, box["y"] + box["height"] / 2)
            line: str | None = screen.page.evaluate(CHOSEN_LINE)
            if line:
                return line
        return None

    wait_until(lambda: chosen() in ("3", "5"), "one of the sides that cross the middle, once the view is drawn")


def test_a_program_that_leaves_the_machine_is_announced_before_it_runs(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.open_program("outside.ngc")
    screen.page.click(".path-notice button.danger:has-text('leaves the machine')")
    screen.press("Line 3: X 310.000, limit 300.000", "dialog[open]")
    screen.page.wait_for_selector(".program-text .line[aria-selected=true][data-line='3']")


def test_a_message_stays_in_the_list_after_its_notice_was_closed(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.send_mdi("(MSG, look at the coolant)")
    screen.wait_text("look at the coolant")
    screen.press("Close", "#toasts")
    screen.go("messages")
    screen.page.wait_for_selector(".message:has-text('look at the coolant')")


def test_hal_values_live_on_the_page(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.go("hal")
    screen.page.fill("#hal-filter", "joint.0.pos-cmd")
    value = ".hal-item[data-name='joint.0.pos-cmd'] .value"
    screen.page.wait_for_selector(f"{value}:text-is('0')")
    with WebClient(mill, name="helper") as helper:
        screen.page.click("#operator")
        screen.press("Release", "dialog[open]")
        helper.wait(lambda state: state["control"] is None, "controls are free")
        helper.call("control.take")
        helper.call("mdi.run", text="G0 X12.5")
    screen.page.wait_for_selector(f"{value}:text-is('12.5')")
    screen.press("Graph of nets")
    screen.page.fill("#hal-filter", "")
    screen.page.wait_for_selector(".hal-graph .node:has-text('iocontrol.0')")


def test_the_scope_draws_what_was_recorded(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.power_up()
    screen.go("scope")
    screen.page.click("#scope-start")
    screen.page.wait_for_selector(".uplot canvas")
    screen.wait_text("joint.0.pos-cmd")


def test_the_system_page_names_processes_buffers_and_threads(mill: int, open_screen: Any) -> None:
    screen = open_screen(mill)
    screen.go("system")
    for table, name in (("Processes", "task"), ("NML buffers", "emcStatus"), ("Realtime threads", "servo-thread")):
        screen.page.get_by_role("table", name=table).get_by_text(name).first.wait_for()


def test_display_keys_reach_the_page(tmp_path: Path, open_screen: Any) -> None:
    keys = """RELATIVE
TITLE = Router in hall 3
INCREMENTS = 5 mm, 1/4 in
EMBED_TAB_NAME = Camera
EMBED_TAB_COMMAND = http://127.0.0.1:9/camera
EMBED_TAB_LOCATION = tab"""
    commands = "[MDI_COMMAND_LIST]\nMDI_COMMAND = G0 X0 Y0,To\\nzero"
    with web_mill(tmp_path, changes={"DISPLAY.POSITION_OFFSET": keys}, extra=commands) as (_, port):
        screen = open_screen(port)
        screen.power_up()
        assert screen.page.title() == "Router in hall 3"
        increments = screen.page.locator(".increments button").all_inner_texts()
        assert increments == ["Hold", "5 mm", "1/4 in"]
        screen.send_mdi("G0 X9")
        screen.wait_position("X", 9)
        screen.go("manual")
        screen.page.click(".mdi-command")
        screen.wait_position("X", 0)
        assert "Camera" in screen.page.inner_text("#rail")


def test_a_lathe_shows_diameters_and_its_own_jog_pad(tmp_path: Path, open_screen: Any) -> None:
    with web_mill(tmp_path, changes={"DISPLAY.POSITION_OFFSET": "RELATIVE\nMACHINE_TYPE_HINT = lathe"}) as (_, port):
        screen = open_screen(port)
        screen.power_up()
        screen.send_mdi("G7 G0 X10")
        wait_until(lambda: screen.page.inner_text(".readout tr[data-axis=X] .letter") == "X⌀", "diameter mode")
        screen.wait_position("X", 10)
        screen.send_mdi("G8")
        screen.wait_position("X", 5)
        screen.go("manual")
        z_minus = screen.page.locator("[data-jog='Z-']").bounding_box()
        z_plus = screen.page.locator("[data-jog='Z+']").bounding_box()
        assert z_minus is not None
        assert z_plus is not None
        assert z_minus["y"] == z_plus["y"], "Z lies"


def test_a_foam_cutter_is_shown_with_both_ends_of_its_wire(tmp_path: Path, open_screen: Any) -> None:
    ini, wrong = make.generate({"machine_type": "foam", "axes": "XYUV", "spindles": False}, "foam", tmp_path)
    assert wrong == []
    ini.write_text(ini.read_text().replace("DISPLAY = web", "DISPLAY = web --port 0 --no-browser"))
    with running(ini) as run:
        screen = open_screen(web_port(run))
        screen.power_up()
        rows = screen.page.locator(".readout tr[data-axis]")
        assert [rows.nth(number).get_attribute("data-axis") for number in range(rows.count())] == list("XYUV")
        screen.send_mdi("G0 X10 Y5 U20 V6")
        screen.wait_position("U", 20)
        screen.go("path")
        screen.page.wait_for_selector(".canvas canvas")
        parts = displaykeys.geometry(IniFile(ini))
        assert screen.page.evaluate(POINTS_OF, [parts, POSE]) == [[1, 2, 0], [7, 8, 1.5]]


POSE = [1, 2, 3, 0, 0, 90, 7, 8, 9]
POINTS_OF = "async ([parts, pose]) => new (await import('/page/path/shape.js')).Shape(parts, 1).pointsOf(pose)"


@pytest.mark.parametrize(
    ("entry", "points"),
    [
        ("XYZABCUVW", [[1 - 8, 2 + 7, 3 + 9]]),  # UVW turn with C, XYZ do not
        ("CXYZ", [[-2, 1, 3]]),
        ("-CXYZ", [[2, -1, 3]]),
        ("XYZ-W", [[1, 2, 3 - 9]]),
    ],
)
def test_the_picture_follows_the_geometry_of_the_ini_file(
    mill: int, open_screen: Any, tmp_path: Path, entry: str, points: list[list[float]]
) -> None:
    text = (tmp_path / "mill_mm.ini").read_text().replace("COORDINATES = X Y Z", "COORDINATES = X Y Z A B C U V W")
    (tmp_path / "all.ini").write_text(text.replace("[DISPLAY]", f"[DISPLAY]\nGEOMETRY = {entry}"))
    screen = open_screen(mill)
    found = screen.page.evaluate(POINTS_OF, [displaykeys.geometry(IniFile(tmp_path / "all.ini")), POSE])
    assert found == [pytest.approx(point) for point in points]


def test_the_grid_and_the_icon_of_the_ini_file_are_used(tmp_path: Path, open_screen: Any) -> None:
    (tmp_path / "shop.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    keys = "RELATIVE\nGRIDS = 5 mm, 1 in\nICON = shop.svg"
    with web_mill(tmp_path, changes={"DISPLAY.POSITION_OFFSET": keys}) as (_, port):
        screen = open_screen(port, panel="path")
        grid = screen.page.get_by_label("Grid", exact=True)
        options = grid.locator("option")
        wait_until(lambda: options.all_inner_texts() == ["No grid", "5 mm", "1 in"], "the grids of the INI file")
        grid.select_option("25.4")
        screen.page.wait_for_selector("link[rel=icon][href^='data:image/svg+xml;base64,']", state="attached")


def test_the_panel_of_the_guide_appears_in_the_rail(mill: int, open_screen: Any) -> None:
    guide = (ROOT / "docs" / "web-panel.md").read_text()
    module = guide.partition("```js\n")[2].partition("```")[0]
    index = (ROOT / "gui" / "web" / "page" / "panels" / "index.js").read_text()
    added = {"parts.js": module, "index.js": index + 'import "./parts.js";\n'}
    screen = open_screen(mill, files={f"**/page/panels/{name}": text for name, text in added.items()})
    screen.go("parts")
    screen.page.wait_for_selector("#panel-parts output:text-is('0')")
    assert not axe(screen)
