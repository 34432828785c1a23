"""Every entry that an INI file may have: section, key, kind of value, default, unit, limits, reader, meaning.

``check`` looks entries up here, and ``docs/ini.md`` is this table: ``python -m linuxcnc.inikeys > docs/ini.md``.
Section JOINT_n stands for JOINT_0 to JOINT_15, AXIS_L for AXIS_X to AXIS_W, SPINDLE_n for SPINDLE_0 to SPINDLE_7.
"""

# ruff: noqa: E501  each entry of the table is one line

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import groupby

LENGTH_UNITS = ("mm", "metric", "inch", "in", "imperial", "1", "1.0")
ANGLE_UNITS = ("degree", "deg", "grad", "gon", "radian", "rad", "1", "1.0")


class Kind(Enum):
    """What a value must be."""

    TEXT = "text"
    INTEGER = "whole number"
    REAL = "number"
    BOOLEAN = "yes or no"
    FILE = "file"
    CHOICE = "one of"


class Reader(Enum):
    """Who acts on an entry."""

    TASK = "task"
    IO = "io"
    LANGUAGE = "interpreter"
    LAUNCHER = "launcher"
    HALUI = "halui"
    NML = "NML server"
    SHOP = "MQTT and OPC UA"
    HAL = "HAL files"
    SCREEN = "screens"
    NOBODY = "nobody"


@dataclass(frozen=True, slots=True)
class Key:
    """One entry. ``default`` is text; empty: there is none. lu, au: the machine's units of length and angle."""

    section: str
    name: str
    kind: Kind
    reader: Reader
    doc: str
    default: str = ""
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    required: bool = False
    repeated: bool = False

    @property
    def allowed(self) -> str:
        """Kind and limits, for people."""
        if self.choices:
            return ", ".join(self.choices)
        match self.minimum, self.maximum:
            case None, None:
                return self.kind.value
            case low, None:
                return f"{self.kind.value}, at least {low:g}"
            case None, high:
                return f"{self.kind.value}, at most {high:g}"
            case low, high:
                return f"{self.kind.value}, {low:g} to {high:g}"


TEXT, INTEGER, REAL, BOOLEAN, FILE, CHOICE = Kind
TASK, IO, LANGUAGE, LAUNCHER, HALUI, NML, SHOP, HAL, SCREEN, NOBODY = Reader


def _keys(section: str, *rows: tuple[str, Kind, Reader, str, dict[str, object]]) -> tuple[Key, ...]:
    return tuple(Key(section, name, kind, reader, doc, **more) for name, kind, reader, doc, more in rows)  # type: ignore[arg-type]


def _plain(section: str, kind: Kind, reader: Reader, doc: str, *names: str) -> tuple[Key, ...]:
    """Entries that have all but the name in common."""
    return tuple(Key(section, name, kind, reader, doc) for name in names)


def _motion_limits(section: str, what: str) -> tuple[Key, ...]:
    return _keys(
        section,
        ("MIN_LIMIT", REAL, TASK, f"lowest position of the {what}", {"default": "-1e99", "unit": "lu or au"}),
        ("MAX_LIMIT", REAL, TASK, f"highest position of the {what}", {"default": "1e99", "unit": "lu or au"}),
        ("MAX_VELOCITY", REAL, TASK, f"highest speed of the {what}", {"default": "1", "unit": "lu/s or au/s"}),
        ("MAX_ACCELERATION", REAL, TASK, f"highest acceleration of the {what}", {"default": "1", "unit": "lu/s² or au/s²"}),
        ("MAX_JERK", REAL, TASK, f"highest jerk of the {what}; 0: no limit", {"default": "0", "unit": "lu/s³ or au/s³", "minimum": 0.0}),
    )


SCREENS_OWN = "read by screens that know it"
LINUXCNC_ONLY = "known to LinuxCNC; without effect here"

