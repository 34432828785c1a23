"""Motion without HAL, NML or a clock: stepped from Python, for tests and tools, as fast as it can.

``Motion`` takes EMCMOT_COMMAND messages, steps servo periods, gives EMCMOT_STATUS messages, and reads and writes
every HAL pin of motmod by name. With ``loopback`` the motors follow their commands at once. Simulated home, limit
and index switches make a machine of it that can be homed.
"""

from libc.math cimport fabs, floor
from libc.stdint cimport int32_t, uintptr_t
from libc.string cimport memcpy

from emcmot._messages cimport EMCMOT_COMMAND, EMCMOT_ERROR, EMCMOT_STATUS, MAX_JOINTS
from emcmot.commands cimport run
from emcmot.controller cimport controller
from emcmot.core cimport Core
from emcmot.homing cimport HOME_INDEX_NO_ENCODER_RESET
from emcmot.state cimport Joint
from emcmot.status cimport fill_status

import numpy as np

from emcmot.kins import trivkins
from nml.emc.emcmot import EMCMOT_COMMAND as Command
from nml.emc.emcmot import EMCMOT_ERROR as Error
from nml.emc.emcmot import EMCMOT_STATUS as Status

cdef enum:
    OFF = 0
    HOME = 1
    POSITIVE = 2
    NEGATIVE = 4

ctypedef struct Switch:
    int kind             # bits: what the switch is wired to
    double low           # closed from here, in motor position as the machine's ground has it
    double high          # to here


ctypedef struct Ground:
    double encoder_zero  # true position of encoder count 0, which may be anywhere
    double index_pitch   # 0: no index
    double index_at      # true position of one index pulse
    double last_true
    Switch switch[4]
    int switches
    double command       # true position commanded in the period before, and its speed
    double speed
    double push         # and its acceleration


