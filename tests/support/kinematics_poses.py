"""For every kinematics: how it is made, a geometry that is not the standard one, and joints that it can have."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

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
from emcmot.kins.kinematics import KinematicsModule


@dataclass(frozen=True)
class Case:
    """One kinematics in one of its ways; ``ranges`` are those of its joints, or of its pose where that is easier."""

    name: str
    create: Callable[..., KinematicsModule]
    ranges: Sequence[tuple[float, float]]
    of_pose: bool = False
    way: int = 0
    arguments: dict[str, str] = field(default_factory=dict)
    pins: dict[str, float] = field(default_factory=dict)
    in_2_9: bool = True
    stock_forward: bool = True  # whether LinuxCNC's forward undoes its inverse, so that it can be compared

    def __str__(self) -> str:
        return " ".join([self.name, f"type {self.way}", *self.arguments.values()])

    def module(self) -> KinematicsModule:
        made = self.create(**self.arguments)
        for name, value in self.pins.items():
            made.set_parameter(name, value)
        made.select(self.way)
        return made

    def random(self, rng: random.Random) -> list[float]:
        return [rng.uniform(low, high) for low, high in self.ranges]


SLIDE, TURN, TILT, ARM = (-200.0, 200.0), (-179.0, 179.0), (-80.0, 80.0), (-70.0, 70.0)
TABLE_NAMES = ("x-rot-point", "y-rot-point", "z-rot-point", "x-offset", "y-offset", "z-offset", "tool-offset")
TABLE = dict(zip(TABLE_NAMES, (3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0), strict=True))
DUAL = {name: TABLE[name] for name in TABLE if name not in ("y-offset", "tool-offset")} | {"tool-offset-z": 19.0}
SKEW = {"C_xx": 0.99, "C_yy": 1.01, "C_xy": 0.02, "C_xz": -0.01, "C_yx": 0.03, "C_zx": -0.02, "C_zy": 0.04}
PUMA_RANGES = (TURN, (-90, -30), (-40, 40), (-160, 160), (10, 100), TURN)

CASES = (
    Case("trivkins", trivkins.create, [SLIDE] * 4, arguments={"coordinates": "zxay"}),
    Case("corexykins", corexykins.create, [SLIDE] * 9),
    Case("rotatekins", rotatekins.create, [SLIDE] * 9),
    Case("scarakins", scarakins.create, (TURN, (5, 150), SLIDE, TURN, TURN, TURN)),
    Case("scarakins", scarakins.create, [SLIDE] * 6, way=1, arguments={"coordinates": "xyzcab"}),
    Case("genhexkins", genhexkins.create, ((-5, 5), (-5, 5), (20, 40), (-20, 20), (-20, 20), (-20, 20)), of_pose=True),
    Case(
        "genhexkins",
        genhexkins.create,
        ((-5, 5), (-5, 5), (20, 40), (-15, 15), (-15, 15), (-15, 15)),
        of_pose=True,
        pins={"screw-lead": 0.2, "spindle-offset": 2.0, "tool-offset": 1.5},
    ),
    Case("genhexkins", genhexkins.create, [SLIDE] * 6, way=1, stock_forward=False),
    Case("tripodkins", tripodkins.create, (SLIDE, SLIDE, (1, 200)), of_pose=True, pins={"Bx": 70, "Cx": 30, "Cy": 60}),
    Case("lineardeltakins", lineardeltakins.create, [(-90, 90)] * 3 + [SLIDE] * 6, of_pose=True),
    Case("rotarydeltakins", rotarydeltakins.create, [(15, 60)] * 3 + [SLIDE] * 6),
    Case("rosekins", rosekins.create, ((1, 200), SLIDE, TURN)),
    Case(
        "maxkins",
        maxkins.create,
        [*[SLIDE] * 3, TURN, TILT, TURN, *[SLIDE] * 3],
        pins={"pivot-length": 120.0},
        stock_forward=False,
    ),
    Case("matrixkins", matrixkins.create, [SLIDE] * 9, pins=SKEW, in_2_9=False),
    Case("scorbot-kins", scorbotkins.create, (TURN, (-20, 85), (-80, -25), TURN, TURN)),
    Case("pumakins", pumakins.create, PUMA_RANGES, pins={"A2": 320.0, "D6": 55.0}),
    Case("pumakins", pumakins.create, [SLIDE] * 6, way=1),
    Case("genserkins", genserkins.create, PUMA_RANGES, arguments={"coordinates": "xyzabc"}),
    Case("genserkins", genserkins.create, [SLIDE] * 6, way=1, arguments={"coordinates": "abcxyz"}),
    Case("pentakins", pentakins.create, [(-60, 60), (-60, 60), (250, 350), (-15, 15), (-15, 15)], of_pose=True),
    Case(
        "pentakins",
        pentakins.create,
        [(-60, 60), (-60, 60), (250, 350), (-15, 15), (-15, 15)],
        of_pose=True,
        pins={"tool-offset": 40.0},
    ),
    Case("5axiskins", fiveaxiskins.create, (SLIDE, SLIDE, SLIDE, TILT, TURN, SLIDE)),
    Case(
        "5axiskins",
        fiveaxiskins.create,
        (SLIDE, SLIDE, SLIDE, TILT, TURN, SLIDE, SLIDE),
        arguments={"coordinates": "XYZBCWV"},
        pins={"pivot-length": 180.0},
    ),
    Case("5axiskins", fiveaxiskins.create, [SLIDE] * 6, way=1),
    Case("xyzac-trt-kins", xyzac_trt_kins.create, [SLIDE] * 3 + [TILT, TURN], pins=TABLE),
    Case("xyzac-trt-kins", xyzac_trt_kins.create, [SLIDE] * 5, pins=TABLE, arguments={"sparm": "identityfirst"}),
    Case(
        "xyzac-trt-kins",
        xyzac_trt_kins.create,
        [SLIDE] * 3 + [TILT, TURN],
        way=1,
        pins=TABLE,
        arguments={"coordinates": "zyxca", "sparm": "identityfirst"},
    ),
    Case("xyzbc-trt-kins", xyzbc_trt_kins.create, [SLIDE] * 3 + [TILT, TURN], pins=TABLE),
    Case("xyzab_tdr_kins", xyzab_tdr_kins.create, [SLIDE] * 5, pins=DUAL),
    Case("xyzab_tdr_kins", xyzab_tdr_kins.create, [SLIDE] * 3 + [TILT, TURN], way=1, pins=DUAL),
    Case("millturn", millturn.create, [SLIDE] * 4),
    Case("userkins", userkins.create, [SLIDE] * 3),
    Case("millturn", millturn.create, [SLIDE] * 4, way=1),
)
