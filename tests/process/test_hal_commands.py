"""halcmd, halrun and the programs around them, as their users start them: output, messages, exit codes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from tests.support.halsession import environment, halcmd, run, script, some_periods

pytestmark = pytest.mark.process


@pytest.fixture
def session(own_namespace: str) -> Iterator[None]:
    """A realtime session with a sine on a signal."""
    loads = "loadrt threads\nloadrt siggen\nloadrt and2\n"
    commands = loads + "net wave siggen.0.sine\naddf siggen.0.update thread1\nstart\n"
    assert run("halcmd", "-f", given=commands).returncode == 0
    yield
    assert run("halrun", "-U").returncode == 0


def test_a_failed_command_ends_with_code_1_and_its_place(own_namespace: str, tmp_path: Path) -> None:
    assert (run("halcmd", "foo").returncode, run("halcmd", "foo").stderr) == (
        1, "<commandline>:0: Unknown command 'foo'\n",
    )  # fmt: skip
    done = script(tmp_path, "newsig a bit\nnewsig b nonsense\nnewsig c bit\nshow sig\n")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"{tmp_path}/test.hal:2: Unknown signal type 'nonsense'")


def test_commands_about_what_is_not_there_end_as_scripts_expect(session: None) -> None:
    assert (run("halcmd", "unloadusr", "gone").returncode, run("halcmd", "unload", "gone").returncode) == (0, 1)
    assert run("halcmd", "help", "nosuch").stdout == "No help for unknown command 'nosuch'\n"
    assert "belongs before 'loadrt threads'" in run("halcmd", "setexact_for_test_suite_only").stderr


def test_k_keeps_going_and_q_is_silent(own_namespace: str, tmp_path: Path) -> None:
    done = script(tmp_path, "bogus\nnewsig a bit\ngets a\n", "-k")
    assert (done.returncode, done.stdout) == (1, "FALSE\n")
    assert script(tmp_path, "bogus\n", "-Q").stderr == ""


def test_wrong_usage_is_code_255(own_namespace: str) -> None:
    assert run("halcmd", "-z").returncode == 255
    assert run("halcmd", "-f", "/no/such/file").returncode == 255
    assert "cannot read the HAL file" in run("halrun", "-f", "/no/such/file").stderr


def test_commands_come_from_standard_input_too(own_namespace: str) -> None:
    done = run("halcmd", "-f", given="newsig x s32\nsets x -7\ngets x\n")
    assert (done.returncode, done.stdout) == (0, "-7\n")


def test_script_mode_prints_items_in_single_lines(session: None) -> None:
    assert halcmd("-s", "show", "sig").split()[0::2][:2] == ["float", "wave"]
    assert halcmd("-s", "show", "pin", "and2.0.in0") == "and2 bit   IN FALSE and2.0.in0\n\n"
    assert halcmd("-s", "show", "thread").endswith("siggen.0.update\n\n")


@pytest.mark.parametrize("how", ["-tbit", "-t bit"])
def test_list_and_show_take_a_data_type_before_their_patterns(session: None, how: str) -> None:
    assert halcmd("list", "pin", *how.split(), "and2*") == "and2.0.in0 and2.0.in1 and2.0.out \n"
    lines = halcmd("-s", "show", "pin", *how.split(), "and2*", "siggen*").splitlines()
    names = ["and2.0.in0", "and2.0.in1", "and2.0.out", "siggen.0.clock", "siggen.0.reset"]
    assert [line.split()[-1] for line in lines if line] == names
    assert halcmd("list", "sig", *how.split()) == "\n"
    assert "tmax-increased" in halcmd("list", "param", *how.split())
    assert halcmd("list", "pin", how.replace("bit", "BIT"), "and2*").split()[-1] == "and2.0.time"


def test_what_is_saved_makes_the_same_session_again(session: None, tmp_path: Path) -> None:
    saved = tmp_path / "saved.hal"
    halcmd("setp", "siggen.0.frequency", "2.5")
    halcmd("save", "allu", str(saved))
    assert run("halrun", "-U").returncode == 0
    assert run("halcmd", "-f", str(saved)).returncode == 0
    assert halcmd("getp", "siggen.0.frequency") == "2.5\n"
    again = tmp_path / "again.hal"
    halcmd("save", "allu", str(again))
    assert again.read_text() == saved.read_text()


def test_waiting_for_programs(own_namespace: str, tmp_path: Path) -> None:
    python = sys.executable
    component = tmp_path / "comp.py"
    component.write_text(
        "import hal, os, time\nc = hal.component('comp')\nc.newpin('x', hal.HAL_S32, hal.HAL_OUT)\nc['x'] = 3\n"
        "time.sleep(0.1)\nc.ready()\nwhile not os.path.exists('seen'): time.sleep(0.01)\nc.exit()\n"
    )
    lines = f"loadusr -Wn comp {python} {component}\ngetp comp.x\nloadusr -w touch seen\nwaitusr comp\nshow pin comp\n"
    done = script(tmp_path, lines)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("3\n")
    assert "comp.x" not in done.stdout
    assert "failed, returned 3" in script(tmp_path, f"loadusr -w {python} -c exit(3)\n").stderr
    assert script(tmp_path, f"loadusr -w -i {python} -c exit(3)\n").returncode == 0
    assert "exited without becoming ready" in script(tmp_path, f"loadusr -W {python} -c pass\n").stderr
    assert "program 'no-such-program' not found" in script(tmp_path, "loadusr no-such-program\n").stderr


def test_a_second_halrun_in_a_namespace_is_refused(session: None, tmp_path: Path) -> None:
    done = script(tmp_path, "newsig a bit\n")
    assert done.returncode == 1
    assert "Realtime already running" in done.stderr
    assert halcmd("gets", "wave")  # and the first is unharmed


def test_two_namespaces_do_not_see_each_other(
    session: None, monkeypatch: pytest.MonkeyPatch, own_namespace: str
) -> None:
    monkeypatch.setenv("PYEMC_NAMESPACE", own_namespace + "-b")
    assert "not found" in run("halcmd", "gets", "wave").stderr
    monkeypatch.setenv("PYEMC_NAMESPACE", own_namespace)


def test_halsampler_and_halstreamer_are_each_others_inverse(own_namespace: str, tmp_path: Path) -> None:
    lines = [f"{n * 0.5:f} {n % 2} {-n} " for n in range(50)]
    (tmp_path / "data").write_text("# a remark\n" + "\n".join(lines) + "\nnonsense\n")
    done = script(
        tmp_path,
        "loadrt threads\nloadrt streamer cfg=fbs depth=100\nloadrt sampler cfg=fbs depth=200\n"
        + "".join(f"net s{n} streamer.0.pin.{n} sampler.0.pin.{n}\n" for n in range(3))
        + "net e streamer.0.empty\naddf streamer.0 thread1\naddf sampler.0 thread1\n"
        + "loadusr -w halstreamer data\nstart\nloadusr -w halsampler -n 50\n",
    )
    assert done.stdout == "\n".join(lines) + "\n"
    assert "data:52: 1 columns; 3 would be right; line skipped" in done.stderr


def test_the_scope_records_around_its_trigger(session: None, tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    done = run(
        "scope", "--capture", "siggen.0.sawtooth", "--thread", "thread1", "--samples", "50", "--before", "10",
        "--trigger", "siggen.0.sawtooth>0.2491", "--csv", str(path),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = [[float(word) for word in line.split(",")] for line in path.read_text().splitlines()[1:]]
    assert [round(row[0] * 1000) for row in rows] == list(range(-10, 40))
    assert rows[9][1] <= 0.2491 < rows[10][1]
    assert all(b[1] - a[1] == pytest.approx(0.002) for a, b in pairwise(rows))
    assert "scope" not in halcmd("list", "comp")


def test_meter_and_report_show_the_session(session: None) -> None:
    assert len(run("meter", "-n", "2", "sig", "wave").stdout.splitlines()) == 2
    text = run("report").stdout
    assert "wave (float)" in text
    assert "from siggen.0.sine" in text
    halcmd("net", "bit", "siggen.0.clock", "and2.0.in0")
    assert '"siggen.0" -> "and2.0" [label="bit"];' in run("report", "--dot").stdout


@pytest.mark.parametrize("main", ["main", "histogram_main"])
def test_latency_programs_leave_a_running_session_alone(session: None, main: str) -> None:
    code = f"import sys; from hal.latency import {main}; sys.exit({main}(['--seconds', '1']))"
    done = subprocess.run([sys.executable, "-c", code], env=environment(), capture_output=True, text=True, timeout=60)
    assert (done.returncode, "a realtime session is running" in done.stderr) == (1, True)
    before, after = (float(halcmd("getp", "siggen.0.sine")) for _ in range(2))
    assert -1.0 <= before <= 1.0
    assert -1.0 <= after <= 1.0
    assert halcmd("list", "thread") == "thread1 \n"


@pytest.mark.parametrize(
    ("words", "what"),
    [
        (["--trigger", "siggen.0.sine"], "trigger 'siggen.0.sine': PIN>LEVEL or PIN<LEVEL would be right"),
        (["--thread", "servo"], "thread 'servo' not found; there is thread1"),
    ],
)
def test_the_scope_says_what_would_be_right(session: None, words: list[str], what: str) -> None:
    done = run("scope", "--capture", "siggen.0.sine", *words)
    assert done.returncode == 1
    assert done.stderr == f"halscope: {what}\n"


def test_latency_test_measures_in_a_session_of_its_own(own_namespace: str, tmp_path: Path) -> None:
    lines = run("latency", "-", "1ms", "--seconds", "0.3").stdout.splitlines()
    assert lines[-1].split()[:2] == ["servo", "1000000"]


def test_the_shell_completes_commands_and_names(session: None) -> None:
    done = subprocess.run(
        [sys.executable, "-c", "from hal.session import Session\nfrom hal.interactive import Completer\n"
         "with Session() as s:\n    c = Completer(s)\n    print(c.candidates([], 'unl'))\n"
         "    print(c.candidates(['setp'], 'and2.0.in'))\n    print(c.candidates(['addf', 'x'], ''))\n"
         "    print(c.candidates(['net', 'wave', 'a'], 'siggen.0.si'))"],
        env=environment(), capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    assert done.stdout.splitlines() == [
        "['unlinkp', 'unload', 'unloadrt', 'unloadusr', 'unlock']", "['and2.0.in0', 'and2.0.in1']", "['thread1']",
        "['siggen.0.sine']",
    ]  # fmt: skip


def test_a_tcl_file_speaks_hal(own_namespace: str, tmp_path: Path) -> None:
    pytest.importorskip("tkinter")
    path = tmp_path / "f.tcl"
    path.write_text(
        "loadrt and2 names=a,b\nforeach n {a b} { setp $n.in0 1 }\nputs [getp b.in0]\nputs $::KINS(JOINTS)\n"
        "puts [hal list comp]\nloadrt $::HAL(LOADS)\ngetp x.0.out\nsetp nothing 1\n"
    )
    ini = tmp_path / "m.ini"
    ini.write_text("[KINS]\nJOINTS = 3\n[HAL]\nLOADS = or2 names=x.0\n")
    done = run("halrun", "-i", str(ini), str(path), cwd=tmp_path)
    assert done.stdout.splitlines()[:2] == ["TRUE", "3"]
    assert "and2" in done.stdout
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == f"{path}:8: parameter or pin 'nothing' not found"


def test_what_realtime_functions_say_reaches_the_user(tmp_path: Path) -> None:
    text = """loadrt threads name1=t period1=1000000
