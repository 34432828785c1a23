"""What a person got wrong is said in one line with its place, the exit code is not 0, and nothing is left running."""

import os
import re
import subprocess
import sys

import pytest

from tests.support.machine import PATIENCE, ROOT, Run, copy_mill, traces

pytestmark = pytest.mark.process


def fails(ini, *options, speed=20.0) -> str:
    """The one line that the launcher says when it fails."""
    run = Run(ini, *options, speed=speed)
    assert run.finish() != 0
    assert traces() == []
    (line,) = run.errors.strip().splitlines()
    return line


def in_private_mounts(ini, mounts) -> subprocess.CompletedProcess[str]:
    """Start a machine where ``mounts``, commands for a shell, are done before; skipped where nothing may be mounted."""
    private = ["unshare", "--mount", "sh", "-c"]
    if subprocess.run([*private, "mount -t tmpfs none /mnt"], capture_output=True).returncode:
        pytest.skip("needs the right to mount a file system")
    command = f'{mounts}; exec "$0" -m linuxcnc_start "$1"'
    environment = {**os.environ, "HOME": str(ini.parent), "PYTHONPATH": str(ROOT)}
    return subprocess.run(
        [*private, command, sys.executable, str(ini)],
        cwd=ini.parent, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip


def program(folder, text):
    part = folder / "part.ngc"
    part.write_text(text)
    return "--run", str(part)


def test_a_missing_ini_file(tmp_path):
    assert fails(tmp_path / "none.ini").startswith(f"{tmp_path}/none.ini: ")


def test_an_unreadable_ini_file(tmp_path):
    folder = tmp_path / "folder.ini"
    folder.mkdir()
    assert fails(folder).startswith(f"{folder}: ")


@pytest.mark.parametrize(
    ("content", "place"),
    [
        (b"\x7fELF\x02\x01\x01\0\0", ":1"),
        ("[EMC]\nMACHINE = a mill\n".encode("utf-16"), ":1"),
        (b"", ""),
        (b"loadrt trivkins\nloadrt motmod num_joints=3\n", ""),
    ],
    ids=["a program", "UTF-16", "empty", "a HAL file"],
)
def test_a_file_that_is_no_ini_file(tmp_path, content, place):
    ini = tmp_path / "some.ini"
    ini.write_bytes(content)
    assert re.match(rf"{ini}{place}: .*no INI file", fails(ini))


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        ("KINS.JOINTS", "three"),
        ("KINS.JOINTS", "99"),
        ("HAL.HALFILE", "none.hal"),
        ("HAL.HALFILE", "'mill.hal"),
        ("DISPLAY.DISPLAY", 'web --port "8080'),
        ("EMCMOT.EMCMOT", "motmod\nHOMEMOD = 'homemod"),
        ("TASK.TASK", "notask"),
        ("DISPLAY.DISPLAY", "nodisplay"),
        ("TRAJ.LINEAR_UNITS", "furlong"),
        ("TRAJ.COORDINATES", "X Q"),
        ("JOINT_0.TYPE", "SQUARE"),
        ("JOINT_0.MAX_VELOCITY", "fast"),
    ],
)
def test_an_ini_value_that_cannot_be(tmp_path, entry, value):
    line = fails(copy_mill(tmp_path, changes={entry: value}))
    assert re.match(rf"{tmp_path}/mill_mm.ini:\d+: ", line), line
    assert entry.partition(".")[2] in line


def test_a_missing_nml_file(tmp_path):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("local.nml", "none.nml"))
    assert re.match(rf"{ini}:\d+: .*none\.nml", fails(ini))


def test_a_broken_nml_file(tmp_path):
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("local.nml", "bad.nml"))
    (tmp_path / "bad.nml").write_text("# buffers\nB emcCommand SHMEM localhost many 0 0 1 16 1001\n")
    assert fails(ini).startswith(f"{tmp_path}/bad.nml:2:")


@pytest.mark.parametrize("line", ["loadrt nosuchmodule", "addf nothing servo-thread", "net a joint.0.none", "bogus"])
def test_a_wrong_line_in_a_hal_file(tmp_path, line):
    ini = copy_mill(tmp_path, hal=f"# comment\n{line}\n")
    assert fails(ini).startswith(f"{tmp_path}/test.hal:2: ")


def test_a_missing_program(tmp_path):
    assert fails(copy_mill(tmp_path), "--run", str(tmp_path / "none.ngc")).startswith(f"{tmp_path}/none.ngc: ")


@pytest.mark.parametrize(
    ("text", "number"),
    [("G21\nG1 X1 F100\nG1 X[1/0]\nM2\n", 3), ("G21 G1 X1\nM2\n", 1), ("G21\nG77777\nM2\n", 2), ("G1 XQ F100\n", 1)],
)
def test_a_wrong_program(tmp_path, text, number):
    line = fails(copy_mill(tmp_path), *program(tmp_path, text))
    assert line.startswith(f"{tmp_path}/part.ngc:{number}"), line


def test_a_program_that_leaves_the_machine(tmp_path):
    line = fails(copy_mill(tmp_path), *program(tmp_path, "G21 G90\nG1 X10 F3000\nG1 X5000\nM2\n"))
    assert "limit" in line
    assert "300" in line


def test_a_namespace_that_is_in_use(tmp_path):
    ini = copy_mill(tmp_path)
    first = Run(ini, speed=20.0)
    try:
        first.port()
        second = Run(ini, speed=20.0)
        assert second.finish() != 0
        assert "already running" in second.errors
        assert first.process.poll() is None
    finally:
        assert first.stop() == 143
    assert traces() == []


@pytest.mark.parametrize("size", ["64k", "9m"])
def test_too_little_shared_memory(tmp_path, size):
    """Said by whoever makes memory, so that nobody dies of a bus error while it runs."""
    ini = copy_mill(tmp_path)
    done = in_private_mounts(ini, f"mount -t tmpfs -o size={size} none /dev/shm")
    assert done.returncode == 1, done.stderr
    assert re.search(r"no room for .* bytes .*in /dev/shm", done.stderr.splitlines()[-1]), done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("option", "words"), [("size=64k", "No space left on device"), ("ro", "Read-only file system")], ids=["full", "ro"]
)
def test_a_folder_of_run_time_files_that_cannot_be_written(tmp_path, option, words):
    run_time = tmp_path / "run"
    run_time.mkdir()
    mount = f"mount -t tmpfs -o {option} none {run_time} && export XDG_RUNTIME_DIR={run_time}"
    fill = f"head -c 1M /dev/zero 2>/dev/null > {run_time}/ballast" if option != "ro" else "true"
    done = in_private_mounts(copy_mill(tmp_path), f"{mount}; {fill}")
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"{run_time}/pyemc")
    assert words in line


@pytest.mark.parametrize(("option", "value"), [("--speed", "0"), ("--namespace", "a/b")])
def test_an_option_that_cannot_be(tmp_path, option, value):
    assert value.strip("0") in fails(copy_mill(tmp_path), option, value)
