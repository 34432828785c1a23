"""The Python plug-in: the user's functions for remapped codes, O-word subroutines and predefined parameters.

``[PYTHON]TOPLEVEL`` names a script that imports the modules remap, oword and namedparams; ``PATH_PREPEND`` and
``PATH_APPEND`` say where they are. The functions get LinuxCNC's interpreter object as ``self`` (``plugin_view``) and
import the modules ``interpreter`` and ``emccanon``, which exist only while there is a plug-in. A function returns
INTERP_OK, INTERP_ERROR, INTERP_EXECUTE_FINISH or an error text, or yields them.
"""

from __future__ import annotations

import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from types import ModuleType
from typing import Any

from nml.errors import ConfigError, InterpError
from rs274ngc import plugin_canon, plugin_interpreter, settings
from rs274ngc.plugin_interpreter import INTERP_ERROR, INTERP_EXECUTE_FINISH, INTERP_EXIT, INTERP_OK
from rs274ngc.remap import Remap

MODULES = ("remap", "oword", "namedparams")


class Plugin:
    """One interpreter's Python functions."""

    def __init__(self, interp: Any, ini: Any) -> None:
        """Run the toplevel script; ConfigError where it cannot be."""
        from rs274ngc.plugin_view import InterpView

        self.interp = interp
        base = settings.folder_of(ini)
        toplevel = settings.expanded(base, ini.find("PYTHON", "TOPLEVEL"))
        prepend = [settings.expanded(base, path) for path in reversed(ini.findall("PYTHON", "PATH_PREPEND"))]
        append = [settings.expanded(base, path) for path in ini.findall("PYTHON", "PATH_APPEND")]
        sys.path[:0] = [path for path in prepend if path not in sys.path]
        sys.path += [path for path in append if path not in sys.path]
        self.view = InterpView(interp)
        sys.modules["interpreter"] = plugin_interpreter.module(self.view)
        sys.modules["emccanon"] = plugin_canon.module()
        self.error_message = ""
        self.toplevel = toplevel
        self.namespace: dict[str, Any] = {"__name__": "toplevel", "__file__": toplevel}
        self._forget(os.path.dirname(toplevel), *prepend, *append)
        with plugin_canon.using(interp.canon):
            self._run_toplevel(toplevel)
        self._check(interp.state.remaps.values())
        self.named: dict[str, Callable[..., Any]] = {
            name: function
            for name, function in vars(self.namespace.get("namedparams", ModuleType("none"))).items()
            if name.startswith("_") and inspect.isfunction(function)
        }

    @staticmethod
    def _forget(*folders: str) -> None:
        """Drop what another configuration imported under the same names."""
        for name in MODULES:
            file = getattr(sys.modules.get(name), "__file__", None)
            if file is not None and os.path.dirname(os.path.abspath(file)) not in map(os.path.abspath, folders):
                del sys.modules[name]

    def _run_toplevel(self, path: str) -> None:
        try:
            with open(path, encoding="utf-8") as file:
                exec(compile(file.read(), path, "exec"), self.namespace)
            begin = self.namespace.get("__init__")
            if callable(begin):
                begin(self.view)
        except OSError as error:
            raise ConfigError(f"[PYTHON]TOPLEVEL={path}: {error.strerror}") from error
        except Exception as error:
            raise ConfigError(f"[PYTHON]TOPLEVEL={path}: {told(error)}") from error

    def _check(self, remaps: Iterable[Remap]) -> None:
        """ConfigError where a remapped code names a function that is not there."""
        for remap in remaps:
            for function in (remap.python, remap.prolog, remap.epilog):
                if function is not None and not self.has("remap", function):
                    raise ConfigError(f"REMAP={remap.name}: '{function}' is no function of the Python module remap")

    def close(self) -> None:
        """The interpreter ends: call the toplevel script's ``__delete__``."""
        end = self.namespace.get("__delete__")
        if callable(end):
            plugin_canon.write_out(self.interp.canon)
            with plugin_canon.using(self.interp.canon):
                end(self.view)

    def has(self, module: str, name: str) -> bool:
        """Is there such a function?"""
        return callable(getattr(self.namespace.get(module), name, None))

    def run_statement(self, text: str) -> None:
        """``;py,STATEMENT``, in the toplevel script's namespace."""
        self._run(f"py_execute({text})", text, "<string>")

    def run_file(self, path: str) -> None:
        """``(pyrun,FILE)``: the same for a file, relative to the INI file's folder; nothing where it is not there."""
        path = os.path.join(os.path.dirname(self.toplevel), path)
        if os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                self._run(f"pyrun({path})", file.read(), path)

    def reload(self) -> None:
        """``(pyreload)``: run the toplevel script again."""
        with plugin_canon.using(self.interp.canon):
            self._run_toplevel(self.toplevel)

    def _run(self, what: str, text: str, path: str) -> None:
        with plugin_canon.using(self.interp.canon):
            plugin_canon.write_out(self.interp.canon)
            try:
                exec(compile(text, path, "exec"), self.namespace)
            except Exception as error:
                raise InterpError(f"{what}: {told(error)}") from error
            finally:
                plugin_canon.write_out(self.interp.canon)

    def steps(self, module: str, name: str, arguments: Any, words: dict[str, float]) -> Iterator[int]:
        """Call a function; yields INTERP_EXECUTE_FINISH where it wants the machine to come to rest."""
        if not self.has(module, name):
            raise InterpError(f"Python plug-in: there is no function {module}.{name}")
        self.error_message = ""
        function = getattr(self.namespace[module], name)
        with plugin_canon.using(self.interp.canon):
            result = self._guarded(module, name, lambda: function(self.view, *arguments, **words))
        if not inspect.isgenerator(result):
            if self._judge(module, name, result):
                yield INTERP_EXECUTE_FINISH
            return
        while True:
            with plugin_canon.using(self.interp.canon):
                value = self._guarded(module, name, lambda: next(result, None))
            if value is None or not self._judge(module, name, value):
                return
            yield INTERP_EXECUTE_FINISH

    def parameter(self, name: str) -> float:
        """Value of a predefined parameter that the user's Python defines."""
        with plugin_canon.using(self.interp.canon):
            value = self._guarded("namedparams", name, lambda: self.named[name](self.view))
        if isinstance(value, str):
            raise InterpError(value)
        if not isinstance(value, (int, float)):
            raise InterpError(f"Python parameter #<{name}>: {type(value).__name__} is no number")
        return float(value)

    def _guarded(self, module: str, name: str, call: Callable[[], Any]) -> Any:
        plugin_canon.write_out(self.interp.canon)
        try:
            return call()
        except Exception as error:
            raise InterpError(f"Python exception in {module}.{name}: {told(error)}") from error
        finally:
            plugin_canon.write_out(self.interp.canon)

    def _judge(self, module: str, name: str, value: Any) -> bool:
        """True: the machine is to come to rest, and the function goes on. An O-word's number is its return value."""
        if isinstance(value, str):
            raise InterpError(value)
        if module == "oword" and isinstance(value, (int, float)) and not isinstance(value, plugin_interpreter.Result):
            state = self.interp.state
            state.return_value, state.value_returned = float(value), True
            return False
        if value == INTERP_ERROR:
            raise InterpError(self.error_message or f"Python function {module}.{name} failed")
        if value in (None, INTERP_OK, INTERP_EXIT):
            return False
        if value == INTERP_EXECUTE_FINISH:
            return True
        raise InterpError(f"Python function {module}.{name} returned {value!r}")


def told(error: Exception) -> str:
    """An exception in one line: what, and where in the user's file."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({os.path.basename(frames[-1].filename)}:{frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {error}{where}"


def plugin_of(interp: Any, ini: Any) -> Plugin | None:
    """The plug-in that an INI file asks for."""
    return Plugin(interp, ini) if ini.find("PYTHON", "TOPLEVEL") else None
