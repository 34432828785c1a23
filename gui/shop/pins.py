"""``mqtt-publisher keys=NAME,...``: tells an MQTT broker values of HAL again and again, as LinuxCNC's component does.

    loadusr -W mqtt-publisher --mqtt-broker=broker.example keys=Xpos,halui.machine.is-on

Each message is one JSON object with the values of pins, signals and parameters by name; null for one that is not there.
The pin ``period`` says how many seconds lie between two, ``enable`` whether any is sent, ``lastpublish`` when the last
was. ``--dryrun`` prints the messages and needs no broker.
"""

from __future__ import annotations

import argparse
import json
import math
import signal
import sys
import time
from collections.abc import Callable

import hal
from nml import clock
from nml.errors import HalError

NAME = "mqtt-publisher"
TOPIC = "devices/linuxcnc/machine"
PORT = 1883
PERIOD_S = 10
LOOK_S = 0.1  # host time between two looks at the pins
KEYS = "keys="
ENDS = {signal.SIGTERM, signal.SIGINT}


def values(names: list[str]) -> dict[str, object]:
    """What HAL has under these names."""
    return {name: _value(name) for name in names}


def _value(name: str) -> object:
    try:
        value: object = hal.get_value(name)
    except (HalError, RuntimeError):
        return None
    return value


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=NAME, description="Tell an MQTT broker values of HAL again and again.")
    parser.add_argument("--dryrun", action="store_true", help="print the messages instead")
    parser.add_argument("--mqtt-broker", metavar="HOST", default="localhost", help="default: localhost")
    parser.add_argument("--mqtt-port", metavar="PORT", type=int, default=PORT, help=f"default: {PORT}")
    parser.add_argument("--mqtt-user", metavar="NAME")
    parser.add_argument("--mqtt-password", metavar="WORD")
    parser.add_argument("--mqtt-prefix", metavar="TOPIC", default=TOPIC, help=f"default: {TOPIC}")
    parser.add_argument("keys", metavar="keys=NAME[,NAME...]", help="pins, signals and parameters, without blanks")
    options = parser.parse_args(arguments)
    if not options.keys.startswith(KEYS):
        parser.error(f"{options.keys!r}: {KEYS}NAME,... is needed")
    options.keys = [name for name in options.keys.removeprefix(KEYS).split(",") if name]
    return options


def _printer(text: str) -> None:
    print(text, flush=True)


def _to_broker(options: argparse.Namespace) -> tuple[Callable[[str], object], Callable[[], object]]:
    """What sends a message, and what takes leave."""
    import paho.mqtt.client as paho  # an extra of the package; a dry run does without

    client = paho.Client(paho.CallbackAPIVersion.VERSION2)
    client.username_pw_set(options.mqtt_user, options.mqtt_password)
    client.connect_async(options.mqtt_broker, options.mqtt_port)
    client.loop_start()

    def leave() -> None:
        client.disconnect()
        client.loop_stop()

    return lambda text: client.publish(options.mqtt_prefix, text), leave


def main(arguments: list[str] | None = None) -> int:
    """Run until SIGTERM or SIGINT; the exit code."""
    options = _options(arguments)
    signal.pthread_sigmask(signal.SIG_BLOCK, ENDS)
    try:
        send, leave = (_printer, lambda: None) if options.dryrun else _to_broker(options)
    except ImportError as error:
        print(f"{NAME}: {error}; pip install 'pyemc[shop]' brings what talks to a broker", file=sys.stderr)
        return 1
    component = hal.component(NAME)
    try:
        enable = component.newpin("enable", hal.HAL_BIT, hal.HAL_IN)
        period = component.newpin("period", hal.HAL_U32, hal.HAL_IN)
        last = component.newpin("lastpublish", hal.HAL_U32, hal.HAL_OUT)
        enable.set(True)
        period.set(PERIOD_S)
        component.ready()
        sent = -math.inf
        while not ENDS & signal.sigpending():  # sigtimedwait() would take a continued process for an ended one
            if enable.get() and clock.host_now() - sent >= period.get():
                sent = clock.host_now()
                send(json.dumps(values(options.keys)))
                last.set(int(time.time()))
            clock.host_sleep(LOOK_S)
        return 0
    finally:
        component.exit()
        leave()


if __name__ == "__main__":
    sys.exit(main())
