"""The INI file of mb2hal: [MB2HAL_INIT], and one [TRANSACTION_nn] for each thing to read or write again and again.

What belongs to the link, the device's number and the timeouts may be left out where they are those of the transaction
before. A wrong entry raises ConfigError with its place.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TypeVar

from hal.modbus.links import SerialPlace, TcpPlace, Timeouts
from hal.modbus.protocol import (
    MOST_BITS_READ,
    MOST_BITS_WRITTEN,
    MOST_WORDS_READ,
    MOST_WORDS_WRITTEN,
    Function,
)
from hal.modbus.trace import Trace
from nml.inifile import IniFile

T = TypeVar("T")

INIT = "MB2HAL_INIT"
COMMON, TRANSACTION, TCP, SERIAL = (
    f"parse_{part}" for part in ("common_section", "transaction_section", "tcp_subsection", "serial_subsection")
)
PINS_BY_TYPE = 1001
"""From this version of the configuration on the names of all pins end in their type, and single coils are known."""
LONGEST_NAME = 28
FUNCTIONS = {
    "fnct_02_read_discrete_inputs": Function(2, False, True, MOST_BITS_READ),
    "fnct_03_read_holding_registers": Function(3, False, False, MOST_WORDS_READ),
    "fnct_04_read_input_registers": Function(4, False, False, MOST_WORDS_READ),
    "fnct_06_write_single_register": Function(6, True, False, MOST_WORDS_WRITTEN),
    "fnct_15_write_multiple_coils": Function(15, True, True, MOST_BITS_WRITTEN),
    "fnct_16_write_multiple_registers": Function(16, True, False, MOST_WORDS_WRITTEN),
    "fnct_01_read_coils": Function(1, False, True, MOST_BITS_READ),
    "fnct_05_write_single_coil": Function(5, True, True, MOST_BITS_WRITTEN),
}
"""In LinuxCNC's order, which its messages show."""
NEW_FUNCTIONS = frozenset({1, 5})
LINK_TYPES = {"serial": 0, "tcp": 1}
PARITIES = {"none": "N", "even": "E", "odd": "O"}


@dataclass(frozen=True, slots=True)
class Transaction:
    """One [TRANSACTION_nn]."""

    number: int
    place: TcpPlace | SerialPlace
    delay_s: float
    """Host time that a serial line rests after it."""
    device: int
    first: int
    elements: tuple[str, ...]
    """The last but one parts of the pins' names."""
    rate: float
    """Times a second at most; 0: as often as possible."""
    timeouts: Timeouts
    debug: int
    function: Function
    name: str


@dataclass(frozen=True, slots=True)
class Config:
    """The whole file."""

    module: str
    version: int
    slowdown_s: float
    """Host time between two transactions of a link."""
    transactions: list[Transaction]


def read(ini: IniFile, trace: Trace) -> Config:
    """Read it all; the level of ``trace`` becomes INIT_DEBUG."""
    trace.level = ini.integer(INIT, "INIT_DEBUG", 1, minimum=0, maximum=4)
    version = _version(ini)
    module = ini.find(INIT, "HAL_MODULE_NAME", "mb2hal")
    slowdown = ini.real(INIT, "SLOWDOWN", 0.0, minimum=0.0)
    total = ini.integer(INIT, "TOTAL_TRANSACTIONS", minimum=1)
    shown = {
        "INIT_DEBUG": trace.level,
        "VERSION": version,
        "HAL_MODULE_NAME": module,
        "SLOWDOWN": f"{slowdown:.3f}",
        "TOTAL_TRANSACTIONS": total,
    }
    for key, value in shown.items():
        trace.detail(COMMON, f"[{INIT}] [{key}] [{value}]")
    transactions: list[Transaction] = []
    for number in range(total):
        before = transactions[-1] if transactions else None
        transactions.append(_Reader(ini, trace, number, version).read(before))
        trace.ok("parse_ini_file", f"parse_transaction_section {number} OK")
    return Config(module, version, slowdown, transactions)


def _version(ini: IniFile) -> int:
    text = ini.find(INIT, "VERSION", "1.0")
    if not (parts := re.fullmatch(r"(\d+)\.(\d{1,3})", text)):
        raise ini.error(INIT, "VERSION", f"{text!r} is no version; N.N is, 1.1 for example")
    return int(parts[1]) * 1000 + int(parts[2])


