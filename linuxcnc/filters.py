"""[FILTER]: programs that make G-code of other files, chosen by the file's extension; for who opens programs.

    [FILTER]
    PROGRAM_EXTENSION = .png,.gif Images
    png = image-to-gcode

The filter is called with the file's name and writes G-code to its standard output. Lines ``FILTER_PROGRESS=42`` on its
standard error tell how many percent are done; its other lines are for the operator. Another exit code than 0 is an
error.
"""

from __future__ import annotations

import re
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import IO

from nml import namespace
from nml.errors import ConfigError, PyemcError
from nml.inifile import IniFile

PROGRESS = re.compile(r"FILTER_PROGRESS=(\d+)\s*")

Progress = Callable[[int], None]
"""Takes percent."""
Say = Callable[[str], None]


class FilterError(PyemcError):
    """A filter could not make a program; the text says why."""


def filter_of(ini: IniFile, path: Path) -> str | None:
    """The command line of the filter for a file; None where the file is a program itself."""
    extension = path.suffix.lstrip(".")
    return ini.find("FILTER", extension) if extension and extension != "PROGRAM_EXTENSION" else None


def filtered(ini: IniFile, path: Path, progress: Progress = lambda percent: None, say: Say = lambda line: None) -> Path:
    """The program to open for a file: itself, or what its filter makes of it, which stays until the machine ends.

    FilterError: the filter failed. ConfigError: it cannot be started.
    """
    command = filter_of(ini, path)
    if command is None:
        return path
    made = namespace.runtime_dir() / f"{path.stem}.filtered.ngc"
    with made.open("wb") as output:
        try:
            process = subprocess.Popen(
                [*shlex.split(command), str(path)],
                cwd=ini.file.absolute().parent,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
            )
        except OSError as error:
            place = ini.place("FILTER", path.suffix.lstrip("."))
            raise ConfigError(f"[FILTER]: {command}: {error.strerror}", place) from None
        assert process.stderr is not None
        lines = _listen(process.stderr, progress, say)
    code = process.wait()
    if code:
        made.unlink()
        reason = " ".join(lines) or "no reason given"
        raise FilterError(f"{path}: {command} ended with exit code {code}: {reason}")
    return made


def _listen(stream: IO[str], progress: Progress, say: Say) -> list[str]:
    """Pass on what a filter says, until it closes its standard error; its lines for the operator."""
    lines = []
    with stream:
        for line in stream:
            match = PROGRESS.fullmatch(line)
            if match:
                progress(min(int(match[1]), 100))
            elif line.strip():
                lines.append(line.strip())
                say(line.strip())
    return lines
