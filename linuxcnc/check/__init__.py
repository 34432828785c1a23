"""``linuxcnc --check``: everything that is wrong with a configuration, found without starting it.

Each rule is a function from the configuration to findings, ``file:line: what is wrong; what would be right``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from linuxcnc.check import entries, files, machine
from linuxcnc.check.base import Checked
from nml.errors import ConfigError
from nml.inifile import IniFile

Rule = Callable[[Checked], Iterator[str]]

RULES: tuple[Rule, ...] = (
    files.lines,
    entries.missing,
    files.hal_files,
    files.references,
    entries.sections,
    entries.misspelt_keys,
    entries.unknown_keys,
    entries.values,
    files.programs,
    files.modules,
    files.nml_file,
    files.tool_table,
    machine.kinematics,
    machine.joint_sections,
    machine.axis_sections,
    machine.limits,
    machine.axes_within_joints,
    machine.homing,
    machine.home_sequence,
    machine.periods,
    machine.servo_period,
)
"""``hal_files`` gathers what the rules after it look at."""

WARNINGS: tuple[Rule, ...] = (
    files.lines,
    files.hal_files,
    entries.sections,
    entries.misspelt_keys,
    machine.periods,
    machine.servo_period,
)
"""Those whose findings let a machine start, but other than its user meant."""


def findings(path: Path, rules: tuple[Rule, ...] = RULES) -> list[str]:
    """What is wrong by ``rules``, in their order, each once; a file that cannot be read is the only finding."""
    try:
        checked = Checked(IniFile(path))
    except ConfigError as error:
        return [str(error)]
    return list(dict.fromkeys(finding for rule in rules for finding in _found(rule, checked)))


def _found(rule: Rule, checked: Checked) -> Iterator[str]:
    """What a rule finds; an entry that it cannot even read is a finding too."""
    try:
        yield from rule(checked)
    except ConfigError as error:
        yield str(error)
