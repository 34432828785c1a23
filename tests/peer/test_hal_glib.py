"""LinuxCNC's ``hal_glib``, on which GladeVCP, gmoccapy and QtVCP are built, over our ``hal``."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from linuxcnc.systempython import SYSTEM_PYTHON, environment, is_ours

SCRIPT = """
import _hal, hal, hal_glib
with hal.component("panel") as c:
    pin = hal_glib.GPin(c.newpin("speed", hal.HAL_FLOAT, hal.HAL_OUT))
    heard = []
    pin.connect("value-changed", lambda pin: heard.append(pin.get()))
    for value in (2.5, 2.5, 4.0):
        pin.value = value
        pin.update()
    lamp = hal_glib.GComponent(c).newpin("lamp", hal.HAL_BIT, hal.HAL_IN)
    print(heard, c["speed"], pin.get_name(), pin.type == hal.HAL_FLOAT, pin.dir == hal.HAL_OUT)
    print(isinstance(pin, hal.Pin), lamp.is_pin(), lamp.get(), _hal.component is hal.component)
"""
DEBIAN = Path("/usr/lib/python3/dist-packages")
FOUND = (DEBIAN / "hal_glib.py").exists() and (DEBIAN / "gi").exists() and is_ours()


@pytest.mark.peer
@pytest.mark.skipif(not FOUND, reason="Debian's hal_glib, or a Python of its version, is not installed")
def test_a_glib_pin_is_a_pin_of_ours_and_tells_its_changes():
    command, variables = [SYSTEM_PYTHON, "-c", SCRIPT], os.environ | environment()
    done = subprocess.run(command, env=variables, cwd="/", capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.splitlines() == ["[2.5, 4.0] 4.0 speed True True", "True True False True"], done.stderr
