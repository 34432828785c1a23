"""NML messages by name over a WebSocket: what a client in any language does with /nml."""

import asyncio
import contextlib
import json
import signal
import subprocess
import sys
import time

import aiohttp
import msgpack
import pytest

import linuxcnc
from nml import namespace
from tests.support.machine import ROOT, copy_mill, running, wait_until
from tests.support.webclient import shared_web_mill

pytestmark = pytest.mark.process

OPERATOR, READER = "operator-token-0123456789", "reader-token-0123456789"
TIMEOUT = 60.0
EMC_STATE_ESTOP_RESET = 2


@pytest.fixture(scope="module")
def mill(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mill")
    tokens = folder / "tokens"
    tokens.write_text(f"operator {OPERATOR}\nreader {READER}\n")
    tokens.chmod(0o600)
    with shared_web_mill(folder, extra="[WEB]\nTOKEN_FILE = tokens") as mill:
        yield mill


@pytest.fixture
def port(mill, monkeypatch):
    name, port = mill
    monkeypatch.setenv(namespace.VARIABLE, name)
    return port


class Gateway:
    """A connection to /nml in one of its two languages."""

    def __init__(self, socket, protocol):
        self.socket, self.protocol = socket, protocol

    async def send(self, **frame):
        if self.protocol == "nml.json":
            await self.socket.send_str(json.dumps(frame))
        else:
            await self.socket.send_bytes(msgpack.packb(frame))

    async def receive(self):
        message = await self.socket.receive(TIMEOUT)
        return json.loads(message.data) if self.protocol == "nml.json" else msgpack.unpackb(message.data)

    async def until(self, condition):
        """The first frame that fulfils a condition."""
        while True:
            frame = await self.receive()
            if condition(frame):
                return frame


def talk(port, work, *, protocol="nml.json", token=OPERATOR, **headers):
    """Run ``work(gateway)`` on a connection that has said hello."""

    async def whole():
        async with aiohttp.ClientSession() as session:
            url = f"http://127.0.0.1:{port}/nml"
            async with session.ws_connect(url, protocols=(protocol,), headers=headers, max_msg_size=0) as socket:
                gateway = Gateway(socket, protocol)
                await gateway.send(hello=token)
                greeting = await gateway.receive()
                assert greeting["hello"]["role"]
                return await work(gateway)

    return asyncio.run(whole())


@pytest.mark.parametrize("protocol", ["nml.json", "nml.msgpack"])
def test_a_command_is_acknowledged_and_its_end_is_told(port, protocol):
    async def work(gateway):
        await gateway.send(command="EMC_TASK_SET_STATE", fields={"state": EMC_STATE_ESTOP_RESET}, id=7)
        first, second = await gateway.receive(), await gateway.receive()
        assert first["id"] == second["id"] == 7
        assert first["serial"] == second["serial"] > 0
        assert (second["result"], second["messages"]) == ("done", [])

    talk(port, work, protocol=protocol)


def test_the_status_comes_whole_and_whenever_it_changes(port):
    async def work(gateway):
        await gateway.send(subscribe="emcStatus", interval=0.02)
        status = await gateway.until(lambda frame: frame.get("message") == "EMC_STAT")
        assert status["fields"]["task"]["ini_filename"].endswith(".ini")
        await gateway.send(command="EMC_TASK_SET_STATE", fields={"state": EMC_STATE_ESTOP_RESET}, id=1)
        await gateway.until(lambda frame: "fields" in frame and frame["fields"]["io"]["aux"]["estop"] == 0)

    talk(port, work)


def test_operator_messages_are_passed_on(port):
    async def work(gateway):
        await gateway.send(subscribe="emcError")
        await gateway.send(command="EMC_OPERATOR_TEXT", fields={"text": "Grüße"}, id=1)
        message = await gateway.until(lambda frame: "message" in frame)
        assert message["message"] == "EMC_OPERATOR_TEXT"
        assert message["fields"]["text"] == "Grüße"

    talk(port, work)


@pytest.mark.parametrize(
    ("frame", "what"),
    [
        ({"command": "EMC_NO_SUCH"}, "no command"),
        ({"command": "EMC_STAT"}, "no command"),
        ({"command": "EMC_JOINT_HOME", "fields": {"joint": "x"}}, "joint"),
        ({"command": "EMC_JOINT_HOME", "fields": {"wheel": 1}}, "wheel"),
        ({"command": "EMC_JOG_CONT", "fields": {"vel": float("inf")}}, "finite"),
        ({"subscribe": "emcCommand"}, "emcCommand"),
        ({"dance": 1}, "needed"),
    ],
)
def test_what_makes_no_sense_gets_one_clear_line(port, frame, what):
    async def work(gateway):
        await gateway.send(**frame, id=3)
        answer = await gateway.receive()
        assert answer["id"] == 3
        assert what in answer["error"]

    talk(port, work, protocol="nml.msgpack")


def test_readers_may_not_command(port):
    async def work(gateway):
        await gateway.send(command="EMC_TASK_ABORT", id=1)
        assert "readers" in (await gateway.receive())["error"]
        await gateway.send(describe="EMC_JOG_CONT")
        assert [field["name"] for field in (await gateway.receive())["fields"]] == ["joint_or_axis", "vel", "jjogmode"]

    talk(port, work, token=READER)


def test_without_the_right_token_there_is_no_way_in(port):
    async def whole():
        async with aiohttp.ClientSession() as session, session.ws_connect(f"http://127.0.0.1:{port}/nml") as socket:
            await socket.send_str(json.dumps({"hello": "wrong"}))
            message = await socket.receive(TIMEOUT)
            assert message.type is aiohttp.WSMsgType.CLOSE
            assert message.data == 4401

    asyncio.run(whole())


def test_pages_of_other_servers_do_not_get_in(port):
    async def work(gateway):
        raise AssertionError("connected")

    with pytest.raises(aiohttp.WSServerHandshakeError):
        talk(port, work, Origin="http://evil.example")


async def jogging(gateway):
    """Switch on and jog joint 0; comes back when it moves."""
    orders = (
        ("EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ESTOP_RESET}),
        ("EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ON}),
        ("EMC_TASK_SET_MODE", {"mode": linuxcnc.MODE_MANUAL}),
        ("EMC_TRAJ_SET_MODE", {"mode": linuxcnc.TRAJ_MODE_FREE}),
    )
    for number, (name, fields) in enumerate(orders):
        await gateway.send(command=name, fields=fields, id=number)
        await gateway.until(lambda frame, number=number: frame.get("id") == number and "result" in frame)
    await gateway.send(subscribe="emcStatus", interval=0.02)
    began = None
    while True:
        await gateway.send(command="EMC_JOG_CONT", fields=JOG, id=99)
        frame = await gateway.until(lambda frame: "fields" in frame)
        position = frame["fields"]["motion"]["joint"][0]["output"]
        began = position if began is None else began
        if position > began + 1.0:
            return


JOG = {"joint_or_axis": 0, "jjogmode": 1, "vel": 5.0}
LONGEST_WAY = 40.0  # mm after the failure; a jog that goes on passes it within seconds


def comes_to_rest():
    """The machine stands, not far from where it is now."""
    status = linuxcnc.stat()
    at = status.joint_position[0]

    def stands():
        before = status.joint_position[0]
        time.sleep(0.3)
        status.poll()
        return status.joint_position[0] == before

    wait_until(stands, "at rest")
    assert abs(status.joint_position[0] - at) < LONGEST_WAY


def test_a_client_that_goes_away_leaves_no_jog_behind(port):
    talk(port, jogging)
    comes_to_rest()


def test_a_jog_ends_when_no_frames_come(port):
    async def work(gateway):
        await jogging(gateway)
        await asyncio.to_thread(comes_to_rest)

    talk(port, work)


def test_a_jog_goes_on_while_frames_come_and_stops_by_order(port):
    async def work(gateway):
        await jogging(gateway)
        status = linuxcnc.stat()
        began = status.joint_position[0]
        while status.joint_position[0] < began + 5.0:
            await gateway.send(beat=1)
            await asyncio.sleep(0.05)
            status.poll()
            if status.joint[0]["velocity"] == 0.0:  # a busy computer was late with a sign of life
                await jogging(gateway)
                status.poll()
                began = status.joint_position[0]
        await gateway.send(command="EMC_JOG_STOP", fields={"joint_or_axis": 0, "jjogmode": 1}, id=100)
        await gateway.until(lambda frame: frame.get("id") == 100 and "result" in frame)
        await asyncio.to_thread(comes_to_rest)

    talk(port, work)


def test_each_of_many_commands_at_once_gets_its_own_end(port):
    async def work(gateway):
        for number in range(60):
            if number % 2:
                await gateway.send(command="EMC_TASK_SET_MODE", fields={"mode": 1000 + number}, id=number)
            else:
                await gateway.send(command="EMC_TRAJ_SET_SCALE", fields={"scale": 1.0}, id=number)
        ends = {}
        while len(ends) < 60:
            frame = await gateway.receive()
            if "result" in frame:
                ends[frame["id"]] = frame
        return ends

    for number, end in talk(port, work).items():
        assert end["result"] == ("refused" if number % 2 else "done")
        assert [str(1000 + number) in text for text in end["messages"]] == ([True] if number % 2 else [])


@pytest.mark.parametrize("fields", [{**JOG, "vel": 0.0}, {**JOG, "joint_or_axis": 7}])
def test_a_jog_of_nothing_is_refused(port, fields):
    async def work(gateway):
        await gateway.send(command="EMC_JOG_CONT", fields=fields, id=1)
        return await gateway.until(lambda frame: frame.get("id") == 1)

    assert talk(port, work)["error"] in ("vel must not be 0", "there is no such axis or joint")


@contextlib.contextmanager
def server_of_its_own(folder):
    """A web server beside a machine that has another display: the server and its port."""
    tokens = folder / "tokens"
    tokens.write_text(f"operator {OPERATOR}\n")
    tokens.chmod(0o600)
    ini = copy_mill(folder, changes={"DISPLAY.PROGRAM_PREFIX": str(folder)})
    ini.write_text(f"{ini.read_text()}\n[WEB]\nTOKEN_FILE = tokens\n")
    with running(ini) as machine:
        machine.port()
        command = [sys.executable, "-m", "gui.web", "-ini", str(ini), "--port", "0", "--no-browser"]
        server = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        try:
            yield server, int(server.stdout.readline().rstrip("/\n").rpartition(":")[2])
        finally:
            server.kill()
            server.communicate()


@pytest.mark.parametrize("signal_number", [signal.SIGSTOP, signal.SIGKILL])
def test_a_server_that_hangs_or_is_killed_in_mid_jog_leaves_a_machine_at_rest(tmp_path, signal_number):
    async def work(gateway):
        await jogging(gateway)
        server.send_signal(signal_number)
        await asyncio.to_thread(comes_to_rest)

    with server_of_its_own(tmp_path) as (server, port):
        talk(port, work)
        status = linuxcnc.stat()
        assert status.task_state == linuxcnc.STATE_ON  # the machine itself goes on
