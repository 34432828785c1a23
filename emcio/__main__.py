"""The command ``io -ini FILE``: the controller of E-stop, tools, coolant and lubrication, one process of a machine."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Sequence

from emcio.changer import Changer
from emcio.changer2 import FaultingChanger
from emcio.controller import IoChannels, IoController
from emcio.database import DatabaseTools
from emcio.pins import make_component
from emcio.sources import FileTools, NoTools, ToolSource
from emcio.toolstore import ToolStore
from nml.channel import Channel
from nml.config import NmlConfig
from nml.errors import PyemcError
from nml.inifile import IniFile

DEFAULT_CYCLE_S = 0.1


def main(arguments: Sequence[str] | None = None) -> int:
    """Run io until SIGTERM or a halt command; the exit code."""
    parser = argparse.ArgumentParser(prog="io", description=__doc__)
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="the machine's INI file")
    parser.add_argument("-v2", action="store_true", help="be iov2: a tool changer that reports faults")
    parser.add_argument("-support-start-change", action="store_true", help="iov2: M6 begins with start-change")
    options = parser.parse_args(arguments)
    if not options.ini:
        print("io: no INI file; give -ini FILE or set INI_FILE_NAME", file=sys.stderr)
        return 1
    os.environ["INI_FILE_NAME"] = options.ini
    try:
        controller = build(IniFile(options.ini), faults=options.v2, announces=options.support_start_change)
    except PyemcError as error:
        print(error, file=sys.stderr)
        return 1

    def stop(number: int, frame: object) -> None:
        controller.running = False

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    try:
        controller.run()
    finally:
        controller.channels.close()
        controller.pins.exit()  # type: ignore[attr-defined]
    return 0


def build(ini: IniFile, *, faults: bool = False, announces: bool = False) -> IoController:
    """The controller that the INI file describes; ConfigError when it describes none.

    ``faults``: the tool changer reports faults (iov2); ``announces``: and M6 begins with start-change.
    """
    cycle_s = ini.real("EMCIO", "CYCLE_TIME", DEFAULT_CYCLE_S, maximum=10.0)
    store = ToolStore(ini.boolean("EMCIO", "RANDOM_TOOLCHANGER", False))
    source = tool_source(ini)
    try:
        remarks = source.load(store)
    except PyemcError:
        source.close()
        raise
    for remark in remarks:
        print(remark, file=sys.stderr)
    config = NmlConfig.load()
    channels = IoChannels(
        commands=Channel(config, "toolCmd", process="tool"),
        status=Channel(config, "toolSts", process="tool"),
        table=Channel(config, "toolTable", process="tool"),
        errors=Channel(config, "emcError", process="emc"),
    )
    pins = make_component(faults)
    changer = FaultingChanger(store, pins, announces) if faults else Changer(store, pins)
    return IoController(pins, store, source, channels, cycle_s if cycle_s > 0.0 else 0.001, changer)


def tool_source(ini: IniFile) -> ToolSource:
    """Where this machine's tools come from: a data base program goes before a table file."""
    if command := ini.words("EMCIO", "DB_PROGRAM"):
        return DatabaseTools([str(ini.resolve(command[0])), *command[1:]], ini.file.parent)
    name = ini.find("EMCIO", "TOOL_TABLE")
    if not name:
        return NoTools()
    path = ini.resolve(name)
    if not path.exists():
        place = ini.place("EMCIO", "TOOL_TABLE")
        print(f"{place}: [EMCIO]TOOL_TABLE = {name}: there is no such file; this machine has no tools", file=sys.stderr)
        return NoTools()
    return FileTools(path)


if __name__ == "__main__":
    sys.exit(main())
