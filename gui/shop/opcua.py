"""``linuxcnc-opcua``: an OPC UA server whose variables show what the machine does; they cannot be written.

The section [OPCUA] of the INI file gives its address. Below Objects stands one object with the machine's name; its
variables are those of ``items``, with folders for the parts of their names, and ``message``, the last for the operator.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import signal
import sys
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from asyncua import Node, Server, ua

import linuxcnc
from gui.shop.items import ITEMS, MESSAGE_KINDS, Item, Value, readings
from gui.shop.settings import Section
from nml.errors import ConfigError

NAMESPACE = "urn:pyemc:machine"
TYPES = {bool: ua.VariantType.Boolean, int: ua.VariantType.Int64, float: ua.VariantType.Double}


@dataclass(frozen=True, slots=True)
class Settings:
    """The section [OPCUA]."""

    endpoint: str
    machine: str
    certificate: Path | None
    key: Path | None
    cycle: float
    """Host seconds between looks at the status."""

    @classmethod
    def read(cls, path: Path) -> Settings:
        section = Section(path, "OPCUA")
        endpoint = section.text("ENDPOINT", "opc.tcp://127.0.0.1:4840/")
        parts = urlsplit(endpoint)
        if parts.scheme != "opc.tcp" or not parts.hostname:
            raise section.wrong("ENDPOINT", f"= {endpoint}", "e.g. ENDPOINT = opc.tcp://127.0.0.1:4840/")
        certificate, key = section.file("CERTIFICATE"), section.file("KEY")
        if (certificate is None) != (key is None):
            raise section.wrong("CERTIFICATE", "and KEY belong together", "give both or none")
        return cls(endpoint, section.machine(), certificate, key, section.real("CYCLE_TIME", 0.2, 0.01, 3600.0))


class MachineServer:
    """The server, its variables by the names of the items, and what they hold."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._server = Server()
        self._variables: dict[str, tuple[Node, ua.VariantType]] = {}
        self._held: dict[str, Value] = {}
        self._index = 0

    async def start(self, values: dict[str, Value]) -> None:
        """Make the variables, and open the port."""
        server, settings = self._server, self._settings
        await server.init()
        server.set_endpoint(settings.endpoint)
        server.set_server_name(f"{settings.machine} (LinuxCNC)")
        policies = [ua.SecurityPolicyType.NoSecurity]
        if settings.certificate and settings.key:
            await server.load_certificate(settings.certificate)
            await server.load_private_key(settings.key)
            policies = [ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt]
        server.set_security_policy(policies)
        self._index = await server.register_namespace(NAMESPACE)
        folders = {"": await server.nodes.objects.add_object(self._index, settings.machine)}
        for item in ITEMS:
            await self._add(item, values[item.name], folders)
        await self._add(Item("message", "the last operator message", lambda status: ""), "", folders)
        await server.start()

    async def _add(self, item: Item, value: Value, folders: dict[str, Node]) -> None:
        parent, _, name = item.name.rpartition("/")
        if parent not in folders:
            folders[parent] = await folders[""].add_folder(self._index, parent)
        first = value[0] if isinstance(value, list) and value else value
        kind = TYPES.get(type(first), ua.VariantType.String)
        identifier = ua.NodeId(ua.String(f"{self._settings.machine}/{item.name}"), ua.Int16(self._index))
        variable = await folders[parent].add_variable(identifier, name, value, kind)
        text = f"{item.doc}, {item.unit}" if item.unit else item.doc
        await variable.write_attribute(ua.AttributeIds.Description, ua.DataValue(ua.Variant(ua.LocalizedText(text))))
        self._variables[item.name] = variable, kind
        self._held[item.name] = value

    async def tell(self, values: dict[str, Value]) -> None:
        """Write what has changed."""
        for name, value in values.items():
            if self._held[name] != value:
                variable, kind = self._variables[name]
                await variable.write_value(ua.Variant(value, kind))
                self._held[name] = value

    async def stop(self) -> None:
        await self._server.stop()


async def serve(settings: Settings) -> None:
    """Serve until SIGTERM or SIGINT."""
    over = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, over.set)
    status, errors = linuxcnc.stat(), linuxcnc.error_channel()
    server = MachineServer(settings)
    await server.start(readings(status))
    try:
        while not over.is_set():
            status.poll()
            await server.tell(readings(status))
            while (message := errors.poll()) is not None:
                await server.tell({"message": f"{MESSAGE_KINDS.get(message[0], 'text')}: {message[1]}"})
            await asyncio.sleep(settings.cycle)
    finally:
        await server.stop()


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    parser = argparse.ArgumentParser(prog="linuxcnc-opcua", description="Show the machine's state over OPC UA.")
    parser.add_argument("-ini", metavar="FILE", default=os.environ.get("INI_FILE_NAME"), help="INI file of the machine")
    options = parser.parse_args(arguments)
    try:
        if options.ini is None:
            raise ConfigError("no INI file; give one with -ini")
        asyncio.run(serve(Settings.read(Path(options.ini))))
    except (ConfigError, linuxcnc.error, OSError) as reason:
        print(f"linuxcnc-opcua: {reason}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
