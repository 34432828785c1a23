"""A clock that is set while a machine runs changes nothing: whoever waits or measures uses the monotonic clock."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
CONTROLLER = ("nml", "hal", "rs274ngc", "emcmot", "emctask", "emcio", "linuxcnc")
WALL_CLOCK = re.compile(r"\btime\.time\(|\btime_ns\(|CLOCK_REALTIME|gettimeofday|datetime\.now|\btime\(NULL\)")

STAMPS = {
    "nml/net/diagnostics.py": "times on the wire, as LinuxCNC's",
    "nml/emc/orders.py": "when an order was given, for the log",
    "hal/_mapping.pyx": "the timeout of a lock that another process holds",
}
"""Who may know the time of day, and what for."""


def test_only_time_stamps_come_from_the_wall_clock():
    readers = {
        str(path.relative_to(ROOT))
        for package in CONTROLLER
        for path in (ROOT / package).rglob("*")
        if path.suffix in (".py", ".pyx", ".pxd") and WALL_CLOCK.search(path.read_text())
    }
    assert readers <= STAMPS.keys()
