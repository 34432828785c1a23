"""``loadrt threads``: realtime threads without motion control. Talks to the host only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nml.errors import HalError

if TYPE_CHECKING:
    from hal.realtime import Host

DEFAULT_NAMES = ("thread1", "thread2", "thread3")
SHORTEST_NS = 1000
ALLOWED = {f"{key}{n}" for key in ("name", "period", "fp") for n in (1, 2, 3)}


def load(host: Host, args: dict[str, str]) -> None:
    """Realtime threads: `name1=`, `period1=` (ns), `fp1=`; up to three, fastest first; one of 1 ms by default."""
    unknown = sorted(set(args) - ALLOWED)
    if unknown:
        raise HalError(f"threads: unknown parameter '{unknown[0]}'; name1-3, period1-3 and fp1-3 are known")
    comp = host.component("threads")
    for n, default_name in enumerate(DEFAULT_NAMES, 1):
        default_period = 1_000_000 if n == 1 else 0
        period = _integer(args, f"period{n}", default_period)
        if period and period < SHORTEST_NS:
            raise HalError(f"threads: period{n}={period}: from {SHORTEST_NS} (ns) would be right, or 0 for no thread")
        if period:
            host.thread(args.get(f"name{n}", default_name), period, bool(_integer(args, f"fp{n}", 1)))
    comp.ready()


def _integer(args: dict[str, str], key: str, default: int) -> int:
    text = args.get(key)
    if text is None:
        return default
    try:
        return int(text, 0)
    except ValueError:
        raise HalError(f"threads: {key}={text}: a whole number would be right") from None
