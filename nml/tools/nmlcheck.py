"""nmlcheck FILE: prints which process writes and reads which buffer, and every contradiction in an NML file.

Exit code 0: none; 1: contradictions; 2: the file cannot be read.
"""

from __future__ import annotations

import argparse
import sys

from nml.check import contradictions, topology
from nml.config import NmlConfig
from nml.errors import ConfigError


def main(argv: list[str] | None = None) -> int:
    """Check one file."""
    parser = argparse.ArgumentParser(prog="nmlcheck", description="Show what is in an NML file, and what is wrong.")
    parser.add_argument("file", nargs="?", help="NML file; without it the one of this environment")
    parser.add_argument("-q", "--quiet", action="store_true", help="print contradictions only")
    arguments = parser.parse_args(argv)
    try:
        config = NmlConfig(arguments.file) if arguments.file else NmlConfig.load()
    except ConfigError as error:
        print(error, file=sys.stderr)
        return 2
    if not arguments.quiet:
        print(f"{config.path} (writers -> readers, * master)")
        for line in topology(config):
            print(line)
    for remark in config.remarks:
        print(remark, file=sys.stderr)
    found = contradictions(config)
    for finding in found:
        print(finding, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
