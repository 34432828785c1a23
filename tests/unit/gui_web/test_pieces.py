"""The pieces of the web server that need no machine: frames, calls, state, calculator, tool table, jog arithmetic."""

import asyncio
import re
from pathlib import Path
from types import SimpleNamespace

import msgpack
import pytest

import gui.web.methods
import gui.web.wizard.methods  # noqa: F401  registers its methods too
from gui.web import frames, texts, tooltable
from gui.web.access import Access, Role
from gui.web.calculator import calculate
from gui.web.calls import METHODS, Caller, CallError, Method, Right, _parameters, perform
from gui.web.dialogs import questions
from gui.web.hub import Hub
from gui.web.jogging import AHEAD, TICK, Target, extension
from gui.web.loaded import ProgramText
from gui.web.messages import Messages
from gui.web.programfolder import ProgramFolder
from gui.web.settings import Settings
from gui.web.state import State
from gui.web.store import MdiHistory, Preferences
from nml.errors import ConfigError
from nml.inifile import IniFile

# --- frames and calls ------------------------------------------------------------------------------------------------


def test_a_frame_comes_back_as_it_was_sent():
    assert frames.decode(frames.encode("call", {"id": 1, "m": "x"})) == {"t": "call", "id": 1, "m": "x"}


@pytest.mark.parametrize(
    "data", [b"", b"\xc1", b"\x01", msgpack.packb({"x": 1}), msgpack.packb({"t": 1}), msgpack.packb({1: 2, "t": "x"})]
)
def test_what_is_no_frame_is_refused(data):
    with pytest.raises(frames.BadFrame):
        frames.decode(data)


async def _example(caller, number: int, ratio: float, name: str | None = None, what: float | str = 0.0) -> None:
    """A method for tests."""


EXAMPLE = Method("example", Right.ANYBODY, _example, _parameters(_example))


@pytest.mark.parametrize(
    ("given", "taken"),
    [
        ({"number": 1, "ratio": 2}, {"number": 1, "ratio": 2.0}),
        ({"number": 1, "ratio": 2.5, "name": None}, {"number": 1, "ratio": 2.5}),
        ({"number": 1, "ratio": 1.0, "name": "x", "what": "a"}, {"number": 1, "ratio": 1.0, "name": "x", "what": "a"}),
    ],
)
def test_arguments_of_the_right_type_are_taken(given, taken):
    assert EXAMPLE.arguments(given) == taken


@pytest.mark.parametrize(
    "given",
    [
        None, [], {"number": 1}, {"number": 1.0, "ratio": 1.0}, {"number": True, "ratio": 1.0},
        {"number": 1, "ratio": float("nan")}, {"number": 1, "ratio": "1"}, {"number": 1, "ratio": 1.0, "extra": 1},
        {"number": 1, "ratio": 10**30},
    ],
)  # fmt: skip
def test_arguments_that_are_wrong_are_named(given):
    with pytest.raises(CallError) as refused:
        EXAMPLE.arguments(given)
    assert refused.value.code == "argument"


METHOD_NAME = re.compile(r"`([a-z_]+(?:\.[a-z_0-9]+)?)`")
METHOD_ROW = re.compile(r"\| (?:[ROC] \| )?`[a-z_]+(?:\.[a-z_0-9]+)?`")


def test_every_documented_method_exists_and_every_method_is_documented():
    text = (Path(__file__).parents[3] / "docs" / "web-protocol.md").read_text()
    cells = [line.split(" | ")[1] if line[2] in "ROC" else line for line in text.splitlines() if METHOD_ROW.match(line)]
    documented = {name for cell in cells for name in METHOD_NAME.findall(cell.split(" | ")[0])}
    assert set(METHODS) - documented == set()
    assert {name for name in documented if "." in name} - set(METHODS) == set()


# --- state -----------------------------------------------------------------------------------------------------------


def test_listeners_hear_only_what_has_changed():
    state, heard = State(), []
    state.listen(heard.append)
    state.update({"a": 1, "b": [1, 2]})
    state.update({"a": 1, "b": [1, 3]})
    state.update({"a": 1})
    state.bump("c")
    assert heard == [{"a": 1, "b": [1, 2]}, {"b": [1, 3]}, {"c": 1}]


# --- access ----------------------------------------------------------------------------------------------------------


def settings(**changes):
    values = {
        "host": "127.0.0.1", "port": 0, "port_is_wish": False, "token_file": None, "certificate": None, "key": None,
        "names": (), "hal_write": False, "upload_limit": 1, "program_folder": None, "mdi_history_file": None,
        "preference_file": None, "log_file": None,
    }  # fmt: skip
    return Settings(**values | changes)


