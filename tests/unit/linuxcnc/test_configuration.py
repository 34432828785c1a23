"""What the launcher reads from an INI file, and how it names what is wrong with it."""

import pytest

from linuxcnc.configuration import Configuration
from nml.errors import ConfigError
from tests.support.machine import copy_mill


def configuration(folder, changes=None):
    return Configuration(copy_mill(folder, changes=changes))


def test_the_programs_are_modules_of_ours(tmp_path):
    found = configuration(tmp_path)
    assert (found.task.module, found.io.module, found.display().module) == ("emctask", "emcio", "gui.linuxcncrsh")
    assert found.display().words == ["linuxcncrsh", "-ini", str(tmp_path / "mill_mm.ini"), "--port", "0"]
    assert found.halui is None


@pytest.mark.parametrize("name", ["myscreen", "./myscreen"])
def test_a_display_may_be_any_executable(tmp_path, name):
    screen = tmp_path / "myscreen"
    screen.write_text("#!/bin/sh\n")
    screen.chmod(0o755)
    found = configuration(tmp_path, {"DISPLAY.DISPLAY": f"{name} --big"})
    assert found.display().words == [str(screen), "-ini", str(tmp_path / "mill_mm.ini"), "--big"]


def test_hal_files_come_in_their_order(tmp_path):
    assert [file.path.name for file in configuration(tmp_path).hal_files] == ["mill.hal", "spindle.hal"]


def test_the_environment_names_what_scripts_expect(tmp_path):
    found = configuration(tmp_path).environment()
    assert found["INI_FILE_NAME"] == str(tmp_path / "mill_mm.ini")
    assert found["CONFIG_DIR"] == str(tmp_path)
    assert found["TRAJ_COORDINATES"] == "X Y Z"
    assert found["KINS_KINEMATICS"] .split()[0] == "trivkins"
    assert found["LINUXCNC_TCL_DIR"] == "/usr/lib/tcltk/linuxcnc"


@pytest.mark.parametrize(
    ("entry", "value"), [("HAL.HALFILE", "none.hal b.hal"), ("HAL.HALFILE", "none.hal"), ("EMCIO.EMCIO", "noio")]
)
def test_a_mistake_is_named_with_its_line(tmp_path, entry, value):
    with pytest.raises(ConfigError, match=rf"mill_mm.ini:\d+: .*{value}"):
        configuration(tmp_path, {entry: value})


def test_an_ini_file_that_is_a_link_names_files_from_the_folder_of_the_link(tmp_path):
    shared, here = tmp_path / "shared", tmp_path / "here"
    for folder in (shared, here):
        folder.mkdir()
    copy_mill(shared, changes={"DISPLAY.DISPLAY": "./screen", "HAL.HALFILE": "own.hal"})
    for file in shared.iterdir():
        (here / file.name).symlink_to(file)
    for name in ("screen", "own.hal"):
        (here / name).write_text("#!/bin/sh\n")
        (here / name).chmod(0o755)
    found = Configuration(here / "mill_mm.ini")
    assert found.display().words == [str(here / "screen"), "-ini", str(here / "mill_mm.ini")]
    assert {file.path for file in found.hal_files} == {here / "own.hal"}
    assert found.folder == here