KEYS: tuple[Key, ...] = (
    *_keys(
        "EMC",
        ("VERSION", TEXT, NOBODY, "version of the file's layout; 1.1 has joints and axes apart", {}),
        ("MACHINE", TEXT, SCREEN, "name of the machine", {}),
        ("DEBUG", INTEGER, TASK, "what task prints for debugging, a bit mask", {"default": "0"}),
        ("NML_FILE", FILE, LAUNCHER, "NML file; without it the built-in one", {}),
        ("MACRO", TEXT, SCREEN, SCREENS_OWN, {"repeated": True}),
        ("RS274NGC_STARTUP_CODE", TEXT, NOBODY, "old place of [RS274NGC]RS274NGC_STARTUP_CODE; without effect here", {}),
    ),
    *_keys(
        "DISPLAY",
        ("DISPLAY", TEXT, LAUNCHER, "the screen: web, linuxcncrsh or any program, with its options", {"required": True}),
        ("PROGRAM_PREFIX", FILE, TASK, "folder of programs and of M100 to M199", {"default": "nc_files"}),
        ("MAX_FEED_OVERRIDE", REAL, TASK, "highest feed override", {"default": "1", "minimum": 0.0}),
        ("CYCLE_TIME", REAL, SCREEN, "time between looks at the status", {"unit": "s or ms"}),
        ("POSITION_OFFSET", CHOICE, SCREEN, "coordinates to show", {"choices": ("RELATIVE", "MACHINE")}),
        ("POSITION_FEEDBACK", CHOICE, SCREEN, "position to show", {"choices": ("ACTUAL", "COMMANDED")}),
        ("MAX_SPINDLE_OVERRIDE", REAL, SCREEN, "highest spindle override", {"minimum": 0.0}),
        ("MIN_SPINDLE_OVERRIDE", REAL, SCREEN, "lowest spindle override", {"minimum": 0.0}),
        ("DEFAULT_LINEAR_VELOCITY", REAL, SCREEN, "jog speed at first", {"unit": "lu/s", "minimum": 0.0}),
        ("MAX_LINEAR_VELOCITY", REAL, SCREEN, "highest jog speed", {"unit": "lu/s", "minimum": 0.0}),
        ("MIN_LINEAR_VELOCITY", REAL, SCREEN, "lowest jog speed", {"unit": "lu/s", "minimum": 0.0}),
        ("MIN_VELOCITY", REAL, SCREEN, "lowest jog speed", {"unit": "lu/s", "minimum": 0.0}),
        ("MACHINE_TYPE_HINT", CHOICE, SCREEN, "how to show the part", {"choices": ("mill", "lathe", "foam")}),
        ("DEFAULT_ANGULAR_VELOCITY", REAL, SCREEN, "jog speed of rotary axes at first", {"unit": "au/s", "minimum": 0.0}),
        ("MAX_ANGULAR_VELOCITY", REAL, SCREEN, "highest jog speed of rotary axes", {"unit": "au/s", "minimum": 0.0}),
        ("MIN_ANGULAR_VELOCITY", REAL, SCREEN, "lowest jog speed of rotary axes", {"unit": "au/s", "minimum": 0.0}),
        ("NGCGUI_SUBFILE", TEXT, SCREEN, SCREENS_OWN, {"repeated": True}),
        ("EMBED_TAB_NAME", TEXT, SCREEN, SCREENS_OWN, {"repeated": True}),
        ("EMBED_TAB_COMMAND", TEXT, SCREEN, SCREENS_OWN, {"repeated": True}),
        ("EMBED_TAB_LOCATION", TEXT, SCREEN, SCREENS_OWN, {"repeated": True}),
    ),
    *_plain(
        "DISPLAY", TEXT, SCREEN, SCREENS_OWN,
        "ARCDIVISION", "BACK_TOOL_LATHE", "CONE_BASESIZE", "CONFIRM_EXIT", "DEFAULT_SPINDLE_SPEED", "DRO_FORMAT_IN", "DRO_FORMAT_MM",
        "EDITOR", "FOAM", "GEOMETRY", "GLADEVCP", "GRIDS", "HELP_FILE", "ICON", "INCREMENTS", "INTRO_GRAPHIC",
        "INTRO_TIME", "JOG_AXES", "LATHE", "LOG_FILE", "MDI_HISTORY_FILE", "OPEN_FILE",
        "PREFERENCE_FILE_PATH", "PREVIEW_TIMEOUT", "PYVCP", "PYVCP_POSITION", "SPINDLE_INCREMENT", "TITLE",
        "TOOL_EDITOR", "USER_COMMAND_FILE", "ANGULAR_INCREMENTS", "BALLOON_HELP", "JOG_INVERT", "MACHINE_LOG_PATH", "MACRO",
        "MAX_RAPID_OVERRIDE", "MAX_SPINDLE_POWER", "MAX_SPINDLE_n_OVERRIDE", "MIN_SPINDLE_n_OVERRIDE",
        "DEFAULT_SPINDLE_n_SPEED", "MAX_SPINDLE_n_SPEED", "MIN_SPINDLE_n_SPEED", "MESSAGE_BOLDTEXT", "MESSAGE_DETAILS",
        "MESSAGE_ICON", "MESSAGE_PINNAME", "MESSAGE_TEXT", "MESSAGE_TYPE", "TKPKG", "TTT", "TTT_PREAMBLE",
        "NGCGUI_FONT", "NGCGUI_OPTIONS", "NGCGUI_POSTAMBLE", "NGCGUI_PREAMBLE", "NGCGUI_SUBFILE_PATH",
    ),
    *_keys(
        "TASK",
        ("TASK", TEXT, LAUNCHER, "the task program", {"default": "milltask"}),
        ("CYCLE_TIME", REAL, TASK, "period of task; 0 or less: the shortest", {"default": "0.01", "unit": "s", "maximum": 1.0}),
        ("MDI_QUEUED_COMMANDS", INTEGER, TASK, "MDI lines that may wait", {"default": "10000", "minimum": 1}),
    ),
    *_keys(
        "RS274NGC",
        ("PARAMETER_FILE", FILE, LANGUAGE, "file of numbered parameters; made where it is missing", {}),
        ("RS274NGC_STARTUP_CODE", TEXT, TASK, "G-code executed at start and after abort", {}),
        ("SUBROUTINE_PATH", TEXT, LANGUAGE, "folders of subroutines, separated by colons", {}),
        ("USER_M_PATH", TEXT, TASK, "more folders of M100 to M199, separated by colons", {}),
        ("ON_ABORT_COMMAND", TEXT, TASK, "G-code executed after an abort", {}),
        ("CENTER_ARC_RADIUS_TOLERANCE_INCH", REAL, LANGUAGE, "how much an arc's radii may differ", {"unit": "inch"}),
        ("CENTER_ARC_RADIUS_TOLERANCE_MM", REAL, LANGUAGE, "how much an arc's radii may differ", {"unit": "mm"}),
        ("ORIENT_OFFSET", REAL, LANGUAGE, "added to the angle of M19", {"default": "0", "unit": "deg"}),
        ("FEATURES", INTEGER, NOBODY, "old form of the next six entries; without effect here", {}),
        ("RETAIN_G43", BOOLEAN, LANGUAGE, "keep G43 on through tool changes", {"default": "no"}),
        ("OWORD_NARGS", BOOLEAN, LANGUAGE, "#<n_args> in subroutines", {"default": "no"}),
        ("INI_VARS", BOOLEAN, LANGUAGE, "#<_ini[SECTION]KEY>", {"default": "yes"}),
        ("HAL_PIN_VARS", BOOLEAN, LANGUAGE, "#<_hal[pin]>", {"default": "yes"}),
        ("NO_DOWNCASE_OWORD", BOOLEAN, LANGUAGE, "keep the case of O words", {"default": "no"}),
        ("OWORD_WARNONLY", BOOLEAN, LANGUAGE, "only warn of mistakes in O words", {"default": "no"}),
        ("DISABLE_G92_PERSISTENCE", BOOLEAN, LANGUAGE, "forget G92 at the end", {"default": "no"}),
        ("DISABLE_FANUC_STYLE_SUB", BOOLEAN, LANGUAGE, "no M98 and M99", {"default": "no"}),
        ("T_COMMAND", TEXT, NOBODY, LINUXCNC_ONLY, {}),
        ("M6_COMMAND", TEXT, NOBODY, LINUXCNC_ONLY, {}),
        ("M61_COMMAND", TEXT, NOBODY, LINUXCNC_ONLY, {}),
        ("REMAP", TEXT, LANGUAGE, "a code that a procedure or Python carries out", {"repeated": True}),
        ("USER_DEFINED_FUNCTION_MAX_DIRS", INTEGER, NOBODY, LINUXCNC_ONLY, {}),
        ("LOG_LEVEL", INTEGER, NOBODY, LINUXCNC_ONLY, {}),
        ("LOG_FILE", FILE, NOBODY, LINUXCNC_ONLY, {}),
    ),
    *_keys(
        "EMCMOT",
        ("EMCMOT", TEXT, HAL, "the motion module, for loadrt", {"default": "motmod"}),
        ("SERVO_PERIOD", REAL, HAL, "period of the servo thread", {"default": "1000000", "unit": "ns", "minimum": 1000}),
        ("BASE_PERIOD", REAL, HAL, "period of the base thread; 0: none", {"default": "0", "unit": "ns", "minimum": 0}),
        ("TRAJ_PERIOD", REAL, HAL, "period of the planner, for loadrt", {"unit": "ns", "minimum": 0}),
        ("COMM_TIMEOUT", REAL, TASK, "how long motion may take to answer", {"default": "1", "unit": "s", "minimum": 0.01}),
        ("HEARTBEAT_TIMEOUT", REAL, TASK, "how long motion waits for a sign of life of task before it stops the machine; 0.5 where there is no realtime priority", {"default": "0.1", "unit": "s", "minimum": 0.02, "maximum": 10.0}),
        ("COMM_WAIT", REAL, NOBODY, LINUXCNC_ONLY, {"unit": "s"}),
        ("SHMEM_KEY", INTEGER, NOBODY, LINUXCNC_ONLY, {}),
        ("HOMEMOD", TEXT, LAUNCHER, "the homing module: homemod, or one of your own by its name or file", {"default": "homemod"}),
    ),
    *_keys(
        "EMCIO",
        ("EMCIO", TEXT, LAUNCHER, "the I/O program: io, or iov2 -support-start-change", {"default": "io"}),
        ("CYCLE_TIME", REAL, IO, "period of io", {"default": "0.1", "unit": "s", "maximum": 10.0}),
        ("TOOL_TABLE", FILE, IO, "the tool table", {}),
        ("DB_PROGRAM", TEXT, IO, "program that keeps the tools, in place of a table", {}),
        ("RANDOM_TOOLCHANGER", BOOLEAN, IO, "tools change places in the magazine", {"default": "no"}),
        ("TOOL_CHANGE_WITH_SPINDLE_ON", BOOLEAN, LANGUAGE, "M6 leaves the spindle on", {"default": "no"}),
        ("TOOL_CHANGE_POSITION", TEXT, TASK, "where tools are changed: X Y Z, X to C or X to W, machine coordinates", {"unit": "lu, au"}),
        ("TOOL_CHANGE_QUILL_UP", BOOLEAN, LANGUAGE, "M6 goes to machine Z0 first", {"default": "no"}),
        ("TOOL_CHANGE_AT_G30", BOOLEAN, LANGUAGE, "M6 goes to the place of G30 first", {"default": "no"}),
    ),
    *_keys(
        "HAL",
        ("HALFILE", TEXT, LAUNCHER, "a HAL or Tcl file with arguments; LIB: takes it from the library", {"repeated": True}),
        ("HALCMD", TEXT, LAUNCHER, "a HAL command executed after the files", {"repeated": True}),
        ("TWOPASS", TEXT, LAUNCHER, "not empty: read the HAL files twice, loads first", {}),
        ("HALUI", TEXT, LAUNCHER, "start halui", {}),
        ("POSTGUI_HALFILE", TEXT, SCREEN, "HAL file for when the screen has made its pins", {"repeated": True}),
        ("POSTGUI_HALCMD", TEXT, SCREEN, "HAL command for when the screen has made its pins", {"repeated": True}),
        ("SHUTDOWN", TEXT, LAUNCHER, "HAL file executed when the machine is at rest and about to end", {}),
    ),
    Key("HALUI", "MDI_COMMAND", TEXT, HALUI, "an MDI line for halui.mdi-command-NN", repeated=True),
    *_keys(
        "APPLICATIONS",
        ("APP", TEXT, LAUNCHER, "program with arguments that runs beside the machine", {"repeated": True}),
        ("DELAY", REAL, LAUNCHER, "time between the machine's being ready and their start", {"default": "0", "unit": "s", "minimum": 0.0}),
    ),
    *_keys(
        "MQTT",
        ("BROKER", TEXT, SHOP, "host of the broker that is told what the machine does; the section needs it", {}),
        ("PORT", INTEGER, SHOP, "port of the broker; 8883 with TLS", {"default": "1883", "minimum": 1, "maximum": 65535}),
        ("TOPIC", TEXT, SHOP, "what topics begin with", {"default": "linuxcnc/[EMC]MACHINE"}),
        ("USER", TEXT, SHOP, "name to log in with", {}),
        ("PASSWORD_FILE", FILE, SHOP, "file with the password", {}),
        ("TLS", BOOLEAN, SHOP, "encrypt the connection", {"default": "no"}),
        ("CA_FILE", FILE, SHOP, "certificates to trust; without it the system's", {}),
        ("CYCLE_TIME", REAL, SHOP, "shortest time between two values", {"default": "0.2", "unit": "s", "minimum": 0.01, "maximum": 3600.0}),
    ),
    *_keys(
        "OPCUA",
        ("ENDPOINT", TEXT, SHOP, "address of the server", {"default": "opc.tcp://127.0.0.1:4840/"}),
        ("CERTIFICATE", FILE, SHOP, "the server's certificate; connections are encrypted then", {}),
        ("KEY", FILE, SHOP, "the certificate's key", {}),
        ("CYCLE_TIME", REAL, SHOP, "shortest time between two values", {"default": "0.2", "unit": "s", "minimum": 0.01, "maximum": 3600.0}),
    ),
    *_keys(
        "WEB",
        ("HOST", TEXT, SCREEN, "address that the web display listens on", {"default": "127.0.0.1"}),
        ("PORT", INTEGER, SCREEN, "port of the web display", {"minimum": 0, "maximum": 65535}),
        ("NAMES", TEXT, SCREEN, "names by which browsers may ask for it", {}),
        ("TOKEN_FILE", FILE, SCREEN, "file with the token that browsers must show", {}),
        ("TLS_CERTIFICATE", FILE, SCREEN, "certificate; connections are encrypted then", {}),
        ("TLS_KEY", FILE, SCREEN, "the certificate's key", {}),
        ("HAL_WRITE", BOOLEAN, SCREEN, "let browsers set HAL pins", {"default": "no"}),
        ("UPLOAD_LIMIT", REAL, SCREEN, "largest program that a browser may send", {"unit": "MB", "minimum": 0.0}),
    ),
    *_keys(
        "PYTHON",
        ("TOPLEVEL", FILE, LANGUAGE, "Python file with the functions of remaps and O words", {}),
        ("PATH_PREPEND", TEXT, LANGUAGE, "folders to import from before others", {"repeated": True}),
        ("PATH_APPEND", TEXT, LANGUAGE, "folders to import from after others", {"repeated": True}),
    ),
    Key("FILTER", "PROGRAM_EXTENSION", TEXT, SCREEN, "extensions of programs, and what they are, for file lists", repeated=True),
    Key("NML", "LISTEN", TEXT, NML, "address that the NML server listens on", "127.0.0.1"),
    *_keys(
        "KINS",
        ("JOINTS", INTEGER, TASK, "number of joints", {"minimum": 1, "maximum": 16, "required": True}),
        ("KINEMATICS", TEXT, HAL, "kinematics module and its parameters, for loadrt", {}),
    ),
    *_keys(
        "TRAJ",
        ("COORDINATES", TEXT, TASK, "letters of the axes, like X Y Z", {"required": True}),
        ("LINEAR_UNITS", CHOICE, TASK, "unit of length", {"choices": LENGTH_UNITS, "required": True}),
        ("ANGULAR_UNITS", CHOICE, TASK, "unit of angle", {"choices": ANGLE_UNITS, "default": "degree"}),
        ("SPINDLES", INTEGER, TASK, "number of spindles", {"default": "1", "minimum": 0, "maximum": 8}),
        ("DEFAULT_LINEAR_VELOCITY", REAL, TASK, "speed where nothing else says one", {"default": "1", "unit": "lu/s", "minimum": 0.0}),
        ("MAX_LINEAR_VELOCITY", REAL, TASK, "highest speed of the path", {"default": "1e99", "unit": "lu/s", "minimum": 0.0}),
        ("DEFAULT_LINEAR_ACCELERATION", REAL, TASK, "acceleration of the path", {"default": "1e99", "unit": "lu/s²", "minimum": 0.0}),
        ("MAX_LINEAR_ACCELERATION", REAL, TASK, "highest acceleration of the path", {"default": "1e99", "unit": "lu/s²", "minimum": 0.0}),
        ("HOME", TEXT, TASK, "position after homing, X to W, where the kinematics need it", {"default": "0 0 0 0 0 0 0 0 0", "unit": "lu, au"}),
        ("NO_FORCE_HOMING", BOOLEAN, TASK, "programs and MDI without homing", {"default": "no"}),
        ("NO_PROBE_JOG_ERROR", BOOLEAN, TASK, "jog on when the probe trips", {"default": "no"}),
        ("NO_PROBE_HOME_ERROR", BOOLEAN, TASK, "home on when the probe trips", {"default": "no"}),
        ("ARC_BLEND_ENABLE", BOOLEAN, TASK, "blend with look-ahead", {"default": "yes"}),
        ("ARC_BLEND_FALLBACK_ENABLE", BOOLEAN, TASK, "parabolic blends where they are faster", {"default": "no"}),
        ("ARC_BLEND_OPTIMIZATION_DEPTH", INTEGER, TASK, "segments to look ahead", {"default": "50", "minimum": 1}),
        ("ARC_BLEND_RAMP_FREQ", REAL, TASK, "shortest ramps", {"default": "100", "unit": "Hz", "minimum": 0.0}),
        ("TPMOD", TEXT, LAUNCHER, "the planner module: tpmod, or one of your own by its name or file", {"default": "tpmod"}),
        ("POSITION_FILE", FILE, TASK, "file that keeps the joints' positions while the machine is off", {}),
        ("PLANNER_TYPE", INTEGER, TASK, "0: trapezoids of velocity, 1: limited jerk", {"default": "0", "minimum": 0, "maximum": 1}),
        ("MAX_LINEAR_JERK", REAL, TASK, "highest jerk of the path; 0: no limit", {"default": "0", "unit": "lu/s³", "minimum": 0.0}),
        ("ARC_BLEND_GAP_CYCLES", REAL, TASK, "only shown as ini.traj_arc_blend_gap_cycles", {"default": "4"}),
        ("ARC_BLEND_KINK_RATIO", REAL, TASK, "only shown as ini.traj_arc_blend_tangent_kink_ratio", {"default": "0.1"}),
        ("ARC_BLEND_SMOOTHING_THRESHOLD", REAL, NOBODY, LINUXCNC_ONLY, {}),
    ),
    *_plain(
        "TRAJ", TEXT, NOBODY, LINUXCNC_ONLY,
        "AXES", "CYCLE_TIME", "DEFAULT_ANGULAR_VELOCITY", "MAX_ANGULAR_VELOCITY", "DEFAULT_ANGULAR_ACCELERATION",
        "MAX_ANGULAR_ACCELERATION",
    ),
    *_motion_limits("AXIS_L", "axis"),
    *_keys(
        "AXIS_L",
        ("OFFSET_AV_RATIO", REAL, TASK, "share of speed and acceleration for external offsets", {"default": "0", "minimum": 0.0, "maximum": 0.9}),
        ("WRAPPED_ROTARY", BOOLEAN, LANGUAGE, "positions go from 0 to 360, the sign is the direction", {"default": "no"}),
        ("LOCKING_INDEXER_JOINT", INTEGER, TASK, "joint that unlocks for this axis", {"default": "-1", "minimum": -1, "maximum": 15}),
        ("HOME", REAL, NOBODY, LINUXCNC_ONLY, {"unit": "lu or au"}),
    ),
    *_keys(
        "JOINT_n",
        ("TYPE", CHOICE, TASK, "kind of joint", {"default": "LINEAR", "choices": ("LINEAR", "ANGULAR")}),
        ("UNITS", CHOICE, TASK, "unit, where it is not the machine's", {"choices": (*LENGTH_UNITS, *ANGLE_UNITS)}),
    ),
    *_motion_limits("JOINT_n", "joint"),
    *_keys(
        "JOINT_n",
        ("BACKLASH", REAL, TASK, "play of the drive", {"default": "0", "unit": "lu or au"}),
        ("COMP_FILE", FILE, TASK, "table of screw errors; goes before BACKLASH", {}),
        ("COMP_FILE_TYPE", INTEGER, TASK, "0: forward and reverse position, 1: forward and reverse correction", {"default": "0", "minimum": 0, "maximum": 1}),
        ("FERROR", REAL, TASK, "largest following error at full speed", {"default": "1", "unit": "lu or au", "minimum": 0.0}),
        ("MIN_FERROR", REAL, TASK, "largest following error at low speed", {"default": "FERROR", "unit": "lu or au", "minimum": 0.0}),
        ("HOME", REAL, TASK, "position after homing", {"default": "0", "unit": "lu or au"}),
        ("HOME_OFFSET", REAL, TASK, "position of the switch or index", {"default": "0", "unit": "lu or au"}),
        ("HOME_SEARCH_VEL", REAL, TASK, "speed towards the switch; 0: home where it stands", {"default": "0", "unit": "lu/s or au/s"}),
        ("HOME_LATCH_VEL", REAL, TASK, "speed when the switch is measured", {"default": "0", "unit": "lu/s or au/s"}),
        ("HOME_FINAL_VEL", REAL, TASK, "speed to HOME; below 0: the joint's highest", {"default": "-1", "unit": "lu/s or au/s"}),
        ("HOME_SEQUENCE", INTEGER, TASK, "when homing all: who goes first; the same number goes together, below 0 ends together", {"default": "999", "minimum": -100, "maximum": 999}),
        ("HOME_IGNORE_LIMITS", BOOLEAN, TASK, "the home switch is a limit switch", {"default": "no"}),
        ("HOME_USE_INDEX", BOOLEAN, TASK, "measure the encoder's index", {"default": "no"}),
        ("HOME_INDEX_NO_ENCODER_RESET", BOOLEAN, TASK, "the index does not reset the encoder", {"default": "no"}),
        ("HOME_IS_SHARED", BOOLEAN, TASK, "other joints use the same switch", {"default": "no"}),
        ("HOME_ABSOLUTE_ENCODER", INTEGER, TASK, "1: absolute encoder, move to HOME; 2: without that move", {"default": "0", "minimum": 0, "maximum": 2}),
        ("LOCKING_INDEXER", BOOLEAN, TASK, "unlock before moving", {"default": "no"}),
        ("VOLATILE_HOME", BOOLEAN, TASK, "switching off forgets the home position", {"default": "no"}),
    ),
    *_plain("JOINT_n", TEXT, NOBODY, LINUXCNC_ONLY, "AXIS", "NAME", "CYCLE_TIME"),
    *_plain(
        "JOINT_n", REAL, HAL, "for HAL files",
        "P", "I", "D", "FF0", "FF1", "FF2", "BIAS", "DEADBAND", "INPUT_SCALE", "OUTPUT_SCALE", "OUTPUT_OFFSET",
        "ENCODER_SCALE", "SCALE", "STEP_SCALE", "MAX_OUTPUT", "MAX_ERROR", "STEPGEN_MAXVEL", "STEPGEN_MAXACCEL",
        "STEPGEN_MAX_VEL", "STEPGEN_MAX_ACC", "DIRSETUP", "DIRHOLD", "STEPLEN", "STEPSPACE",
    ),
    *_keys(
        "SPINDLE_n",
        ("MAX_FORWARD_VELOCITY", REAL, TASK, "highest speed forward", {"default": "1e99", "unit": "rpm", "minimum": 0.0}),
        ("MIN_FORWARD_VELOCITY", REAL, TASK, "lowest speed forward", {"default": "0", "unit": "rpm", "minimum": 0.0}),
        ("MAX_REVERSE_VELOCITY", REAL, TASK, "highest speed in reverse", {"default": "forward", "unit": "rpm", "minimum": 0.0}),
        ("MIN_REVERSE_VELOCITY", REAL, TASK, "lowest speed in reverse", {"default": "forward", "unit": "rpm", "minimum": 0.0}),
        ("MAX_VELOCITY", REAL, TASK, "both highest speeds at once", {"unit": "rpm", "minimum": 0.0}),
        ("MIN_VELOCITY", REAL, TASK, "both lowest speeds at once", {"unit": "rpm", "minimum": 0.0}),
        ("HOME_SEARCH_VELOCITY", REAL, NOBODY, LINUXCNC_ONLY, {"unit": "rpm"}),
        ("HOME_SEQUENCE", INTEGER, NOBODY, LINUXCNC_ONLY, {}),
        ("INCREMENT", REAL, TASK, "how much faster or slower at an operator's order", {"default": "100", "unit": "rpm", "minimum": 0.0}),
    ),
)  # fmt: skip

