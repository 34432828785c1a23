"""What linuxcncrsh says to `help`; the lists come from the tables of commands themselves."""

from __future__ import annotations

from gui.rsh_get import GETTERS
from gui.rsh_set import FREE, SETTERS

ARGUMENTS = {
    "ANGULAR_UNIT_CONVERSION": "<Deg | Rad | Grad | Auto>",
    "BRAKE": "<On | Off> [Spindle]",
    "COMM_MODE": "<Ascii | Binary>",
    "COMM_PROT": "<Version>",
    "DEBUG": "<Flags>",
    "ECHO": "<On | Off>",
    "ENABLE": "<Password | Off>",
    "ESTOP": "<On | Off>",
    "FEED_OVERRIDE": "<Percent>",
    "FLOOD": "<On | Off>",
    "HOME": "<Joint | -1>",
    "JOG": "<Joint | Axis> <Units per minute>",
    "JOG_INCR": "<Joint | Axis> <Units per minute> <Distance>",
    "JOG_STOP": "<Joint | Axis>",
    "LINEAR_UNIT_CONVERSION": "<Inch | mm | cm | Auto>",
    "LOAD_TOOL_TABLE": "<File>",
    "MACHINE": "<On | Off>",
    "MDI": "<Block>",
    "MIST": "<On | Off>",
    "MODE": "<Manual | Auto | MDI>",
    "OPEN": "<File>",
    "OPTIONAL_STOP": "<0 | 1>",
    "OVERRIDE_LIMITS": "<On | Off>",
    "PROBE": "<X> <Y> <Z>",
    "RUN": "[Line]",
    "SET_TIMEOUT": "<Seconds>",
    "SET_WAIT": "<Received | Done>",
    "SPINDLE": "<Forward | Reverse | Increase | Decrease | Constant | Off> [Spindle]",
    "SPINDLE_OVERRIDE": "<Percent> [Spindle]",
    "TELEOP_ENABLE": "[On | Off]",
    "TIMEOUT": "<Seconds>",
    "TOOL_OFFSET": "<Tool> <Length> [Diameter]",
    "UPDATE": "<None | Auto>",
    "VERBOSE": "<On | Off>",
    "WAIT": "<Received | Done>",
}


def _listed(names: list[str]) -> list[str]:
    return [f"    {name.capitalize()} {ARGUMENTS.get(name, '')}".rstrip() for name in names]


TOPICS: dict[str, list[str]] = {
    "": [
        "Available commands:",
        "  Hello <password> <client name> <protocol version>",
        "  Get <LinuxCNC command>",
        "  Set <LinuxCNC command>",
        "  Shutdown",
        "  Quit",
        "  Help <command>",
    ],
    "HELLO": [
        "Usage:",
        "  Hello <password> <client name> <protocol version>",
        "  The answer is HELLO ACK <server name> <protocol version>, or HELLO NAK for a wrong password.",
    ],
    "GET": [
        "Usage:",
        "  Get <LinuxCNC command> [<joint, axis or spindle>]",
        "  The LinuxCNC commands are:",
        *(f"    {name.capitalize()}" for name in GETTERS),
    ],
    "SET": [
        "Usage:",
        "  Set <LinuxCNC command> [<value> ...]",
        "  After a hello these need no control of the machine:",
        *_listed(list(FREE)),
        "  These need it (Set Enable <password>):",
        *_listed([name for name in SETTERS if name not in FREE]),
    ],
    "QUIT": ["Usage:", "  Quit ends this connection; it needs neither hello nor control."],
    "SHUTDOWN": ["Usage:", "  Shutdown ends the machine and all connections; it needs control."],
    "HELP": ["Usage:", "  Help [<command>]"],
}


def help_on(topic: str) -> list[str]:
    """The lines on one command, or the list of all."""
    return TOPICS.get(topic.upper(), [f"{topic.upper()} is not a valid command."])
