"""``mb2hal config=FILE``: reads and writes Modbus devices again and again, as the INI file says; a user component.

    loadusr -W mb2hal config=mb2hal.ini

It runs until SIGTERM or SIGINT. docs/hal.md has the keys of the file.
"""

from __future__ import annotations

import signal
import sys

import hal
from hal.modbus import config
from hal.modbus.bridge import Job, Loop, make_pins
from hal.modbus.links import SerialPlace, TcpPlace, make_link
from hal.modbus.trace import Trace
from nml.errors import PyemcError
from nml.inifile import IniFile

ENDS = {signal.SIGTERM, signal.SIGINT}
Places = list[TcpPlace | SerialPlace]


def main(arguments: list[str] | None = None) -> int:
    """Run until a signal comes; the exit code."""
    given = sys.argv[1:] if arguments is None else arguments
    if len(given) != 1 or not given[0].startswith("config="):
        print("usage: mb2hal config=FILE", file=sys.stderr)
        return 1
    trace = Trace()
    signal.pthread_sigmask(signal.SIG_BLOCK, ENDS)  # until all is told and the threads run
    try:
        settings = config.read(IniFile(given[0].partition("=")[2]), trace)
        trace.ok("main", "parse_ini_file done OK")
        _work(settings, trace)
    except PyemcError as error:
        print(f"mb2hal: {error}", file=sys.stderr)
        return 1
    return 0


def _work(settings: config.Config, trace: Trace) -> None:
    places: Places = list(dict.fromkeys(t.place for t in settings.transactions))
    _tell_links(settings, places, trace)
    component = hal.component(settings.module)
    loops: list[Loop] = []
    try:
        jobs = make_pins(component, settings, trace)
        component.ready()
        trace.ok("main", "HAL components created OK")
        loops = [_loop(place, jobs, settings) for place in places]
        for number, loop in enumerate(loops):
            loop.start()
            trace.ok("main", f"Link thread loop and logic {number} created OK")
        trace.ok("main", "mb2hal is running")
        trace.detail("quit_signal", f"signal [{signal.sigwait(ENDS):d}] received")
    finally:
        trace.detail("quit_cleanup", "started")
        for loop in loops:
            loop.stop()
        trace.detail("quit_cleanup", f"unloading HAL module [{component.id}] ret[0]")
        component.exit()
        trace.detail("quit_cleanup", "done OK")
    trace.ok("main", "going to exit!")


def _loop(place: TcpPlace | SerialPlace, jobs: list[Job], settings: config.Config) -> Loop:
    own = [job for job in jobs if job.transaction.place == place]
    return Loop(make_link(place), own, settings.slowdown_s)


def _tell_links(settings: config.Config, places: Places, trace: Trace) -> None:
    for number, place in enumerate(places):
        if isinstance(place, TcpPlace):
            text = f"(TCP) link_type[1] IP[{place.address}] port[{place.port}] fd[-1]"
        else:
            text = f"(RTU) link_type[0] device[{place.device}] baud[{place.baud}] data[{place.bits}] "
            text += f"parity[{place.parity}] stop[{place.stop}] fd[-1]"
        trace.detail("init_mb_links", f"LINK {number} {text}")
    trace.ok("main", "init_gbl.mb_link done OK")
    for t in settings.transactions:
        pause = 1 / t.rate if t.rate else 0.0
        link = places.index(t.place)
        text = f"lk_n[{link}] tx_n[{t.number}] cfg_dbg[{t.debug}] lk_dbg[0] t_inc[{pause:.3f}] nxt_t[0.000]"
        trace.detail("init_mb_tx", f"MB_TX {t.number} {text}")
    trace.ok("main", "init_gbl.mb_tx done OK")


if __name__ == "__main__":
    sys.exit(main())
