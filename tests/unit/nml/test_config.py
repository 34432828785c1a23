"""NML files: every field and option, and errors that name place and remedy."""

from pathlib import Path

import pytest

from nml.config import (
    DEFAULT_FILE,
    FOREVER,
    BufferType,
    Encoding,
    Mutex,
    NmlConfig,
    ProcessType,
)
from nml.errors import ConfigError

STOCK = Path("/usr/share/doc/linuxcnc/examples/sample-configs/common")

FULL = """# a comment
B one SHMEM localhost 1024 0 0 1 16 0x3e9 TCP=5005 UDP=5006 STCP=5007 xdr queue broadcast confirm_write serial diag
B two LOCMEM here 2048 1 9 2 4 1002 mutex=mao split ascii bsem=7 passwd=a.pwd subdiv=2 enc_max_size=99 version=3.2 # end
B three FILEMEM localhost 2048 0 0 3 4 1003 mutex=none disp serialPortDevName=/dev/ttyS0 baud=9600
B four PHANTOM localhost 2048 0 0 4 4 1004 msgpack
P a one LOCAL localhost RW 0 1.5 1 0
P a two AUTO here r 1 INF 0 1 shared
P b default REMOTE there W 0 -1 0 2 POLL sub=0.5 noreconnect max_timeouts=INF
"""


def parse(folder: Path, text: str) -> NmlConfig:
    path = folder / "test.nml"
    path.write_text(text)
    return NmlConfig(path)


def test_every_field_and_option_of_a_buffer_line_is_read(tmp_path: Path):
    config = parse(tmp_path, FULL)
    one, two, three, four = config.buffer_lines
    assert (one.name, one.type, one.host, one.size, one.number, one.max_procs, one.key) == (
        "one",
        BufferType.SHMEM,
        "localhost",
        1024,
        1,
        16,
        1001,
    )
    assert (one.tcp, one.udp, one.stcp, two.bsem) == (5005, 5006, 5007, 7)
    assert one.queue
    assert one.broadcast
    assert one.confirm_write
    assert one.serial
    assert one.diag
    assert (two.type, two.neutral, two.rpc, two.mutex, two.encoding) == (
        BufferType.LOCMEM,
        True,
        9,
        Mutex.MAO_SPLIT,
        Encoding.ASCII,
    )
    assert (two.passwd, two.subdivisions, two.enc_max_size, two.version) == ("a.pwd", 2, 99, 3.2)
    assert (three.mutex, three.encoding, three.serial_port, three.baud) == (
        Mutex.NONE,
        Encoding.DISP,
        "/dev/ttyS0",
        9600,
    )
    assert four.encoding is Encoding.MSGPACK


def test_every_field_and_option_of_a_process_line_is_read(tmp_path: Path):
    first, second, third = parse(tmp_path, FULL).process_lines
    assert (first.process, first.buffer, first.ops, first.timeout, first.master, first.c_num) == (
        "a",
        "one",
        "RW",
        1.5,
        True,
        0,
    )
    assert first.may_read
    assert first.may_write
    assert (second.type, second.server, second.timeout, second.shared) == (ProcessType.AUTO, True, FOREVER, True)
    assert second.may_read
    assert not second.may_write
    assert (third.type, third.timeout, third.poll, third.subscription, third.reconnect, third.max_timeouts) == (
        ProcessType.REMOTE,
        FOREVER,
        True,
        "0.5",
        False,
        None,
    )


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("X one", "test.nml:1:1: 'X' begins no line; B, P or a comment"),
        ("B one SHMEM localhost", "test.nml:1:1: size is missing: a whole number from 128"),
        ("B one SHM localhost 1024 0 0 1 16 1", "1:7: type is 'SHM'; one of SHMEM, LOCMEM, FILEMEM, PHANTOM, GLOBMEM"),
        ("B one SHMEM localhost big 0 0 1 16 1", "1:23: size is 'big'; a whole number from 128"),
        ("B one SHMEM localhost 1024 0 0 1 16 1 queu", "1:39: 'queu' is no option here; allowed are queue, broadcast"),
        ("B one SHMEM localhost 1024 0 0 1 16 1 TCP=70000", "1:39: TCP is '70000'; a whole number from 1 to 65535"),
        ("B one SHMEM localhost 1024 0 0 1 16 1 mutex=soft", "mutex is 'soft'; one of os_sem, none"),
        ("P a one LOCAL localhost X 0 1 0 0", "1:25: ops is 'X'; R, W or RW is allowed"),
        ("P a one LOCAL localhost R 0 soon 0 0", "timeout is 'soon'; seconds, a negative number or INF"),
        ("P a one LOCAL localhost R 0 1 0", "c_num is missing"),
        ("B " + "n" * 32 + " SHMEM localhost 1024 0 0 1 16 1", "1:3: name is"),
    ],
)
def test_a_wrong_line_names_place_and_what_is_allowed(tmp_path: Path, line: str, text: str):
    with pytest.raises(ConfigError) as caught:
        parse(tmp_path, line + "\n")
    assert text in str(caught.value)


