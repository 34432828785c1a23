"""The command ``linuxcnc`` from its first instant: Ctrl-C ends it while its launcher is still being read too."""

from __future__ import annotations

import sys

from nml import signals


def main() -> int:
    """Entry point; returns the exit code, which ``linuxcnc.launcher`` describes."""
    try:
        signals.catch()
        from linuxcnc import launcher

        signals.check()
        return launcher.main()
    except signals.Stopped as stopped:
        signals.ignore()
        print(f"linuxcnc: {stopped}", file=sys.stderr)
        return 128 + stopped.number


if __name__ == "__main__":
    sys.exit(main())
