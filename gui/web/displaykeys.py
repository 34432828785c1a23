"""The [DISPLAY] keys of the manual's GUI chapter and what else of the INI file the page must know: ``config`` of
hello.

Values come out in machine units; whatever the file leaves out gets the value that LinuxCNC's screens take.
"""

from __future__ import annotations

import base64
import math
import re
from typing import Any

from gui.web.settings import Settings
from nml.inifile import IniFile

AXES = "XYZABCUVW"
ROTARY = "ABC"
MM = {"mm": 1.0, "metric": 1.0, "cm": 10.0, "inch": 25.4, "in": 25.4, "imperial": 25.4}  # of one unit
UNIT_NAMES = {1.0: "mm", 10.0: "cm", 25.4: "inch"}
DEGREES = {"degree": 1.0, "deg": 1.0, "rad": 180.0 / math.pi, "radian": 180.0 / math.pi, "grad": 0.9, "gon": 0.9}
LENGTHS = {"mm": 1.0, "cm": 10.0, "um": 0.001, "inch": 25.4, "in": 25.4, "mil": 0.0254, "thou": 0.0254}
LENGTHS["μm"] = LENGTHS["µm"] = LENGTHS["um"]
LONGEST_CYCLE, SHORTEST_CYCLE = 1.0, 0.02  # s
DEFAULT_CYCLE = 0.05
MILLISECONDS_FROM = 5.0  # a CYCLE_TIME of this or more is meant in ms
DEFAULT_INCREMENTS = {
    1.0: "1 mm, .1 mm, .01 mm, .001 mm",
    10.0: "1 mm, .1 mm, .01 mm",
    25.4: ".1 in, .05 in, .01 in, .001 in",
}
DEFAULT_GRIDS = "10 mm, 20 mm, 50 mm, 100 mm, 1 in, 2 in, 5 in, 10 in"
MACHINE_TYPES = ("mill", "lathe", "foam")
FOAM_PLANES = (0.0, 1.5)  # machine units: where XY and UV are shown
ICON_TYPES = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif", ".ico": "image/x-icon"}
LARGEST_ICON = 1 << 16  # bytes
DEFAULT_EXTENSIONS = (".ngc", ".nc", ".tap")
NO_LIMIT = 1e99

_INCREMENT = re.compile(r"([0-9.]+(?:\s*/\s*[0-9.]+)?)\s*([A-Za-zµμ]*)")


def configuration(ini: IniFile, settings: Settings) -> dict[str, Any]:
    """All of ``config`` that the INI file decides; nml.errors.ConfigError where an entry is wrong."""
    mm = ini.choice("TRAJ", "LINEAR_UNITS", MM, 1.0)
    degrees = ini.choice("TRAJ", "ANGULAR_UNITS", DEGREES, 1.0)
    machine = ini.find("EMC", "MACHINE", ini.file.stem)
    return {
        "machine": machine,
        "title": ini.find("DISPLAY", "TITLE", machine),
        "ini": str(ini.file),
        "units": {
            "linear": UNIT_NAMES[mm],
            "mm_per_unit": mm,
            "angular": ini.find("TRAJ", "ANGULAR_UNITS", "degree").lower(),
            "degrees_per_unit": degrees,
        },
        "machine_type": machine_type(ini),
        "back_tool_lathe": ini.boolean("DISPLAY", "BACK_TOOL_LATHE", False),
        "axes": axes(ini),
        "joints": joints(ini),
        "identity": "trivkins" in ini.find("KINS", "KINEMATICS", "trivkins").lower(),
        "spindles": [
            spindle(ini, number) for number in range(ini.integer("TRAJ", "SPINDLES", 1, minimum=0, maximum=8))
        ],
        "overrides": {
            "feed_max": override(ini, "MAX_FEED_OVERRIDE", 1.0),
            "rapid_max": override(ini, "MAX_RAPID_OVERRIDE", 1.0),
        },
        "max_velocity": ini.real(
            "TRAJ", "MAX_LINEAR_VELOCITY", max([axis["max_velocity"] for axis in axes(ini)] or [1.0])
        ),
        "no_force_homing": ini.boolean("TRAJ", "NO_FORCE_HOMING", False),
        "increments": increments(
            ini.find("DISPLAY", "INCREMENTS", DEFAULT_INCREMENTS[mm]), LENGTHS, mm, ini, "INCREMENTS"
        ),
        "angular_increments": increments(
            ini.find("DISPLAY", "ANGULAR_INCREMENTS", "1, 5, 10, 45, 90"), DEGREES, degrees, ini, "ANGULAR_INCREMENTS"
        ),
        "jog_speed": {"linear": jog_speed(ini, "LINEAR", mm), "angular": jog_speed(ini, "ANGULAR", mm)},
        "position_offset": ini.find("DISPLAY", "POSITION_OFFSET", "RELATIVE").lower(),
        "position_feedback": ini.find("DISPLAY", "POSITION_FEEDBACK", "ACTUAL").lower(),
        "cycle_time": cycle_time(ini),
        "mdi_commands": mdi_commands(ini),
        "embed_tabs": embed_tabs(ini),
        "program_extensions": program_extensions(ini),
        "filters": filters(ini),
        "upload_limit": settings.upload_limit,
        "confirm_exit": ini.boolean("DISPLAY", "CONFIRM_EXIT", False),
        "icon": icon(ini),
        "grids": grids(ini, mm),
        "geometry": geometry(ini),
        "hal_write": settings.hal_write,
    }


