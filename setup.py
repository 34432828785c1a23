"""Build the native core: every ``.pyx`` file of the packages becomes an extension module beside it.

``PYEMC_BUILD_ONLY=nml,hal`` limits the build to some packages (``nothing``: the modules are built already);
``PYEMC_DEBUG=1`` builds with bounds checks.
"""

import importlib
import os
import sys
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup

ROOT = Path(__file__).parent
PACKAGES = ("nml", "hal", "rs274ngc", "emcmot", "linuxcnc")
DEBUG = os.environ.get("PYEMC_DEBUG") == "1"
DIRECTIVES = {
    "language_level": "3",
    "boundscheck": DEBUG,
    "wraparound": False,
    "initializedcheck": DEBUG,
    "cdivision": True,
    "embedsignature": True,
}
COMPILE_ARGS = ["-O2", "-ffp-contract=off", "-fno-math-errno", "-Wno-unused-function", "-g" if DEBUG else "-g0"]


def wanted_packages() -> tuple[str, ...]:
    """The packages to build: all, or those that ``PYEMC_BUILD_ONLY`` names."""
    only = os.environ.get("PYEMC_BUILD_ONLY")
    return tuple(only.split(",")) if only else PACKAGES


def extensions() -> list[Extension]:
    """One extension for each ``.pyx`` below the packages that are to be built."""
    found = []
    for package in wanted_packages():
        for path in sorted((ROOT / package).rglob("*.pyx")):
            relative = path.relative_to(ROOT)
            found.append(
                Extension(
                    ".".join(relative.with_suffix("").parts),
                    [str(relative)],
                    extra_compile_args=COMPILE_ARGS,
                    libraries=["pthread", "rt", "m"],
                )
            )
    return found


def write_message_structs() -> None:
    """Make emcmot/_messages.pxd from nml/emc/emcmot.py, with the pure Python part of nml in this source tree."""
    sys.path.insert(0, str(ROOT))
    try:
        cheader = importlib.import_module("nml.cheader")
        cheader.write_pxd(importlib.import_module("nml.emc.emcmot"), ROOT / "emcmot" / "_messages.pxd")
    finally:
        sys.path.remove(str(ROOT))


if "emcmot" in wanted_packages():
    write_message_structs()

setup(
    ext_modules=cythonize(
        extensions(),
        compiler_directives=DIRECTIVES,
        nthreads=int(os.environ.get("PYEMC_BUILD_JOBS", "2")),
        show_all_warnings=False,
    )
)
