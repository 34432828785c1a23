"""The machine's state in the shop's systems: a real MQTT broker and a real OPC UA client, with a whole machine."""

from __future__ import annotations

import asyncio
import json
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import linuxcnc
from tests.support.machine import PATIENCE, Run, copy_mill, running, traces, wait_until
from tests.support.nml_server import free_port

paho = pytest.importorskip("paho.mqtt.client", reason="paho-mqtt is not installed")
asyncua = pytest.importorskip("asyncua", reason="asyncua is not installed")

from gui.shop.mqtt import main as mqtt_program  # noqa: E402  once the packages are known to be there
from gui.shop.opcua import main as opcua_program  # noqa: E402

MOSQUITTO = shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin")

pytestmark = pytest.mark.process
needs_broker = pytest.mark.skipif(MOSQUITTO is None, reason="mosquitto is not installed")


class Broker:
    """A mosquitto of our own on a loopback port."""

    def __init__(self, folder: Path, port: int) -> None:
        self.port = port
        self._config = folder / "mosquitto.conf"
        self._config.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\npersistence false\n")
        self.start()

    def start(self) -> None:
        self._process = subprocess.Popen(
            [str(MOSQUITTO), "-c", str(self._config)], env={}, stderr=subprocess.DEVNULL
        )

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait(PATIENCE)


class Reader:
    """A client that notes what the topics hold now, and which of it was retained."""

    def __init__(self, port: int) -> None:
        self.values: dict[str, str] = {}
        self.retained: set[str] = set()
        self._lock = threading.Lock()
        self._client = paho.Client(paho.CallbackAPIVersion.VERSION2)
        self._client.on_connect = lambda client, *_: client.subscribe("shop/#", 1)
        self._client.on_message = self._on_message
        wait_until(lambda: self._connected(port), "broker")
        self._client.loop_start()

    def _connected(self, port: int) -> bool:
        try:
            return self._client.connect("127.0.0.1", port) == paho.MQTT_ERR_SUCCESS
        except OSError:
            return False

    def _on_message(self, client: object, data: object, message: paho.MQTTMessage) -> None:
        with self._lock:
            self.values[message.topic] = message.payload.decode()
            if message.retain:
                self.retained.add(message.topic)

    def wait(self, topic: str, value: object) -> None:
        wait_until(lambda: self.values.get(topic) == json.dumps(value), f"{topic} = {value!r}, not {self.values}")

    def close(self) -> None:
        self._client.loop_stop()


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    one = Broker(tmp_path, free_port())
    yield one
    one.stop()


def mqtt(broker: Broker) -> str:
    return f"[MQTT]\nBROKER = 127.0.0.1\nPORT = {broker.port}\nTOPIC = shop/mill\nCYCLE_TIME = 0.02"


def machine_with(folder: Path, section: str) -> Path:
    ini = copy_mill(folder)
    ini.write_text(f"{ini.read_text()}\n{section}\n")
    return ini


def switch_on(run: Run) -> None:
    run.port()
    status, command = linuxcnc.stat(), linuxcnc.command()
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.state(linuxcnc.STATE_ON)
    wait_until(lambda: status.poll() or status.task_state == linuxcnc.STATE_ON, "machine on")


@needs_broker
def test_the_broker_holds_the_state_and_learns_of_the_end(tmp_path: Path, broker: Broker) -> None:
    ini = machine_with(tmp_path, mqtt(broker))
    reader = Reader(broker.port)
    with running(ini, speed=10.0) as run:
        reader.wait("shop/mill/online", 1)
        reader.wait("shop/mill/status/state", "estop")
        switch_on(run)
        reader.wait("shop/mill/status/state", "on")
        linuxcnc.command().text_msg("coolant is low")
        wait_until(lambda: "shop/mill/message" in reader.values, "message")
        assert json.loads(reader.values["shop/mill/message"])["text"] == "coolant is low"
        late = Reader(broker.port)
        late.wait("shop/mill/status/axes", "XYZ")
        topics = {"shop/mill/online", "shop/mill/status/state", "shop/mill/status/position/actual"}
        wait_until(lambda: topics <= late.retained, f"retained, not {late.retained}")
        assert "shop/mill/message" not in late.values
        late.close()
    reader.wait("shop/mill/online", 0)
    reader.close()
    assert traces() == []


