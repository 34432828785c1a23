"""``hal.modbus``: requests and answers, links to a device, and the INI file of mb2hal."""

from __future__ import annotations

from pathlib import Path

import pytest

from hal.modbus import config, protocol
from hal.modbus.config import FUNCTIONS
from hal.modbus.links import Link, SerialLink, SerialPlace, TcpLink, TcpPlace, Timeouts
from hal.modbus.protocol import ModbusError
from hal.modbus.trace import Trace
from nml.errors import ConfigError
from nml.inifile import IniFile
from tests.support.modbus_device import Device, on_a_line, over_tcp

PATIENT = Timeouts(30.0, 30.0)
READ_BITS, READ_WORDS = FUNCTIONS["fnct_02_read_discrete_inputs"], FUNCTIONS["fnct_04_read_input_registers"]
LINE = "LINK_TYPE=serial\nSERIAL_PORT=/dev/x\nSERIAL_BAUD=9600\nSERIAL_BITS=8\nSERIAL_PARITY=even\nSERIAL_STOP=1\n"
NET = "LINK_TYPE=tcp\nTCP_IP=10.0.0.1\n"
WHAT = "MB_TX_CODE=fnct_03_read_holding_registers\nFIRST_ELEMENT=4\nNELEMENTS=2\n"


def test_the_checksum_is_that_of_the_specification() -> None:
    assert protocol.crc(bytes.fromhex("1103006B0003")) == bytes.fromhex("7687")


@pytest.mark.parametrize(
    ("name", "values", "requests"),
    [
        ("fnct_05_write_single_coil", [1, 0], ["050009ff00", "05000a0000"]),
        ("fnct_06_write_single_register", [0x1234], ["0600091234"]),
        ("fnct_15_write_multiple_coils", [1, 0, 1, 1, 0, 0, 1, 1, 1, 0], ["0f0009000a02cd01"]),
        ("fnct_16_write_multiple_registers", [10, 258], ["1000090002" "04000a0102"]),
    ],
)  # fmt: skip
def test_values_are_packed_as_the_specification_says(name: str, values: list[int], requests: list[str]) -> None:
    assert [request.hex() for request in protocol.write_requests(FUNCTIONS[name], 9, values)] == requests


@pytest.mark.parametrize(
    ("answer", "complaint"),
    [
        ("8202", "illegal data address"),
        ("04020001", "answer to function 4"),
        ("0202ff", "1 bytes came"),
        ("02", "too short"),
    ],
)
def test_an_answer_that_is_none_is_refused(answer: str, complaint: str) -> None:
    with pytest.raises(ModbusError, match=complaint):
        protocol.values(READ_BITS, 10, bytes.fromhex(answer))


def exercise(link: Link, device: Device) -> None:
    """Each function does on the device what it says."""

    def ask(name: str, values: list[int]) -> None:
        for request in protocol.write_requests(FUNCTIONS[name], 3, values):
            protocol.check(FUNCTIONS[name], link.exchange(device.NUMBER, request, PATIENT))

    def get(name: str, count: int) -> list[int]:
        function = FUNCTIONS[name]
        return protocol.values(
            function, count, link.exchange(device.NUMBER, protocol.read_request(function, 3, count), PATIENT)
        )

    assert get("fnct_02_read_discrete_inputs", 10) == [1, 0, 0, 1, 0, 0, 1, 0, 0, 1]
    assert get("fnct_04_read_input_registers", 3) == [3000, 4000, 5000]
    ask("fnct_15_write_multiple_coils", [1, 0, 1, 1, 0, 0, 1, 1, 1])
    assert get("fnct_01_read_coils", 9) == [1, 0, 1, 1, 0, 0, 1, 1, 1]
    ask("fnct_05_write_single_coil", [0])
    assert device.coils[3] == 0
    ask("fnct_16_write_multiple_registers", [1, 65535])
    ask("fnct_06_write_single_register", [17])
    assert get("fnct_03_read_holding_registers", 2) == [17, 65535]
    with pytest.raises(ModbusError, match="illegal data address"):
        get("fnct_04_read_input_registers", 100)
    assert get("fnct_04_read_input_registers", 1) == [3000]
    link.close()


