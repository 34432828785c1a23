"""Workers: a spare one waits, takes its work, and none outlives the pool."""

import asyncio
import json
import os

from gui.web.workers import Workers, end_worker
from tests.support.machine import MILL

QUESTION = ("--mdi", "G0 X5", "-i", str(MILL / "mill_mm.ini"))


async def ask(workers):
    worker = await workers.start(*QUESTION)
    output, _ = await worker.communicate()
    return json.loads(output)["end"][0]


def test_the_spare_worker_takes_the_next_question():
    async def work():
        workers = Workers("rs274ngc.dryrun")
        workers.refill()
        await workers._refilling
        spare = workers._spare
        worker = await workers.start(*QUESTION)
        assert worker is spare
        await worker.communicate()
        assert await ask(workers) == 5.0
        await workers.close()

    asyncio.run(work())


def test_a_spare_worker_that_was_killed_is_replaced():
    async def work():
        workers = Workers("rs274ngc.dryrun")
        workers.refill()
        await workers._refilling
        await end_worker(workers._spare)
        assert await ask(workers) == 5.0
        await workers.close()

    asyncio.run(work())


def test_ctrl_c_of_the_terminal_does_not_reach_a_worker():
    """The pool ends it; a worker that ended at the same time would be reported as unknown."""

    async def work():
        workers = Workers("rs274ngc.dryrun")
        worker = await workers.start(*QUESTION)
        assert os.getsid(worker.pid) == worker.pid
        await worker.communicate()
        await workers.close()

    asyncio.run(work())


def test_a_closed_pool_leaves_no_process():
    async def work():
        workers = Workers("rs274ngc.dryrun")
        workers.refill()
        await workers._refilling
        spare = workers._spare
        await workers.close()
        assert spare.returncode is not None

    asyncio.run(work())