loadrt message names=oil,air messages="Oil is low,No air"
addf oil t
addf air t
start
setp oil.trigger 1
setp air.edge 0
"""
    said = script(tmp_path, f"{text}{some_periods(tmp_path)}stop\n").stderr.splitlines()
    assert said.count("Oil is low") == 1
    assert said.count("No air") == 1


def test_a_component_that_died_is_told_to_the_next_user(tmp_path: Path) -> None:
    program = tmp_path / "short.py"
    program.write_text(
        f"#!{sys.executable}\nimport hal, os, signal, time\nc = hal.component('short')\nc.ready()\ntime.sleep(1)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    program.chmod(0o755)
    done = script(tmp_path, f"loadrt threads\nloadusr -W {program}\nwaitusr short\nunloadrt threads\n")
    assert "HAL: component 'short' died without leaving; removed" in done.stderr


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    pytest.importorskip("matplotlib")
    return tmp_path / "out.png"


def is_picture(path: Path) -> bool:
    """Whether it is a PNG that matplotlib can read, with something drawn on it."""
    from matplotlib import image

    pixels = image.imread(path)
    return path.read_bytes().startswith(b"\x89PNG\r\n") and pixels.min() < 0.5 < pixels.max()


def test_a_capture_is_drawn_as_a_picture(session: None, picture: Path) -> None:
    done = run("scope", "--capture", "siggen.0.sine", "siggen.0.square", "--thread", "thread1", "--samples", "50",
               "--png", str(picture))  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert is_picture(picture)


def test_a_latency_histogram_is_drawn_as_a_picture(own_namespace: str, picture: Path) -> None:
    code = "import sys; from hal.latency import histogram_main; sys.exit(histogram_main(sys.argv[1:]))"
    done = subprocess.run(
        [sys.executable, "-c", code, "--seconds", "0.3", "--png", str(picture)],
        env=environment(), capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert is_picture(picture)


def test_unlock_takes_away_what_lock_of_the_same_name_gave(own_namespace: str, tmp_path: Path) -> None:
    orders = ["lock tune", "unlock tune", "lock all", "unlock tune", "unlock", "lock tune", "unlock all"]
    done = script(tmp_path, "".join(f"{order}\nstatus lock\n" for order in orders))
    values = [int(line.split()[3]) for line in done.stdout.splitlines() if "lock value" in line]
    assert values == [3, 0, 255, 252, 0, 3, 0], done.stdout + done.stderr
