"""Our `import linuxcnc` beside Debian's: names, numbers of constants, fields of a tool."""

import json
import subprocess
from pathlib import Path

import pytest

import linuxcnc

PYTHON = Path("/usr/bin/python3")
MODULE = Path("/usr/lib/python3/dist-packages")

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not list(MODULE.glob("linuxcnc*.so")), reason="Debian's linuxcnc-uspace is not installed"),
]

SCRIPT = """
import json, linuxcnc
names = [n for n in dir(linuxcnc) if not n.startswith("_")]
print(json.dumps({
    "names": names,
    "constants": {n: getattr(linuxcnc, n) for n in names if isinstance(getattr(linuxcnc, n), int)},
    "members": {c: [n for n in dir(getattr(linuxcnc, c)) if not n.startswith("_")]
                for c in ("stat", "command", "error_channel", "ini")},
    "tool": [n for n in dir(linuxcnc.tool) if not n.startswith(("_", "n_"))],
}))
"""


@pytest.fixture(scope="module")
def theirs():
    result = subprocess.run([PYTHON, "-c", SCRIPT], cwd="/", env={}, check=True, capture_output=True, text=True)
    return json.loads(result.stdout)


def test_every_constant_has_the_same_number(theirs):
    assert {name: getattr(linuxcnc, name, None) for name in theirs["constants"]} == theirs["constants"]


def test_every_public_name_is_there(theirs):
    assert set(theirs["names"]) <= set(dir(linuxcnc))


@pytest.mark.parametrize("kind", ["stat", "command", "error_channel", "ini"])
def test_every_attribute_and_method_is_there(theirs, kind):
    assert set(theirs["members"][kind]) <= set(dir(getattr(linuxcnc, kind)))


def test_a_tool_has_the_same_fields(theirs):
    assert set(theirs["tool"]) == {name for name in dir(linuxcnc.tool) if not name.startswith("_")}