def machine_type(ini: IniFile) -> str:
    """mill, lathe or foam; the old keys LATHE and FOAM count where there is no hint."""
    hint = ini.find("DISPLAY", "MACHINE_TYPE_HINT")
    if hint is not None:
        if hint.lower() not in MACHINE_TYPES:
            raise ini.error("DISPLAY", "MACHINE_TYPE_HINT", f"{hint}; one of {', '.join(MACHINE_TYPES)} would be right")
        return hint.lower()
    for word in ("lathe", "foam"):
        if ini.boolean("DISPLAY", word.upper(), False):
            return word
    return "mill"


def geometry(ini: IniFile) -> list[dict[str, Any]]:
    """[DISPLAY]GEOMETRY: how the picture makes points of poses, the steps of each in the order of their execution.

    A foam cutter is shown as the two ends of its wire, in planes a little apart, whatever the entry says.
    """
    if machine_type(ini) == "foam":
        return [
            {"steps": [[letter, 1] for letter in letters], "height": height}
            for letters, height in zip(("XY", "UV"), FOAM_PLANES, strict=True)
        ]
    text = ini.find("DISPLAY", "GEOMETRY", AXES).upper()
    if not re.fullmatch(rf"(-?[{AXES}]|!)*", text):
        raise ini.error("DISPLAY", "GEOMETRY", f"{text}; letters of {AXES}, where need be with -, would be right")
    known = axis_letters(ini)
    steps = [[letter, -1 if sign else 1] for sign, letter in re.findall(rf"(-?)([{AXES}])", text) if letter in known]
    return [{"steps": steps[::-1], "height": 0.0}]


def grids(ini: IniFile, mm: float) -> list[dict[str, Any]]:
    """Distances of grid lines to choose from."""
    return increments(ini.find("DISPLAY", "GRIDS", DEFAULT_GRIDS), LENGTHS, mm, ini, "GRIDS")[1:]


def icon(ini: IniFile) -> str | None:
    """The picture of [DISPLAY]ICON as a data: address, where it is of a kind that browsers show."""
    path = ini.path("DISPLAY", "ICON", None)
    kind = ICON_TYPES.get(path.suffix.lower()) if path is not None else None
    try:
        if path is None or kind is None or path.stat().st_size > LARGEST_ICON:
            return None
        return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"
    except OSError:
        return None


def axis_letters(ini: IniFile) -> str:
    """Letters of [TRAJ]COORDINATES, each once."""
    letters = [letter for letter in ini.find("TRAJ", "COORDINATES", "XYZ").upper() if letter in AXES]
    return "".join(dict.fromkeys(letters))


def axes(ini: IniFile) -> list[dict[str, Any]]:
    """The axes in the order of [TRAJ]COORDINATES."""
    described = joints(ini)
    return [
        {
            "letter": letter,
            "index": AXES.index(letter),
            "linear": letter not in ROTARY,
            **motion_limits(ini, f"AXIS_{letter}", letter not in ROTARY),
            "joints": [joint["number"] for joint in described if joint["axis"] == letter],
        }
        for letter in axis_letters(ini)
    ]


