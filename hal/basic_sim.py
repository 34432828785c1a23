"""``LIB:basic_sim.tcl``: HAL of a simulated machine with any number of joints, made from the INI file.

Loads kinematics and motion, passes commands back as feedback (held while motion is off), and adds derivatives, home
switches, a spindle and the manual tool change. Options leave parts out: ``-no_make_ddts``, ``-no_simulated_home``,
``-no_use_hal_manualtoolchange``, ``-no_sim_spindle``. Names of components and signals are those of LinuxCNC's script.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from nml.errors import HalError
from nml.inifile import IniFile

if TYPE_CHECKING:
    from hal.session import Session


class BasicSim:
    """Executes the commands of one simulated machine."""

    def __init__(self, session: Session) -> None:
        if session.ini is None:
            raise HalError("basic_sim.tcl needs an INI file (-i)")
        self.session = session
        self.ini: IniFile = session.ini
        self.joints = range(self.ini.integer("KINS", "JOINTS", minimum=1, maximum=16))
        coordinates = self.ini.find("TRAJ", "COORDINATES")
        if not coordinates:
            raise HalError("basic_sim.tcl needs [TRAJ]COORDINATES")
        self.axes = [letter.lower() for letter in coordinates if not letter.isspace()]

    def do(self, *lines: str) -> None:
        for line in lines:
            self.session.execute(line.split())

    def load(self, component: str, names: list[str]) -> None:
        """Load instances and call them in the servo thread."""
        self.do(f"loadrt {component} names={','.join(names)}")
        function = ".do-pid-calcs" if component == "pid" else ""
        self.do(*(f"addf {name}{function} servo-thread" for name in names))

    def core(self) -> None:
        """Kinematics, motion, and a pid that only passes on, so that the net is that of a servo machine."""
        motion = self.ini.find("EMCMOT", "EMCMOT", "motmod")
        base = self.ini.find("EMCMOT", "BASE_PERIOD", "0")
        servo = self.ini.find("EMCMOT", "SERVO_PERIOD", "1000000")
        self.do(
            f"loadrt {self.ini.find('KINS', 'KINEMATICS', 'trivkins')}",
            f"loadrt {motion} base_period_nsec={base} servo_period_nsec={servo} num_joints={len(self.joints)}",
            "addf motion-command-handler servo-thread",
            "addf motion-controller servo-thread",
        )
        self.load("pid", [f"J{n}_pid" for n in self.joints])
        self.load("mux2", [f"J{n}_mux" for n in self.joints])
        self.do(
            "net estop:loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in",
            "net tool:prep-loop iocontrol.0.tool-prepare => iocontrol.0.tool-prepared",
            "net tool:change-loop iocontrol.0.tool-change => iocontrol.0.tool-changed",
            "net sample:enable <= motion.motion-enabled",
        )
        for n in self.joints:
            self.do(
                f"setp J{n}_pid.FF0 1.0",
                *(f"setp J{n}_pid.{gain} 0" for gain in ("Pgain", "Dgain", "Igain", "FF1", "FF2")),
                f"net sample:enable => J{n}_mux.sel",
                f"net J{n}:enable joint.{n}.amp-enable-out => J{n}_pid.enable",
                f"net J{n}:pos-cmd joint.{n}.motor-pos-cmd => J{n}_pid.command",
                f"net J{n}:on-pos J{n}_pid.output => J{n}_mux.in1",
                f"net J{n}:pos-fb J{n}_mux.out => J{n}_mux.in0 joint.{n}.motor-pos-fb",
            )

    def make_ddts(self) -> None:
        """Velocity and acceleration of each joint, and of XY and XYZ together."""
        self.load("ddt", [f"J{n}_{what}" for n in self.joints for what in ("vel", "accel")])
        for n in self.joints:
            self.do(
                f"net J{n}:pos-fb => J{n}_vel.in",
                f"net J{n}:vel J{n}_vel.out => J{n}_accel.in",
                f"net J{n}:acc <= J{n}_accel.out",
            )
        if (self.ini.find("KINS", "KINEMATICS") or "").startswith("trivkins") and {"x", "y", "z"} <= set(self.axes):
            x, y, z = (self.axes.index(axis) for axis in "xyz")
            self.load("hypot", ["hyp_xy", "hyp_xyz"])
            self.do(
                f"net J{x}:vel => hyp_xy.in0 hyp_xyz.in0",
                f"net J{y}:vel => hyp_xy.in1 hyp_xyz.in1",
                f"net J{z}:vel => hyp_xyz.in2",
                "net xy:vel <= hyp_xy.out",
                "net xyz:vel <= hyp_xyz.out",
            )

    def simulated_home(self) -> None:
        """A home switch for each joint, on the side to which the INI file searches."""
        self.load("sim_home_switch", [f"J{n}_switch" for n in self.joints])
        inch = (self.ini.find("TRAJ", "LINEAR_UNITS") or "").lower() in ("in", "inch", "imperial")
        for n in self.joints:
            self.do(
                f"net J{n}:pos-fb => J{n}_switch.cur-pos",
                f"net J{n}:homesw J{n}_switch.home-sw => joint.{n}.home-sw-in",
            )
            kind = self.ini.find(f"JOINT_{n}", "TYPE")
            if kind is not None and kind != "ANGULAR":
                home = 0.1 if inch else 1.0
                backwards = self.ini.real(f"JOINT_{n}", "HOME_SEARCH_VEL", 0.0) < 0.0
                self.do(f"setp J{n}_switch.home-pos {-home if backwards else home}")
                if inch:
                    self.do(f"setp J{n}_switch.hysteresis 0.05")
            if self.ini.boolean(f"JOINT_{n}", "HOME_USE_INDEX", False):
                self.do(f"net J{n}:index-enable joint.{n}.index-enable <=> J{n}_switch.index-enable")

    def use_hal_manualtoolchange(self) -> None:
        self.do(
            "loadusr -W hal_manualtoolchange",
            "unlinkp iocontrol.0.tool-change",
            "unlinkp iocontrol.0.tool-changed",
            "delsig tool:change-loop",
            "net tool:change iocontrol.0.tool-change => hal_manualtoolchange.change",
            "net tool:changed hal_manualtoolchange.changed => iocontrol.0.tool-changed",
            "net tool:prep-number hal_manualtoolchange.number iocontrol.0.tool-prep-number",
        )

    def sim_spindle(self) -> None:
        """A spindle with inertia, position, and at-speed."""
        self.do(
            "loadrt sim_spindle names=sim_spindle",
            "loadrt limit2 names=limit_speed",
            "loadrt lowpass names=spindle_mass",
            "loadrt near names=near_speed",
            "loadrt scale names=rpm_rps",
            "setp sim_spindle.scale 0.01666667",
            "setp rpm_rps.gain .0167",
            "setp limit_speed.maxv 5000.0",
            "setp spindle_mass.gain .07",
            "setp near_speed.scale 1.1",
            "setp near_speed.difference 10",
            "net spindle-index-enable spindle.0.index-enable <=> sim_spindle.index-enable",
            "net spindle-pos sim_spindle.position-fb => spindle.0.revs",
            "net spindle-speed-cmd spindle.0.speed-out => limit_speed.in near_speed.in1",
            "net spindle-speed-limited limit_speed.out => sim_spindle.velocity-cmd spindle_mass.in",
            "net spindle-rpm-filtered spindle_mass.out => rpm_rps.in near_speed.in2",
            "net spindle-rps-filtered rpm_rps.out => spindle.0.speed-in",
            "net spindle-at-speed near_speed.out => spindle.0.at-speed",
            "net spindle-orient spindle.0.orient => spindle.0.is-oriented",
        )
        names = ("limit_speed", "spindle_mass", "rpm_rps", "near_speed", "sim_spindle")
        self.do(*(f"addf {name} servo-thread" for name in names))


PARTS = ("make_ddts", "simulated_home", "use_hal_manualtoolchange", "sim_spindle")


def run(session: Session, options: list[str]) -> None:
    """Make the machine, without the parts that an option ``-no_PART`` names."""
    unknown = [option for option in options if option.removeprefix("-no_") not in PARTS]
    if unknown:
        raise HalError(f"basic_sim.tcl: unknown option '{unknown[0]}'; -no_ and one of {', '.join(PARTS)} is possible")
    sim = BasicSim(session)
    sim.core()
    for part in PARTS:
        if f"-no_{part}" not in options:
            getattr(sim, part)()