@pytest.mark.parametrize(
    ("host", "allowed"),
    [
        ("127.0.0.1:80", True), ("localhost", True), ("[::1]:8080", True), ("LOCALHOST:1", True),
        ("evil.example", False), ("127.0.0.1.evil.example", False), ("", False), (None, False),
        ("localhost@evil.example", False), ("[", False),
    ],
)  # fmt: skip
def test_only_our_own_names_are_served(host, allowed):
    assert Access(settings()).host_allowed(host) is allowed


@pytest.mark.parametrize(
    ("origin", "allowed"),
    [
        ("http://localhost:80", True), ("http://localhost:81", False), ("http://evil.example", False), ("null", False),
        (None, False), ("", False),
    ],
)  # fmt: skip
def test_only_our_own_page_is_an_origin(origin, allowed):
    assert Access(settings()).origin_allowed(origin, "localhost:80") is allowed


def test_tokens_give_roles(tmp_path):
    path = tmp_path / "tokens"
    path.write_text("# ours\noperator aaaaaaaaaaaaaaaaaaaa\nreader bbbbbbbbbbbbbbbbbbbb # visitors\n")
    path.chmod(0o600)
    access = Access(settings(token_file=path))
    assert access.role("a" * 20) is Role.OPERATOR
    assert access.role("b" * 20) is Role.READER
    assert access.role(None) is access.role("ü") is access.role("a" * 19) is None


@pytest.mark.parametrize("text", ["", "root aaaaaaaaaaaaaaaaaaaa", "operator", "operator a b c"])
def test_token_files_that_make_no_sense_are_refused(tmp_path, text):
    path = tmp_path / "tokens"
    path.write_text(text)
    path.chmod(0o600)
    with pytest.raises(ConfigError):
        Access(settings(token_file=path))


# --- calculator ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", 7.0), ("-(2-5)/2", 1.5), ("2**3", 8.0), ("2^3", 8.0), ("1,5", 1.5), ("1 in", 25.4), ("1/8in", 3.175),
        ('.5" + 1mm', 13.7), (" 10 ", 10.0), ("1e2", 100.0),
    ],
)  # fmt: skip
def test_the_calculator_calculates(text, value):
    assert calculate(text, 1.0) == pytest.approx(value)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "x",
        "1/0",
        "9**9**9",
        "(-1)**.5",
        "__import__('os')",
        "1 if 1 else 2",
        "[1]",
        "True",
        "'1'",
        "1;2",
        "(" * 300,
        "1e99",
        "1_0x",
    ],
)
def test_the_calculator_refuses_everything_else(text):
    with pytest.raises(CallError):
        calculate(text, 1.0)


# --- jogs ------------------------------------------------------------------------------------------------------------

TARGET = Target("X", None, 0, acceleration=100.0, low=-300.0, high=300.0)


def test_a_jog_reaches_ahead_by_its_time_and_its_way_to_stop():
    ahead = 10.0 * (AHEAD + 2 * TICK) + 10.0**2 / 200.0
    assert extension(TARGET, 0.0, 0.0, 10.0) == pytest.approx(ahead)
    assert extension(TARGET, 1.0, ahead, 10.0) == pytest.approx(1.0)
    assert extension(TARGET, 0.0, 0.0, -10.0) == pytest.approx(ahead)


def test_a_jog_never_reaches_beyond_a_limit():
    assert extension(TARGET, 299.0, 299.0, 10.0) == pytest.approx(1.0)
    assert extension(TARGET, 300.0, 300.0, 10.0) == 0.0
    assert extension(TARGET, 310.0, 310.0, 10.0) == 0.0


def test_a_position_that_stays_behind_extends_nothing():
    assert extension(TARGET, 0.0, 100.0, 10.0) == 0.0


# --- files -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    root = tmp_path / "nc"
    root.mkdir()
    (root / "sub").mkdir()
    (root / "a.ngc").write_text("G0\nM2")
    return ProgramFolder.of(root, [])


@pytest.mark.parametrize("path", ["../x.ngc", "/etc/passwd", "sub/../../x.ngc", "a\0.ngc", "x" * 5000])
def test_paths_out_of_the_folder_do_not_exist(folder, path):
    with pytest.raises(CallError):
        folder.resolve(path)


def test_saving_replaces_a_file_in_one_step_and_leaves_no_pieces(folder):
    version = folder.read("a.ngc")["version"]
    fresh = folder.save("a.ngc", "G1\n", version)
    assert folder.read("a.ngc") == {"text": "G1\n", "version": fresh}
    with pytest.raises(CallError) as refused:
        folder.save("a.ngc", "G2\n", version)
    assert refused.value.code == "conflict"
    with pytest.raises(CallError):
        folder.save("a.ngc", "G2\n", None)
    assert sorted(path.name for path in folder.root.iterdir()) == ["a.ngc", "sub"]


