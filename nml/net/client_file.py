"""Writes the NML file for a program on another computer: ``linuxcncsvr --client-file HOST``."""

from __future__ import annotations

from nml.config import NmlConfig
from nml.errors import ConfigError, Place
from nml.net.served import served_lines

CLIENT = "xemc"
"""The process of displays and other clients in NML files."""


def client_file(config: NmlConfig, server: str, host: str) -> str:
    """The lines of the served buffers and of process ``xemc``, who reaches them at ``host``."""
    served = {line.name for line, _ in served_lines(config, server)}
    kept = [f"# Made by linuxcncsvr from {config.path}, for programs that reach that machine at {host}."]
    for text in config.path.read_text(encoding="utf-8", errors="replace").splitlines():
        words = text.partition("#")[0].split()
        match words:
            case ["B", name, kind, _, *rest] if name in served:
                kept.append(" ".join(["B", name, kind, host, *rest]))
            case ["P", process, name, _, _, *rest] if process == CLIENT and name in served:
                kept.append(" ".join(["P", process, name, "REMOTE", host, *rest]))
    if not any(line.startswith("P") for line in kept):
        raise ConfigError(f"no P line of process {CLIENT} for a served buffer", Place(str(config.path)))
    return "\n".join(kept) + "\n"
