"""``linuxcnc-mqtt``: tells an MQTT broker what the machine does; it takes no orders.

    TOPIC/online              1, retained; 0 as last will and at the end
    TOPIC/status/NAME         one value as JSON, retained, when it changes (``items`` has the names)
    TOPIC/message             an operator message as JSON: kind, text, time

The section [MQTT] of the INI file names the broker. A broker that is away is tried again for ever; when it is back it
gets everything anew.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion

import linuxcnc
from gui.shop.items import MESSAGE_KINDS, Value, readings
from gui.shop.settings import Section
from nml.errors import ConfigError

QOS = 1  # each message arrives
FAREWELL = 2.0  # host seconds for the last messages
LONGEST_PAUSE = 30  # s between tries to reach the broker


@dataclass(frozen=True, slots=True)
class Settings:
    """The section [MQTT]."""

    broker: str
    port: int
    topic: str
    user: str
    password: str | None
    tls: bool
    authority: Path | None
    cycle: float
    """Host seconds between looks at the status: a value is told at most so often."""

    @classmethod
    def read(cls, path: Path) -> Settings:
        section = Section(path, "MQTT")
        tls = section.boolean("TLS")
        secret = section.file("PASSWORD_FILE")
        return cls(
            broker=section.required("BROKER", "broker.example"),
            port=int(section.real("PORT", 8883 if tls else 1883, 1, 65535)),
            topic=section.text("TOPIC", f"linuxcnc/{section.machine()}").strip("/"),
            user=section.text("USER"),
            password=secret.read_text().strip() if secret else None,
            tls=tls,
            authority=section.file("CA_FILE"),
            cycle=section.real("CYCLE_TIME", 0.2, 0.01, 3600.0),
        )


class Publisher:
    """The connection to the broker, and what it was told last."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._told: dict[str, Value] = {}
        self._connected = False
        self._client = client = paho.Client(CallbackAPIVersion.VERSION2)
        client.will_set(self._topic("online"), "0", QOS, retain=True)
        client.reconnect_delay_set(1, LONGEST_PAUSE)
        if settings.user:
            client.username_pw_set(settings.user, settings.password)
        if settings.tls:
            client.tls_set(ca_certs=str(settings.authority) if settings.authority else None)
        client.on_connect = self._on_connect
        client.on_disconnect = self._on_disconnect
        client.on_connect_fail = lambda client, data: self._complain("cannot be reached")

    def _topic(self, name: str) -> str:
        return f"{self._settings.topic}/{name}"

    def _complain(self, text: str) -> None:
        broker = f"{self._settings.broker}:{self._settings.port}"
        print(f"linuxcnc-mqtt: broker {broker} {text}", file=sys.stderr, flush=True)

    def _on_connect(
        self, client: paho.Client, data: object, flags: object, reason: paho.ReasonCode, properties: object
    ) -> None:
        if reason.is_failure:
            self._complain(f"refuses: {reason}")
            return
        self._told.clear()
        client.publish(self._topic("online"), "1", QOS, retain=True)
        self._connected = True

    def _on_disconnect(
        self, client: paho.Client, data: object, flags: object, reason: paho.ReasonCode, properties: object
    ) -> None:
        if self._connected and reason.is_failure:
            self._complain(f"is gone: {reason}")
        self._connected = False

    def start(self) -> None:
        """Connect, in a thread of the client's own."""
        self._client.connect_async(self._settings.broker, self._settings.port)
        self._client.loop_start()

    def tell(self, values: dict[str, Value]) -> None:
        """Publish what has changed."""
        if not self._connected:
            return
        for name, value in values.items():
            if self._told.get(name) != value:
                self._client.publish(self._topic(f"status/{name}"), json.dumps(value), QOS, retain=True)
                self._told[name] = value

    def message(self, kind: str, text: str) -> None:
        """Publish an operator message."""
        if self._connected:
            content = {"kind": kind, "text": text, "time": time.time()}
            self._client.publish(self._topic("message"), json.dumps(content), QOS)

    def stop(self) -> None:
        """Take leave."""
        if self._connected:
            self._client.publish(self._topic("online"), "0", QOS, retain=True).wait_for_publish(FAREWELL)
        self._client.disconnect()
        self._client.loop_stop()


def publish(settings: Settings, stopping: list[bool]) -> None:
    """Publish until ``stopping`` has an element."""
    status, errors = linuxcnc.stat(), linuxcnc.error_channel()
    publisher = Publisher(settings)
    publisher.start()
    try:
        while not stopping:
            status.poll()
            publisher.tell(readings(status))
            while (message := errors.poll()) is not None:
                publisher.message(MESSAGE_KINDS.get(message[0], "text"), message[1])
            time.sleep(settings.cycle)
    finally:
        publisher.stop()


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    parser = argparse.ArgumentParser(prog="linuxcnc-mqtt", description="Tell an MQTT broker what the machine does.")
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="INI file of the machine")
    options = parser.parse_args(arguments)
    stopping: list[bool] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stopping.append(True))
    try:
        if options.ini is None:
            raise ConfigError("no INI file; give one with -ini")
        publish(Settings.read(Path(options.ini)), stopping)
    except (ConfigError, linuxcnc.error, OSError, ValueError) as reason:
        print(f"linuxcnc-mqtt: {reason}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
