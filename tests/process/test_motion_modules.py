"""A planner and a homing module of one's own, built as extension modules, named in the INI file, move a machine."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import linuxcnc
from tests.support.desk import DONE, Desk
from tests.support.machine import ROOT, Run, copy_mill, running

pytest.importorskip("Cython", reason="the modules of this test are built with Cython")
pytestmark = pytest.mark.process

CREEP = 2.0  # lu/s, the fastest that the planner of this test moves

SOURCES = {
    "creeptp": f'''
from emcmot.modules cimport planner_module
from emcmot.tp.interface cimport TpInterface, tp_interface
from emcmot.tp.tp cimport Tp
from nml.errors import HalError

cdef const TpInterface* ours = tp_interface()
cdef TpInterface table = ours[0]

cdef void set_vel_limit(Tp* tp, double vel) noexcept nogil:
    ours.set_vel_limit(tp, {CREEP} if vel > {CREEP} else vel)

table.set_vel_limit = set_vel_limit

def load(host, args):
    if args != {{"gentle": "1"}}:
        raise HalError(f"creeptp: {{args}}")
    comp = host.component("creeptp")
    host.provide("planner", planner_module("creeptp", &table))
    comp.ready()
''',
    "herehome": '''
from emcmot.modules cimport homing_module
from emcmot.homing cimport homing_interface
from emcmot.state cimport HomingInterface, Motion

cdef HomingInterface table = homing_interface()[0]

cdef int home_joint(Motion* m, int number) noexcept nogil:
    m.joint[number].home.homed = 1
    return 0

cdef void home_all(Motion* m) noexcept nogil:
    for number in range(m.num_joints):
        m.joint[number].home.homed = 1

table.home_joint = home_joint
table.home_all = home_all

def load(host, args):
    comp = host.component("herehome")
    host.provide("homing", homing_module("herehome", &table))
    comp.ready()
''',
}
BUILD = """
import sys
from Cython.Build import cythonize
from setuptools import Extension, setup
names = {names!r}
setup(
    script_args=["-q", "build_ext", "--inplace"],
    ext_modules=cythonize(
        [Extension(name, [name + ".pyx"]) for name in names],
        include_path=[{root!r}],
        compiler_directives={{"language_level": "3"}},
    ),
)
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The modules, as files."""
    folder = tmp_path_factory.mktemp("modules")
    for name, text in SOURCES.items():
        (folder / f"{name}.pyx").write_text(text)
    code = BUILD.format(names=list(SOURCES), root=str(ROOT))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"},
        capture_output=True, text=True, check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return {name: next(folder.glob(f"{name}*.so")) for name in SOURCES}


def add(ini: Path, section: str, line: str) -> None:
    ini.write_text(ini.read_text().replace(f"[{section}]", f"[{section}]\n{line}"))


def test_the_modules_of_the_ini_file_plan_and_home(tmp_path: Path, built: dict[str, Path]) -> None:
    ini = copy_mill(tmp_path)
    add(ini, "TRAJ", f"TPMOD = {built['creeptp']} gentle=1")
    add(ini, "EMCMOT", f"HOMEMOD = {built['herehome']}")
    with running(ini) as run:
        run.port()
        desk = Desk(tmp_path)
        desk.ready(linuxcnc.MODE_MDI)
        desk.command.mdi("G0 X6")
        fastest = 0.0
        while (result := desk.command.wait_complete(0.01)) == -1:
            fastest = max(fastest, desk.look().current_vel)
        assert result == DONE, desk.texts
        assert desk.look().position[0] == pytest.approx(6.0)
        assert 0.0 < fastest <= CREEP * 1.001
        command = [sys.executable, "-m", "hal.halcmd", "show", "comp"]
        shown = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
        assert {"creeptp", "herehome", "motmod"} <= set(shown.split())


def test_a_planner_that_refuses_its_arguments_ends_the_start_in_one_line(
    tmp_path: Path, built: dict[str, Path]
) -> None:
    ini = copy_mill(tmp_path)
    run = Run(ini, "-t", str(built["creeptp"]))
    assert run.finish() == 1
    assert "creeptp: {}" in run.errors
    assert len(run.errors.splitlines()) == 1


def test_a_module_that_offers_no_planner_is_not_taken_for_one(tmp_path: Path, built: dict[str, Path]) -> None:
    ini = copy_mill(tmp_path)
    run = Run(ini, "-t", str(built["herehome"]))
    assert run.finish() == 1
    assert f"-t {built['herehome']}: this module offers no planner" in run.errors
