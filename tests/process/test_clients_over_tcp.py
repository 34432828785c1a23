"""A machine whose NML file makes its own clients remote: the display reaches task through the NML server."""

import re
from pathlib import Path

import pytest

import linuxcnc
from linuxcnc.aio import Outcome
from tests.support.machine import PACKAGED_NML, RshClient, copy_mill, running, traces, wait_until
from tests.support.nml_server import free_port, remote_text

pytestmark = pytest.mark.process

LINUXCNCS_OWN = ("emcCommand", "emcStatus", "emcError", "toolCmd", "toolSts")


def stock_file(port: int) -> str:
    """An NML file as LinuxCNC has it, with its five buffers only, whose clients are remote."""
    text = re.sub(r"TCP=\d+", f"TCP={port}", remote_text(PACKAGED_NML.read_text()))
    lines = [line for line in text.splitlines() if line.startswith(("B ", "P "))]
    return "\n".join(line for line in lines if line.split()[1 if line[0] == "B" else 2] in (*LINUXCNCS_OWN, "default"))


def test_a_display_that_is_a_remote_client_runs_the_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ini, port = copy_mill(tmp_path), free_port()
    (tmp_path / "local.nml").write_text(stock_file(port) + "\n")
    with running(ini, speed=10.0) as run, RshClient(run.port()) as client:
        client.take_control()
        for line in ("set estop off", "set machine on", "set mode manual", "set home -1", "set joint_wait_homed",
                     "set mode mdi", "set mdi g0 x3"):
            assert client.ask(line) == f"SET {line.split()[1].upper()} ACK"
        wait_until(lambda: client.ask("get abs_act_pos x") == "ABS_ACT_POS X 3.000000", "the feedback follows to 3")
        assert client.ask("set mdi g1 bad") == "SET MDI NAK"
        assert client.ask("get error").startswith("ERROR Bad character")
        monkeypatch.setattr(linuxcnc, "nmlfile", str(tmp_path / "local.nml"))
        status = linuxcnc.stat()
        assert (status.joints, status.spindles) == (3, 1)  # more than crosses the wire to a stock program
        assert any(tool.id > 0 for tool in status.tool_table)
        command = linuxcnc.command()
        command.mdi("G1 also bad")
        refused = command.result(60.0)
        command.mdi("G0 X4 (MSG,moved)")
        done = command.result(60.0)
        assert (refused.outcome, len(refused.messages)) == (Outcome.REFUSED, 1)
        assert (done.outcome, done.messages) == (Outcome.DONE, ("moved",))
        client.send("shutdown")
        assert run.finish() == 0
    assert traces() == []
