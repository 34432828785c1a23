"""Tool table files: what is read, and that saving touches nothing but the values that changed."""

import os
import stat

import pytest

from emcio.tooltable import Tool, ToolFile, format_line, parse_line, replace_file, update_line
from nml.errors import ConfigError

TABLE = """\
; the shop's tools
T1  P17 Z0.511   D3     ;3mm end mill
T2 P4 Z+0.1 D.5 K7 ;drill; with a second semicolon

T99999 P1 X-1.5 Q2 I95 J155 ;turning tool
"""


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "tool.tbl"
    path.write_text(TABLE)
    return ToolFile(path)


def test_every_word_of_a_line_arrives(table):
    tool = table.tools[2]
    assert (tool.toolno, tool.pocketno, tool.offset[0], tool.orientation) == (99999, 1, -1.5, 2)
    assert (tool.frontangle, tool.backangle, tool.remark) == (95.0, 155.0, "turning tool")
    assert [t.toolno for t in table.tools] == [1, 2, 99999]


def test_saving_unchanged_tools_changes_no_character(table):
    assert table.render(table.tools) == TABLE


def test_only_the_changed_word_of_a_line_is_written_anew(table):
    table.tools[0].offset[2] = -12.25
    lines = table.render(table.tools).splitlines()
    assert lines[1] == "T1  P17 Z-12.250000   D3     ;3mm end mill"
    assert lines[2:] == TABLE.splitlines()[2:]


def test_a_word_that_was_not_there_is_put_before_the_remark(table):
    table.tools[1].offset[0] = 1.0
    assert table.render(table.tools).splitlines()[2] == "T2 P4 Z+0.1 D.5 K7 X+1.000000 ;drill; with a second semicolon"


def test_a_value_that_becomes_zero_is_written_as_zero():
    assert update_line("T1 P1 Z5", Tool(toolno=1, pocketno=1)) == "T1 P1 Z+0.000000"


def test_a_new_tool_gets_a_line_of_its_own(table):
    table.tools.append(Tool(toolno=7, pocketno=8, diameter=2.0, remark="new"))
    assert table.render(table.tools).splitlines()[-1] == "T7 P8 D+2.000000 ;new"


def test_a_formatted_line_reads_back_as_the_same_tool():
    tool = Tool(3, 4, [1.5, 0, -2, 0, 0, 0, 0, 0, 9], 6.0, 10.0, 20.0, 5, "chamfer")
    assert parse_line(format_line(tool)) == tool


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("T1 P1 Zabc", "1: 'Zabc' is no word of a tool table"),
        ("T1.5 P1", "1: 'T1.5': a whole number is needed"),
        ("P1 Z3", "1: a tool needs a tool number"),
        ("T1 Z3", "1: a tool needs a pocket number"),
        ("T1 P1\nT1 P2", "2: T1 is in line 1 already"),
    ],
)
def test_a_wrong_line_is_left_out_and_named_with_file_line_and_remedy(tmp_path, line, complaint):
    path = tmp_path / "tool.tbl"
    path.write_text(line + "\nT9 P9\n")
    table = ToolFile(path)
    assert [remark for remark in table.remarks if remark.startswith(f"{path}:{complaint}")]
    assert table.tools[-1].toolno == 9
    assert table.render(table.tools) == line + "\nT9 P9\n"


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match="cannot be read"):
        ToolFile(tmp_path / "none.tbl")


def test_replacing_keeps_rights_and_follows_links_and_leaves_no_other_file(tmp_path):
    real, link = tmp_path / "real.tbl", tmp_path / "link.tbl"
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    replace_file(link, "new")
    assert real.read_text() == "new"
    assert link.is_symlink()
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert sorted(os.listdir(tmp_path)) == ["link.tbl", "real.tbl"]


def test_a_failed_replacement_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "tool.tbl"
    path.write_text("old")

    def full(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        replace_file(path, "new")
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["tool.tbl"]


def test_text_that_is_no_utf8_survives(tmp_path):
    path = tmp_path / "tool.tbl"
    path.write_bytes(b"T1 P1 Z1 ;Schaftfr\xe4ser\n")
    table = ToolFile(path)
    table.tools[0].offset[2] = 2.0
    replace_file(path, table.render(table.tools))
    assert path.read_bytes() == b"T1 P1 Z+2.000000 ;Schaftfr\xe4ser\n"
