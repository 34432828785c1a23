"""A step right after a pause: motion may not have taken the pause yet, and must not stay in it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from emctask.runner import Runner
from emctask.task import Task
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.emcmot import MotCommand


def paused_by_its_program(depth: int, taken: bool) -> tuple[Runner, list[MotCommand]]:
    """A runner whose program has just stopped itself, with so many moves in motion, and what motion was sent.

    ``taken``: motion has taken the pause.
    """
    sent: list[MotCommand] = []
    plan = SimpleNamespace(save_parameters=None, typed=False, active=True)
    motion = SimpleNamespace(status=SimpleNamespace(paused=taken, depth=depth), echoed=taken, send=sent.append)
    sequencer = SimpleNamespace(held=False, only_block=None)
    task: Any = SimpleNamespace(
        plan=plan, motion=motion, sequencer=sequencer, paused=False, interp_state=Interp.WAITING
    )  # fmt: skip
    runner = Runner(cast(Task, task))
    runner.pause_at_stop()
    return runner, sent


@pytest.mark.parametrize("taken", [True, False])
@pytest.mark.parametrize(("depth", "order"), [(0, MotCommand.RESUME), (2, MotCommand.STEP)])
def test_a_step_lifts_a_pause_that_motion_has_taken_or_is_about_to(taken: bool, depth: int, order: MotCommand) -> None:
    runner, sent = paused_by_its_program(depth, taken)
    runner.step()
    assert sent == [MotCommand.PAUSE, order]
