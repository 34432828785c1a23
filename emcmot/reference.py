"""Writes docs/motion-reference.md from the tables that motion runs on: commands, parameters, pins.

python -m emcmot.reference > docs/motion-reference.md
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from emcmot.commands import COMMANDS
from emcmot.core import LIMITS, Core
from emcmot.kins import (
    corexykins,
    fiveaxiskins,
    genhexkins,
    genserkins,
    lineardeltakins,
    matrixkins,
    maxkins,
    millturn,
    pentakins,
    pumakins,
    rosekins,
    rotarydeltakins,
    rotatekins,
    scarakins,
    scorbotkins,
    tripodkins,
    trivkins,
    userkins,
    xyzab_tdr_kins,
    xyzac_trt_kins,
    xyzbc_trt_kins,
)
from emcmot.kins.kinematics import KinematicsModule, Value
from emcmot.parameters import PARAMETERS

KINEMATICS = (
    *(corexykins, fiveaxiskins, genhexkins, genserkins, lineardeltakins, matrixkins, maxkins, millturn, pentakins),
    *(pumakins, rosekins, rotarydeltakins, rotatekins, scarakins, scorbotkins, tripodkins, trivkins),
    *(userkins, xyzab_tdr_kins, xyzac_trt_kins, xyzbc_trt_kins),
)
LAST_JOINT = 5

HEAD = """# Motion: reference

Made by `python -m emcmot.reference`; the words are in [motion.md](motion.md).
"""


def _table(head: tuple[str, ...], rows: Iterable[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])


def commands() -> str:
    """What each EMCMOT command requires and does."""
    rows = [
        (f"`{name}`", str(code), ", ".join(needs) or "nothing", doc)
        for name, code, needs, doc in sorted(COMMANDS, key=lambda row: row[1])
    ]
    return _table(("command", "number", "requires", "does"), rows)


def parameters() -> str:
    """What the SET_xxx commands set, and which values they take."""
    rows = [(f"`{name}`", owner, f"`{field}`", takes) for name, owner, field, takes in dict.fromkeys(PARAMETERS)]
    return _table(("command", "of each", "field of the command", "takes"), rows)


def arguments() -> str:
    """The arguments of `loadrt motmod` that are numbers."""
    return _table(
        ("argument", "default", "from", "to"),
        [(f"`{name}`", str(default), str(low), str(high)) for name, (default, low, high) in LIMITS.items()],
    )


def pins() -> str:
    """Every pin of a machine with one joint, axis and spindle; N, L and M stand for the others."""
    core = Core(
        xyzab_tdr_kins.create(),
        num_joints=LAST_JOINT + 1,
        num_extrajoints=1,
        num_dio=1,
        num_aio=1,
        num_misc_error=1,
        unlock_joints_mask=1 << LAST_JOINT,
    )
    rows = []
    for pin in core.pins:
        other_joint = pin.name.startswith("joint.") and not pin.name.startswith(f"joint.{LAST_JOINT}.")
        if other_joint or (pin.name.startswith("axis.") and not pin.name.startswith("axis.x.")):
            continue
        name = pin.name.replace(f"joint.{LAST_JOINT}.", "joint.N.").replace("axis.x.", "axis.L.")
        name = name.replace("spindle.0.", "spindle.M.")
        rows.append((f"`{name}`", pin.type, pin.direction))
    return _table(("pin", "type", "direction"), rows)


def _pin_of_kinematics(module: KinematicsModule, pin: Value) -> str:
    name = pin.name if pin.name.startswith("skgui.") else f"{module.name}.{pin.name}"
    return f"`{name}` {pin.value:g}" if pin.direction != "OUT" else f"`{name}` (out)"


def kinematics() -> str:
    """Each kinematics with its pins and their first values; of numbered pins those numbered 0."""
    rows = []
    for source in KINEMATICS:
        module = source.create()
        shown = [pin for pin in module.pins if not any(f"{mark}{n}" in pin.name for mark in ".-" for n in range(1, 6))]
        joints = f"{module.fewest_joints} to {module.joints}" if module.fewest_joints else str(module.joints)
        pins = ", ".join(_pin_of_kinematics(module, pin) for pin in shown)
        rows.append((f"`{module.name}`", joints, str(module.ways), pins))
    return _table(("module", "joints", "types", "pins and their first values"), rows)


def text() -> str:
    """The whole page."""
    parts = [
        HEAD,
        "## Commands\n",
        commands(),
        "\n## Parameters\n",
        parameters(),
        "\n## Arguments of motmod\n",
        arguments(),
        "\n## Pins\n",
        pins(),
        "\n## Kinematics\n",
        kinematics(),
    ]
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    print(text(), end="")
