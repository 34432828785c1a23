"""Homing of joints and the home sequence of the machine."""

from emcmot.state cimport HomingInterface, Joint, Motion

cdef enum HomeState:       # the numbers of LinuxCNC's pin joint.N.home-state
    HOME_IDLE = 0
    HOME_START = 1
    HOME_UNLOCK = 2
    HOME_UNLOCK_WAIT = 3
    HOME_INITIAL_BACKOFF_START = 4
    HOME_INITIAL_BACKOFF_WAIT = 5
    HOME_INITIAL_SEARCH_START = 6
    HOME_INITIAL_SEARCH_WAIT = 7
    HOME_SET_COARSE_POSITION = 8
    HOME_FINAL_BACKOFF_START = 9
    HOME_FINAL_BACKOFF_WAIT = 10
    HOME_RISE_SEARCH_START = 11
    HOME_RISE_SEARCH_WAIT = 12
    HOME_FALL_SEARCH_START = 13
    HOME_FALL_SEARCH_WAIT = 14
    HOME_SET_SWITCH_POSITION = 15
    HOME_INDEX_ONLY_START = 16
    HOME_INDEX_SEARCH_START = 17
    HOME_INDEX_SEARCH_WAIT = 18
    HOME_SET_INDEX_POSITION = 19
    HOME_FINAL_MOVE_START = 20
    HOME_FINAL_MOVE_WAIT = 21
    HOME_LOCK = 22
    HOME_LOCK_WAIT = 23
    HOME_FINISHED = 24
    HOME_ABORT = 25
    HOME_STATES = 26

cdef enum HomeFlag:
    HOME_IGNORE_LIMITS = 1
    HOME_USE_INDEX = 2
    HOME_IS_SHARED = 4
    HOME_UNLOCK_FIRST = 8
    HOME_ABSOLUTE_ENCODER = 16
    HOME_NO_REHOME = 32
    HOME_NO_FINAL_MOVE = 64
    HOME_INDEX_NO_ENCODER_RESET = 128

cdef enum HomeStep:        # of the machine's home sequence
    SEQUENCE_IDLE = 0
    SEQUENCE_START_JOINTS = 1
    SEQUENCE_WAIT_JOINTS = 2

cdef enum:
    NO_SEQUENCE = 1000     # HOME_SEQUENCE of a joint that "home all" leaves alone

cdef inline int homing_ignores_limits(const Joint* joint) noexcept nogil:
    return joint.home.homing and joint.home.flags & HOME_IGNORE_LIMITS

cdef void rename_position(Joint* joint, double shift) noexcept nogil
cdef void take_index(Joint* joint) noexcept nogil
cdef const HomingInterface* homing_interface() noexcept nogil      # the homing of this package
