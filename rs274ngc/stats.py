"""What a program does, in figures: extents, distances by kind, tools, time. ``rs274 --stats`` and ``--json``."""

from __future__ import annotations

from typing import Any

import numpy as np

from rs274ngc.canon import AXES
from rs274ngc.geometry import ARC, FEED, PROBE, RAPID
from rs274ngc.preview import Preview

KIND_NAMES = {RAPID: "rapid", FEED: "feed", ARC: "arc", PROBE: "probe"}


def figures(result: Preview, rapid: float = 10000.0) -> dict[str, Any]:
    """The figures: mm, seconds. Time is path over feed, without acceleration; ``rapid``: mm a minute."""
    table = result.rows
    ends, kinds = table["end"], table["kind"]
    starts = np.vstack([np.zeros((1, 9)), ends[:-1]]) if len(ends) else ends
    lengths = np.linalg.norm(ends[:, :3] - starts[:, :3], axis=1)
    feeds = np.where(kinds == RAPID, rapid, table["feed"])
    seconds = np.divide(lengths * 60.0, feeds, out=np.zeros_like(lengths), where=feeds > 0.0)
    return {
        "moves": len(ends),
        "extents_mm": {
            axis: [float(ends[:, k].min()), float(ends[:, k].max())]
            for k, axis in enumerate(AXES)
            if len(ends) and np.ptp(ends[:, k]) > 0.0
        },
        "distance_mm": {name: float(lengths[kinds == kind].sum()) for kind, name in KIND_NAMES.items()},
        "time_s": float(seconds.sum() + result.dwell_s),
        "tools": result.tools,
    }


def text(values: dict[str, Any]) -> str:
    """The figures for people."""
    rows = [f"moves     {values['moves']}"]
    rows += [f"{axis}         {low:.3f} to {high:.3f}" for axis, (low, high) in values["extents_mm"].items()]
    rows += [f"{name:9s} {distance:.3f} mm" for name, distance in values["distance_mm"].items()]
    rows += [f"tools     {' '.join(map(str, values['tools'])) or 'none'}", f"time      {values['time_s']:.1f} s"]
    return "\n".join(rows)
