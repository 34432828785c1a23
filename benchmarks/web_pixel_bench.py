#!/usr/bin/env python3
"""How soon a change of the machine is on the screen: from an order given elsewhere to the picture that shows it.

    python benchmarks/web_pixel_bench.py

A simulated mill, its web display in headless chromium with software graphics, the tool path beside the manual page.
Another client sets the feed override; the page notes the time of the first frame after its readout has changed, and is
not asked for it before all orders are given, so that the asking delays nothing. The machine's own time (task takes the
order, status goes out) and the server's cycle are included; ``to the readout`` ends when the page has set the text. The
figures are those of a machine at rest; the load that there was is printed with them.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from playwright.sync_api import sync_playwright

import linuxcnc
from nml import namespace
from tests.browser.conftest import ARGUMENTS, CHROMIUM
from tests.browser.screen import Screen
from tests.support.machine import wait_until
from tests.support.webclient import web_mill

ROUNDS = 60
PAUSE = 0.13  # s between two orders, so that they meet the server at any moment of its cycle
NOTE_FRAMES = """
() => {
  const shown = document.querySelector(".override output");
  const now = () => (performance.timeOrigin + performance.now()) / 1000;
  window.frames_seen = [];
  new MutationObserver(() => {
    const [text, set] = [shown.textContent, now()];
    requestAnimationFrame(() => setTimeout(() => window.frames_seen.push([text, set, now()])));
  }).observe(shown, {childList: true, characterData: true, subtree: true});
}
"""


def latencies(screen: Screen) -> tuple[list[float], list[float]]:
    """ms from each order to the text and to the frame that show it."""
    command = linuxcnc.command()
    screen.page.evaluate(NOTE_FRAMES)
    orders = []
    for number in range(ROUNDS):
        percent = 10 + number
        orders.append((f"{percent} %", time.time()))
        command.feedrate(percent / 100)
        time.sleep(PAUSE)
    wait_until(lambda: screen.page.evaluate("window.frames_seen.at(-1)?.[0]") == orders[-1][0], "the last frame")
    seen = {text: times for text, *times in screen.page.evaluate("window.frames_seen")}
    missed = sum(text not in seen for text, _ in orders)
    if missed:
        print(f"{missed} orders were followed by the next one before their frame was drawn: the machine is not at rest")
    pairs = [(seen[text][0] - began, seen[text][1] - began) for text, began in orders if text in seen]
    return [1000 * text for text, _ in pairs], [1000 * frame for _, frame in pairs]


def row(name: str, found: list[float]) -> str:
    """Median, 95 % and worst of some times, ms."""
    late = sorted(found)[int(0.95 * len(found))]
    return f"{name:<16} median {statistics.median(found):4.0f} ms, 95 % {late:4.0f} ms, worst {max(found):4.0f} ms"


def main() -> None:
    os.environ[namespace.VARIABLE] = f"bench{os.getpid()}"
    with (
        tempfile.TemporaryDirectory() as folder,
        web_mill(Path(folder)) as (_, port),
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        screen = Screen(browser, port)
        screen.power_up()
        text, frame = latencies(screen)
        browser.close()
    print(row("to the readout:", text))
    print(row("to the pixel:", frame) + "; wanted: 100 ms")
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


if __name__ == "__main__":
    main()
