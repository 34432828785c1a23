"""Results of commands on a whole machine: what became of each, and the messages that belong to it alone."""

import asyncio

import pytest

import linuxcnc
from linuxcnc.aio import Machine, Outcome
from tests.support.machine import copy_mill, running, wait_until

pytestmark = pytest.mark.process


@pytest.fixture
def mill(tmp_path):
    """A mill that is on, homed and in MDI mode."""
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        status, command = linuxcnc.stat(), linuxcnc.command()
        command.state(linuxcnc.STATE_ESTOP_RESET)
        command.state(linuxcnc.STATE_ON)
        command.home(-1)
        wait_until(lambda: status.poll() or all(status.homed[:3]), "home")
        command.mode(linuxcnc.MODE_MDI)
        command.wait_complete()
        yield status


def test_two_clients_get_their_own_results_and_messages(mill):
    async def both():
        async with Machine() as one, Machine() as other:
            return await one.mdi("G1 X5"), await other.mdi("G1 Y Q bad"), await one.mdi("G0 X2 (MSG,from one)")

    no_feed, bad, told = asyncio.run(both())
    assert {no_feed.outcome, bad.outcome} <= {Outcome.REFUSED, Outcome.FAILED}
    assert told.outcome is Outcome.DONE
    assert len(no_feed.messages) == len(bad.messages) == 1
    assert no_feed.messages != bad.messages
    assert told.messages == ("from one",)
    assert len({no_feed.serial, bad.serial, told.serial}) == 3


def test_a_move_that_is_cut_short_by_somebody_else_is_aborted(mill):
    async def cut():
        async with Machine() as one, Machine() as other:
            dwell = asyncio.create_task(one.mdi("G4 P600"))
            await one.until(lambda status: status.delay_left > 0.0, 20.0)
            return await other.abort(), await dwell

    abort, dwell = asyncio.run(cut())
    assert abort.outcome is Outcome.DONE
    assert dwell.outcome is Outcome.ABORTED


def test_a_program_that_comes_to_a_wrong_line_has_failed(mill, tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94 F3000\nG1 X1\nG1 X20\nG4 P0.2\nG2 X30 Y0 I1 J0\nM2\n")

    async def run():
        async with Machine() as one:
            await one.mode(linuxcnc.MODE_AUTO)
            await one.program_open(str(part))
            return await one.auto(linuxcnc.AUTO_RUN, 0)

    result = asyncio.run(run())
    assert result.outcome is Outcome.FAILED
    assert any("Radius to end of arc differs" in message for message in result.messages)
    mill.poll()
    assert mill.position[0] == pytest.approx(20.0)
