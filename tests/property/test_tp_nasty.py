"""Whatever nasty program comes, and whatever the operator does, no limit breaks, the path holds, the end is hit."""

import os

import pytest

from tests.support.nasty import Nasty

FIRST = int(os.environ.get("PYEMC_SEED", "0"))
SEEDS = int(os.environ.get("PYEMC_EXAMPLES", "6"))  # programs of each kind; hundreds find more
PASSAGES = 14
COMMANDS = 25
FAILED_ONCE = (9110, 13052, 21305)  # under limited jerk: two that never ended, one that broke a limit
KINDS = pytest.mark.parametrize("jerk", [False, True], ids=["acceleration", "jerk"])


@KINDS
@pytest.mark.parametrize("seed", range(FIRST, FIRST + SEEDS))
def test_a_nasty_program_runs_to_its_end_within_every_limit(seed, jerk):
    program = Nasty(seed, jerk)
    program.check(program.run(PASSAGES, 0))


@KINDS
@pytest.mark.parametrize("seed", range(FIRST + 100, FIRST + 100 + SEEDS))
def test_whatever_the_operator_does_meanwhile_breaks_no_limit(seed, jerk):
    program = Nasty(seed, jerk)
    program.check(program.run(PASSAGES, COMMANDS))


@pytest.mark.parametrize("seed", FAILED_ONCE)
def test_a_program_that_failed_once_keeps_every_limit_and_ends(seed):
    program = Nasty(seed, jerk=True)
    program.check(program.run(PASSAGES, COMMANDS))
