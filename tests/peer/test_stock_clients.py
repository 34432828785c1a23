"""Debian's own Python module, unchanged, as a remote client of our server: status, commands, operator messages.

A stand-in for task answers commands, so that every field of every command can be looked at; the whole machine under
stock clients is tested in ``test_stock_clients_machine.py``.
"""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import linuxcnc
from nml.channel import Channel
from nml.codecs import xdr
from nml.emc import EMC_OPERATOR_DISPLAY, EMC_OPERATOR_ERROR, EMC_OPERATOR_TEXT, EMC_STAT
from nml.message import Command
from tests.support.fake_task import FakeTask
from tests.support.machine import wait_until
from tests.support.nml_server import Server, free_port, nml_text, running
from tests.support.stock import StockClient, needs_module

pytestmark = [pytest.mark.peer, needs_module]

LONGEST_TEXT = 254


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    with running(tmp_path, nml_text(f"TCP={free_port()}")) as one:
        yield one


@pytest.fixture
def stock(server: Server) -> StockClient:
    return StockClient(server.folder, server.file)


@pytest.fixture
def task(server: Server, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeTask]:
    monkeypatch.setenv("NML_FILE", str(server.file))
    with FakeTask(cycle=0.001) as one:
        yield one


def random_status(seed: int) -> EMC_STAT:
    """A status in which everything that crosses the wire differs from its default."""
    source = random.Random(seed)

    def value(old: object) -> object:
        if isinstance(old, bool):
            return source.random() < 0.5
        if isinstance(old, int):
            return source.randint(0, 100)
        if isinstance(old, float):
            return source.uniform(-1e6, 1e6)
        assert isinstance(old, bytes)
        return "".join(source.choices("abcXYZ /.,ä", k=source.randint(1, 20))).encode()

    status = EMC_STAT()
    status.FLAT.pack_into(status.data, 0, *map(value, status.astuple()))
    status.set(nml_type=EMC_STAT.TYPE_ID, nml_size=EMC_STAT.SIZE)
    crossing = xdr.decode(xdr.encode(status))
    assert isinstance(crossing, EMC_STAT)
    return crossing


def as_seen(value: Any, like: Any) -> Any:
    """A value of our module in JSON's types; of a dictionary what the stock one has (ours may have more)."""
    if isinstance(like, dict):
        return {key: as_seen(value[key], one) for key, one in like.items()}
    if isinstance(like, list):
        return [as_seen(one, other) for one, other in zip(value, like, strict=True)]
    return value


ATTRIBUTES = """
def attributes(s):
    names = [n for n in dir(s) if not n.startswith("_") and not callable(getattr(s, n)) and n != "tool_table"]
    return {n: getattr(s, n) for n in names}
"""


