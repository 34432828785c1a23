"""nmlcheck: every kind of contradiction is found, and stock files have none but their own."""

from pathlib import Path

import pytest

from nml.check import contradictions
from nml.config import DEFAULT_FILE, NmlConfig
from nml.tools import nmlcheck

GOOD = """B one SHMEM localhost 1024 0 0 1 16 6001 TCP=5005
B two SHMEM localhost 1024 0 0 2 16 6002 queue
P a one LOCAL localhost W 1 1.0 1 0
P a two LOCAL localhost W 0 1.0 1 0
P b default LOCAL localhost R 0 1.0 0 1
"""


def found(folder: Path, text: str) -> list[str]:
    path = folder / "test.nml"
    path.write_text(text)
    return [finding.removeprefix(f"{path}:") for finding in contradictions(NmlConfig(path))]


def test_a_consistent_file_has_no_contradictions(tmp_path: Path):
    assert found(tmp_path, GOOD) == []
    assert contradictions(NmlConfig.load(DEFAULT_FILE)) == []


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("B one SHMEM localhost 1024 0 0 9 16 6009", "6: buffer one is declared twice; first at"),
        ("P a one LOCAL localhost W 0 1.0 0 0", "6: process a has two lines for one; first at"),
        ("P a six LOCAL localhost W 0 1.0 0 0", "6: process a uses buffer six, which no B line declares"),
        ("B six SHMEM localhost 1024 0 0 9 16 6001", "6: buffers one and six have one key, 6001"),
        ("B six SHMEM localhost 1024 0 0 1 16 6003 TCP=5005", "6: buffers one and six have one number, 1, on port"),
        ("P c one LOCAL localhost R 0 1.0 0 16", "6: c_num 16 of c; buffer one has max_procs 16"),
        ("P c one LOCAL localhost R 0 1.0 0 1", "5: c and b both have c_num 1 in one"),
        ("P c one LOCAL localhost R 0 1.0 1 2", "6: buffer one has 2 masters: a, c"),
        ("B six SHMEM localhost 1024 0 0 9 16 6003", "6: buffer six has no master; one process line needs master 1"),
        ("B six SHMEM localhost 1024 0 0 9 16 6003", "6: no process may write buffer six"),
        ("B six SHMEM localhost 1024 0 0 9 16 6003 TCP=5006", "6: buffer six has a port, but no process serves it"),
        ("P c two REMOTE there R 0 1.0 0 2", "6: c is REMOTE, but buffer two has no TCP=, UDP=, STCP= or serial"),
        ("B six SHMEM localhost 1024 0 0 9 16 6003 broadcast", "6: buffer six is broadcast, but no queue"),
        ("B emcStatus SHMEM localhost 1024 0 0 9 16 6003", "6: EMC_STAT has 10784 bytes, messages of"),
        ("B emcError SHMEM localhost 300 0 0 9 16 6003 queue", "6: EMC_OPERATOR_ERROR has 280 bytes, "),
        ("B emcmotStatus SHMEM localhost 9999 1 0 9 16 6003", "6: buffer emcmotStatus is used by the servo"),
    ],
)
def test_a_contradiction_names_line_and_remedy(tmp_path: Path, line: str, text: str):
    assert any(finding.startswith(text) for finding in found(tmp_path, GOOD + line + "\n"))


def test_a_buffer_that_nobody_uses_is_told(tmp_path: Path):
    assert found(tmp_path, "B one SHMEM localhost 1024 0 0 1 16 6001\n") == ["1: no process uses buffer one"]


def test_the_tool_prints_topology_and_findings(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    path = tmp_path / "test.nml"
    path.write_text(GOOD)
    assert nmlcheck.main([str(path)]) == 0
    out = capsys.readouterr().out
    assert "one: SHMEM, single slot, 1024 bytes, key 6001, number 1, TCP=5005\n    a*  ->  b\n" in out
    path.write_text(GOOD + "P c one LOCAL localhost R 0 1.0 1 2\n")
    assert nmlcheck.main(["-q", str(path)]) == 1
    assert capsys.readouterr() == ("", f"{path}:6: buffer one has 2 masters: a, c\n")
    path.write_text("nonsense\n")
    assert nmlcheck.main([str(path)]) == 2
    assert "test.nml:1:1: 'nonsense' begins no line" in capsys.readouterr().err
