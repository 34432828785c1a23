"""What clients may ask the server for, one module for each part of the page; importing this registers them all."""

from gui.web.methods import (
    control,
    cutting,
    halpages,
    jogs,
    mdi,
    misc,
    offsets,
    operating,
    path,
    programs,
    tools,
)

__all__ = ["control", "cutting", "halpages", "jogs", "mdi", "misc", "offsets", "operating", "path", "programs", "tools"]
