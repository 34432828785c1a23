"""nmlstat, nmlsend and nmllog: what they print, send, record and play back."""

import json
import threading
from pathlib import Path

import pytest

from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc import EMC_JOG_CONT, EMC_NULL, EMC_OPERATOR_ERROR, EMC_STAT, EMC_TASK_SET_STATE
from nml.errors import ConfigError, EncodeError
from nml.tools import nmllog, nmlsend, nmlstat
from nml.tools.paths import get, put


@pytest.fixture
def config(monkeypatch: pytest.MonkeyPatch) -> NmlConfig:
    for name in ("NML_FILE", "INI_FILE_NAME"):
        monkeypatch.delenv(name, raising=False)
    return NmlConfig.load()


def printed(capsys: pytest.CaptureFixture[str]) -> list[dict]:
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize(
    ("path", "text", "value"),
    [
        ("motion.joint[2].homed", "1", 1),
        ("task.file", "a b.ngc", "a b.ngc"),
        ("task.input_timeout", "true", True),
        ("motion.traj.position.tran.y", "2.5", 2.5),
        ("motion.synch_di[3]", "0x10", 16),
        ("debug", "-1", -1),
    ],
)
def test_a_path_reads_and_sets_a_field(path: str, text: str, value: object):
    status = EMC_STAT()
    put(status, path, text)
    assert get(status, path) == value


def test_a_whole_structure_is_set_from_numbers():
    status = EMC_STAT()
    put(status, "task.g5x_offset", "1,2,3,0,0,0,0,0,9")
    assert get(status, "task.g5x_offset.w") == 9.0


@pytest.mark.parametrize(
    ("path", "text", "problem"),
    [
        ("motion.joint[16].homed", "1", "16 elements"),
        ("motion.nothing", "1", "EMC_MOTION_STAT has no field 'nothing'"),
        ("motion..x", "1", "is no path to a field"),
        ("debug", "one", "debug: 'one' is not a value of int"),
        ("task.input_timeout", "maybe", "true or false is allowed"),
    ],
)
def test_a_wrong_path_or_value_is_told(path: str, text: str, problem: str):
    with pytest.raises(EncodeError, match=problem):
        put(EMC_STAT(), path, text)


