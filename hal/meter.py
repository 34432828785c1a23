"""``halmeter``: the value of a pin, signal or parameter on the terminal, as it changes."""

from __future__ import annotations

import argparse
import sys

from hal.core import Hal
from hal.values import plain_value
from nml import clock
from nml.errors import PyemcError


def value_text(hal: Hal, kind: str, name: str) -> str:
    """The value as ``getp`` or ``gets`` prints it."""
    item = hal.signal(name) if kind in ("sig", "signal") else hal.item(name)[1]
    return plain_value(item.type, item.get())


def main(argv: list[str] | None = None) -> int:
    """halmeter [pin|sig|param] NAME"""
    parser = argparse.ArgumentParser(prog="halmeter", description="Show a value as it changes; Ctrl-C ends.")
    parser.add_argument("kind", nargs="?", choices=["pin", "sig", "signal", "param", "parameter"], default="pin")
    parser.add_argument("name")
    parser.add_argument("-n", type=int, default=0, metavar="COUNT", help="end after COUNT changes")
    parser.add_argument("--interval", type=float, default=0.1, metavar="S", help="s between two looks")
    options = parser.parse_args(argv)
    hal = Hal()
    shown, changes = "", 0
    try:
        while options.n == 0 or changes < options.n:
            text = value_text(hal, options.kind, options.name)
            if text != shown:
                shown, changes = text, changes + 1
                if sys.stdout.isatty():
                    print(f"\r\033[K{options.name} = {text}", end="", flush=True)
                else:
                    print(text, flush=True)
            if options.n == 0 or changes < options.n:
                clock.host_sleep(options.interval)
    except PyemcError as error:
        print(f"halmeter: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print()
    finally:
        hal.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