def joints(ini: IniFile) -> list[dict[str, Any]]:
    """The joints; each with the axis that it drives where the kinematics say so."""
    letters = joint_letters(ini)
    found = []
    for number in range(ini.integer("KINS", "JOINTS", minimum=1, maximum=16)):
        section = f"JOINT_{number}"
        linear = ini.find(section, "TYPE", "LINEAR").upper() != "ANGULAR"
        found.append(
            {
                "number": number,
                "axis": letters[number] if number < len(letters) else None,
                "linear": linear,
                **motion_limits(ini, section, linear),
                "home_sequence": ini.integer(section, "HOME_SEQUENCE", 999),
            }
        )
    return found


def joint_letters(ini: IniFile) -> list[str]:
    """The letter of each joint: trivkins' coordinates=, else [TRAJ]COORDINATES with its repeated letters."""
    given = re.search(r"coordinates=(\w+)", ini.find("KINS", "KINEMATICS", ""), re.IGNORECASE)
    text = given.group(1) if given else ini.find("TRAJ", "COORDINATES", "XYZ")
    return [letter for letter in text.upper() if letter in AXES]


def motion_limits(ini: IniFile, section: str, linear: bool) -> dict[str, float]:
    """min, max, max_velocity, max_acceleration of an axis or joint."""
    kind = "LINEAR" if linear else "ANGULAR"
    return {
        "min": ini.real(section, "MIN_LIMIT", -NO_LIMIT),
        "max": ini.real(section, "MAX_LIMIT", NO_LIMIT),
        "max_velocity": ini.real(section, "MAX_VELOCITY", ini.real("TRAJ", f"MAX_{kind}_VELOCITY", 1.0)),
        "max_acceleration": ini.real(section, "MAX_ACCELERATION", ini.real("TRAJ", f"MAX_{kind}_ACCELERATION", 1.0)),
    }


def override(ini: IniFile, key: str, default: float) -> float:
    """A factor; the manual's percents (120) are taken as what they mean, because no factor is 10 or more."""
    value = ini.real("DISPLAY", key, default, minimum=0.0)
    return value / 100.0 if value >= 10.0 else value


def spindle(ini: IniFile, number: int) -> dict[str, float]:
    """What the page allows for one spindle."""
    section = f"SPINDLE_{number}"
    fallback = ini.real(section, "MAX_FORWARD_VELOCITY", ini.real(section, "MAX_VELOCITY", NO_LIMIT))
    return {
        "min_override": override(ini, f"MIN_SPINDLE_{number}_OVERRIDE", override(ini, "MIN_SPINDLE_OVERRIDE", 0.5)),
        "max_override": override(ini, f"MAX_SPINDLE_{number}_OVERRIDE", override(ini, "MAX_SPINDLE_OVERRIDE", 1.0)),
        "default_speed": ini.real(
            "DISPLAY", f"DEFAULT_SPINDLE_{number}_SPEED", ini.real("DISPLAY", "DEFAULT_SPINDLE_SPEED", 500.0)
        ),
        "min_speed": ini.real("DISPLAY", f"MIN_SPINDLE_{number}_SPEED", ini.real(section, "MIN_FORWARD_VELOCITY", 0.0)),
        "max_speed": min(ini.real("DISPLAY", f"MAX_SPINDLE_{number}_SPEED", fallback), 1e6),
        "increment": ini.real("DISPLAY", "SPINDLE_INCREMENT", 100.0, minimum=0.0),
    }


