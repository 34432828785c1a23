"""mqtt-publisher as a process: values of HAL reach standard output in a dry run, and else a real broker."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import hal
from tests.process.test_shop import Broker, Reader, broker, needs_broker  # noqa: F401 - broker is a fixture
from tests.support.halsession import environment
from tests.support.machine import PATIENCE, wait_until

pytestmark = pytest.mark.process

LONGER_THAN_A_LOOK = 0.3  # s; the publisher looks at its pins every 0.1 s


class Messages(list[dict[str, object]]):
    """Those of the process ``pid``."""

    pid = 0


@contextlib.contextmanager
def publisher(*options: str) -> Iterator[Messages]:
    """Run it; the messages that it has printed so far."""
    messages = Messages()
    command = [sys.executable, "-m", "gui.shop.pins", *options]
    with subprocess.Popen(command, env=environment(), stdout=subprocess.PIPE, text=True) as process:
        messages.pid = process.pid
        assert process.stdout is not None
        lines = process.stdout

        def collect() -> None:
            for line in lines:
                messages.append(json.loads(line))

        thread = threading.Thread(target=collect)
        thread.start()
        try:
            wait_until(lambda: hal.component_exists("mqtt-publisher"), "component")
            wait_until(lambda: hal.component_is_ready("mqtt-publisher"), "ready")
            yield messages
        finally:
            process.terminate()
            code = process.wait(PATIENCE)
            thread.join()
    assert code == 0
    assert not hal.component_exists("mqtt-publisher")


def test_a_dry_run_prints_the_values() -> None:
    hal.new_sig("level", hal.HAL_FLOAT)
    hal.new_sig("open", hal.HAL_BIT)
    hal.set_s("level", "1.5")
    with publisher("--dryrun", "keys=level,open,nobody.knows") as messages:
        wait_until(lambda: len(messages) >= 1, "first message")
        assert messages[0] == {"level": 1.5, "open": False, "nobody.knows": None}
        wait_until(lambda: hal.get_value("mqtt-publisher.lastpublish") > 0, "time of the message")
        assert hal.get_value("mqtt-publisher.period") == 10
        assert hal.get_value("mqtt-publisher.enable")


def test_messages_come_as_often_as_the_pin_says() -> None:
    with publisher("--dryrun", "keys=mqtt-publisher.period") as messages:
        hal.set_p("mqtt-publisher.period", "1")
        wait_until(lambda: len(messages) >= 3, "three messages")
        assert messages[-1] == {"mqtt-publisher.period": 1}


def test_a_publisher_that_was_stopped_and_continued_goes_on() -> None:
    with publisher("--dryrun", "keys=mqtt-publisher.period") as messages:
        hal.set_p("mqtt-publisher.period", "1")
        for number in range(1, 4):
            wait_until(lambda number=number: len(messages) >= number, "a message")
            os.kill(messages.pid, signal.SIGSTOP)
            time.sleep(LONGER_THAN_A_LOOK)
            os.kill(messages.pid, signal.SIGCONT)


@needs_broker
def test_a_broker_gets_the_values(broker: Broker) -> None:  # noqa: F811
    reader = Reader(broker.port)
    hal.new_sig("level", hal.HAL_FLOAT)
    hal.set_s("level", "2.5")
    options = ["--mqtt-broker=127.0.0.1", f"--mqtt-port={broker.port}", "--mqtt-prefix=shop/lathe"]
    with publisher(*options, "keys=level"):
        hal.set_p("mqtt-publisher.period", "1")
        reader.wait("shop/lathe", {"level": 2.5})
    reader.close()


def test_what_is_missing_is_told(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "gui.shop.pins", "--dryrun", "level"]
    done = subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 2
    assert "'level': keys=NAME,... is needed" in done.stderr


def test_without_the_extra_of_the_package_it_says_what_is_missing() -> None:
    without = "import sys; sys.modules['paho'] = None; from gui.shop import pins; sys.exit(pins.main(['keys=a']))"
    done = subprocess.run(
        [sys.executable, "-c", without], env=environment(), capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert "pip install 'pyemc[shop]'" in done.stderr
