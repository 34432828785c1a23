"""Writes ``docs/hal-components.md`` from the declarations: ``python -m hal.components.reference``."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from hal import components
from hal._shm import IN, OUT, RW
from hal.components.declare import DECLARED, Declaration, Entry
from hal.values import TYPE_NAMES, plain_value

TARGET = Path(__file__).resolve().parents[2] / "docs" / "hal-components.md"
HEAD = """# HAL components

Generated from the declarations by `python -m hal.components.reference`; do not edit. Names and meanings are those of
LinuxCNC's manual pages. Every function also has a pin `.time` and parameters `.tmax` and `.tmax-increased`, in ns.
"""


FIELDS = {
    "{letter}": "M", "{:02}": "MM", "{}": "M", "{type}": "TYPE", "{row:x}": "R", "{column:x}": "C", "{word}": "AXIS",
}  # fmt: skip


def placeholder(entry: Entry) -> str:
    """The entry's name with its numbers as `M`."""
    name = entry.name
    for field, shown in FIELDS.items():
        name = name.replace(field, shown)
    return name


def instance(declaration: Declaration) -> str:
    """An instance's name with its number as `N`."""
    return (declaration.instance or f"{declaration.prefix}.{{}}").replace("{:02}", "NN").replace("{}", "N")


def direction(entry: Entry) -> str:
    if entry.dir_of:
        return "in or out"
    if entry.is_pin:
        return "in" if entry.dir == IN else "out" if entry.dir == OUT else "in/out"
    return "parameter" if entry.dir == RW else "parameter, read only"


def default(entry: Entry) -> str:
    return f" (default {plain_value(entry.type, entry.default)})" if entry.default else ""


def declared(declaration: Declaration) -> Iterator[str]:
    """The section of one component."""
    yield f"## {declaration.name}\n"
    yield f"{declaration.doc}.\n"
    names = ["`names=`"] if declaration.takes_names else []
    options = [f"`{declaration.counted_by}=`", *names, *(f"`{option}=`" for option in declaration.options)]
    if declaration.personality is not None:
        options.append("`personality=`")
    most = f", up to {declaration.most}" if declaration.most else ""
    yield f"Load: `loadrt {declaration.name}` with {', '.join(options)}{most}.\n"
    names = [f"`{instance(declaration)}{'.' + suffix if suffix else ''}`" for suffix in declaration.functions]
    names += [f"`{name}` (all channels)" for name, _ in declaration.shared_functions()]
    yield f"Functions: {', '.join(names)}.\n"
    yield "| name | type | direction | meaning |\n|---|---|---|---|"
    for entry in declaration.entries:
        name = f"{instance(declaration)}.{placeholder(entry)}"
        type_name = "any" if entry.type_of else TYPE_NAMES[entry.type]
        yield f"| `{name}` | {type_name} | {direction(entry)} | {entry.doc}{default(entry)} |"
    yield ""


def of_module(name: str) -> Iterator[str]:
    """The section of a component with code of its own for loading: what its load function says."""
    module, function = components.MODULES[name]
    load = getattr(import_module(f"hal.components.{module}"), function)
    yield f"## {name}\n"
    yield f"{(load.__doc__ or '').strip()}\n"


def reference() -> str:
    """The whole page."""
    lines = [HEAD]
    for name in components.names():
        lines += declared(DECLARED[name]) if name in DECLARED else of_module(name)
    return "\n".join(lines)


if __name__ == "__main__":
    TARGET.write_text(reference(), encoding="utf-8")
