"""The machine that the forecast plans for: limits of axes and joints, kinematics and home position, out of an INI file.

Motion learns these from task and from HAL; a forecast has neither, so it reads the same entries, and takes the
parameters of the kinematics from the ``setp`` lines of the HAL files. Used by ``emcmot.forecast`` and its canon.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from importlib import import_module

from emcmot.kins.kinematics import KinematicsModule
from nml.errors import HalError
from nml.inifile import IniFile

AXES = "XYZABCUVW"
UNLIMITED = 1e9
MM = {"mm": 1.0, "metric": 1.0, "inch": 1 / 25.4, "in": 1 / 25.4, "imperial": 1 / 25.4, "1": 1.0, "1.0": 1.0}
DEGREE = {"degree": 1.0, "deg": 1.0, "grad": 10 / 9, "gon": 10 / 9, "radian": math.pi / 180, "rad": math.pi / 180}
SETP = re.compile(r"^\s*setp\s+([\w.-]+)\s*=?\s*(\S+)", re.MULTILINE)
INI_VALUE = re.compile(r"\[(\w+)\](\w+)")


@dataclass(frozen=True)
class JointLimits:
    """Limits of one joint, in its units, and seconds; 0: none."""

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True)
class Machine:
    """What the forecast must know of a machine; nine axes X to W, lu or deg, and seconds."""

    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]
    jerks: tuple[float, ...]  # 0: no limit
    start: tuple[float, ...]
    axis_mask: int
    period: float
    max_linear_velocity: float
    length_units: float
    angle_units: float
    kinematics: KinematicsModule | None = None  # None: every joint is an axis, without limits of its own
    joints: tuple[JointLimits, ...] = ()

    @classmethod
    def from_ini(cls, ini: IniFile) -> Machine:
        """The machine of an INI file, at its home position."""
        letters = [letter for letter in (ini.find("TRAJ", "COORDINATES") or "").upper() if letter in AXES]
        if not letters:
            raise ini.error("TRAJ", "COORDINATES", "missing; the letters of the axes are needed, like X Y Z")
        velocities, accelerations, jerks = [UNLIMITED] * 9, [UNLIMITED] * 9, [0.0] * 9
        limits_jerk = ini.integer("TRAJ", "PLANNER_TYPE", 0) == 1
        path_jerk = ini.real("TRAJ", "MAX_LINEAR_JERK", 0.0, minimum=0.0)
        for joint, letter in enumerate(letters):
            axis, section = AXES.index(letter), f"AXIS_{letter}"
            linear = "LINEAR" if axis < 3 or axis > 5 else "ANGULAR"
            top_v = ini.real("TRAJ", f"MAX_{linear}_VELOCITY", UNLIMITED)
            top_a = ini.real("TRAJ", f"MAX_{linear}_ACCELERATION", UNLIMITED)
            velocities[axis] = ini.real(section, "MAX_VELOCITY", min(top_v, UNLIMITED))
            accelerations[axis] = ini.real(section, "MAX_ACCELERATION", min(top_a, UNLIMITED))
            if limits_jerk:
                given = [ini.real(part, "MAX_JERK", 0.0, minimum=0.0) for part in (section, f"JOINT_{joint}")]
                jerks[axis] = min((jerk for jerk in (jerks[axis], path_jerk, *given) if jerk > 0.0), default=0.0)
        kinematics = kinematics_of(ini, len(letters))
        return cls(
            velocities=tuple(velocities),
            accelerations=tuple(accelerations),
            jerks=tuple(jerks),
            start=home_of(ini, kinematics),
            axis_mask=sum(1 << AXES.index(letter) for letter in set(letters)),
            period=ini.real("EMCMOT", "SERVO_PERIOD", 1e6, minimum=1e3) * 1e-9,
            max_linear_velocity=ini.real("TRAJ", "MAX_LINEAR_VELOCITY", 0.0, minimum=0.0),
            length_units=ini.choice("TRAJ", "LINEAR_UNITS", MM, 1.0),
            angle_units=ini.choice("TRAJ", "ANGULAR_UNITS", DEGREE, 1.0),
            kinematics=kinematics,
            joints=tuple(joint_limits(ini, joint, limits_jerk) for joint in range(kinematics.joints)),
        )


def home_of(ini: IniFile, kinematics: KinematicsModule) -> tuple[float, ...]:
    """The pose of the joints at home."""
    homes = [ini.real(f"JOINT_{joint}", "HOME", 0.0) for joint in range(kinematics.joints)]
    try:
        return tuple(kinematics.forward(homes))
    except ValueError as error:
        raise ini.error("KINS", "KINEMATICS", f"the machine at its home position: {error}") from None


def joint_limits(ini: IniFile, joint: int, limits_jerk: bool) -> JointLimits:
    """What [JOINT_n] says."""
    section = f"JOINT_{joint}"
    velocity, acceleration, jerk = (
        ini.real(section, key, 0.0, minimum=0.0) for key in ("MAX_VELOCITY", "MAX_ACCELERATION", "MAX_JERK")
    )
    return JointLimits(velocity, acceleration, jerk if limits_jerk else 0.0)


def kinematics_of(ini: IniFile, axes: int) -> KinematicsModule:
    """The kinematics that [KINS] names, with its arguments and parameters; without an entry each axis is a joint."""
    coordinates = "".join((ini.find("TRAJ", "COORDINATES") or "").split())
    name, *words = (ini.find("KINS", "KINEMATICS") or f"trivkins coordinates={coordinates}").split()
    arguments = dict(word.split("=", 1) for word in words if "=" in word)
    try:
        module: KinematicsModule = import_module(f"emcmot.kins.{name.replace('-', '_')}").create(**arguments)
    except (ImportError, HalError, TypeError) as error:
        message = f"{name}: no kinematics that a forecast can be made with: {error}"
        raise ini.error("KINS", "KINEMATICS", message) from None
    module.fit(ini.integer("KINS", "JOINTS", axes, minimum=1))
    for parameter, value in parameters_of(ini, name).items():
        if parameter in module.parameter_names:
            module.set_parameter(parameter, value)
    return module


def parameters_of(ini: IniFile, module: str) -> dict[str, float]:
    """Numbers that the HAL files of an INI file set in a module; values may be INI entries."""
    found: dict[str, float] = {}
    for entry in ini.findall("HAL", "HALFILE"):
        path = ini.resolve(entry.split()[0]) if entry.split() else None
        if path is None or not path.is_file():
            continue
        for pin, text in SETP.findall(path.read_text(errors="replace")):
            owner, _, parameter = pin.partition(".")
            place = INI_VALUE.fullmatch(text)
            text = (ini.find(place[1], place[2]) or "") if place else text
            if owner == module and re.fullmatch(r"[-+]?[\d.]+(e[-+]?\d+)?", text, re.IGNORECASE):
                found[parameter] = float(text)
    return found