def test_the_overview_names_every_buffer(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    status = Channel(config, "emcStatus", "emc")
    commands = Channel(config, "emcCommand", "xemc")
    status.write(EMC_STAT())
    for _ in range(3):
        commands.write(EMC_NULL())
    assert nmlstat.main(["--json", "-i", "0.01"]) == 0
    rows = {row["buffer"]: row for row in printed(capsys)}
    assert rows["emcStatus"]["type"] == "EMC_STAT"
    assert rows["emcCommand"] == rows["emcCommand"] | {"messages": 3, "waiting": 3, "type": "EMC_NULL"}
    assert rows["toolCmd"]["state"] == "not in use"
    assert commands.queue_length() == 3


def test_a_snapshot_has_every_field(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    status = Channel(config, "emcStatus", "emc")
    image = EMC_STAT(echo_serial_number=7)
    image.motion.joint[1].homed = 1
    status.write(image)
    assert nmlstat.main(["emcStatus", "--json"]) == 0
    (row,) = printed(capsys)
    assert (row["type"], row["number"], row["echo_serial_number"]) == ("EMC_STAT", 1, 7)
    assert row["motion.joint[1].homed"] == 1
    assert not status.check_if_read()


def test_watching_prints_changes_only(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    commands = Channel(config, "emcCommand", "xemc")
    for joint in (1, 1, 2):
        commands.write(EMC_JOG_CONT(joint_or_axis=joint))
    assert nmlstat.main(["emcCommand", "--watch", "joint_or_axis", "-n", "3", "--json"]) == 0
    assert [row["joint_or_axis"] for row in printed(capsys)] == [1, 2]


def test_following_prints_every_message(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    errors = Channel(config, "emcError", "emc")
    errors.write(EMC_OPERATOR_ERROR(error="one"))
    errors.write(EMC_OPERATOR_ERROR(error="two"))
    assert nmlstat.main(["emcError", "--follow", "-n", "2"]) == 0
    assert [line.rpartition("=")[2] for line in capsys.readouterr().out.splitlines()] == ["one", "two"]


def test_an_unknown_buffer_is_one_line(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    assert nmlstat.main(["nothing"]) == 1
    assert "no buffer 'nothing'; the file has emcCommand" in capsys.readouterr().err


def answer(config: NmlConfig, status: int, text: str = "") -> threading.Thread:
    """A task that takes one command, answers and stays until then."""
    commands, states = Channel(config, "emcCommand", "emc"), Channel(config, "emcStatus", "emc")
    texts = Channel(config, "emcError", "emc")

    def work() -> None:
        command = commands.blocking_read(10.0)
        assert isinstance(command, EMC_TASK_SET_STATE)
        if text:
            texts.write(EMC_OPERATOR_ERROR(error=text))
        states.write(EMC_STAT(echo_serial_number=command.serial_number, status=status))

    thread = threading.Thread(target=work)
    thread.start()
    return thread


def test_a_command_is_sent_and_its_answer_awaited(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    task = answer(config, status=1)
    assert nmlsend.main(["EMC_TASK_SET_STATE", "state=4", "--timeout", "10"]) == 0
    task.join()
    assert capsys.readouterr().out == "EMC_TASK_SET_STATE number 1: done\n"


def test_a_failed_command_brings_the_operators_texts(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    task = answer(config, status=3, text="can't do that")
    assert nmlsend.main(["505", "state=4", "--timeout", "10"]) == 1
    task.join()
    assert capsys.readouterr() == ("EMC_TASK_SET_STATE number 1: error\n", "can't do that\n")


def test_a_command_that_goes_on_is_told_apart_from_one_that_nobody_took(
    config: NmlConfig, capsys: pytest.CaptureFixture[str]
):
    task = answer(config, status=2)
    assert nmlsend.main(["EMC_TASK_SET_STATE", "--timeout", "1.0"]) == 3
    task.join()
    assert "EMC_TASK_SET_STATE number 1: taken, but not done within 1.0 s" in capsys.readouterr().err


def test_no_answer_is_told_apart_from_a_refusal(config: NmlConfig, capsys: pytest.CaptureFixture[str]):
    assert nmlsend.main(["EMC_NULL", "--timeout", "0.05"]) == 3
    assert nmlsend.main(["EMC_NULL", "--timeout", "0"]) == 0
    assert nmlsend.main(["EMC_NOTHING"]) == 2
    assert nmlsend.main(["EMC_NULL", "state"]) == 2
    assert nmlsend.main(["EMC_NULL", "--vocabulary", "no.such.module"]) == 2
    assert "'state' is no FIELD=VALUE" in capsys.readouterr().err


def test_a_log_plays_back_what_was_recorded(
    config: NmlConfig, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    path = tmp_path / "run.nmllog"
    errors = Channel(config, "emcError", "emc")
    for text in ("one", "two"):
        errors.write(EMC_OPERATOR_ERROR(error=text))
    with path.open("wb") as file:
        counts = nmllog.record(config, file, ["emcError", "emcStatus"], seconds=0.2)
    assert (counts["emcError"], counts["emcStatus"], counts["emcError missed"]) == (2, 0, 0)

    assert nmllog.main(["show", str(path), "--json"]) == 0
    rows = printed(capsys)
    assert [(row["t"] >= 0.0, row["buffer"], row["error"]) for row in rows] == [
        (True, "emcError", "one"),
        (True, "emcError", "two"),
    ]

    errors.close()
    reader = Channel(config, "emcError", "xemc")
    assert nmllog.main(["replay", str(path), "--speed", "1000"]) == 0
    messages = [reader.read(), reader.read(), reader.read()]
    assert [message.error if message else None for message in messages] == ["one", "two", None]


def test_what_is_no_log_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    path = tmp_path / "other"
    for content in (b"", b"hello", b"\x81\xa6format\xa3abc"):
        path.write_bytes(content)
        assert nmllog.main(["show", str(path)]) == 1
    assert "no log of this program" in capsys.readouterr().err
    with pytest.raises(ConfigError, match="cannot read the log"):
        list(nmllog.entries(tmp_path / "none"))