class _Reader:
    """Reads one section."""

    def __init__(self, ini: IniFile, trace: Trace, number: int, version: int) -> None:
        self._ini, self._trace, self._number, self._version = ini, trace, number, version
        self._section = f"TRANSACTION_{number:02}"

    def read(self, before: Transaction | None) -> Transaction:
        """All its entries, in the order in which LinuxCNC shows them."""
        place, delay_ms = self._place(before)
        device = self._whole("MB_SLAVE_ID", before.device if before else None, 0, 255)
        first = self._whole("FIRST_ELEMENT", None, 0, 0xFFFF)
        elements = self._elements()
        rate = self._show("MAX_UPDATE_RATE", self._ini.real(self._section, "MAX_UPDATE_RATE", 0.0, minimum=0.0))
        known = before.timeouts if before else Timeouts(0.5, 0.5)
        response = self._whole("MB_RESPONSE_TIMEOUT_MS", round(known.response * 1000), 1, 60_000)
        byte = self._whole("MB_BYTE_TIMEOUT_MS", round(known.byte * 1000), 1, 60_000)
        debug = self._whole("DEBUG", 1, 0, 4)
        function = self._function(len(elements))
        name = self._ini.find(self._section, "HAL_TX_NAME", f"{self._number:02}")
        if len(name) > LONGEST_NAME:
            raise self._ini.error(self._section, "HAL_TX_NAME", f"{name} has more than {LONGEST_NAME} characters")
        self._show("HAL_TX_NAME", name)
        timeouts = Timeouts(response / 1000, byte / 1000)
        return Transaction(
            self._number, place, delay_ms / 1000, device, first, elements, rate, timeouts, debug, function, name
        )

    def _place(self, before: Transaction | None) -> tuple[TcpPlace | SerialPlace, int]:
        known = before.place if before else None
        usual = None if known is None else "tcp" if isinstance(known, TcpPlace) else "serial"
        kind = self._ini.find(self._section, "LINK_TYPE") or usual
        if kind not in LINK_TYPES:
            raise self._ini.error(self._section, "LINK_TYPE", f"{kind!r} is no kind of link; serial or tcp is")
        self._trace.detail(TRANSACTION, f"[{self._section}] [LINK_TYPE] [{kind}] [{LINK_TYPES[kind]}]")
        if kind == "tcp":
            return self._tcp(known if isinstance(known, TcpPlace) else None), 0
        delay = round(before.delay_s * 1000) if before else 0
        return self._serial(known if isinstance(known, SerialPlace) else None, delay)

    def _tcp(self, known: TcpPlace | None) -> TcpPlace:
        address = self._text(TCP, "TCP_IP", known.address if known else None)
        return TcpPlace(address, self._whole("TCP_PORT", known.port if known else 502, 1, 65535, TCP))

    def _serial(self, known: SerialPlace | None, delay_ms: int) -> tuple[SerialPlace, int]:
        device = self._text(SERIAL, "SERIAL_PORT", known.device if known else None)
        baud = self._whole("SERIAL_BAUD", known.baud if known else None, 1, 10_000_000, SERIAL)
        bits = self._whole("SERIAL_BITS", known.bits if known else None, 5, 8, SERIAL)
        words = {letter: word for word, letter in PARITIES.items()}
        word = self._text(SERIAL, "SERIAL_PARITY", words[known.parity] if known else None)
        if word not in PARITIES:
            raise self._ini.error(self._section, "SERIAL_PARITY", f"{word!r} is no parity; even, odd or none is")
        stop = self._whole("SERIAL_STOP", known.stop if known else None, 1, 2, SERIAL)
        delay_ms = self._whole("SERIAL_DELAY_MS", delay_ms, 0, 60_000, SERIAL)
        return SerialPlace(device, baud, bits, PARITIES[word], stop), delay_ms

    def _elements(self) -> tuple[str, ...]:
        names = self._ini.find(self._section, "PIN_NAMES")
        if names is None:
            count = self._whole("NELEMENTS", None, 1, MOST_BITS_READ)
            return tuple(f"{n:02}" for n in range(count))
        if self._ini.find(self._section, "NELEMENTS") is not None:
            raise self._ini.error(self._section, "NELEMENTS", "PIN_NAMES is there too; one of them is enough")
        self._show("PIN_NAMES", names)
        found = tuple(names.split(","))
        if not all(re.fullmatch(r"\S+", name) for name in found):
            raise self._ini.error(self._section, "PIN_NAMES", f"{names!r}: names stand between commas, without blanks")
        self._show("NELEMENTS", len(found))
        return found

    def _function(self, count: int) -> Function:
        code = self._ini.find(self._section, "MB_TX_CODE", "")
        known = FUNCTIONS.get(code)
        if known is None or (known.code in NEW_FUNCTIONS and self._version < PINS_BY_TYPE):
            right = ", ".join(name for name, one in FUNCTIONS.items() if one.code not in NEW_FUNCTIONS)
            more = ", and with VERSION = 1.1 fnct_01_read_coils and fnct_05_write_single_coil"
            raise self._ini.error(self._section, "MB_TX_CODE", f"{code!r} is no function; {right} are{more}")
        if count > known.most:
            raise self._ini.error(self._section, "MB_TX_CODE", f"{count} elements are too many, {known.most} the most")
        self._trace.detail(TRANSACTION, f"[{self._section}] [MB_TX_CODE] [{code}] [{list(FUNCTIONS).index(code) + 1}]")
        return known

    def _text(self, part: str, key: str, known: str | None) -> str:
        text = self._ini.find(self._section, key) or known
        if text is None:
            raise self._ini.error(self._section, key, "missing; the first transaction of a link needs it")
        self._trace.detail(part, f"[{self._section}] [{key}] [{text}]")
        return text

    def _whole(self, key: str, known: int | None, low: int, high: int, part: str = TRANSACTION) -> int:
        if known is None:
            value = self._ini.integer(self._section, key, minimum=low, maximum=high)
        else:
            value = self._ini.integer(self._section, key, known, minimum=low, maximum=high)
        self._trace.detail(part, f"[{self._section}] [{key}] [{value}]")
        return value

    def _show(self, key: str, value: T) -> T:
        text = f"{value:.3f}" if isinstance(value, float) else value
        self._trace.detail(TRANSACTION, f"[{self._section}] [{key}] [{text}]")
        return value
