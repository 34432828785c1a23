"""Side by side with Debian's halrun: components have the same pins, and commands print the same."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

from tests.support.halsession import script
from tests.support.shield import NOBODY, SHIELD, reason_to_skip

PEER = shutil.which("halrun", path="/usr/bin")
pytestmark = [
    pytest.mark.peer,
    pytest.mark.process,
    pytest.mark.skipif(PEER is None, reason="/usr/bin/halrun (linuxcnc-uspace) is not installed"),
    pytest.mark.skipif(reason_to_skip() is not None, reason=reason_to_skip() or ""),
]

COMPONENTS = """
    abs abs_s32 and2 bin2gray biquad bitslice:personality=3 bitwise blend charge_pump clarke2 clarke3 clarkeinv
    comp constant corexy_by_hal demux:personality=5 differential feedcomp filter_kalman gearchange gray2bin histobins
    joyhandle knob2float latencybins multiclick multiswitch:cfg=2,4 mux_generic:config=bb4,fu3,sf8 orient
    scaled_s32_sums simple_tp sphereprobe weighted_sum:wsum_sizes=3,2
    conv_bit_float conv_bit_s32 conv_bit_u32
    conv_float_s32 conv_float_u32 conv_s32_bit conv_s32_float conv_s32_u32 conv_u32_bit conv_u32_float conv_u32_s32
    counter:num_chan=1 dbounce ddt deadzone debounce:cfg=2 div2 edge encoder:num_chan=1 encoder_ratio:num_chan=1
    estop_latch flipflop hypot ilowpass integ invert limit1 limit2 limit3 lincurve:personality=3
    logic:personality=0x306 lowpass lut5 maj3 match8 minmax mult2 mux16 mux2 mux4 mux8 near not offset oneshot or2
    pid:num_chan=1:debug=1 pwmgen:output_type=0,1,2 sample_hold sampler:cfg=fbsu:depth=9 scale select8 siggen:num_chan=1
    sim_encoder:num_chan=1 sim_home_switch sim_parport sim_spindle stepgen:step_type=0,1,2,5,13
    streamer:cfg=fbsu:depth=9 sum2 supply:num_chan=1 time timedelay timedelta toggle toggle2nist tof ton tp
    tristate_bit tristate_float updown wcomp xor2
    anglejog axistest eoffset_per_angle message:names=m:messages=text moveoff:personality=2 sim_axis_hardware
    spindle_monitor steptest thc thcud gantry:personality=3 watchdog:num_inputs=2 xhc_hb04_util
    modmath:mod_dir=2 ohmic plasmac threadtest spindle:count=2
    carousel:pockets=5,6,8,4:encoding=single,edge,counts,gray matrix_kb:config=2x3,4x4s max31855:personality=2
    bldc:cfg=qi6,aH
"""
NOT_COMPARED = (".time", ".tmax", ".threadbeat")  # times, and what 2.9 has not yet
IDENTITY = re.compile(r"^\s*\d+\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)$", re.M)


def peer(text: str, files: dict[str, str] | None = None) -> str:
    """What Debian's halrun prints for a HAL file, as an ordinary user in namespaces and a folder of its own."""
    with tempfile.TemporaryDirectory(prefix="pyemc-peer-", dir="/var/tmp") as home:
        os.chmod(home, 0o777)
        path = Path(home, "peer.hal")
        for name, content in {path.name: text, **(files or {})}.items():
            Path(home, name).write_text(content)
        done = subprocess.run(
            [*SHIELD, *NOBODY, "timeout", "60", PEER, "-k", "-f", str(path)],
            capture_output=True, text=True, timeout=90, check=False, cwd=home,
            env={"HOME": home, "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"},
        )  # fmt: skip
    return done.stdout


def table(output: str) -> set[tuple[str, ...]]:
    """(type, direction, value, name) of each pin and parameter shown."""
    return {row for row in IDENTITY.findall(output) if not row[3].endswith(NOT_COMPARED)}


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """`show` of all components, ours and the peer's."""
    loads = "".join(f"loadrt {name.replace(':', ' ')}\n" for name in COMPONENTS.split())
    text = f"loadrt threads\n{loads}show pin\nshow param\n"
    folder = tmp_path_factory.mktemp("peer")
    return script(folder, text, "-k").stdout, peer(text)


def test_every_component_has_the_peers_pins_parameters_and_defaults(both: tuple[str, str]) -> None:
    ours, theirs = (table(output) for output in both)
    assert theirs, "the peer did not run"
    assert sorted(theirs - ours) == []
    assert sorted(row for row in ours - theirs if not row[3].startswith(("conv-", "bitslice"))) == []


COMMANDS = """loadrt threads name1=slow period1=1000000
loadrt and2 count=2
net foo and2.0.out => and2.1.in0 and2.1.in1
newsig bar float
sets bar 1.25
newsig unsigned u32
sets unsigned 255
gets bar
gets unsigned
getp and2.0.in0
ptype and2.0.tmax
stype foo
list pin and2.0
loadrt encoder num_chan=4
loadrt not count=3
net read not.0.in not.1.in
net index encoder.0.index-enable encoder.1.index-enable encoder.2.index-enable
net mixed encoder.3.index-enable not.2.in
help nosuch
unloadusr nosuch
addf and2.0 slow
alias pin and2.0.in0 hello
show alias
save net
save neta
save netla
save link
save linka
save sig
save sigu
save comp
save alias
save thread
lock tune
status lock
"""


def test_commands_print_what_the_peers_print(tmp_path: Path) -> None:
    ours, theirs = script(tmp_path, COMMANDS, "-k").stdout, peer(COMMANDS)
    assert ours.splitlines() == [line for line in theirs.splitlines() if not line.startswith("Note:")]
