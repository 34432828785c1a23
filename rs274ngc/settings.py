"""What of the INI file concerns the language: sections RS274NGC, EMCIO, DISPLAY, TRAJ and the axes."""

from __future__ import annotations

import os
from typing import Any

from nml.errors import ConfigError
from rs274ngc.canon import AXES
from rs274ngc.remap import remaps_of

INCHES_OF = {"inch", "in", "imperial"}
TRUE = {"1", "yes", "true", "on", "y", "t"}

DEFAULT_FEATURES = 0b1100
"""INI_VARS and HAL_PIN_VARS."""


def number(ini: Any, section: str, key: str, default: float) -> float:
    """A number of the INI file; ConfigError where it is none."""
    text = ini.find(section, key)
    if text is None:
        return default
    try:
        return float(int(text, 0)) if text.strip().lower().startswith("0x") else float(text)
    except ValueError:
        raise ConfigError(f"invalid [{section}]{key} in INI file: '{text}' is not a number") from None


def flag(ini: Any, section: str, key: str, default: bool = False) -> bool:
    """A yes or no of the INI file."""
    text = ini.find(section, key)
    return default if text is None else text.strip().lower() in TRUE


def folder_of(ini: Any) -> str:
    """The folder that relative paths of the INI file begin in."""
    path = getattr(ini, "file", None)
    return os.path.dirname(os.path.abspath(path)) if path else os.getcwd()


def expanded(base: str, path: str) -> str:
    """A path of the INI file as an absolute one."""
    return os.path.join(base, os.path.expanduser(path.strip()))


def units_per_mm(ini: Any) -> float:
    """Machine length units in a millimetre, by [TRAJ]LINEAR_UNITS."""
    text = (ini.find("TRAJ", "LINEAR_UNITS") or "mm").strip().lower()
    return 1.0 / 25.4 if text in INCHES_OF else 1.0


def axis_mask(ini: Any) -> int:
    """Which axes the machine has, by [TRAJ]COORDINATES: bit 0 X to bit 8 W; all when it is not there."""
    letters = {letter for letter in (ini.find("TRAJ", "COORDINATES") or AXES).upper() if letter in AXES}
    return sum(1 << AXES.index(letter) for letter in letters)


def apply_settings(interp: Any, ini: Any) -> None:
    """Set the interpreter as the INI file says."""
    state = interp.state
    base = folder_of(ini)
    section = "RS274NGC"
    path = ini.find(section, "PARAMETER_FILE")
    if path is not None:
        interp.parameter_file = expanded(base, path)
    state.features = DEFAULT_FEATURES
    for bit, key in enumerate(
        ("RETAIN_G43", "OWORD_NARGS", "INI_VARS", "HAL_PIN_VARS", "NO_DOWNCASE_OWORD", "OWORD_WARNONLY")
    ):
        if ini.find(section, key) is not None:
            state.features = (state.features & ~(1 << bit)) | (flag(ini, section, key) << bit)
    state.arc_tolerance_inch = number(
        ini, section, "CENTER_ARC_RADIUS_TOLERANCE_INCH", state.arc_tolerance_inch
    )
    state.arc_tolerance_mm = number(ini, section, "CENTER_ARC_RADIUS_TOLERANCE_MM", state.arc_tolerance_mm)
    state.orient_offset = number(ini, section, "ORIENT_OFFSET", 0.0)
    state.g92_persistent = not flag(ini, section, "DISABLE_G92_PERSISTENCE")
    state.fanuc_subs = not flag(ini, section, "DISABLE_FANUC_STYLE_SUB")
    state.subroutine_path = [
        expanded(base, folder) for folder in (ini.find(section, "SUBROUTINE_PATH") or "").split(":") if folder.strip()
    ]
    prefix = ini.find("DISPLAY", "PROGRAM_PREFIX")
    state.program_prefix = expanded(base, prefix) if prefix else ""
    state.remaps = remaps_of(ini)
    state.spindles = min(8, max(1, int(number(ini, "TRAJ", "SPINDLES", 1))))
    state.random_toolchanger = flag(ini, "EMCIO", "RANDOM_TOOLCHANGER")
    state.change_with_spindle_on = flag(ini, "EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON")
    state.change_with_quill_up = flag(ini, "EMCIO", "TOOL_CHANGE_QUILL_UP")
    state.change_at_g30 = flag(ini, "EMCIO", "TOOL_CHANGE_AT_G30")
    state.wrapped_rotary = sum(
        1 << (3 + k) for k, axis in enumerate("ABC") if flag(ini, f"AXIS_{axis}", "WRAPPED_ROTARY")
    )
    for k, axis in enumerate("ABC"):
        joint = ini.find(f"AXIS_{axis}", "LOCKING_INDEXER_JOINT")
        if joint is not None:
            state.set_indexer(k, int(number(ini, f"AXIS_{axis}", "LOCKING_INDEXER_JOINT", -1)))
