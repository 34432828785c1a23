"""One browser window on the web display, with the words of an operator: press, hold, open a page, read the position."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

from tests.support.machine import PATIENCE, ROOT, wait_until
from tests.support.webclient import WebClient

ARTEFACTS = ROOT / "artefacts" / "browser"
TABLET = (1280, 800)
PHONE = (390, 844)
TIMEOUT_MS = PATIENCE * 1000
LOADING_MS = 3 * TIMEOUT_MS  # the page is many files and compiles them
EXPECTED = re.compile(r"WebSocket connection|status of 409")  # a cut network; an upload that asks whether to replace
GRAPHICS = "GL Driver Message"
SLOW_JOG = {"jog.linear": "600"}  # mm/min; preferences of a screen whose jogs are far from the limits for half a minute
FILLED = {  # what a panel shows once the answers that it asks for when it is opened have come
    "path": ".path-tools",
    "offsets": "table.offsets tbody tr",
    "tools": "tr[data-tool]",
    "hal": ".hal-tree details",
    "scope": "#scope-start",
    "system": "table.system >> text=emcStatus",
}
PRESS_AGAIN = 2.0  # s without a jog until a button is pressed again


def module(text: str) -> Callable[[Any], None]:
    """Answers a request with this JavaScript in place of the server's."""
    return lambda route: route.fulfill(body=text, content_type="text/javascript")


def jog_until(
    reached: Callable[[], object], observer: WebClient, press: Callable[[], object], let_go: Callable[[], object]
) -> None:
    """Hold something that jogs until something is so while the machine is being jogged.

    A busy computer may be late with the signs of life, which ends a jog: then it is pressed again.
    """
    press()
    pressed = time.monotonic()

    def there() -> bool:
        nonlocal pressed
        if observer.state["jog"]:
            return bool(reached())
        if time.monotonic() - pressed > PRESS_AGAIN:
            let_go()
            press()
            pressed = time.monotonic()
        return False

    wait_until(there, "jogging")


class Screen:
    """A page of its own in a browser context of its own, so it shares no memory with other screens."""

    def __init__(
        self,
        browser: Any,
        port: int,
        *,
        size: tuple[int, int] = TABLET,
        lang: str = "en",
        token: str | None = None,
        touch: bool = False,
        theme: str = "dark",
        panel: str = "manual",
        wait: bool = True,
        preferences: dict[str, str] | None = None,
        files: dict[str, str] | None = None,
    ) -> None:
        self.problems: list[str] = []
        width, height = size
        self.context = browser.new_context(
            viewport={"width": width, "height": height},
            has_touch=touch,
            locale=lang,
            reduced_motion="reduce",  # colours have their values at once, not after a transition
        )
        self.context.set_default_timeout(TIMEOUT_MS)
        self.context.set_default_navigation_timeout(LOADING_MS)
        self.page = self.context.new_page()
        self.page.on("pageerror", lambda error: self.problems.append(f"page: {error}"))
        self.page.on("console", self._console)
        remembered = {"language": f'"{lang}"', "theme": f'"{theme}"', "panel": f'"{panel}"', **(preferences or {})}
        for name, value in remembered.items():
            self.context.add_init_script(f"localStorage['pyemc.{name}'] ??= {value!r}")
        for pattern, text in (files or {}).items():
            self.page.route(pattern, module(text))
        self.page.goto(f"http://127.0.0.1:{port}/" + (f"#token={token}" if token else ""))
        if wait:
            self.wait_loaded()

    def _console(self, message: Any) -> None:
        ignored = EXPECTED.search(message.text) or GRAPHICS in message.text
        if message.type in ("error", "warning") and not ignored:
            self.problems.append(f"console: {message.text}")

    def wait_loaded(self) -> None:
        """Wait for the page and, where it is shown at first, the picture; files that come in vain are errors."""
        self.page.wait_for_selector("#rail [role=tab]")
        if self.page.is_visible("#panel-path"):  # made together with the rail
            self.page.wait_for_selector(f"#panel-path {FILLED['path']}")

    # --- an operator's hands ---------------------------------------------------------------------------------------

    def go(self, panel: str) -> None:
        """Open a page of the rail, and wait for what it shows."""
        self.page.click(f"#tab-{panel}")
        self.page.wait_for_selector(f"#panel-{panel}:visible")
        if panel in FILLED:
            self.page.wait_for_selector(f"#panel-{panel} {FILLED[panel]}")

    def press(self, name: str, scope: str = "body") -> None:
        """Click the visible button with this name."""
        self.page.locator(scope).get_by_role("button", name=name, exact=True).locator("visible=true").first.click()

    def power_up(self) -> None:
        """Reset E-stop, switch on, home all."""
        self.page.click("#estop:has-text('Reset E-stop'):enabled")
        self.page.click("#power:enabled[aria-pressed=false]")
        self.page.wait_for_selector("#power[aria-pressed=true]")
        self.go("manual")
        self.page.click("#home-all:enabled")
        self.wait_state("Ready")

    def hold(self, selector: str) -> None:
        """Put the finger on a button and leave it there."""
        box = self.page.locator(selector).bounding_box()
        assert box is not None, selector
        self.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        self.page.mouse.down()

    def let_go(self) -> None:
        self.page.mouse.up()

    def hold_until(self, selector: str, reached: Callable[[], object], observer: WebClient) -> None:
        """Keep a finger on a jog button until something is so; it stays there."""
        jog_until(reached, observer, lambda: self.hold(selector), self.let_go)

    def type_expression(self, text: str) -> None:
        """Type into the field of an open dialog that has the focus, over what stands there."""
        self.page.wait_for_selector("dialog[open] input")
        self.page.keyboard.press("Control+A")
        self.page.keyboard.type(text)

    def open_program(self, name: str) -> None:
        self.go("program")
        self.page.click("#program-open:enabled")
        self.page.click(f".file button:has-text('{name}'):enabled")
        self.page.wait_for_selector(f"#run-state:has-text('{name}')")

    def send_mdi(self, line: str) -> None:
        self.go("mdi")
        self.page.fill("#mdi-line", line)
        self.page.click("#mdi-send:enabled")

    # --- an operator's eyes ----------------------------------------------------------------------------------------

    def state(self) -> str:
        return str(self.page.inner_text("#state-line"))

    def wait_state(self, text: str) -> None:
        self.page.wait_for_selector(f"#state-line:text-is('{text}')")

    def position(self, axis: str) -> float:
        """Work coordinate of an axis as the readout shows it."""
        return float(self.page.inner_text(f".readout .work[data-axis={axis}]"))

    def wait_position(self, axis: str, value: float) -> None:
        wait_until(lambda: abs(self.position(axis) - value) < 0.0005, f"{axis} at {value}, is {self.position(axis)}")

    def wait_text(self, text: str) -> None:
        """Wait until a visible element bears this text."""
        self.page.locator(f"text={text}").locator("visible=true").first.wait_for()

    def errors(self) -> list[str]:
        """Error notices that are on the screen."""
        return [str(text).strip() for text in self.page.locator("#toasts [data-kind=error] p").all_inner_texts()]

    def picture(self, name: str, **options: Any) -> None:
        """A screenshot among the artefacts."""
        ARTEFACTS.mkdir(parents=True, exist_ok=True)
        if not self.page.is_closed():
            self.page.screenshot(path=ARTEFACTS / name, **options)

    def close(self) -> None:
        self.context.close()
