"""A real browser on a real machine: Debian's chromium looks at the web display of a simulated mill.

Every test leaves a picture of its last moment in ``artefacts/browser``, for people to look at.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from typing import Any

import pytest

from tests.browser.screen import ARTEFACTS, TIMEOUT_MS, Screen
from tests.support.machine import ROOT

CHROMIUM = os.environ.get("PYEMC_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
ARGUMENTS = [
    "--no-sandbox",
    "--disable-dev-shm-usage",  # a container has little of it, and the machines live there
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-watchdog",  # which takes a busy computer for a graphics driver that hangs
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """All of this folder starts processes; without a browser it is skipped as a whole, with the reason."""
    try:
        import playwright  # noqa: F401
    except ImportError:
        reason = "Playwright is not installed (pip install pyemc[test])"
    else:
        reason = "" if CHROMIUM else "chromium is not installed (Debian's package chromium)"
    folder = ROOT / "tests" / "browser"
    for item in items:
        if folder not in item.path.parents:
            continue
        item.add_marker(pytest.mark.process)
        if reason:
            item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="package")
def chromium() -> Iterator[Any]:
    """One browser for all tests of this folder; while it is there, no other test could run a loop of asyncio."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS, timeout=TIMEOUT_MS)
        yield browser
        browser.close()


@pytest.fixture
def open_screen(chromium: Any, request: pytest.FixtureRequest) -> Iterator[Any]:
    """Open screens on a port: ``open_screen(port, size=(1280, 800), lang="en", token=None)``; closed afterwards.

    A test fails when one of its screens reported an error that no operator would see.
    """
    screens: list[Screen] = []

    def make(port: int, **options: Any) -> Screen:
        screen = Screen(chromium, port, **options)
        screens.append(screen)
        return screen

    yield make
    ARTEFACTS.mkdir(parents=True, exist_ok=True)
    problems = []
    for number, screen in enumerate(screens):
        name = request.node.name.replace("/", "_")
        screen.picture(f"{name}{f'-{number}' if number else ''}.png")
        problems += screen.problems
        screen.close()
    assert not problems