def test_a_device_on_the_network_does_what_each_function_says() -> None:
    device = Device()
    with over_tcp(device) as port:
        exercise(TcpLink(TcpPlace("127.0.0.1", port)), device)


def test_a_device_on_a_serial_line_does_what_each_function_says() -> None:
    device = Device()
    with on_a_line(device) as near:
        exercise(SerialLink(SerialPlace(near, 19200, 8, "N", 1)), device)


def test_a_device_that_is_not_there_is_an_error_and_not_a_wait_for_ever() -> None:
    with on_a_line(Device()) as near:
        link = SerialLink(SerialPlace(near, 19200, 8, "N", 1))
        with pytest.raises(ModbusError, match="does not answer"):
            link.exchange(Device.NUMBER + 1, protocol.read_request(READ_WORDS, 0, 1), Timeouts(0.05, 0.05))
        link.close()
    with pytest.raises(ModbusError, match="nowhere"):
        SerialLink(SerialPlace("/dev/nowhere", 19200, 8, "N", 1)).exchange(1, b"", PATIENT)


def read(tmp_path: Path, *sections: str, version: str = "1.1") -> config.Config:
    path = tmp_path / "mb2hal.ini"
    text = f"[MB2HAL_INIT]\nVERSION={version}\nTOTAL_TRANSACTIONS={len(sections)}\n"
    path.write_text(text + "".join(f"[TRANSACTION_{n:02}]\n{body}" for n, body in enumerate(sections)))
    return config.read(IniFile(path), Trace())


def test_a_transaction_takes_link_device_and_timeouts_from_the_one_before(tmp_path: Path) -> None:
    first = f"{NET}MB_SLAVE_ID=3\nMB_RESPONSE_TIMEOUT_MS=50\nHAL_TX_NAME=in\nMAX_UPDATE_RATE=5\nDEBUG=3\n{WHAT}"
    named = "MB_TX_CODE=fnct_05_write_single_coil\nFIRST_ELEMENT=9\nPIN_NAMES=a,b\n"
    one, two, three, four = read(tmp_path, first, named, f"{LINE}SERIAL_DELAY_MS=2\n{WHAT}", WHAT).transactions
    assert (one.place, one.elements, one.rate, one.debug, one.name) == (
        TcpPlace("10.0.0.1", 502),
        ("00", "01"),
        5,
        3,
        "in",
    )
    assert (two.place, two.device, two.timeouts) == (one.place, 3, Timeouts(0.05, 0.5))
    assert (two.elements, two.rate, two.debug, two.name, two.first) == (("a", "b"), 0, 1, "01", 9)
    assert three.place == four.place == SerialPlace("/dev/x", 9600, 8, "E", 1)
    assert three.delay_s == four.delay_s == 0.002


@pytest.mark.parametrize(
    ("section", "version", "complaint"),
    [
        (f"MB_SLAVE_ID=1\n{WHAT}", "1.1", r"\[TRANSACTION_00\]LINK_TYPE"),
        (f"LINK_TYPE=tcp\nMB_SLAVE_ID=1\n{WHAT}", "1.1", r"TCP_IP: missing"),
        (f"{NET}{WHAT}", "1.1", "MB_SLAVE_ID: missing"),
        (f"{NET}MB_SLAVE_ID=1\n{WHAT}PIN_NAMES=a\n", "1.1", "one of them is enough"),
        (f"{NET}MB_SLAVE_ID=1\n{WHAT.replace('NELEMENTS=2', 'NELEMENTS=126')}", "1.1", "125 the most"),
        (f"{NET}MB_SLAVE_ID=1\n{WHAT.replace('03_read_holding_registers', '01_read_coils')}", "1.0", "VERSION = 1.1"),
        (f"{NET}MB_SLAVE_ID=1\nHAL_TX_NAME={29 * 'x'}\n{WHAT}", "1.1", "more than 28"),
        (f"{NET}MB_SLAVE_ID=1\n{WHAT}", "one", "is no version"),
    ],
)
def test_a_wrong_entry_is_named_with_its_place(tmp_path: Path, section: str, version: str, complaint: str) -> None:
    with pytest.raises(ConfigError, match=complaint) as caught:
        read(tmp_path, section, version=version)
    assert "mb2hal.ini" in str(caught.value)
