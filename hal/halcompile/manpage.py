"""The manual page of a .comp file, in troff as man(7) describes it."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import date

from hal.halcompile.language import Component, Item, to_hal

DIRECTIONS = {"HAL_IN": "in", "HAL_OUT": "out", "HAL_IO": "io", "HAL_RO": "r", "HAL_RW": "rw"}


def generate(made: Component) -> str:
    """The whole page."""
    return "\n".join(_lines(made)) + "\n"


def _lines(made: Component) -> Iterator[str]:
    section = "1" if made.option("userspace") else "9"
    first, _, rest = made.doc.partition("\n")
    yield f'.TH {made.name.upper()} "{section}" "{date.today().isoformat()}" "" "HAL component"'
    yield ".SH NAME"
    yield f"{made.name} \\- {first}" if first else made.name
    if rest.strip():
        yield rest
    yield ".SH SYNOPSIS"
    yield from _synopsis(made)
    if "description" in made.texts:
        yield f".SH DESCRIPTION\n{made.texts['description'].strip()}"
    if made.functions:
        yield ".SH FUNCTIONS"
    for function in made.functions:
        yield f".TP\n.B {_full(made, to_hal(function.name))}{'' if function.uses_fp else ' (no floating point)'}"
        yield function.doc or ".br"
    for title, is_pin in (("PINS", True), ("PARAMETERS", False)):
        items = [item for item in made.items if item.is_pin == is_pin]
        if items:
            yield f".SH {title}"
        for item in items:
            yield from _item(made, item)
    for word, title in (("examples", "EXAMPLES"), ("see_also", "SEE ALSO"), ("notes", "NOTES"), ("author", "AUTHOR")):
        if word in made.texts:
            yield f".SH {title}\n{made.texts[word].strip()}"
    yield f".SH LICENSE\n{made.texts['license']}"


def _synopsis(made: Component) -> Iterator[str]:
    words = [made.name]
    if made.option("singleton") or made.option("count_function"):
        pass
    else:
        words.append("[count=\\fIN\\fB|names=\\fIname1\\fB[,\\fIname2...\\fB]]")
    if made.has_personality:
        words.append("[personality=\\fIP1,P2,...\\fB]")
    yield f".B {'loadusr' if made.option('userspace') else 'loadrt'} {' '.join(words)}"


def _full(made: Component, hal_name: str) -> str:
    start = made.hal_name if made.option("singleton") else f"{made.hal_name}.\\fIN\\fB"
    return f"{start}.{hal_name}" if hal_name else start


def _item(made: Component, item: Item) -> Iterator[str]:
    name = item.name.replace("_", "-").rstrip("-.")
    marks = name.count("#")
    name = name.replace("#" * marks, f"\\fI{'M' * marks}\\fB") if marks else name
    text = f".TP\n.B {_full(made, name)} \\fR{item.type} {DIRECTIONS[item.direction]}"
    if item.size:
        text += f" ({'M' * marks}=0..{f'({item.how_many}) - 1' if item.how_many else item.size - 1})"
    if item.condition:
        text += f" [if {item.condition}]"
    if item.value:
        text += f" (default: {item.value})"
    yield text
    yield item.doc or ".br"
