"""The NML file for programs on another computer."""

from __future__ import annotations

from pathlib import Path

import pytest

from nml.config import NmlConfig, ProcessType
from nml.errors import ConfigError
from nml.net.client_file import client_file
from nml.net.server import main

STOCK_STYLE = """\
# buffers of a machine
B emcCommand  SHMEM localhost  8192  0 0 1 16 1001 TCP=5005 xdr queue confirm_write serial  # commands
B emcStatus   SHMEM localhost 20480  0 0 2 16 1002 TCP=5005 xdr
B private     SHMEM localhost  1024  0 0 9 16 1009
P emcsvr default    LOCAL localhost RW 1 1.0 1 2
P xemc   emcCommand LOCAL localhost W  0 10.0 0 10
P xemc   emcStatus  LOCAL localhost R  0 10.0 0 10
P xemc   private    LOCAL localhost R  0 10.0 0 10
P emc    emcStatus  LOCAL localhost W  0 1.0 0 0
"""


@pytest.fixture
def machine_file(tmp_path: Path) -> Path:
    path = tmp_path / "machine.nml"
    path.write_text(STOCK_STYLE)
    return path


def test_served_buffers_are_reached_at_the_host_by_the_clients_process(machine_file: Path, tmp_path: Path) -> None:
    path = tmp_path / "remote.nml"
    path.write_text(client_file(NmlConfig.load(machine_file), "emcsvr", "192.168.1.20"))
    made = NmlConfig(path)
    assert [line.name for line in made.buffer_lines] == ["emcCommand", "emcStatus"]
    assert {line.host for line in made.buffer_lines} == {"192.168.1.20"}
    assert made.buffer("emcCommand").confirm_write
    assert [(line.process, line.buffer, line.type) for line in made.process_lines] == [
        ("xemc", "emcCommand", ProcessType.REMOTE),
        ("xemc", "emcStatus", ProcessType.REMOTE),
    ]


def test_the_command_prints_it(machine_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["-nml", str(machine_file), "--client-file", "cnc.local"]) == 0
    assert "P xemc emcStatus REMOTE cnc.local R 0 10.0 0 10\n" in capsys.readouterr().out


def test_a_file_without_clients_is_an_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "alone.nml"
    path.write_text("".join(line for line in STOCK_STYLE.splitlines(True) if not line.startswith("P xemc")))
    with pytest.raises(ConfigError, match=r"alone.nml: no P line of process xemc"):
        client_file(NmlConfig(path), "emcsvr", "cnc.local")
