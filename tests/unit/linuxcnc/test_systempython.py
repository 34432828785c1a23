"""How the system's Python is led to our packages."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import metadata

import pytest

from linuxcnc import systempython
from linuxcnc.instance import Instance
from nml import LIBRARIES, namespace


def test_our_packages_come_first_and_what_they_import_last():
    found = systempython.environment()
    assert found["PYTHONPATH"].split(os.pathsep)[0] == str(systempython.PACKAGES)
    assert found.get(LIBRARIES, str(systempython.OTHERS)) == str(systempython.OTHERS)


def test_the_folder_of_other_packages_is_appended_once(tmp_path):
    script = "import sys, nml, nml.errors; print(sys.path.count(sys.argv[1]), sys.path[-1] == sys.argv[1])"
    variables = os.environ | {LIBRARIES: str(tmp_path), "PYTHONPATH": str(systempython.PACKAGES)}
    command = [sys.executable, "-c", script, str(tmp_path)]
    assert subprocess.run(command, env=variables, capture_output=True, text=True).stdout.split() == ["1", "True"]


def test_packages_installed_among_others_are_linked_until_the_machine_ends(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(systempython, "OTHERS", systempython.PACKAGES)
    names = ("hal/module.py", "gcode.py", "pyemc-1.dist-info/RECORD", "../../../bin/halcmd")
    monkeypatch.setattr(metadata, "files", lambda name: [metadata.PackagePath(path) for path in names])
    instance = Instance()
    for _ in range(2):
        folder = systempython.environment()["PYTHONPATH"].split(os.pathsep)[0]
    assert folder == str(namespace.runtime_dir() / "python")
    assert sorted(os.listdir(folder)) == ["gcode.py", "hal"]
    instance.release()
    assert not os.path.exists(folder)
