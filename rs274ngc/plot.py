"""``rs274 --plot``: a program's tool path as a picture (``.png``) or as a page to turn and zoom (``.html``).

The page needs nothing but a browser: moves and script are in it.
"""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np

from nml.errors import ConfigError
from rs274ngc import stats
from rs274ngc.geometry import RAPID
from rs274ngc.preview import Preview

COLOURS = {"rapid": "#9aa3ad", "feed": "#1f77b4", "arc": "#2ca02c", "probe": "#d62728"}
SUFFIXES = (".png", ".html")
PAGE = Path(__file__).with_name("plot.html")


def save(result: Preview, path: str, title: str) -> None:
    """Write the plot; ConfigError for a kind of file that it cannot be."""
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise ConfigError(f"--plot {path}: the name must end in {' or '.join(SUFFIXES)}")
    if suffix == ".png":
        picture(result, path, title)
    else:
        page(result, path, title)


def segments(rows: Any) -> Any:
    """Start and end of each move, (n, 2, 3), mm; the first move begins where it ends."""
    ends = rows["end"][:, :3]
    starts = np.vstack([ends[:1], ends[:-1]]) if len(ends) else ends
    return np.stack([starts, ends], axis=1)


def picture(result: Preview, path: str, title: str) -> None:
    """A PNG: the path in three dimensions."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]
    except ImportError as error:
        raise ConfigError("--plot to a .png needs matplotlib: pip install pyemc[plot]; .html needs nothing") from error
    lines, kinds = segments(result.rows), result.rows["kind"]
    figure = Figure(figsize=(10, 8))
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(projection="3d")
    for kind, name in stats.KIND_NAMES.items():
        chosen = lines[kinds == kind]
        if len(chosen):
            style = "dashed" if kind == RAPID else "solid"
            axes.add_collection3d(
                Line3DCollection(chosen, colors=COLOURS[name], linewidths=0.8, linestyles=style, label=name)
            )
    if len(lines):
        low, high = lines.min(axis=(0, 1)), lines.max(axis=(0, 1))
        middle, half = (low + high) / 2.0, max(float((high - low).max()) / 2.0, 1e-3)
        axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
        axes.set(zlim=(middle[2] - half, middle[2] + half))
        axes.legend(loc="upper right")
    axes.set(xlabel="X mm", ylabel="Y mm", zlabel="Z mm", title=title)
    figure.savefig(path, dpi=120)


def page(result: Preview, path: str, title: str) -> None:
    """A self-contained HTML page: drag turns, wheel zooms, a click names the line."""
    rows = result.rows
    data = {
        "title": title,
        "points": base64.b64encode(segments(rows).astype("<f4").tobytes()).decode(),
        "kinds": base64.b64encode(rows["kind"].astype("u1").tobytes()).decode(),
        "lines": base64.b64encode(rows["line"].astype("<i4").tobytes()).decode(),
        "names": list(COLOURS),
        "colours": list(COLOURS.values()),
        "figures": stats.text(stats.figures(result)),
    }
    values = json.dumps(data).replace("</", "<\\/")
    Path(path).write_text(PAGE.read_text(encoding="utf-8").replace("/*DATA*/null", values), encoding="utf-8")
