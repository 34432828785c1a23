"""The import rules of docs/architecture.md: which package may import which, in Python and in Cython."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = {"nml", "hal", "rs274ngc", "rs274", "emcmot", "emctask", "emcio", "linuxcnc", "gui"}
GATEWAY = {"nml.channel", "nml.codecs.packed", "nml.emc", "nml.message"}  # what gui/web/gateway.py is a door to
ALLOWED = {
    "nml": set(),
    "hal": {"nml"},
    "rs274ngc": {"nml.errors", "nml.inifile"},
    "rs274": {"gcode", "rs274ngc"},
    "emcmot": {"nml", "hal", "rs274ngc"},
    "emctask": {"nml", "hal", "rs274ngc"},
    "emcio": {"nml", "hal"},
    "linuxcnc": {"nml", "hal"},
    "gui": {"linuxcnc", "hal", "nml.clock", "nml.namespace", "nml.errors", "nml.inifile", *GATEWAY},
}
# Libraries that know no bus: the planner and the kinematics
BUSLESS = {"emcmot/tp": {"nml.errors", "emcmot", "cython"}}

_CIMPORT = re.compile(r"^\s*(?:from\s+([\w.]+)\s+c?import\b|c?import\s+([\w.]+))", re.MULTILINE)


def python_imports(path: Path) -> set[str]:
    """Full names of the modules that a Python file imports, wherever in the file."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(), str(path))):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            found |= {f"{node.module}.{name.name}" for name in node.names}
    return found


def cython_imports(path: Path) -> set[str]:
    """Full names of the modules that a Cython file imports or cimports."""
    text = re.sub(r'"""(?:.|\n)*?"""|#.*', "", path.read_text())
    return {first or second for first, second in _CIMPORT.findall(text)}


def imports(path: Path) -> set[str]:
    return python_imports(path) if path.suffix in (".py", ".pyi") else cython_imports(path)


def allowed(name: str, rule: set[str]) -> bool:
    return any(name == one or name.startswith(f"{one}.") for one in rule)


def sources(folder: str) -> list[Path]:
    return sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in (".py", ".pyi", ".pyx", ".pxd"))


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_a_package_imports_only_what_the_architecture_allows(package):
    wrong = [
        f"{path.relative_to(ROOT)} imports {name}"
        for path in sources(package)
        for name in sorted(imports(path))
        if name.split(".")[0] in PACKAGES - {package} and not allowed(name, ALLOWED[package])
    ]
    assert not wrong


@pytest.mark.parametrize("folder", sorted(BUSLESS))
def test_a_library_of_motion_knows_no_bus(folder):
    wrong = [
        f"{path.relative_to(ROOT)} imports {name}"
        for path in sources(folder)
        for name in sorted(imports(path))
        if name.split(".")[0] in PACKAGES and not allowed(name, BUSLESS[folder])
    ]
    assert not wrong


def test_every_package_has_a_rule():
    folders = {path.parent.name for path in ROOT.glob("*/__init__.py")}
    assert set(ALLOWED) == PACKAGES == folders - {"tests", "benchmarks"}


@pytest.mark.parametrize(
    ("text", "name"),
    [("from nml._shm cimport queue_pop\n", "nml._shm"), ("cimport hal.cell\n", "hal.cell"), ("import nml\n", "nml")],
)
def test_cython_imports_are_seen(tmp_path, text, name):
    path = tmp_path / "x.pyx"
    path.write_text(text)
    assert cython_imports(path) == {name}
