"""Tool table files as ``rs274 -t`` reads them: ``T1 P1 Z0.5 D0.25 ;remark``, machine units."""

from __future__ import annotations

import re
from pathlib import Path

from nml.errors import ConfigError, Place
from rs274ngc.canon import AXES, Tool

DEFAULT = (
    Tool(1, 1, (0.0, 0.0, 0.511) + (0.0,) * 6, 0.125),
    Tool(2, 2, (0.0, 0.0, 0.1) + (0.0,) * 6, 0.0625),
    Tool(3, 3, (0.0, 0.0, 1.273) + (0.0,) * 6, 0.201),
    Tool(99999, 123, (0.0, 0.0, 0.1) + (0.0,) * 6, 0.0),
)
"""The tools that ``rs274`` has without ``-t``: those of LinuxCNC's common simulator table, inches."""

WORD = re.compile(r"([A-Za-z])\s*([-+]?(?:\d+\.?\d*|\.\d+))")


def load(path: str | Path) -> list[Tool]:
    """The entries of a tool table file in its order; lines without a T word are skipped."""
    tools = []
    try:
        with open(path, encoding="utf-8", errors="replace") as lines:
            for line in lines:
                words = {letter.upper(): float(value) for letter, value in WORD.findall(line.partition(";")[0])}
                if "T" in words:
                    tools.append(
                        Tool(
                            toolno=int(words["T"]),
                            pocketno=int(words.get("P", 0)),
                            offset=tuple(words.get(axis, 0.0) for axis in AXES),
                            diameter=words.get("D", 0.0),
                            frontangle=words.get("I", 0.0),
                            backangle=words.get("J", 0.0),
                            orientation=int(words.get("Q", 0)),
                        )
                    )
    except OSError as error:
        raise ConfigError(f"Cannot open {path} ({error.strerror})", Place(str(path))) from error
    return tools
