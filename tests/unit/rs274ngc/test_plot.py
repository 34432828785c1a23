"""``rs274 --plot``: a picture, and a page with the moves in it; the progress bar."""

import base64
import json
import re

import numpy as np
import pytest

from rs274ngc import __main__ as rs274

PROGRAM = "g21 f100\ng0 x10 y5\ng1 z-2\ng2 x20 i5\nm2\n"


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "part.ngc"
    path.write_text(PROGRAM)
    return path


def test_a_page_has_all_moves_and_needs_no_network(program, tmp_path):
    page = tmp_path / "part.html"
    assert rs274.main([str(program), "--plot", str(page)]) == 0
    text = page.read_text()
    assert not re.search(r"https?://|src=", text)
    data = json.loads(re.search(r"const data = (\{.*\});\n", text)[1])
    points = np.frombuffer(base64.b64decode(data["points"]), "<f4").reshape(-1, 2, 3)
    lines = np.frombuffer(base64.b64decode(data["lines"]), "<i4")
    assert set(lines) == {2, 3, 4}
    assert points[1].tolist() == [[10.0, 5.0, 0.0], [10.0, 5.0, -2.0]]
    assert np.allclose(points[1:, 0], points[:-1, 1])


def test_a_picture_is_a_png(program, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "part.png"
    assert rs274.main([str(program), "--plot", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_an_empty_program_can_be_plotted(tmp_path):
    empty = tmp_path / "empty.ngc"
    empty.write_text("m2\n")
    pytest.importorskip("matplotlib")
    for name in ("out.html", "out.png"):
        assert rs274.main([str(empty), "--plot", str(tmp_path / name)]) == 0


def test_another_kind_of_file_is_refused(program, capsys):
    assert rs274.main([str(program), "--plot", "part.bmp"]) == 1
    assert "--plot part.bmp: the name must end in .png or .html" in capsys.readouterr().err


def test_a_long_program_shows_its_progress_on_a_terminal(program, monkeypatch):
    monkeypatch.setattr(rs274, "LONG_BYTES", 10)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with rs274.progress_bar(str(program)) as progress:
        assert progress is not None
        progress(0.5)


def test_a_short_program_or_a_pipe_shows_no_bar(program):
    with rs274.progress_bar(str(program)) as progress:
        assert progress is None
