"""HAL files in two passes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from hal import twopass
from hal.realtime import REALTIME_VARIABLE
from hal.session import Session
from nml.errors import HalError


@pytest.fixture
def session(own_namespace: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Session]:
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    with Session() as made:
        yield made
        made.teardown()


def test_loads_of_one_module_are_joined() -> None:
    loads = twopass.Loads()
    for line in ("loadrt and2 names=a,b", "loadusr -W x", "loadrt pid num_chan=2", "loadrt and2 names=c",
                 "loadrt pid num_chan=1 debug=1", "loadusr -W x"):  # fmt: skip
        loads.add(line.split())
    assert loads.commands() == [
        ["loadrt", "and2", "names=a,b,c"], ["loadrt", "pid", "num_chan=3", "debug=1"], ["loadusr", "-W", "x"],
    ]  # fmt: skip


@pytest.mark.parametrize("second", ["loadrt and2 names=b", "loadrt and2 count=1"])
def test_loads_that_contradict_are_refused(second: str) -> None:
    loads = twopass.Loads()
    loads.add(["loadrt", "and2", "names=a,b"])
    with pytest.raises(HalError, match="TWOPASS: and2"):
        loads.add(second.split())


def test_files_are_read_twice(session: Session, tmp_path: Path) -> None:
    first, second, third = (tmp_path / f"{n}.hal" for n in range(3))
    first.write_text("loadrt and2 names=a\nnet s a.out => b.in0\n")
    second.write_text("loadrt and2 names=b\nsetp b.in1 1\n")
    third.write_text("#NOTWOPASS\nloadrt or2\nsetp or2.0.in0 1\n")
    assert twopass.run(session, [(first, ()), (second, ()), (third, ())])
    assert session.hal.segment.find_comp("and2").args == "names=a,b"  # type: ignore[union-attr]
    assert [pin.shown for pin in session.hal.signal("s").pins()] == ["a.out", "b.in0"]
    assert (session.hal.value("b.in1"), session.hal.value("or2.0.in0")) == (True, True)
    assert session.pass_number == -1


def test_without_two_passes_the_second_load_is_refused(
    session: Session, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "f.hal"
    path.write_text("loadrt and2 names=a\nloadrt and2 names=b\n")
    assert not session.run_file(path)
    assert capsys.readouterr().err == f"{path}:2: and2: already exists\n"
