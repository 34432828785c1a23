"""halcompile as its users start it: components in the .comp language and in C, compiled, loaded and run."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from hal._calls import call
from hal.finder import MODULES_VARIABLE
from hal.realtime import REALTIME_VARIABLE, Host
from nml.errors import HalError
from tests.support.halsession import environment, script, some_periods

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc, which compiles components, is not installed"),
]

SHIFT = """\
component shift "Shift register, integrator and counter";
pin in bit in;
pin out bit out-##[8 : personality & 0xf];
pin in float rate;
pin out float total = 1.5;
pin io s32 calls if personality & 0x100;
param rw float gain = 2.0;
param r unsigned number;
variable double sum = 1.5;
option extra_setup;
function _;
function clear nofp;
license "GPL";
;;
#include <rtapi_math.h>
EXTRA_SETUP() { number = extra_arg + 10; return personality == 0xbad ? -EINVAL : 0; }
FUNCTION(_) {
    int i;
    for (i = (personality & 0xf) - 1; i > 0; i--) out(i) = out(i - 1);
    out(0) = in;
    sum += gain * rate * fperiod;
    total = sum;
    if (personality & 0x100) calls++;
}
FUNCTION(clear) { sum = 0; }
"""
CALLS = """\
component calls "Shift register that writes its pins by calls, as LinuxCNC's components of 2026 do";
pin in bool in;
pin out bool out-# [4];
pin io sint count;
pin out si32 small;
pin out real half_;
param r uint number;
option period no;
option post_export yes;
function _;
license "GPL";
;;
POST_EXPORT() { number_set(extra_arg + 10); return prefix[0] == 'x' ? -EINVAL : 0; }
FUNCTION(_) {
    rtapi_sint now = count;
    for (int i = 3; i > 0; i--) out_set(i, out(i - 1));
    out_set(0, in);
    count_set(now + 3000000000);
    small_set(now > 0 ? -1 : 7);
    half__set((rtapi_real)now / 2);
}
"""
RAW = """\
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
MODULE_LICENSE("GPL");
static int step = 1;
RTAPI_MP_INT(step, "how much a period adds");
static char *label[2];
RTAPI_MP_ARRAY_STRING(label, 2, "names of the pins");
typedef struct { hal_s32_t *out; hal_u64_t *in; hal_bit_t flag; } raw_t;
static raw_t *raw;
static int comp_id;
static void update(void *arg, long period) {
    raw_t *r = arg;
    *r->out += step * (int)*r->in;
    if (r->flag) { rtapi_print_msg(RTAPI_MSG_ERR, "raw: flag at %ld ns\\n", period); r->flag = 0; }
}
int rtapi_app_main(void) {
    static hal_bit_t lost;
    hal_bit_t *pointer = &lost;
    int r;
    comp_id = hal_init("raw");
    if (comp_id < 0) return comp_id;
    raw = hal_malloc(sizeof(*raw));
    r = hal_pin_s32_newf(HAL_OUT, &raw->out, comp_id, "raw.%s", label[0] ? label[0] : "out");
    if (r == 0) r = hal_pin_u64_new("raw.in", HAL_IN, &raw->in, comp_id);
    if (r == 0) r = hal_param_bit_new("raw.flag", HAL_RW, &raw->flag, comp_id);
    if (r == 0) r = hal_export_funct("raw.update", update, raw, 0, 0, comp_id);
    if (r == 0 && step == 99) r = hal_pin_bit_new("raw.lost", HAL_OUT, &pointer, comp_id);
    if (r != 0) { hal_exit(comp_id); return r; }
    return hal_ready(comp_id);
}
void rtapi_app_exit(void) { rtapi_print("raw goes\\n"); hal_exit(comp_id); }
"""
PROGRAM = """\
component program;
option userspace;
option userinit;
pin in s32 in;
pin out si32 out = 42;
license "GPL";
;;
#include <signal.h>
#include <unistd.h>
static volatile int ending;
static void end(int number) { ending = 1; }
void userinit(int argc, char **argv) {
    printf("count=%d argc=%d %s %s %s\\n", count, argc, argv[0], argc > 1 ? argv[1] : "", names[0] ? names[0] : "");
    fflush(NULL);
    signal(SIGTERM, end);
}
void user_mainloop(void) {
    while (!ending) { FOR_ALL_INSTS() { out = in + 1; } usleep(1000); }
}
"""


def halcompile(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "hal.halcompile.program", *words]
    return subprocess.run(
        command, cwd=folder, env=environment(), capture_output=True, text=True, timeout=120, check=False
    )


def installed(folder: Path, name: str, text: str, *words: str) -> None:
    (folder / name).write_text(text)
    done = halcompile(folder, "--compile", *words, name)
    assert done.returncode == 0, done.stderr


@pytest.fixture
def modules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(MODULES_VARIABLE, str(tmp_path))
    monkeypatch.setenv(REALTIME_VARIABLE, "0")
    return tmp_path


@pytest.fixture
def host(own_namespace: str, modules: Path) -> Iterator[Host]:
    made = Host()
    yield made
    made.close()


def period(host: Host, function: str) -> None:
    funct = host.hal.segment.find_funct(function)
    assert funct is not None
    call(funct.code, funct.arg, 1_000_000)


def test_a_component_has_its_pins_and_does_its_work(host: Host, modules: Path) -> None:
    installed(modules, "shift.comp", SHIFT)
    host.load("shift", ["names=a,b", "personality=0x103,2"])
    hal = host.hal
    assert [hal.value("a.number"), hal.value("b.number"), hal.value("a.total"), hal.value("b.gain")] == [10, 11, 1.5, 2]
    assert hal.find("a.calls") is not None
    assert hal.find("b.calls") is None
    assert [hal.find(f"{name}-02") is not None for name in ("a.out", "b.out")] == [True, False]
    hal.set_item("a.in", "1")
    hal.set_item("a.rate", "1000")
    hal.set_item("a.gain", "0.5")
    for _ in range(2):
        period(host, "a")
    assert [hal.value(f"a.out-{n:02}") for n in range(3)] == [True, True, False]
    assert (hal.value("a.total"), hal.value("a.calls"), hal.value("b.total")) == (2.5, 2, 1.5)
    period(host, "a.clear")
    period(host, "a")
    assert hal.value("a.total") == 0.5


def test_pins_and_parameters_may_be_written_by_calls(host: Host, modules: Path) -> None:
    installed(modules, "calls.comp", CALLS)
    host.load("calls", ["names=a,b"])
    hal = host.hal
    assert [hal.value("a.number"), hal.value("b.number")] == [10, 11]
    hal.set_item("a.in", "1")
    for _ in range(2):
        period(host, "a")
    assert [hal.value(f"a.out-{n}") for n in range(4)] == [True, True, False, False]
    assert [hal.value(f"a.{name}") for name in ("count", "small", "half")] == [6_000_000_000, -1, 1.5e9]
    assert hal.value("b.count") == 0


def test_what_an_instance_says_after_its_pins_are_made_counts(host: Host, modules: Path) -> None:
    installed(modules, "calls.comp", CALLS)
    with pytest.raises(HalError):
        host.load("calls", ["names=x"])
    assert host.hal.find("x.in") is None


def test_links_made_and_cut_later_are_followed(host: Host, modules: Path) -> None:
    installed(modules, "shift.comp", SHIFT)
    host.load("shift", ["personality=2"])
    hal = host.hal
    hal.net("speed", ["shift.0.rate"])
    hal.net("way", ["shift.0.total"])
    hal.set_signal("speed", "1000")
    period(host, "shift.0")
    assert hal.value("shift.0.total") == 3.5
    hal.unlink("shift.0.rate")
    hal.set_item("shift.0.rate", "0")
    hal.unlink("shift.0.total")
    period(host, "shift.0")
    assert hal.value("shift.0.total") == 3.5


def test_refusals_leave_nothing_behind(host: Host, modules: Path) -> None:
    installed(modules, "shift.comp", SHIFT)
    for words, what in (
        (["personality=0xbad"], "Invalid argument"),
        (["personality=0xc"], "shift: rtapi_app_main: Invalid argument"),
        (["count=2", "names=a"], "shift: rtapi_app_main: Invalid argument"),
        (["speed=3"], "unknown parameter 'speed'; count, names, personality are known"),
        (["count=x"], "count=x: a whole number would be right"),
    ):
        with pytest.raises(HalError, match=what):
            host.load("shift", words)
        assert host.hal.segment.find_comp("shift") is None
        assert host.hal.find("shift.0.rate") is None
    host.load("shift", [])
    host.unload("shift")
    assert host.hal.find("shift.0.rate") is None


def test_a_component_in_plain_c_has_parameters_messages_and_an_end(host: Host, modules: Path) -> None:
    from hal._messages import hear

    installed(modules, "raw.c", RAW)
    with pytest.raises(HalError, match=r"'raw\.lost': its variable is not in memory of hal_malloc"):
        host.load("raw", ["step=99"])
    hear()
    host.load("raw", ["step=3", "label=sum,"])
    host.hal.set_item("raw.in", "5")
    host.hal.set_item("raw.flag", "1")
    period(host, "raw.update")
    period(host, "raw.update")
    assert (host.hal.value("raw.sum"), host.hal.value("raw.flag")) == (30, False)
    host.unload("raw")
    assert hear() == ["raw: flag at 1000000 ns", "raw goes"]


def test_loadrt_takes_a_compiled_file_and_threads_run_it(own_namespace: str, modules: Path) -> None:
    installed(modules, "shift.comp", SHIFT)
    done = script(
        modules,
        f"loadrt {modules}/shift.so personality=1\nloadrt threads\naddf shift.0 thread1\nsetp shift.0.rate 1\nstart\n"
        f"{some_periods(modules)}stop\ngetp shift.0.total\nunloadrt shift\nlist pin shift*\n",
    )
    assert done.returncode == 0, done.stderr
    assert float(done.stdout.split()[0]) > 1.5
    assert len(done.stdout.split()) == 1


def test_a_program_takes_names_or_a_count_and_its_own_words(own_namespace: str, modules: Path) -> None:
    installed(modules, "program.comp", PROGRAM)
    assert (modules / "program").stat().st_mode & stat.S_IXUSR
    lines = []
    for words in ("zip count=2", "names=left,right"):
        done = script(
            modules,
            f"loadusr -W {modules}/program {words}\nlist pin\nunloadusr program\nwaitusr program\nlist comp\n",
        )
        assert done.returncode == 0, done.stderr
        lines += done.stdout.splitlines()[:2]
    assert lines == [
        "count=2 argc=2 program zip ",
        "program.0.in program.0.out program.1.in program.1.out ",
        "count=0 argc=1 program  left",
        "left.in left.out right.in right.out ",
    ]


def test_preprocessing_and_documents_go_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "shift.comp").write_text(SHIFT)
    assert halcompile(tmp_path, "shift.comp").returncode == 0
    assert "static int export(char *prefix, long extra_arg, long personality)" in (tmp_path / "shift.c").read_text()
    assert halcompile(tmp_path, "--document", "shift.comp").returncode == 0
    assert ".B shift.\\fIN\\fB.clear (no floating point)" in (tmp_path / "shift.9").read_text()
    assert halcompile(tmp_path, "--license", "shift.comp").stdout == "GPL\n"


def test_what_is_wrong_is_said_and_nothing_is_left(tmp_path: Path) -> None:
    done = halcompile(tmp_path, "gone.comp")
    assert (done.returncode, done.stderr) == (1, "halcompile: gone.comp: No such file or directory\n")
    (tmp_path / "other.comp").write_text(SHIFT)
    done = halcompile(tmp_path, "other.comp")
    assert (done.returncode, done.stderr) == (
        1, "halcompile: other.comp: component name (shift) does not match filename (other)\n",
    )  # fmt: skip
    (tmp_path / "shift.comp").write_text(SHIFT.replace("sum = 0;", "summ = 0;"))
    done = halcompile(tmp_path, "--compile", "shift.comp")
    assert done.returncode != 0
    assert "shift.comp:25:" in done.stderr
    assert "summ" in done.stderr
    assert sorted(os.listdir(tmp_path)) == ["other.comp", "shift.comp"]
