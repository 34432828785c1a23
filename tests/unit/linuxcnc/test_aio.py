"""The asyncio interface: results of orders, and the status as an iteration."""

import asyncio
import threading

import pytest

import linuxcnc
from linuxcnc.aio import Machine, Outcome
from tests.support.fake_task import RCS_DONE, RCS_ERROR, FakeTask


class Task(FakeTask):
    """Refuses Q words with a message; begins G4 and leaves it unfinished."""

    def __init__(self):
        super().__init__(self.answer_order)
        self.began = threading.Event()

    def answer_order(self, command, status):
        status.command_type = command.TYPE_ID
        block = getattr(command, "command", "")
        if "Q" in block:
            self.tell_error(command.serial_number, "bad word")
            self.tell_error(command.serial_number + 1000, "of another client")
            return RCS_ERROR
        if "G4" in block:
            self.began.set()
            return linuxcnc.RCS_EXEC
        return RCS_DONE


@pytest.fixture
def task():
    with Task() as task:
        yield task


def test_an_order_that_is_done_is_true(task):
    async def work():
        async with Machine() as machine:
            return await machine.mdi("G0 X1")

    result = asyncio.run(work())
    assert result
    assert (result.outcome, result.messages) == (Outcome.DONE, ())


def test_a_refused_order_comes_with_its_own_messages_only(task):
    async def work():
        async with Machine() as machine:
            return await machine.mdi("G0 XQ")

    result = asyncio.run(work())
    assert not result
    assert (result.outcome, result.messages) == (Outcome.REFUSED, ("bad word",))


def test_an_abort_ends_an_order_that_is_awaited(task):
    async def work():
        async with Machine() as machine:
            dwell = asyncio.create_task(machine.mdi("G4 P100"))
            await asyncio.to_thread(task.began.wait, 10.0)
            assert await machine.abort()
            return await dwell

    assert asyncio.run(work()).outcome is Outcome.ABORTED


def test_the_status_can_be_iterated_and_waited_for(task):
    async def work():
        async with Machine() as machine:
            waiting = asyncio.create_task(machine.until(lambda s: s.task_mode == linuxcnc.MODE_AUTO, 10.0))
            await asyncio.sleep(0)
            task.status.task.mode = linuxcnc.MODE_AUTO
            task.publish()
            return (await waiting).task_mode

    assert asyncio.run(work()) == linuxcnc.MODE_AUTO


def test_a_state_that_does_not_come_is_a_timeout(task):
    async def work():
        async with Machine() as machine:
            await machine.until(lambda s: s.task_mode == linuxcnc.MODE_MDI, 0.05)

    with pytest.raises(TimeoutError):
        asyncio.run(work())


def test_only_orders_are_attributes(task):
    with pytest.raises(AttributeError):
        Machine().no_such_order  # noqa: B018
