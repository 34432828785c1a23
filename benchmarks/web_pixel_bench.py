#!/usr/bin/env python3
"""How soon a change of the machine is on the screen: from an order given elsewhere to the picture that shows it.

    python benchmarks/web_pixel_bench.py

A simulated mill, its web display in headless chromium with software graphics, the tool path beside the manual page.
Another client sets the feed override; the page notes the time of the first frame after its readout has changed. The
machine's own time (task takes the order, status goes out) and the server's cycle are included.
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
from tests.support.webclient import web_mill

ROUNDS = 60
PAUSE = 0.13  # s between two orders, so that they meet the server at any moment of its cycle
NOTE_FRAMES = """
() => {
  const shown = document.querySelector(".override output");
  window.frames_seen = [];
  new MutationObserver(() => requestAnimationFrame(() => setTimeout(() => {
    window.frames_seen.push([shown.textContent, (performance.timeOrigin + performance.now()) / 1000]);
  }))).observe(shown, {childList: true, characterData: true, subtree: true});
}
"""


def latencies(screen: Screen) -> list[float]:
    """ms from each order to the frame that shows it."""
    command = linuxcnc.command()
    screen.page.evaluate(NOTE_FRAMES)
    found = []
    for number in range(ROUNDS):
        percent = 50 + number % 2 * 25
        began = time.time()
        command.feedrate(percent / 100)
        while not (seen := screen.page.evaluate("window.frames_seen.at(-1)")) or seen[0] != f"{percent} %":
            time.sleep(0.01)
        found.append(1000 * (seen[1] - began))
        time.sleep(PAUSE)
    return found


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
        found = sorted(latencies(screen))
        browser.close()
    worst, late = found[-1], found[int(0.95 * len(found))]
    median = statistics.median(found)
    print(f"status to pixel: median {median:.0f} ms, 95 % {late:.0f} ms, worst {worst:.0f} ms; wanted: 100 ms")


if __name__ == "__main__":
    main()
