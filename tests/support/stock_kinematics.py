"""The kinematics of Debian's LinuxCNC as an oracle: its modules are asked for poses and joints, outside of any HAL.

``ask`` runs this file as a process of its own, because the modules want to find HAL's C functions in the process.
"""

from __future__ import annotations

import ctypes
import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

MODULES = Path("/usr/lib/linuxcnc/modules")
CELL_TYPES = (ctypes.c_ubyte, ctypes.c_double, ctypes.c_int32, ctypes.c_uint32)
available = (MODULES / "trivkins.so").exists() and shutil.which("cc") is not None


def ask(tmp_path: Path, module: str, **request: Any) -> dict[str, list[list[float] | None]]:
    """What ``module`` answers: ``joints`` of each pose of ``poses``, ``poses`` of each row of ``joints``; None: none.

    ``arguments`` of loadrt, ``pins`` by their name, ``way`` of switchable kinematics, ``near``: the joints before each
    pose, ``guess``: the pose before each row of joints. The four lists are of one length.
    """
    library = tmp_path / "shim.so"
    if not library.exists():
        source = Path(__file__).with_suffix(".c")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True, capture_output=True)
    question = json.dumps({"library": str(library), "module": module, **request})
    done = subprocess.run([sys.executable, __file__], input=question, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def _answer(request: dict[str, Any]) -> dict[str, Any]:
    shim = ctypes.CDLL(request["library"], ctypes.RTLD_GLOBAL)
    shim.shim_name.restype, shim.shim_cell.restype = ctypes.c_char_p, ctypes.c_void_p
    stock = ctypes.CDLL(str(MODULES / f"{request['module']}.so"))
    texts = {name: text.encode() for name, text in request.get("arguments", {}).items()}  # the module keeps pointers
    for name, text in texts.items():
        address = ctypes.c_void_p.in_dll(stock, f"rtapi_info_address_{name}").value
        ctypes.c_char_p.from_address(address).value = text
    assert stock.rtapi_app_main() == 0
    stock.kinematicsType()  # some make their pins only here
    stock.kinematicsSwitch(request.get("way", 0))
    for n in range(shim.shim_count()):
        name = shim.shim_name(n).decode()
        if name in request.get("pins", {}):
            CELL_TYPES[shim.shim_type(n)].from_address(shim.shim_cell(n)).value = request["pins"][name]
    flags = ctypes.c_ulong(0), ctypes.c_ulong(0)

    def call(function: Any, given: list[float], size: int, start: list[float], length: int) -> list[float] | None:
        into = (ctypes.c_double * length)(*start)
        result = function((ctypes.c_double * size)(*given), into, *(ctypes.byref(flag) for flag in flags))
        return list(into) if result == 0 else None

    found: dict[str, list[list[float] | None]] = {"poses": [], "joints": []}
    for pose, joints, near, guess in zip(*(request[key] for key in ("poses", "joints", "near", "guess")), strict=True):
        call(stock.kinematicsInverse, pose, 9, near, 16)  # iterative ones begin at the pose that was asked for last
        call(stock.kinematicsForward, joints, 16, guess, 9)  # the very first only takes the guess
        found["poses"].append(call(stock.kinematicsForward, joints, 16, guess, 9))
        found["joints"].append(call(stock.kinematicsInverse, pose, 9, near, 16))
    return found


if __name__ == "__main__":
    print(json.dumps(_answer(json.load(sys.stdin))))
