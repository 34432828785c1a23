"""The page's files: small enough, whole, licensed, and harmless under a strict Content-Security-Policy."""

from __future__ import annotations

import re
from pathlib import Path

from gui import web

PAGE = Path(web.__file__).parent / "page"
LIMIT = 1_500_000  # bytes, vendored libraries included
IMPORT = re.compile(r"""(?:from|import)\s*\(?\s*["'](\.[^"']+)["']""")


def own(pattern: str) -> list[Path]:
    return [path for path in sorted(PAGE.rglob(pattern)) if "vendor" not in path.relative_to(PAGE).parts]


def test_the_whole_page_is_small() -> None:
    assert sum(path.stat().st_size for path in PAGE.rglob("*") if path.is_file()) < LIMIT


def test_every_vendored_library_brings_its_licence_and_is_listed() -> None:
    listed = (PAGE / "vendor" / "README.md").read_text()
    folders = [path for path in (PAGE / "vendor").iterdir() if path.is_dir()]
    assert folders
    for folder in folders:
        assert (folder / "LICENSE").exists(), folder.name
        assert f"| `{folder.name}` |" in listed


def test_markup_has_no_inline_scripts_styles_or_handlers() -> None:
    for path in own("*.html"):
        text = path.read_text()
        assert not re.search(r"<script(?![^>]*\bsrc=)", text)
        assert not re.search(r"<style|\sstyle=|\son\w+=", text)


def test_modules_never_turn_text_into_markup_or_code() -> None:
    for path in own("*.js"):
        assert not re.search(
            r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function", path.read_text()
        ), path


def test_nothing_is_loaded_from_elsewhere() -> None:
    for path in [*own("*.js"), *own("*.css"), *own("*.html"), *own("*.svg")]:
        text = path.read_text().replace("http://www.w3.org/", "")
        assert not re.search(r"https?://", text), path


def test_every_import_leads_to_a_file() -> None:
    for path in PAGE.rglob("*.*js"):
        for target in IMPORT.findall(path.read_text(errors="replace")):
            assert (path.parent / target).exists(), f"{path.name} imports {target}"


def test_every_panel_is_in_the_index() -> None:
    index = (PAGE / "panels" / "index.js").read_text()
    for path in (PAGE / "panels").glob("*.js"):
        if re.search(r"^registerPanel\(", path.read_text(), re.MULTILINE):
            assert f'"./{path.name}"' in index, path.name


def test_modules_open_with_what_they_are_for_and_stay_short() -> None:
    for path in own("*.js"):
        lines = path.read_text().splitlines()
        assert lines[0].startswith("/**"), path.name
        assert len(lines) < 500, path.name
