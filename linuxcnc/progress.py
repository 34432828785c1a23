"""Shows on the terminal how far a program is: a bar where there is one, a line now and then where there is not."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from nml import clock

if TYPE_CHECKING:
    from linuxcnc.program import Display, Progress

LINE_INTERVAL = 5.0  # host seconds between lines where there is no terminal


def duration(seconds: float) -> str:
    """``1:02:03`` or ``2:03.4``: hours only where there are some."""
    minutes, rest = divmod(seconds, 60.0)
    hours, minutes = divmod(int(minutes), 60)
    return f"{hours}:{minutes:02}:{int(rest):02}" if hours else f"{minutes}:{rest:04.1f}"


def position(progress: Progress) -> str:
    """``X1.000 Y2.000 Z0.000``, the axes that the machine has."""
    return " ".join(f"{axis}{progress.position['XYZABCUVW'.index(axis)]:.3f}" for axis in progress.axes)


def description(progress: Progress) -> str:
    """One line with all that the bar shows."""
    remaining = progress.remaining
    return (
        f"line {progress.line}/{progress.lines} {progress.fraction:4.0%}  {position(progress)}  "
        f"elapsed {duration(progress.elapsed)}  remaining {'-' if remaining is None else duration(remaining)}"
    )


class PlainDisplay:
    """A line every few seconds."""

    def __init__(self) -> None:
        self._next = clock.host_now() + LINE_INTERVAL

    def show(self, progress: Progress) -> None:
        if clock.host_now() >= self._next:
            self._next = clock.host_now() + LINE_INTERVAL
            self.say(description(progress))

    def say(self, line: str) -> None:
        print(line, file=sys.stderr, flush=True)


@contextmanager
def make_display(title: str) -> Iterator[Display]:
    """The display that fits standard error."""
    if not sys.stderr.isatty():
        yield PlainDisplay()
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("{task.fields[title]}"), BarColumn(bar_width=16), TextColumn("{task.description}"))
    # Without rich's refresh thread: the launcher may have to fork a new guard
    with Bar(*columns, console=Console(stderr=True), auto_refresh=False) as bar:
        task = bar.add_task("", total=1.0, title=title)

        class BarDisplay:
            def show(self, progress: Progress) -> None:
                bar.update(task, completed=progress.fraction, description=description(progress))
                bar.refresh()

            def say(self, line: str) -> None:
                bar.console.print(line, markup=False, highlight=False)

        yield BarDisplay()