def increments(text: str, units: dict[str, float], unit: float, ini: IniFile, key: str) -> list[dict[str, Any]]:
    """Jog increments as text and machine units; continuous always comes first."""
    found: list[dict[str, Any]] = [{"text": "continuous", "value": None}]
    for part in re.split(r",|\s(?=[0-9.]+\s*(?:[A-Za-zµμ]|$))", text):
        word = part.strip()
        if not word or word.lower() == "continuous":
            continue
        match = _INCREMENT.fullmatch(word)
        name = match.group(2).lower() if match else ""
        if match is None or (name and name not in units):
            raise ini.error("DISPLAY", key, f"{word!r} is no increment; like '0.1 mm' or '1/8 in' would be right")
        top, _, bottom = match.group(1).partition("/")
        try:
            value = float(top) / float(bottom or 1.0)
        except (ValueError, ZeroDivisionError):
            raise ini.error("DISPLAY", key, f"{word!r} is no increment; like '0.1 mm' would be right") from None
        found.append({"text": word, "value": value * units[name] / unit if name else value})
    return found


def jog_speed(ini: IniFile, kind: str, mm: float) -> dict[str, float]:
    """Jog speeds per minute; the entries are in units per s, as task and LinuxCNC's screens take them."""
    top = 50.0 / mm if kind == "LINEAR" else 90.0
    highest = ini.real("DISPLAY", f"MAX_{kind}_VELOCITY", ini.real("TRAJ", f"MAX_{kind}_VELOCITY", top), minimum=0.0)
    if highest >= NO_LIMIT:
        highest = top
    lowest = min(ini.real("DISPLAY", f"MIN_{kind}_VELOCITY", highest / 1000.0, minimum=0.0), highest)
    default = ini.real("DISPLAY", f"DEFAULT_{kind}_VELOCITY", highest / 4.0, minimum=0.0)
    return {
        "default_per_min": min(max(default, lowest), highest) * 60.0,
        "min_per_min": lowest * 60.0,
        "max_per_min": highest * 60.0,
    }


def cycle_time(ini: IniFile) -> float:
    """[DISPLAY]CYCLE_TIME in s: files have it in s or, as the manual says, in ms."""
    value = ini.real("DISPLAY", "CYCLE_TIME", DEFAULT_CYCLE, minimum=0.0)
    if value >= MILLISECONDS_FROM:
        value /= 1000.0
    return min(max(value, SHORTEST_CYCLE), LONGEST_CYCLE)


def mdi_commands(ini: IniFile) -> list[dict[str, Any]]:
    """The buttons of [MDI_COMMAND_LIST]: ``KEY = G0 X0;G0 Z0, Label\\nof the button``."""
    found: list[dict[str, Any]] = []
    for section in ("MDI_COMMAND_LIST", "MDI_COMMAND"):
        for key in dict.fromkeys(ini.keys(section)):
            for text in ini.findall(section, key):
                code, _, label = text.partition(",")
                commands = [line.strip() for line in code.split(";") if line.strip()]
                if commands:
                    shown = label.strip().replace("\\n", "\n") or code.strip()
                    found.append({"index": len(found), "label": shown, "commands": commands})
    return found


def embed_tabs(ini: IniFile) -> list[dict[str, str | None]]:
    """Tabs whose command is the address of a page; programs cannot be shown in a browser."""
    names = ini.findall("DISPLAY", "EMBED_TAB_NAME")
    places = ini.findall("DISPLAY", "EMBED_TAB_LOCATION")
    found = []
    for number, command in enumerate(ini.findall("DISPLAY", "EMBED_TAB_COMMAND")):
        if re.match(r"https?://[^\s\"'<>;,]+$", command.strip()):
            name = names[number] if number < len(names) else command
            place = places[number] if number < len(places) else None
            found.append({"name": name, "url": command.strip(), "location": place})
    return found


def program_extensions(ini: IniFile) -> list[dict[str, Any]]:
    """What counts as a program: [FILTER]PROGRAM_EXTENSION, or G-code's usual extensions."""
    found = []
    for text in ini.findall("FILTER", "PROGRAM_EXTENSION"):
        extensions, _, remark = text.strip().partition(" ")
        words = [word if word.startswith(".") else f".{word}" for word in extensions.lower().split(",") if word]
        found.append({"extensions": words, "text": remark.strip() or extensions})
    return found or [{"extensions": list(DEFAULT_EXTENSIONS), "text": "G-code"}]


def filters(ini: IniFile) -> list[str]:
    """Extensions that have a filter program."""
    return [f".{key}" for key in dict.fromkeys(ini.keys("FILTER")) if key != "PROGRAM_EXTENSION"]
