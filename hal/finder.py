"""Find what a HAL file names: realtime modules, and programs for ``loadusr``.

In an installed package both are entry points; in a checkout that is not installed the same tables are read from its
``pyproject.toml``. Our own programs go before others of the same name on the PATH, such as those of a LinuxCNC package.
"""

from __future__ import annotations

import importlib
import os
import sys
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from nml.errors import HalError

GROUP = "pyemc.realtime"
MODULES_VARIABLE = "PYEMC_MODULES"  # a folder of components in C, instead of the one in which they are installed
NATIVE_MARK = b"hal_host_table"  # what every component in C has (hal/include), and no Python module
_CHECKOUT = Path(__file__).resolve().parent.parent


@cache
def _project() -> dict[str, Any]:
    """The ``project`` table of the checkout that we run from; empty where we are installed."""
    import tomllib

    try:
        with open(_CHECKOUT / "pyproject.toml", "rb") as file:
            return tomllib.load(file)["project"]
    except (FileNotFoundError, KeyError):
        return {}


def _entry_points(group: str) -> dict[str, str]:
    from importlib.metadata import entry_points

    return {point.name: point.value for point in entry_points(group=group)}


def realtime_modules() -> dict[str, str]:
    """Names of realtime modules outside of ``hal`` and where they are."""
    return {**_entry_points(GROUP), **_project().get("entry-points", {}).get(GROUP, {})}


def is_file(name: str) -> bool:
    """Does ``loadrt name`` mean a file of Python source, or of an extension module that was built from it?"""
    return name.endswith((".py", ".so"))


def name_of(name: str) -> str:
    """The name of the module that ``loadrt name`` means: that of a file without its endings."""
    return Path(name).name.partition(".")[0] if is_file(name) else name


def modules_folder() -> Path:
    """Where ``halcompile --install`` puts realtime components in C."""
    return Path(os.environ.get(MODULES_VARIABLE) or Path(sys.prefix, "lib", "pyemc", "modules"))


def native_library(name: str) -> Path | None:
    """The shared library of a component in C: a file that is named, or an installed one."""
    path = Path(name) if is_file(name) else modules_folder() / f"{name}.so"
    return path if path.suffix == ".so" and path.is_file() and NATIVE_MARK in path.read_bytes() else None


def realtime_module(name: str) -> ModuleType:
    """The Python module that ``loadrt name`` loads, from the tables or a file; HalError for none."""
    if is_file(name):
        return _module_from_file(Path(name))
    target = _project().get("entry-points", {}).get(GROUP, {}).get(name) or _entry_points(GROUP).get(name)
    if target is None:
        from hal.components import names
        from hal.core import suggest

        raise HalError(f"there is no realtime module '{name}'{suggest(name, [*names(), *realtime_modules()])}", -2)
    try:
        return importlib.import_module(target)
    except ImportError as error:
        raise HalError(f"realtime module '{name}' ({target}) cannot be imported: {error}", -2) from error


def _module_from_file(path: Path) -> ModuleType:
    from importlib.util import module_from_spec, spec_from_file_location

    spec = spec_from_file_location(name_of(path.name), path)
    if not path.is_file() or spec is None or spec.loader is None:
        raise HalError(f"there is no component file '{path}'", -2)
    try:
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
    except SyntaxError as error:
        raise HalError(f"{path}:{error.lineno}: SyntaxError: {error.msg}") from None
    except ImportError as error:
        raise HalError(f"{path} cannot be loaded: {error}") from None
    if not hasattr(module, "load"):
        raise HalError(f"{path}: there is no function load(host, args) in it")
    return module


def program(name: str) -> list[str]:
    """The command line with which a program that ``loadusr`` names starts; HalError where there is none."""
    from shutil import which

    if os.sep in name:
        if Path(name).is_file() and not os.access(name, os.X_OK):
            raise HalError(f"program '{name}' is no executable file; 'chmod +x {name}' would make it one", -13)
        path: str | None = name if os.access(name, os.X_OK) else None
    else:
        beside = Path(sys.executable).parent / name
        if os.access(beside, os.X_OK):
            return [str(beside)]
        target = _project().get("scripts", {}).get(name)
        if target is not None:
            module, _, function = target.partition(":")
            return [sys.executable, "-c", f"import sys; from {module} import {function}; sys.exit({function}())"]
        path = which(name)
    if path is None:
        raise HalError(f"program '{name}' not found", -2)
    return [path]