@pytest.mark.parametrize("seed", range(3))
def test_every_attribute_that_crosses_the_wire_is_right(
    server: Server, stock: StockClient, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(linuxcnc, "nmlfile", str(server.file))
    machine = Channel(server.config, "emcStatus", "emc")
    machine.write(random_status(seed))
    (seen,) = stock.run(ATTRIBUTES + "s = linuxcnc.stat(); s.poll(); out.append(attributes(s))")
    ours = linuxcnc.stat()
    ours.poll()
    assert len(seen) > 80
    expected = {name: as_seen(getattr(ours, name), value) for name, value in seen.items()}
    assert seen == expected
    machine.close()


def test_polls_bring_new_values_and_keep_old_ones(stock: StockClient, task: FakeTask) -> None:
    client = stock.start(
        "s = linuxcnc.stat(); s.poll(); out.append(s.current_line)\n"
        "print('polled', flush=True)\n"
        "end = time.time() + 60\n"
        "while s.current_line != 42 and time.time() < end: s.poll()\n"
        "out.append(s.current_line); s.poll(); out.append(s.current_line)"
    )
    assert client.stdout is not None
    assert client.stdout.readline() == "polled\n"
    task.status.task.currentLine = 42
    task.publish()
    rest, _ = client.communicate(timeout=120)
    assert json.loads(rest) == [0, 42, 42]


COMMANDS: list[tuple[str, str, dict[str, object]]] = [
    ("state(linuxcnc.STATE_ESTOP_RESET)", "EMC_TASK_SET_STATE", {"state": 2}),
    ("state(linuxcnc.STATE_ON)", "EMC_TASK_SET_STATE", {"state": 4}),
    ("mode(linuxcnc.MODE_MDI)", "EMC_TASK_SET_MODE", {"mode": 3}),
    ("mdi('G0 X12.5 Y-3 (ä)')", "EMC_TASK_PLAN_EXECUTE", {"command": "G0 X12.5 Y-3 (ä)"}),
    ("mdi('G1 ' + 'x' * 251)", "EMC_TASK_PLAN_EXECUTE", {"command": "G1 " + "x" * 251}),
    ("auto(linuxcnc.AUTO_RUN, 17)", "EMC_TASK_PLAN_RUN", {"line": 17}),
    ("auto(linuxcnc.AUTO_PAUSE)", "EMC_TASK_PLAN_PAUSE", {}),
    ("auto(linuxcnc.AUTO_RESUME)", "EMC_TASK_PLAN_RESUME", {}),
    ("auto(linuxcnc.AUTO_STEP)", "EMC_TASK_PLAN_STEP", {}),
    ("abort()", "EMC_TASK_ABORT", {}),
    ("reset_interpreter()", "EMC_TASK_PLAN_INIT", {}),
    ("task_plan_synch()", "EMC_TASK_PLAN_SYNCH", {}),
    ("home(2)", "EMC_JOINT_HOME", {"joint": 2}),
    ("home(-1)", "EMC_JOINT_HOME", {"joint": -1}),
    ("unhome(1)", "EMC_JOINT_UNHOME", {"joint": 1}),
    ("jog(linuxcnc.JOG_STOP, True, 1)", "EMC_JOG_STOP", {"joint_or_axis": 1, "jjogmode": 1}),
    ("jog(linuxcnc.JOG_CONTINUOUS, False, 2, -1.5)", "EMC_JOG_CONT", {"joint_or_axis": 2, "vel": -1.5, "jjogmode": 0}),
    (
        "jog(linuxcnc.JOG_INCREMENT, True, 0, 2.5, 0.01)",
        "EMC_JOG_INCR",
        {"joint_or_axis": 0, "vel": 2.5, "incr": 0.01, "jjogmode": 1},
    ),
    ("teleop_enable(1)", "EMC_TRAJ_SET_TELEOP_ENABLE", {"enable": 1}),
    ("traj_mode(linuxcnc.TRAJ_MODE_COORD)", "EMC_TRAJ_SET_MODE", {"mode": 2}),
    ("maxvel(25.0)", "EMC_TRAJ_SET_MAX_VELOCITY", {"velocity": 25.0}),
    ("feedrate(0.75)", "EMC_TRAJ_SET_SCALE", {"scale": 0.75}),
    ("rapidrate(0.5)", "EMC_TRAJ_SET_RAPID_SCALE", {"scale": 0.5}),
    ("spindleoverride(1.2, 0)", "EMC_TRAJ_SET_SPINDLE_SCALE", {"scale": 1.2, "spindle": 0}),
    ("spindle(linuxcnc.SPINDLE_FORWARD, 1200)", "EMC_SPINDLE_ON", {"speed": 1200.0, "spindle": 0}),
    ("spindle(linuxcnc.SPINDLE_REVERSE, 800)", "EMC_SPINDLE_ON", {"speed": -800.0, "spindle": 0}),
    ("spindle(linuxcnc.SPINDLE_OFF)", "EMC_SPINDLE_OFF", {"spindle": 0}),
    ("brake(linuxcnc.BRAKE_ENGAGE)", "EMC_SPINDLE_BRAKE_ENGAGE", {"spindle": 0}),
    ("mist(linuxcnc.MIST_ON)", "EMC_COOLANT_MIST_ON", {}),
    ("flood(linuxcnc.FLOOD_OFF)", "EMC_COOLANT_FLOOD_OFF", {}),
    ("load_tool_table()", "EMC_TOOL_LOAD_TOOL_TABLE", {"file": ""}),
    ("override_limits()", "EMC_JOINT_OVERRIDE_LIMITS", {"joint": 0}),
    ("set_min_limit(1, -10.5)", "EMC_JOINT_SET_MIN_POSITION_LIMIT", {"joint": 1, "limit": -10.5}),
    ("set_max_limit(1, 10.5)", "EMC_JOINT_SET_MAX_POSITION_LIMIT", {"joint": 1, "limit": 10.5}),
    ("set_feed_override(0)", "EMC_TRAJ_SET_FO_ENABLE", {"mode": 0}),
    ("set_feed_hold(1)", "EMC_TRAJ_SET_FH_ENABLE", {"mode": 1}),
    ("set_adaptive_feed(1)", "EMC_MOTION_ADAPTIVE", {"status": 1}),
    ("set_digital_output(3, 1)", "EMC_MOTION_SET_DOUT", {"index": 3, "start": 1, "now": 1}),
    ("set_analog_output(2, 1.5)", "EMC_MOTION_SET_AOUT", {"index": 2, "start": 1.5, "now": 1}),
    ("set_optional_stop(True)", "EMC_TASK_PLAN_SET_OPTIONAL_STOP", {"state": 1}),
    ("set_block_delete(False)", "EMC_TASK_PLAN_SET_BLOCK_DELETE", {"state": 0}),
    ("debug(6)", "EMC_SET_DEBUG", {"debug": 6}),
    ("error_msg('from a client')", "EMC_OPERATOR_ERROR", {"error": "from a client"}),
]


def test_each_command_arrives_with_its_fields_and_is_waited_for(stock: StockClient, task: FakeTask) -> None:
    calls = "\n".join(f"c.{call}; out.append([c.serial, c.wait_complete()])" for call, _, _ in COMMANDS)
    results = stock.run("c = linuxcnc.command()\n" + calls, seconds=600)
    assert results == [[number, linuxcnc.RCS_DONE] for number in range(1, len(COMMANDS) + 1)]
    for (call, name, fields), command in zip(COMMANDS, task.taken, strict=True):
        assert type(command).__name__ == name, call
        assert {key: getattr(command, key) for key in fields} == fields, call


def test_opening_a_program_sends_the_path(stock: StockClient, task: FakeTask) -> None:
    stock.run("c = linuxcnc.command(); c.program_open('/home/x/part.ngc'); c.wait_complete()")
    assert [type(one).__name__ for one in task.taken] == ["EMC_TASK_PLAN_CLOSE", "EMC_TASK_PLAN_OPEN"]
    assert task.taken[1].file == "/home/x/part.ngc"


def test_a_command_that_fails_is_an_error_for_the_one_who_waits(
    server: Server, stock: StockClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NML_FILE", str(server.file))
    with FakeTask(lambda command, status: linuxcnc.RCS_ERROR, cycle=0.001):
        assert stock.run("c = linuxcnc.command(); c.mdi('G1 X'); out.append(c.wait_complete())") == [linuxcnc.RCS_ERROR]


def test_operator_messages_arrive_whole_and_in_order(stock: StockClient, task: FakeTask) -> None:
    long_text = ("joint 0 following error: 0.500 mm, limit 0.250 mm; " * 6)[:LONGEST_TEXT]
    messages = [
        EMC_OPERATOR_ERROR(error=long_text),
        EMC_OPERATOR_TEXT(text="probe contact"),
        EMC_OPERATOR_DISPLAY(display="tool 7, ä"),
        EMC_OPERATOR_ERROR(error="short"),
    ]
    for message in messages:
        task.errors.write(message)
    found = stock.run("e = linuxcnc.error_channel()\nfor _ in range(5): out.append(e.poll())")
    assert found == [[11, long_text], [12, "probe contact"], [13, "tool 7, ä"], [11, "short"], None]


def test_a_remote_reader_takes_no_message_from_a_local_one(
    server: Server, stock: StockClient, task: FakeTask, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(linuxcnc, "nmlfile", str(server.file))
    local = linuxcnc.error_channel()
    task.errors.write(EMC_OPERATOR_ERROR(error="for all"))
    script = "a = linuxcnc.error_channel(); b = linuxcnc.error_channel(); out += [a.poll(), b.poll(), a.poll()]"
    client = stock.start(script)
    text, _ = client.communicate(timeout=120)
    assert json.loads(text)[0] == [11, "for all"]
    assert local.poll() == (11, "for all")


def test_a_client_that_dies_in_the_middle_of_a_command_leaves_the_others_alone(
    server: Server, stock: StockClient, task: FakeTask
) -> None:
    victim = stock.start(
        "c = linuxcnc.command()\nprint('on', flush=True)\nwhile True: c.mode(linuxcnc.MODE_MANUAL)"
    )
    assert victim.stdout is not None
    assert victim.stdout.readline() == "on\n"
    wait_until(lambda: len(task.taken) > 10, "commands")
    victim.kill()
    victim.communicate()
    before = len(task.taken)
    assert stock.run("c = linuxcnc.command(); c.mode(linuxcnc.MODE_MDI); out.append(c.wait_complete())") == [1]
    assert all(isinstance(one, Command) for one in task.taken)
    assert type(task.taken[-1]).__name__ == "EMC_TASK_SET_MODE"
    assert before > 0
    serials = [one.serial_number for one in task.taken]
    assert serials == list(range(1, len(serials) + 1))
