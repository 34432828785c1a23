"""The io process with real HAL pins and real buffers: E-stop chain, tool changes, coolant, table, death."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import hal
from nml.channel import Channel
from nml.emc import (
    EMC_AUX_ESTOP_OFF,
    EMC_AUX_ESTOP_ON,
    EMC_COOLANT_FLOOD_ON,
    EMC_IO_STAT,
    EMC_TOOL_ABORT,
    EMC_TOOL_LOAD,
    EMC_TOOL_LOAD_TOOL_TABLE,
    EMC_TOOL_PREPARE,
    EMC_TOOL_SET_OFFSET,
    EMC_TOOL_TABLE,
)
from nml.message import Command
from tests.support.machine import PATIENCE, ROOT, wait_until

pytestmark = pytest.mark.process

TABLE = "T1 P17 Z+1.0 D3 ;first\nT5 P3 Z2 ;second\n"
DONE, EXEC, ERROR = 1, 2, 3


class Io:
    """A running io, seen from task's side."""

    def __init__(self, folder: Path, random: bool) -> None:
        self.table_path = folder / "tool.tbl"
        self.table_path.write_text(TABLE)
        self.ini = folder / "io.ini"
        self.ini.write_text(f"[EMCIO]\nTOOL_TABLE = tool.tbl\nCYCLE_TIME = 0.01\nRANDOM_TOOLCHANGER = {int(random)}\n")
        self.process = self.start()
        self.commands = Channel(None, "toolCmd", process="emc")
        self.status_channel = Channel(None, "toolSts", process="emc")
        self.table_channel = Channel(None, "toolTable", process="emc")
        self.status = EMC_IO_STAT()
        self.serial = 0
        wait_until(lambda: self.look() or self.process.poll() is not None, "io is up")
        assert self.process.poll() is None, self.process.communicate()
        self.hal = hal.component("tester")

    def connect(self) -> None:
        """Make the pins of the test and join them with io's."""
        for name, kind, direction in (
            ("enable", hal.HAL_BIT, hal.HAL_OUT),
            ("prepared", hal.HAL_BIT, hal.HAL_OUT),
            ("changed", hal.HAL_BIT, hal.HAL_OUT),
        ):
            self.hal.newpin(name, kind, direction)
        self.hal.ready()
        for own, its in (("enable", "emc-enable-in"), ("prepared", "tool-prepared"), ("changed", "tool-changed")):
            hal.new_sig(own, hal.HAL_BIT)
            hal.connect(f"tester.{own}", own)
            hal.connect(f"iocontrol.0.{its}", own)

    def start(self) -> subprocess.Popen[str]:
        environment = dict(os.environ, PYTHONPATH=str(ROOT))
        arguments = [sys.executable, "-m", "emcio", "-ini", str(self.ini)]
        return subprocess.Popen(arguments, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def look(self) -> bool:
        message = self.status_channel.peek()
        if message is not None:
            self.status = message
        return message is not None

    def send(self, command: Command) -> None:
        """Send a command and wait until it is taken."""
        self.serial += 1
        command.serial_number = self.serial
        self.commands.write(command)
        self.until(lambda status: status.echo_serial_number == self.serial, f"{type(command).__name__} is taken")

    def until(self, condition, what: str) -> None:
        def arrived() -> bool:
            self.look()
            return condition(self.status)

        wait_until(arrived, what)

    def done(self) -> None:
        self.until(lambda status: status.status != EXEC, "the command is done")

    def pin(self, name: str):
        return hal.get_value(f"iocontrol.0.{name}")

    def change(self, tool: int) -> None:
        """A complete tool change with the test as the changer."""
        for command, request, answer in (
            (EMC_TOOL_PREPARE(tool=tool), "tool-prepare", "prepared"),
            (EMC_TOOL_LOAD(), "tool-change", "changed"),
        ):
            self.send(command)
            wait_until(lambda request=request: self.pin(request), request)
            self.hal[answer] = True
            wait_until(lambda request=request: not self.pin(request), f"end of {request}")
            self.hal[answer] = False
            self.done()

    def table(self) -> EMC_TOOL_TABLE:
        message = self.table_channel.peek()
        assert message is not None
        return message

    def end(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            assert self.process.wait(PATIENCE) == 0
        for stream in (self.process.stdout, self.process.stderr):
            stream.close()
        for channel in (self.commands, self.status_channel, self.table_channel):
            channel.close()
        self.hal.exit()


@pytest.fixture
def io(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Io]:
    machine = Io(tmp_path, getattr(request, "param", False))
    try:
        machine.connect()
        yield machine
    finally:
        machine.end()


def test_estop_is_what_comes_back_through_the_chain(io):
    assert io.status.aux.estop == 1
    io.send(EMC_AUX_ESTOP_OFF())
    wait_until(lambda: io.pin("user-enable-out") and io.pin("user-request-enable"), "the request")
    io.hal["enable"] = True
    io.until(lambda status: status.aux.estop == 0, "E-stop is reset")
    wait_until(lambda: not io.pin("user-request-enable"), "the request ends")
    io.hal["enable"] = False
    io.until(lambda status: status.aux.estop == 1, "E-stop")
    io.send(EMC_AUX_ESTOP_ON())
    wait_until(lambda: not io.pin("user-enable-out"), "io opens the chain")


def test_a_tool_change_goes_through_the_pins_into_the_published_table(io):
    io.change(5)
    assert (io.status.tool.toolInSpindle, io.status.tool.toolFromPocket, io.status.tool.pocketPrepped) == (5, 3, -1)
    wait_until(lambda: io.pin("tool-number") == 5, "the number on its pin")
    wait_until(lambda: io.table_channel.has_news(), "the table is published")
    assert io.table().tools[0].toolno == 5
    assert io.table_path.read_text() == TABLE


@pytest.mark.parametrize("io", [True], indirect=True)
def test_a_random_change_is_on_the_disk_when_it_is_reported_done(io):
    io.change(5)
    assert io.table_path.read_text() == "T1 P17 Z+1.0 D3 ;first\nT5 P0 Z2 ;second\n"
    io.change(1)
    assert io.table_path.read_text() == "T1 P0 Z+1.0 D3 ;first\nT5 P17 Z2 ;second\n"


@pytest.mark.parametrize("io", [True], indirect=True)
def test_a_killed_io_finds_its_tools_again(io):
    io.change(5)
    io.process.kill()
    io.process.wait()
    for stream in (io.process.stdout, io.process.stderr):
        stream.close()
    io.process = io.start()
    io.send(EMC_AUX_ESTOP_ON())  # only the new one can take it
    io.until(lambda status: status.tool.toolInSpindle == 5, "the tool of before")


def test_an_abort_during_a_change_leaves_the_spindle_and_stops_the_coolant(io):
    io.change(1)
    io.send(EMC_COOLANT_FLOOD_ON())
    io.send(EMC_TOOL_PREPARE(tool=5))
    wait_until(lambda: io.pin("tool-prepare"), "tool-prepare")
    io.send(EMC_TOOL_ABORT())
    io.done()
    wait_until(lambda: not io.pin("tool-prepare") and not io.pin("coolant-flood"), "everything is off")
    assert io.status.tool.toolInSpindle == 1


def test_an_unknown_tool_is_an_error_with_a_text_for_the_operator(io):
    errors = Channel(None, "emcError", process="xemc")
    io.send(EMC_TOOL_PREPARE(tool=9))
    io.until(lambda status: status.status == ERROR, "the error")
    wait_until(errors.has_news, "its text")
    assert "T9 is not in the tool table" in errors.read().error
    errors.close()


def test_offsets_are_written_to_the_file_and_a_reload_takes_over_edits(io):
    offset = (0, 0, 9.5, 0, 0, 0, 0, 0, 0)
    io.send(EMC_TOOL_SET_OFFSET(pocket=1, toolno=1, offset=offset, diameter=3.0))
    io.done()
    assert io.table_path.read_text().startswith("T1 P17 Z+9.500000 D3 ;first\n")
    io.table_path.write_text("T7 P7 Z7\n")
    io.send(EMC_TOOL_LOAD_TOOL_TABLE())
    io.done()
    wait_until(lambda: io.table_channel.has_news(), "the table is published")
    assert io.table().tools[1].toolno == 7


def test_a_reload_leaves_wrong_lines_out_and_says_what_is_wrong_with_them(io):
    errors = Channel(None, "emcError", process="xemc")
    io.table_path.write_text("T1 P1 Zx\nT5 P3\n")
    io.send(EMC_TOOL_LOAD_TOOL_TABLE())
    io.until(lambda status: status.status == ERROR, "the error")
    wait_until(errors.has_news, "its text")
    assert "tool.tbl:1: 'Zx' is no word of a tool table" in errors.read().error
    errors.close()
    io.send(EMC_TOOL_PREPARE(tool=5))
    wait_until(lambda: io.pin("tool-prepare"), "tool 5 is known")


def test_a_wrong_configuration_is_one_line_and_exit_code_1(tmp_path):
    ini = tmp_path / "io.ini"
    ini.write_text("[EMCIO]\nRANDOM_TOOLCHANGER = maybe\n")
    environment = dict(os.environ, PYTHONPATH=str(ROOT))
    arguments = [sys.executable, "-m", "emcio", "-ini", str(ini)]
    result = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert result.stderr.startswith(f"{ini}:2: [EMCIO]RANDOM_TOOLCHANGER: 'maybe' is not ")
    assert result.stderr.count("\n") == 1
