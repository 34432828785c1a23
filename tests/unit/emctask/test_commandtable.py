"""The command table: every message of the manual is handled or refused, and rules are checked with a reason."""

import json
from pathlib import Path

import pytest

from emctask import handlers
from emctask.commandtable import MANUAL, REFUSALS, RULES, Refused, Rule, check, never
from nml.emc import EMC_TASK_ABORT, EMC_TASK_PLAN_EXECUTE, EMC_TASK_SET_STATE
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.message import Command, registry

FACTS = Path(__file__).parents[3].parent / "shared" / "facts" / "nml-messages.json"

assert handlers.LOADED


def everywhere(**changes) -> Rule:
    values = {"handler": lambda task, message: None, "on": False, "modes": frozenset(Mode), "idle": False}
    return Rule(**(values | {"urgent": never} | changes))


def test_every_command_of_the_vocabulary_is_handled_or_refused_with_a_reason():
    known = {cls.TYPE_ID for cls in registry.values() if issubclass(cls, Command) and cls.__name__.startswith("EMC_")}
    open_ends = [registry[number].__name__ for number in known - RULES.keys() - REFUSALS.keys()]
    assert [name for name in open_ends if not name.endswith("_STAT")] == []


@pytest.mark.skipif(not FACTS.exists(), reason="the catalogue of LinuxCNC's messages is not here")
def test_the_catalogues_commands_are_all_there():
    catalogue = json.loads(FACTS.read_text())["messages"]
    commands = {m["type_id"]: m["name"] for m in catalogue if m["preamble"] == "RCS_CMD_MSG"}
    missing = {name for number, name in commands.items() if number not in RULES.keys() | REFUSALS.keys()}
    assert {name for name in missing if name.startswith("EMC_")} == set()


def test_no_command_is_both_handled_and_refused():
    assert not RULES.keys() & REFUSALS.keys()


@pytest.mark.parametrize(
    ("rule", "state", "mode", "interp", "reason"),
    [
        (everywhere(on=True), State.ESTOP, Mode.MDI, Interp.IDLE, r"\(EMC_TASK_PLAN_EXECUTE\) .* turned on$"),
        (everywhere(on=True), State.ESTOP_RESET, Mode.MDI, Interp.IDLE, "until the machine is out of E-stop"),
        (everywhere(modes=MANUAL), State.ON, Mode.MDI, Interp.IDLE, r"can't do that \(.*EXECUTE:509\) in MDI mode"),
        (everywhere(modes=MANUAL), State.ON, Mode.AUTO, Interp.IDLE, "in auto mode with the interpreter idle"),
        (everywhere(idle=True), State.ON, Mode.AUTO, Interp.PAUSED, "in auto mode with the interpreter paused"),
    ],
)
def test_a_rule_that_is_not_met_says_why(rule, state, mode, interp, reason):
    with pytest.raises(Refused, match=reason):
        check(rule, EMC_TASK_PLAN_EXECUTE(), state, mode, interp)


def test_orders_to_stop_overtake_what_is_being_waited_for():
    urgent = RULES[EMC_TASK_SET_STATE.TYPE_ID].urgent
    assert [urgent(EMC_TASK_SET_STATE(state=state)) for state in State] == [True, False, True, False]
    assert RULES[EMC_TASK_ABORT.TYPE_ID].urgent(EMC_TASK_ABORT())
    assert not RULES[EMC_TASK_PLAN_EXECUTE.TYPE_ID].urgent(EMC_TASK_PLAN_EXECUTE())


def test_a_rule_that_is_met_says_nothing():
    check(everywhere(on=True, idle=True), EMC_TASK_PLAN_EXECUTE(), State.ON, Mode.MDI, Interp.IDLE)
