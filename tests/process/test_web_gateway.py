"""NML messages by name over a WebSocket: what a client in any language does with /nml."""

import asyncio
import json
import time

import aiohttp
import msgpack
import pytest

import linuxcnc
from nml import namespace
from tests.support.machine import wait_until
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
        assert second["result"] == "done"

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


def test_a_client_that_goes_away_leaves_no_jog_behind(port):
    async def work(gateway):
        orders = (
            ("EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ESTOP_RESET}),
            ("EMC_TASK_SET_STATE", {"state": linuxcnc.STATE_ON}),
            ("EMC_JOG_CONT", {"joint_or_axis": 0, "jjogmode": 1, "vel": 5.0}),
        )
        for number, (name, fields) in enumerate(orders):
            await gateway.send(command=name, fields=fields, id=number)
            await gateway.until(lambda frame, number=number: frame.get("id") == number)
        await gateway.send(subscribe="emcStatus", interval=0.02)
        await gateway.until(lambda frame: "fields" in frame and frame["fields"]["motion"]["joint"][0]["output"] > 1.0)

    talk(port, work)
    status = linuxcnc.stat()

    def stands():
        before = status.joint_position[0]
        time.sleep(0.3)
        status.poll()
        return status.joint_position[0] == before

    wait_until(stands, "at rest")
    assert status.joint_position[0] < 100.0