OPEN_SECTIONS = frozenset({"EMC", "DISPLAY", "FILTER", "PYTHON", "HAL", "HALUI", "APPLICATIONS", "MDI_COMMAND_LIST"})
"""Sections in which programs that are not ours look for keys of their own."""

_NUMBERED = (
    (re.compile(r"JOINT_\d+"), "JOINT_n"),
    (re.compile(r"AXIS_[XYZABCUVW]"), "AXIS_L"),
    (re.compile(r"SPINDLE_\d"), "SPINDLE_n"),
)

TABLE: dict[str, dict[str, Key]] = {}
for _key in KEYS:
    TABLE.setdefault(_key.section, {})[_key.name] = _key


def family(section: str) -> str:
    """The section's name in the table: JOINT_n for JOINT_2."""
    return next((name for pattern, name in _NUMBERED if pattern.fullmatch(section)), section)


def lookup(section: str, name: str) -> Key | None:
    """What the table has for an entry; a spindle's number in a key's name is n there."""
    return TABLE.get(family(section), {}).get(re.sub(r"SPINDLE_\d", "SPINDLE_n", name))


def document() -> Iterator[str]:
    """The lines of docs/ini.md."""
    yield "# Entries of the INI file"
    yield ""
    yield "Made from `linuxcnc/inikeys.py` by `python -m linuxcnc.inikeys > docs/ini.md`. `linuxcnc --check INI` looks for"
    yield "entries that are not here. lu and au are the machine's units of length and angle. An entry may always be used in a"
    yield "HAL file as `[SECTION]KEY`, so files may have entries of their own. Entries with many values are repeated."
    for section, keys in groupby(sorted(KEYS, key=lambda key: list(TABLE).index(key.section)), lambda key: key.section):
        yield ""
        yield f"## {section}"
        yield ""
        yield "| key | value | default | unit | read by | meaning |"
        yield "|---|---|---|---|---|---|"
        for key in keys:
            default = "required" if key.required else key.default
            name = f"{key.name} (repeated)" if key.repeated else key.name
            yield f"| {name} | {key.allowed} | {default} | {key.unit} | {key.reader.value} | {key.doc} |"


if __name__ == "__main__":
    sys.stdout.write("\n".join(document()) + "\n")