def test_a_missing_file_is_one_line(tmp_path: Path):
    with pytest.raises(ConfigError, match=r"none\.nml: cannot read the NML file: No such file"):
        NmlConfig(tmp_path / "none.nml")


def test_a_process_uses_its_own_line_before_the_default_one(tmp_path: Path):
    config = parse(tmp_path, FULL)
    assert config.process("b", "one").buffer == "default"
    assert config.process("a", "one").buffer == "one"
    with pytest.raises(ConfigError, match="no P line of process 'a' for buffer 'three'; it has one, two"):
        config.process("a", "three")
    with pytest.raises(ConfigError, match="no buffer 'five'; the file has one, two, three, four"):
        config.buffer("five")


def test_our_own_buffers_are_added_and_go_the_way_of_the_status(tmp_path: Path):
    path = tmp_path / "client.nml"
    path.write_text(
        "B emcStatus SHMEM 10.0.0.1 20480 0 0 2 16 1002 TCP=6005\n"
        "B emcError SHMEM 10.0.0.1 8192 0 0 3 16 1003 TCP=6005 queue\n"
        "P xemc emcStatus REMOTE 10.0.0.1 R 0 3.0 0 10\n"
    )
    config = NmlConfig.load(path)
    table = config.buffer("toolTable")
    assert (table.host, table.tcp) == ("10.0.0.1", 6005)
    assert config.buffer("emcmotCommand").tcp is None
    assert (config.process("xemc", "toolTable").type, config.process("xemc", "toolTable").timeout) == (
        ProcessType.REMOTE,
        3.0,
    )
    assert config.buffer("emcError").broadcast


def test_the_file_comes_from_the_environment_or_the_ini_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("NML_FILE", raising=False)
    monkeypatch.delenv("INI_FILE_NAME", raising=False)
    assert NmlConfig.load().path == DEFAULT_FILE
    (tmp_path / "own.nml").write_text(FULL)
    (tmp_path / "machine.ini").write_text("[EMC]\nNML_FILE = own.nml\n")
    monkeypatch.setenv("INI_FILE_NAME", str(tmp_path / "machine.ini"))
    assert NmlConfig.load().path == tmp_path / "own.nml"
    monkeypatch.setenv("NML_FILE", str(DEFAULT_FILE))
    assert NmlConfig.load().path == DEFAULT_FILE


@pytest.mark.skipif(not STOCK.is_dir(), reason="Debian's LinuxCNC is not installed")
@pytest.mark.parametrize("name", ["linuxcnc.nml", "linuxcnc_big.nml", "client.nml", "server.nml"])
def test_linuxcncs_own_files_parse(name: str):
    config = NmlConfig.load(STOCK / name)
    assert {"emcCommand", "emcStatus", "emcError", "toolTable"} <= {line.name for line in config.buffer_lines}