@needs_broker
def test_the_last_will_tells_of_a_publisher_that_was_killed(tmp_path: Path, broker: Broker) -> None:
    ini = machine_with(tmp_path, mqtt(broker))
    reader = Reader(broker.port)
    with running(ini, speed=10.0) as run:
        reader.wait("shop/mill/online", 1)
        wait_until(lambda: "mqtt" in run.pids(), "noted by the launcher")
        subprocess.run(["kill", "-9", str(run.pids()["mqtt"])], check=True)
        reader.wait("shop/mill/online", 0)
        switch_on(run)  # the machine goes on without it
    reader.close()


@needs_broker
def test_a_broker_that_comes_back_gets_everything_anew(tmp_path: Path, broker: Broker) -> None:
    ini = machine_with(tmp_path, mqtt(broker))
    with running(ini, speed=10.0):
        reader = Reader(broker.port)
        reader.wait("shop/mill/status/state", "estop")
        reader.close()
        broker.stop()
        broker.start()
        reader = Reader(broker.port)
        reader.wait("shop/mill/online", 1)
        reader.wait("shop/mill/status/state", "estop")
        reader.close()


def test_an_opc_ua_client_reads_the_state_and_is_told_of_changes(tmp_path: Path) -> None:
    endpoint = f"opc.tcp://127.0.0.1:{free_port()}/"
    ini = machine_with(tmp_path, f"[OPCUA]\nENDPOINT = {endpoint}\nCYCLE_TIME = 0.02")
    with running(ini, speed=10.0) as run:
        run.port()
        asyncio.run(_read_as_a_client(endpoint, run))
    assert traces() == []


async def _read_as_a_client(endpoint: str, run: Run) -> None:
    client = await _connected(endpoint)
    async with client:
        index = await client.get_namespace_index("urn:pyemc:machine")

        def node(name: str) -> asyncua.Node:
            return client.get_node(f"ns={index};s=sim-mill-mm/{name}")

        for name, value in (("state", "estop"), ("axes", "XYZ"), ("position/actual", [0.0, 0.0, 0.0])):
            async with asyncio.timeout(PATIENCE):
                while await node(name).read_value() != value:
                    await asyncio.sleep(0.05)
        assert (await node("velocity").read_description()).Text == "along the path, units/s"
        with pytest.raises(asyncua.ua.UaStatusCodeError):
            await node("override/feed").write_value(200.0)
        changes = Changes()
        subscription = await client.create_subscription(20, changes)
        await subscription.subscribe_data_change([node("state"), node("message")])
        await asyncio.to_thread(switch_on, run)
        await changes.wait("on")
        await asyncio.to_thread(linuxcnc.command().text_msg, "door is open")
        await changes.wait("text: door is open")


class Changes:
    """What a subscription brought."""

    def __init__(self) -> None:
        self._seen: asyncio.Queue[object] = asyncio.Queue()

    def datachange_notification(self, node: object, value: object, data: object) -> None:
        self._seen.put_nowait(value)

    async def wait(self, value: object) -> None:
        async with asyncio.timeout(PATIENCE):
            while await self._seen.get() != value:
                pass


async def _connected(endpoint: str) -> asyncua.Client:
    async with asyncio.timeout(PATIENCE):
        while True:
            client = asyncua.Client(endpoint, timeout=PATIENCE)
            try:
                async with client:
                    return asyncua.Client(endpoint, timeout=PATIENCE)
            except OSError:
                await asyncio.sleep(0.1)


@pytest.mark.parametrize(
    ("program", "section", "said"),
    [
        (mqtt_program, "[MQTT]\nPORT = 1883", "[MQTT]BROKER is missing"),
        (mqtt_program, "[MQTT]\nBROKER = a\nPORT = many", "[MQTT]PORT = many"),
        (opcua_program, "[OPCUA]\nENDPOINT = http://here", "[OPCUA]ENDPOINT = http://here"),
        (opcua_program, "[OPCUA]\nCERTIFICATE = none.pem", "[OPCUA]CERTIFICATE = none.pem"),
    ],
)
def test_a_mistake_in_the_section_is_one_clear_line(
    tmp_path: Path, program: Callable[[list[str]], int], section: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    ini = machine_with(tmp_path, section)
    assert program(["-ini", str(ini)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert str(ini) in line


def test_the_machine_goes_on_without_a_service_that_ends(tmp_path: Path) -> None:
    with running(machine_with(tmp_path, "[MQTT]\nPORT = 1883"), speed=10.0) as run:
        switch_on(run)
        wait_until(lambda: run.has_said("goes on without it"), "end of the service, told by the launcher")
        run.stop()
    assert "[MQTT]BROKER is missing" in run.errors
    assert "Traceback" not in run.errors
