"""The reference of codes and predefined parameters, made from the interpreter's own tables.

``python -m rs274ngc.reference > docs/gcode.md`` writes it; a test keeps the file true.
"""

from __future__ import annotations

from rs274ngc.codes import TABLE, UNUSED
from rs274ngc.predefined import ROWS

G_GROUPS = {
    0: "Group 0: for one line",
    1: "Group 1: motion",
    2: "Group 2: plane",
    3: "Group 3: distance",
    4: "Group 4: arc centres",
    5: "Group 5: feed mode",
    6: "Group 6: units",
    7: "Group 7: cutter compensation",
    8: "Group 8: tool length",
    10: "Group 10: retract mode of cycles",
    11: "Group 11: G92 cancelled and used again",
    12: "Group 12: coordinate system",
    13: "Group 13: path control",
    14: "Group 14: spindle mode",
    15: "Group 15: lathe diameter mode",
}
M_GROUPS = {
    4: "Stops", 5: "Inputs and outputs", 6: "Tools", 7: "Spindles and saved modes", 8: "Coolant", 9: "Overrides",
    10: "The user's",
}  # fmt: skip


def table(kind: str, groups: dict[int, str]) -> list[str]:
    """The codes of one letter, by group."""
    lines = []
    for group, title in groups.items():
        lines += [f"### {title}", "", "| code | words | what it does |", "|---|---|---|"]
        lines += [
            f"| {code} | {' '.join(words)} | {summary} |"
            for code, of, words, summary in TABLE
            if code.startswith(kind) and of == group
        ]
        lines.append("")
    return lines


def reference() -> str:
    """The whole page."""
    lines = [
        "# G-code reference",
        "",
        "Made by `python -m rs274ngc.reference` from the interpreter's tables. Words: the letters that a code uses",
        "besides axis words, F, S and T; any other word on its line is an error (below).",
        "",
        "## G codes",
        "",
        *table("G", G_GROUPS),
        "## M codes",
        "",
        *table("M", M_GROUPS),
        "M98 P L calls a subprogram that ends with M99.",
        "",
        "## Words that nothing uses",
        "",
        *(f"* {message}" for _, message in UNUSED),
        "",
        "## Predefined parameters",
        "",
        "| name | value |",
        "|---|---|",
        *(f"| `#<{name}>` | {meaning} |" for name, meaning, _ in ROWS),
        "| `#5021` to `#5029` | X to W of the position without offsets |",
        "| `#5081` to `#5089` | X to W of the tool offset in force; `#5401` to `#5409` are the loaded tool's |",
        "| `#<_ini[SECTION]KEY>` | number of the INI file |",
        "| `#<_hal[pin]>` | value of a HAL pin, signal or parameter |",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(reference(), end="")