cdef class Motion(Core):
    """A motion controller under the hand of a test."""

    cdef public bint loopback
    cdef public double worst_vel   # largest motor velocity so far as a share of its joint's limit
    cdef public double worst_acc
    cdef public double worst_jerk  # of joints whose own moves have a jerk limit
    cdef Ground ground[MAX_JOINTS]
    cdef EMCMOT_STATUS last_status
    cdef dict _by_name
    cdef int _serial

    def __init__(
        self, coordinates="xyz", double servo_period=0.001, kinematics=None, planner=None, homing=None, **numbers
    ):
        kinematics = kinematics or trivkins.create(coordinates)
        numbers.setdefault("num_joints", kinematics.joints + numbers.get("num_extrajoints", 0))
        super().__init__(kinematics, servo_period, planner, homing, **numbers)
        self._by_name = {pin.name: pin for pin in self.pins}
        fill_status(&self.last_status, self.m)
        self.loopback = True

    def __getitem__(self, name):
        pin = self._by_name[name]
        if pin.type == "float":
            return (<double*><uintptr_t>pin.address)[0]
        value = (<int32_t*><uintptr_t>pin.address)[0]
        return bool(value) if pin.type == "bit" else value

    def __setitem__(self, name, value):
        pin = self._by_name[name]
        if pin.type == "float":
            (<double*><uintptr_t>pin.address)[0] = value
        else:
            (<int32_t*><uintptr_t>pin.address)[0] = value

    def send(self, code, **fields):
        """Take one command at once, and return its MotCommandStatus."""
        self._serial += 1
        return self.send_bytes(bytes(Command(command=int(code), serial_number=self._serial, **fields).data))

    def send_bytes(self, bytes record):
        """Take a record as it may stand in the command buffer."""
        cdef EMCMOT_COMMAND c
        cdef size_t size = len(record)
        memcpy(&c, <const char*>record, min(size, sizeof(c)))
        run(self.m, &c, size)
        return self.m.command_status

    def add_switch(self, int joint, str kinds, double low, double high):
        """A switch of the joint, closed from ``low`` to ``high`` (true place), wired to ``home``, ``pos``, ``neg``."""
        cdef Ground* g = &self.ground[joint]
        bits = {"home": HOME, "pos": POSITIVE, "neg": NEGATIVE}
        g.switch[g.switches].kind = sum(bits[kind] for kind in kinds.split("+"))
        g.switch[g.switches].low, g.switch[g.switches].high = low, high
        g.switches += 1

    def place(self, int joint, double true_position, double index_pitch=0.0, double index_at=0.0):
        """Stand the joint at ``true_position``; its encoder counts from here."""
        cdef Ground* g = &self.ground[joint]
        g.encoder_zero = true_position - self.m.joint[joint].motor_pos_fb
        g.index_pitch, g.index_at = index_pitch, index_at
        g.last_true = true_position
        g.command = g.encoder_zero + self.m.joint[joint].motor_pos_cmd
        g.speed = g.push = 0.0

    def true_position(self, int joint):
        return self.ground[joint].encoder_zero + self.m.joint[joint].motor_pos_cmd

    cdef void turn_ground(self) noexcept nogil:
        """Let the motors follow, the switches close, and an armed encoder see its index."""
        cdef int n, i, closed
        cdef double where, pulses
        cdef Ground* g
        cdef Joint* j
        for n in range(self.m.num_joints):
            g = &self.ground[n]
            j = &self.m.joint[n]
            j.motor_pos_fb = j.motor_pos_cmd
            where = g.encoder_zero + j.motor_pos_fb
            if g.index_pitch > 0.0 and j.index_enable:
                pulses = floor((where - g.index_at) / g.index_pitch)
                if pulses != floor((g.last_true - g.index_at) / g.index_pitch):
                    if where < g.last_true:
                        pulses += 1.0
                    j.index_enable = 0
                    if not j.home.flags & HOME_INDEX_NO_ENCODER_RESET:
                        g.encoder_zero = g.index_at + pulses * g.index_pitch
                        j.motor_pos_fb = where - g.encoder_zero
            g.last_true = where
            if g.switches:
                closed = 0
                for i in range(g.switches):
                    if g.switch[i].low <= where <= g.switch[i].high:
                        closed |= g.switch[i].kind
                j.home_sw = closed & HOME != 0
                j.pos_lim_sw = closed & POSITIVE != 0
                j.neg_lim_sw = closed & NEGATIVE != 0

    cdef void measure(self) noexcept nogil:
        """Differentiate the motor commands, to compare them with the joints' limits."""
        cdef int n
        cdef double command, vel, acc, jerk
        cdef Ground* g
        for n in range(self.m.num_joints):
            g = &self.ground[n]
            command = g.encoder_zero + self.m.joint[n].motor_pos_cmd
            vel = (command - g.command) / self.m.dt
            acc = (vel - g.speed) / self.m.dt
            jerk = (acc - g.push) / self.m.dt
            g.command, g.speed, g.push = command, vel, acc
            self.worst_vel = max(self.worst_vel, fabs(vel) / self.m.joint[n].vel_limit)
            self.worst_acc = max(self.worst_acc, fabs(acc) / self.m.joint[n].acc_limit)
            if self.m.joint[n].jerk_net > 0.0:
                self.worst_jerk = max(self.worst_jerk, fabs(jerk) / self.m.joint[n].jerk_net)

    cdef void period(self) noexcept nogil:
        self.m.host_now += self.m.dt
        controller(self.m)
        fill_status(&self.last_status, self.m)
        self.measure()
        if self.loopback:
            self.turn_ground()

    def step(self, int periods=1):
        """Run servo periods."""
        cdef int n
        with nogil:
            for n in range(periods):
                self.period()

    def record(self, int periods):
        """Run servo periods and return the joints' motor commands after each, with the state before them in front."""
        cdef int n, k
        cdef int joints = self.m.num_joints
        rows = np.empty((periods + 1, joints))
        cdef double[:, ::1] view = rows
        with nogil:
            for k in range(joints):
                view[0, k] = self.m.joint[k].motor_pos_cmd
            for n in range(periods):
                self.period()
                for k in range(joints):
                    view[n + 1, k] = self.m.joint[k].motor_pos_cmd
        return rows

    def run_until_rest(self, int periods=1000000):
        """Step until motion is in position; the number of periods, or RuntimeError where that takes too long."""
        cdef int n = 0
        with nogil:
            while n < periods:
                self.period()
                n += 1
                if self.m.at_rest:
                    break
        if not self.m.at_rest:
            raise RuntimeError(f"motion is not at rest after {periods} periods")
        return n

    @property
    def status(self):
        """The EMCMOT_STATUS message of the last period."""
        return Status.from_bytes((<char*>&self.last_status)[: sizeof(EMCMOT_STATUS)])

    def errors(self):
        """The texts since the last call."""
        found = [
            Error.from_bytes((<char*>&self.m.errors[n])[: sizeof(EMCMOT_ERROR)]).text for n in range(self.m.error_count)
        ]
        self.m.error_count = 0
        return found
