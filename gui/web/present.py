"""How the machine stands now, as arguments of the processes that run programs without it: dry runs and the forecast.

Pure: the status map of ``gui.web.readout`` in, words of a command line out.
"""

from __future__ import annotations

from typing import Any

AXES = "XYZABCUVW"
ROTARY_AXES = (3, 4, 5)
MM_PER_INCH = 25.4
INCHES = 1  # stat.program_units
INVERSE_TIME = "G93"  # wants an F word in every line
CONTINUOUS = "G64"
CARRIED = frozenset(
    (
        "G7", "G8", "G17", "G18", "G19", "G17.1", "G18.1", "G19.1", "G20", "G21", "G54", "G55", "G56", "G57",
        "G58", "G59", "G59.1", "G59.2", "G59.3", "G61", "G61.1", CONTINUOUS, "G90", "G91", "G90.1", "G91.1",
        INVERSE_TIME, "G94", "G95", "G96", "G97", "G98", "G99",
    )
)  # fmt: skip
"""Modal codes that the next line finds in force."""
FEED_MOTION = "G1"
MOTION = frozenset(("G0", FEED_MOTION, "G80"))
BEFORE_ANY_FEED = (f"{FEED_MOTION} F1", "F0")
"""How the feed motion comes into force where there is no feed: the code alone would be an error."""


def modes(values: dict[str, Any]) -> list[str]:
    """Blocks that bring the modal state about: codes with tolerances, F and S; then the motion of lines without one."""
    codes = [code for code in values["gcode_text"] if code in CARRIED]
    _, feed, speed, path, naive = values["settings"][:5]
    words = list(codes)
    if CONTINUOUS in codes and path > 0.0:
        words += [f"P{path:.9g}", f"Q{naive:.9g}"]
    fed = feed > 0.0 and INVERSE_TIME not in codes
    if fed:
        words.append(f"F{feed:.9g}")
    if speed > 0.0:
        words.append(f"S{speed:.9g}")
    blocks = [" ".join(words), *(code for code in values["gcode_text"] if code in MOTION)]
    if not fed and FEED_MOTION in blocks:  # as a program's end leaves it
        blocks[blocks.index(FEED_MOTION) :] = BEFORE_ANY_FEED
    return blocks


def tool_offset(values: dict[str, Any], mm_per_unit: float) -> str:
    """A block that brings the tool offset about, whatever it came from; in program units."""
    inch = values["program_units"] == INCHES
    offset = [
        value * (1.0 if axis in ROTARY_AXES else mm_per_unit / (MM_PER_INCH if inch else 1.0))
        for axis, value in enumerate(values["tool_offset"])
    ]
    words = " ".join(f"{letter}{value:.6f}" for letter, value in zip(AXES, offset, strict=True) if value)
    return f"{'G20' if inch else 'G21'} G43.1 {words}"


def arguments(values: dict[str, Any], mm_per_unit: float) -> list[str]:
    """Place, tool, modal codes and tool offset; nothing before the first status."""
    if "position" not in values:
        return []
    blocks = modes(values)
    if any(values["tool_offset"]):
        blocks.insert(0, tool_offset(values, mm_per_unit))
    return [
        f"--start={','.join(f'{value:.9g}' for value in values['position'])}",
        f"--tool={values['tool_in_spindle']}",
        *(f"--begin={block}" for block in blocks if block),
        *(["--block-delete"] if values["block_delete"] else []),
    ]
