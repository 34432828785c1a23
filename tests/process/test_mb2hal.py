"""mb2hal as a process: what a device has shows in pins, and what pins have reaches the device."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import hal
from tests.support.halsession import environment
from tests.support.modbus_device import Device, over_tcp

pytestmark = pytest.mark.process

INI = """\
[MB2HAL_INIT]
VERSION=1.1
HAL_MODULE_NAME=plc
TOTAL_TRANSACTIONS=6
[TRANSACTION_00]
LINK_TYPE=tcp
TCP_IP=127.0.0.1
TCP_PORT={port}
MB_SLAVE_ID=7
MB_RESPONSE_TIMEOUT_MS=30000
MB_BYTE_TIMEOUT_MS=30000
MB_TX_CODE=fnct_02_read_discrete_inputs
HAL_TX_NAME=in
FIRST_ELEMENT=0
PIN_NAMES=door,light
[TRANSACTION_01]
MB_TX_CODE=fnct_04_read_input_registers
HAL_TX_NAME=analog
FIRST_ELEMENT=2
NELEMENTS=2
[TRANSACTION_02]
MB_TX_CODE=fnct_15_write_multiple_coils
HAL_TX_NAME=out
FIRST_ELEMENT=4
NELEMENTS=2
[TRANSACTION_03]
MB_TX_CODE=fnct_16_write_multiple_registers
HAL_TX_NAME=speed
FIRST_ELEMENT=6
NELEMENTS=1
[TRANSACTION_04]
MB_TX_CODE=fnct_03_read_holding_registers
HAL_TX_NAME=missing
FIRST_ELEMENT=90
NELEMENTS=1
[TRANSACTION_05]
MB_TX_CODE=fnct_05_write_single_coil
HAL_TX_NAME=one
FIRST_ELEMENT=8
NELEMENTS=1
"""


def until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end, "it does not come to it"
        time.sleep(0.01)


@pytest.fixture
def device(tmp_path: Path) -> Iterator[Device]:
    """A device whose values mb2hal exchanges with pins."""
    device = Device()
    with over_tcp(device) as port:
        (tmp_path / "plc.ini").write_text(INI.format(port=port))
        command = [sys.executable, "-m", "hal.modbus.program", "config=plc.ini"]
        process = subprocess.Popen(command, cwd=tmp_path, env=environment())
        try:
            until(lambda: hal.component_exists("plc") and hal.component_is_ready("plc"))
            yield device
        finally:
            process.terminate()
            assert process.wait(60) == 0
    assert not hal.component_exists("plc")


def test_inputs_and_registers_show_in_pins(device: Device) -> None:
    bits = [f"plc.in.{name}" for name in ("door.bit", "door.bit-inv", "light.bit", "light.bit-inv")]
    until(lambda: [hal.get_value(name) for name in bits] == [True, False, False, True])
    until(lambda: hal.get_value("plc.analog.01.int") == 3000 and hal.get_value("plc.analog.00.float") == 2000.0)
    device.inputs[1] = 1
    until(lambda: hal.get_value("plc.in.light.bit") and not hal.get_value("plc.in.light.bit-inv"))


def test_pins_reach_coils_and_registers(device: Device) -> None:
    hal.set_p("plc.out.01.bit", "1")
    hal.set_p("plc.one.00.bit", "1")
    until(lambda: device.coils[5] == device.coils[8] == 1)
    assert device.coils[4] == 0
    hal.set_p("plc.speed.00.float", "40.9")
    hal.set_p("plc.speed.00.int", "100")
    until(lambda: device.holding[6] == 140)
    hal.set_p("plc.speed.00.int", "70000")
    until(lambda: device.holding[6] == 65535)
    hal.set_p("plc.speed.00.int", "-70000")
    until(lambda: device.holding[6] == 0)


def test_a_transaction_that_fails_counts_its_errors_and_holds_up_no_other(device: Device) -> None:
    until(lambda: hal.get_value("plc.missing.num_errors") >= 2)
    assert hal.get_value("plc.in.num_errors") == 0
    device.registers[2] = 5
    until(lambda: hal.get_value("plc.analog.00.int") == 5)


def test_a_wrong_file_is_told_in_a_line(tmp_path: Path) -> None:
    (tmp_path / "wrong.ini").write_text("[MB2HAL_INIT]\nTOTAL_TRANSACTIONS=none\n")
    command = [sys.executable, "-m", "hal.modbus.program", "config=wrong.ini"]
    done = subprocess.run(command, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert done.stderr.startswith("mb2hal: wrong.ini:2: [MB2HAL_INIT]TOTAL_TRANSACTIONS: 'none' is not a whole number")
