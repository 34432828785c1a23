"""The built-in realtime components, found by the name that ``loadrt`` uses.

Small ones are declared in the native modules of `GROUPS`, several to a module (see ``declare.py``); those that need
code of their own at loading are modules here with a ``load(host, args)``.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from hal.components.declare import DECLARED

GROUPS = (
    "logic", "arithmetic", "filters", "timing", "select", "convert", "simulate", "control", "stepgen", "encoders",
    "pulses", "codes", "geometry", "shaping", "counting", "offsets", "supervise", "spindles", "trials", "raster",
    "changers", "keypads", "motors", "thermocouples", "plasmac",
)  # fmt: skip
MODULES = {
    "threads": ("threads", "load"),
    "sampler": ("fifo", "load_sampler"),
    "streamer": ("fifo", "load_streamer"),
    "scope": ("fifo", "load_scope"),
    "message": ("supervise", "load_message"),
}


def _import_groups() -> None:
    for group in GROUPS:
        import_module(f"hal.components.{group}")


def find(name: str) -> Callable[..., None] | None:
    """What loads the component of that name; None where there is none."""
    if name in MODULES:
        module, function = MODULES[name]
        load: Callable[..., None] = getattr(import_module(f"hal.components.{module}"), function)
        return load
    if name not in DECLARED:
        _import_groups()
    declared = DECLARED.get(name)
    return declared.load if declared else None


def names() -> list[str]:
    """All of them, sorted."""
    _import_groups()
    return sorted([*DECLARED, *MODULES])