def test_lines_of_a_program_are_found_without_reading_all_of_it(tmp_path):
    path = tmp_path / "a.ngc"
    path.write_bytes(b"G0 X1\r\nG1\n\nlast")
    text = ProgramText(path)
    assert text.total == 4
    assert text.lines(1, 10) == ["G0 X1", "G1", "", "last"]
    assert text.lines(3, 1) == [""]
    assert text.lines(9, 5) == text.lines(1, -1) == []
    path.write_bytes(b"")
    assert ProgramText(path).total == 0
    with pytest.raises(CallError):
        text.lines(1, 1)


def test_the_tool_table_keeps_remarks_and_what_is_no_tool(tmp_path):
    path = tmp_path / "tool.tbl"
    path.write_text("; my tools\nT1 P1 Z+1.5 D6 ;end mill\nT2 P2 X1 I45 J10 Q2\n")
    table = tooltable.read(path)
    assert table["tools"][0]["offset"][2] == 1.5
    assert table["tools"][0]["comment"] == "end mill"
    assert (table["tools"][1]["frontangle"], table["tools"][1]["orientation"]) == (45.0, 2)
    tooltable.write(path, table["version"], table["tools"])
    assert path.read_text() == "; my tools\nT1 P1 Z1.5 D6 ;end mill\nT2 P2 X1 I45 J10 Q2\n"


@pytest.mark.parametrize(
    "tool",
    [
        None, {}, {"tool": 0}, {"tool": 1, "offset": [0.0]}, {"tool": 1, "diameter": float("nan")}, {"tool": 1.5},
        {"tool": 1, "comment": "a\nT2"}, {"tool": 1, "other": 2}, {"tool": 1, "orientation": 10}, {"tool": True},
    ],
)  # fmt: skip
def test_tools_that_make_no_sense_are_refused(tool):
    with pytest.raises(CallError):
        tooltable.check([tool])


def test_history_and_preferences_outlive_the_server(tmp_path):
    history = MdiHistory(tmp_path / "history")
    for line in ("G0 X1", "G0 X1", "G0 X2"):
        history.add(line)
    assert MdiHistory(tmp_path / "history").lines == ["G0 X1", "G0 X2"]
    Preferences(tmp_path / "p.json").change({"dark": True, "gone": 1})
    Preferences(tmp_path / "p.json").change({"gone": None})
    assert Preferences(tmp_path / "p.json").values == {"dark": True}
    (tmp_path / "p.json").write_text("[broken")
    assert Preferences(tmp_path / "p.json").values == {}


def test_messages_of_the_ini_file_are_read_row_by_row(tmp_path):
    path = tmp_path / "a.ini"
    path.write_text(
        "[DISPLAY]\nMESSAGE_PINNAME = a\nMESSAGE_PINNAME = b\nMESSAGE_TEXT = one\nMESSAGE_TEXT = two\n"
        "MESSAGE_TYPE = okdialog status\nMESSAGE_TYPE = yesnodialog\n"
        "MULTIMESSAGE_ID = V\nMULTIMESSAGE_V_NUMBER = 1\nMULTIMESSAGE_V_NUMBER = 2\nMULTIMESSAGE_V_TEXT = x\n"
    )
    found = questions(IniFile(path))
    assert [(one.pin, one.number, one.text, one.dialog) for one in found] == [
        ("a", 1, "one", "ok"), ("b", 1, "two", "yesno"), ("V", 1, "x", None), ("V", 2, "", None),
    ]  # fmt: skip
    path.write_text("[DISPLAY]\nMESSAGE_PINNAME = a\nMESSAGE_TYPE = shout\n")
    with pytest.raises(ConfigError, match="shout"):
        questions(IniFile(path))


def test_a_method_is_only_performed_for_who_may():
    hub = Hub(State(), lambda text: None)
    client = SimpleNamespace(role=Role.READER, name="r", id=1)
    server = SimpleNamespace(hub=hub, config={"wizard": False})
    for name, right in ((name, row.right) for name, row in METHODS.items()):
        if right is not Right.ANYBODY and not name.startswith("wizard."):
            with pytest.raises(CallError) as refused:
                asyncio.run(perform(Caller(server, client), name, {}))
            assert refused.value.code == "role", name


def test_messages_are_kept_shown_and_written_to_the_log_file(tmp_path):
    shown = []
    messages = Messages(tmp_path / "log.txt", shown.append)
    for number in range(5):
        messages.add("error", f"number\n{number}", serial=number)
    assert [message["id"] for message in messages.newest(texts.ENGLISH, 2)] == [4, 5]
    assert [message["id"] for message in messages.newest(texts.ENGLISH, 2, before=4)] == [2, 3]
    assert shown[0].text == "number\n0"
    assert (tmp_path / "log.txt").read_text().splitlines()[4].endswith("error: number 4")


def test_a_log_file_that_cannot_be_written_stops_nothing(tmp_path):
    messages = Messages(tmp_path / "no" / "such" / "folder", lambda message: None)
    messages.add("error", "one")
    messages.add("error", "two")
    assert len(messages.newest(texts.ENGLISH)) == 2
