"""Homing: a table of states for one joint, and the machine's sequence over all joints.

A state is a function that looks at the joint once a period and may set the next state; it returns 1 where the next
state is to run at once. The joint's free planner makes the moves, so the joint's limits hold whatever happens here.
A failure is reported with joint, state and reason, and ends the sequence of the machine.
"""

from libc.math cimport fabs
from libc.stdio cimport snprintf

from emcmot.joint cimport limit_own_moves
from emcmot.report cimport TEXT_SIZE, report
from emcmot.state cimport Joint, Motion

from emcmot.layout import same_size

same_size(__name__, "Motion", sizeof(Motion))

cdef double HOME_DELAY = 0.100       # s of standstill before a homing move
cdef double SEARCH_RANGE = 1.25      # a search goes this many times the joint's travel at most
cdef double MAX_TRAVEL = 1e6         # lu or deg, for joints without limits
cdef int FIRST_EXCLUDED_SEQUENCE = 100

ctypedef int (*StateFunction)(Motion* m, Joint* joint, int number) noexcept nogil

cdef StateFunction STATES[HOME_STATES]
cdef const char* NAMES[HOME_STATES]


cdef int fail(Motion* m, Joint* joint, int number, const char* reason) noexcept nogil:
    snprintf(
        report(m, number), TEXT_SIZE, b"Homing of joint %d failed in state %s: %s", number, NAMES[joint.home.state],
        reason,
    )
    joint.home.state = HOME_ABORT
    return 1


cdef void go(Motion* m, Joint* joint, double vel, double distance) noexcept nogil:
    """Start a move by ``distance``, whose sign is that of ``vel``."""
    joint.free.target = joint.free.pos + (distance if vel > 0.0 else -distance)
    joint.free.vel_limit = fabs(vel) if fabs(vel) < joint.vel_limit else joint.vel_limit
    limit_own_moves(joint, 1.0)
    joint.free.enabled = 1
    joint.free.active = 1


cdef void search(Motion* m, Joint* joint, double vel) noexcept nogil:
    cdef double travel = joint.max_limit - joint.min_limit
    go(m, joint, vel, SEARCH_RANGE * (travel if travel < MAX_TRAVEL else MAX_TRAVEL))


cdef void rename_position(Joint* joint, double shift) noexcept nogil:
    """Add ``shift`` to the joint's position without moving the motor."""
    joint.motor_offset -= shift
    joint.pos_fb += shift
    joint.pos_cmd += shift
    joint.coarse_pos += shift
    joint.free.pos += shift
    joint.free.target += shift


cdef int settled(Motion* m, Joint* joint) noexcept nogil:
    """Whether the joint has stood still for HOME_DELAY."""
    if joint.free.active:
        joint.home.pause_periods = <int>(HOME_DELAY / m.dt)
        return 0
    if joint.home.pause_periods > 0:
        joint.home.pause_periods -= 1
        return 0
    return 1


cdef int enter(Joint* joint, int state) noexcept nogil:
    joint.home.state = state
    return 1


cdef int moved_in_vain(Motion* m, Joint* joint, int number) noexcept nogil:
    """Fail where the move came to its end or met a limit switch; 1 where it did."""
    if joint.on_pos_limit or joint.on_neg_limit:
        fail(m, joint, number, b"hit a limit switch")
        return 1
    if not joint.free.active:
        fail(m, joint, number, b"end of move without the event that was searched")
        return 1
    return 0


cdef int state_idle(Motion* m, Joint* joint, int number) noexcept nogil:
    return 0


cdef int state_start(Motion* m, Joint* joint, int number) noexcept nogil:
    if joint.home.flags & HOME_NO_REHOME and joint.home.homed:
        joint.home.homing = 0
        return enter(joint, HOME_IDLE)
    if joint.home.flags & HOME_IS_SHARED and not joint.home.flags & HOME_ABSOLUTE_ENCODER and joint.home_sw:
        return fail(m, joint, number, b"the shared home switch is closed already")
    joint.home.homing = 1
    joint.home.homed = 0
    joint.home.index_armed = 0
    joint.home.pause_periods = 0
    return enter(joint, HOME_UNLOCK if joint.home.flags & HOME_UNLOCK_FIRST else choose_search(joint))


cdef int choose_search(Joint* joint) noexcept nogil:
    """The first state of the search that the configuration asks for."""
    if joint.home.flags & HOME_ABSOLUTE_ENCODER:
        return HOME_SET_SWITCH_POSITION
    if joint.home.search_vel != 0.0:
        return HOME_INITIAL_SEARCH_START
    return HOME_INDEX_ONLY_START if joint.home.latch_vel != 0.0 else HOME_SET_SWITCH_POSITION


cdef int state_unlock(Motion* m, Joint* joint, int number) noexcept nogil:
    if joint.free.active:
        return 0
    joint.unlock = 1
    return enter(joint, HOME_UNLOCK_WAIT)


cdef int state_unlock_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    return enter(joint, choose_search(joint)) if joint.is_unlocked else 0


cdef int state_initial_search_start(Motion* m, Joint* joint, int number) noexcept nogil:
    if not settled(m, joint):
        return 0
    if joint.home.latch_vel == 0.0:
        return fail(m, joint, number, b"HOME_SEARCH_VEL needs a HOME_LATCH_VEL that is not 0")
    if joint.home_sw:
        return enter(joint, HOME_INITIAL_BACKOFF_START)
    search(m, joint, joint.home.search_vel)
    return enter(joint, HOME_INITIAL_SEARCH_WAIT)


cdef int begin_search(Motion* m, Joint* joint, int number, int closed, double vel, int next_state) noexcept nogil:
    """At rest, and where the home switch is as it should be: move until it changes."""
    if not settled(m, joint):
        return 0
    if closed and not joint.home_sw:
        return fail(m, joint, number, b"the home switch opened before the joint moved off it")
    if not closed and joint.home_sw:
        return fail(m, joint, number, b"the home switch closed before the joint moved onto it")
    search(m, joint, vel)
    return enter(joint, next_state)


cdef int state_initial_backoff_start(Motion* m, Joint* joint, int number) noexcept nogil:
    return begin_search(m, joint, number, 1, -joint.home.search_vel, HOME_INITIAL_BACKOFF_WAIT)


cdef int state_initial_backoff_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    if not joint.home_sw:
        joint.free.enabled = 0
        return enter(joint, HOME_INITIAL_SEARCH_START)
    return moved_in_vain(m, joint, number)


cdef int state_initial_search_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    if joint.home_sw:
        joint.free.enabled = 0
        return enter(joint, HOME_SET_COARSE_POSITION)
    return moved_in_vain(m, joint, number)


cdef int state_set_coarse_position(Motion* m, Joint* joint, int number) noexcept nogil:
    rename_position(joint, joint.home.offset - joint.pos_fb)
    if joint.home.search_vel * joint.home.latch_vel > 0.0:
        return enter(joint, HOME_FINAL_BACKOFF_START)
    return enter(joint, HOME_FALL_SEARCH_START)


cdef int state_final_backoff_start(Motion* m, Joint* joint, int number) noexcept nogil:
    return begin_search(m, joint, number, 1, -joint.home.search_vel, HOME_FINAL_BACKOFF_WAIT)


cdef int state_final_backoff_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    if not joint.home_sw:
        joint.free.enabled = 0
        return enter(joint, HOME_RISE_SEARCH_START)
    return moved_in_vain(m, joint, number)


cdef int state_rise_search_start(Motion* m, Joint* joint, int number) noexcept nogil:
    return begin_search(m, joint, number, 0, joint.home.latch_vel, HOME_RISE_SEARCH_WAIT)


cdef int state_rise_search_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    return latch(joint) if joint.home_sw else moved_in_vain(m, joint, number)


cdef int state_fall_search_start(Motion* m, Joint* joint, int number) noexcept nogil:
    return begin_search(m, joint, number, 1, joint.home.latch_vel, HOME_FALL_SEARCH_WAIT)


cdef int state_fall_search_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    return latch(joint) if not joint.home_sw else moved_in_vain(m, joint, number)


cdef int latch(Joint* joint) noexcept nogil:
    """The edge of the switch: it gives the position, unless the encoder's index does."""
    if joint.home.flags & HOME_USE_INDEX:
        return enter(joint, HOME_INDEX_SEARCH_START)
    joint.free.enabled = 0
    return enter(joint, HOME_SET_SWITCH_POSITION)


cdef int state_set_switch_position(Motion* m, Joint* joint, int number) noexcept nogil:
    if joint.home.flags & HOME_ABSOLUTE_ENCODER:
        rename_position(joint, joint.motor_offset + joint.home.offset)
    else:
        rename_position(joint, joint.home.offset - joint.pos_fb)
    return enter(joint, HOME_FINAL_MOVE_START)


cdef int state_index_only_start(Motion* m, Joint* joint, int number) noexcept nogil:
    if not settled(m, joint):
        return 0
    if not joint.home.flags & HOME_USE_INDEX:
        return fail(m, joint, number, b"HOME_LATCH_VEL needs a HOME_SEARCH_VEL or HOME_USE_INDEX")
    search(m, joint, joint.home.latch_vel)
    return enter(joint, HOME_INDEX_SEARCH_START)


cdef int state_index_search_start(Motion* m, Joint* joint, int number) noexcept nogil:
    joint.index_enable = 1
    joint.home.index_armed = 1
    joint.home.state = HOME_INDEX_SEARCH_WAIT
    return 0


cdef int state_index_search_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    if not joint.home.index_armed:  # take_index has seen it
        joint.free.enabled = 0
        return enter(joint, HOME_SET_INDEX_POSITION)
    return moved_in_vain(m, joint, number)


cdef void take_index(Joint* joint) noexcept nogil:
    """The encoder has met its index, which is at HOME_OFFSET, and counts from 0 there; keep the following error."""
    cdef double wanted = -joint.home.offset
    cdef double old_pos_cmd = joint.pos_cmd
    if joint.home.flags & HOME_INDEX_NO_ENCODER_RESET:
        wanted = joint.motor_pos_fb - joint.correction.pos - joint.home.offset
    joint.motor_offset = wanted
    joint.pos_cmd = joint.motor_pos_fb - joint.correction.pos - joint.motor_offset + joint.ferror
    joint.coarse_pos = joint.pos_cmd
    joint.free.pos += joint.pos_cmd - old_pos_cmd
    joint.free.target += joint.pos_cmd - old_pos_cmd
    joint.home.index_armed = 0


cdef int state_set_index_position(Motion* m, Joint* joint, int number) noexcept nogil:
    return enter(joint, HOME_FINAL_MOVE_START)


cdef int in_sequence(const Joint* joint, int sequence) noexcept nogil:
    """Whether the joint belongs to this step of "home all"; sequence numbers of either sign share their step."""
    return joint.active and abs(joint.home.sequence) == sequence


cdef int is_synchronised(const Motion* m, int sequence) noexcept nogil:
    """Whether the joints of this sequence number make their final move together: one of them has it negative."""
    cdef int n
    for n in range(m.num_joints):
        if m.joint[n].active and m.joint[n].home.sequence < 0 and m.joint[n].home.sequence == -abs(sequence):
            return 1
    return 0


cdef int partners_ready(Motion* m, Joint* joint) noexcept nogil:
    """Whether all joints that make the final move together wait for it, or have gone on to it."""
    cdef int n
    cdef Joint* other
    if not is_synchronised(m, joint.home.sequence):
        return 1
    for n in range(m.num_joints):
        other = &m.joint[n]
        if other.home.homing and in_sequence(other, abs(joint.home.sequence)):
            if other.home.state < HOME_FINAL_MOVE_START:
                return 0
            if other.home.state == HOME_FINAL_MOVE_START and (other.free.active or other.home.pause_periods > 0):
                return 0
    return 1


cdef int state_final_move_start(Motion* m, Joint* joint, int number) noexcept nogil:
    cdef double vel
    if not settled(m, joint) or not partners_ready(m, joint):
        return 0
    if joint.home.flags & HOME_NO_FINAL_MOVE:
        return enter(joint, HOME_FINISHED)
    vel = joint.home.final_vel if joint.home.final_vel > 0.0 else joint.vel_limit
    go(m, joint, vel, joint.home.home - joint.free.pos)
    joint.free.target = joint.home.home
    return enter(joint, HOME_FINAL_MOVE_WAIT)


cdef int state_final_move_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    if joint.free.pos == joint.home.home and joint.free.vel == 0.0:
        joint.free.enabled = 0
        return enter(joint, HOME_LOCK if joint.home.flags & HOME_UNLOCK_FIRST else HOME_FINISHED)
    if joint.on_pos_limit or joint.on_neg_limit:
        return fail(m, joint, number, b"hit a limit switch")
    return 0


cdef int state_lock(Motion* m, Joint* joint, int number) noexcept nogil:
    joint.unlock = 0
    return enter(joint, HOME_LOCK_WAIT)


cdef int state_lock_wait(Motion* m, Joint* joint, int number) noexcept nogil:
    return enter(joint, HOME_FINISHED) if not joint.is_unlocked else 0


cdef int state_finished(Motion* m, Joint* joint, int number) noexcept nogil:
    joint.home.homing = 0
    joint.home.homed = 1
    joint.ferror_high_mark = 0.0
    return enter(joint, HOME_IDLE)


cdef int state_abort(Motion* m, Joint* joint, int number) noexcept nogil:
    joint.home.homing = 0
    joint.home.homed = 0
    joint.index_enable = 0
    joint.home.index_armed = 0
    joint.free.enabled = 0
    return enter(joint, HOME_IDLE)


cdef int home_joint(Motion* m, int number) noexcept nogil:
    cdef Joint* joint = &m.joint[number]
    if joint.home.sequence < 0:  # it homes together with its partners only
        m.home_step = SEQUENCE_START_JOINTS
        m.home_sequence = -joint.home.sequence
        m.home_all = 0
        return 0
    if joint.home.state == HOME_IDLE:
        joint.free.enabled = 0
        joint.home.state = HOME_START
    return 0


cdef void home_all(Motion* m) noexcept nogil:
    m.home_step = SEQUENCE_START_JOINTS
    m.home_sequence = 0
    m.home_all = 1


cdef int count_in_sequence(const Motion* m, int sequence) noexcept nogil:
    cdef int n
    cdef int found = 0
    for n in range(m.num_joints):
        found += in_sequence(&m.joint[n], sequence)
    return found


cdef void report_gap(Motion* m) noexcept nogil:
    """Name the first joint that a missing number keeps from being homed, if there is one."""
    cdef int n
    for n in range(m.num_joints):
        if m.joint[n].active and m.home_sequence < abs(m.joint[n].home.sequence) < FIRST_EXCLUDED_SEQUENCE:
            snprintf(
                report(m, n), TEXT_SIZE, b"Joint %d is not homed with the others: no joint has HOME_SEQUENCE %d", n,
                m.home_sequence,
            )
            return


cdef void start_joints(Motion* m) noexcept nogil:
    """Start the joints of this step. The first one may be empty; at any other gap the sequence ends."""
    cdef int n
    cdef Joint* joint
    if m.home_sequence == 0 and count_in_sequence(m, 0) == 0:
        m.home_sequence = 1
    if count_in_sequence(m, m.home_sequence) == 0:
        m.home_step = SEQUENCE_IDLE
        report_gap(m)
        return
    m.home_step = SEQUENCE_WAIT_JOINTS
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if in_sequence(joint, m.home_sequence) and joint.home.state == HOME_IDLE:
            joint.free.enabled = 0
            joint.home.homing = 1
            joint.home.state = HOME_START


cdef void wait_joints(Motion* m) noexcept nogil:
    """Go on when all joints of this step are home; stop everything of it when one failed."""
    cdef int n
    cdef int busy = 0
    cdef int failed = 0
    cdef Joint* joint
    for n in range(m.num_joints):
        joint = &m.joint[n]
        if in_sequence(joint, m.home_sequence):
            busy |= joint.home.state != HOME_IDLE
            failed |= joint.home.state == HOME_IDLE and not joint.home.homed
    if failed:
        cancel_homing(m)
    elif not busy:
        m.home_sequence += 1
        m.home_step = SEQUENCE_IDLE
        if m.home_all:  # at once: no status may show a machine between two steps, which does not home
            start_joints(m)


cdef void cancel_homing(Motion* m) noexcept nogil:
    """Stop all homing; the joints that were at it are not homed."""
    cdef int n
    for n in range(m.num_joints):
        if m.joint[n].home.state != HOME_IDLE:
            state_abort(m, &m.joint[n], n)
    m.home_step = SEQUENCE_IDLE


cdef int homing_is_active(Motion* m) noexcept nogil:
    """Whether a joint is homing, or the sequence of the machine is between two of them."""
    cdef int n
    for n in range(m.num_joints):
        if m.joint[n].home.state != HOME_IDLE:
            return 1
    return m.home_step != SEQUENCE_IDLE


cdef void update_homed(Motion* m) noexcept nogil:
    cdef int n
    cdef int active = 0
    cdef int homed = 1
    for n in range(m.num_joints):
        if m.joint[n].active:
            active = 1
            homed &= m.joint[n].home.homed
    m.all_homed = active and homed


cdef void homing_cycle(Motion* m) noexcept nogil:
    """One period of all joints and of the sequence."""
    cdef int n, rounds
    cdef Joint* joint
    if m.home_step == SEQUENCE_START_JOINTS:
        start_joints(m)
    for n in range(m.num_joints):
        joint = &m.joint[n]
        rounds = 0
        while rounds < HOME_STATES and STATES[joint.home.state](m, joint, n):
            rounds += 1
    if m.home_step == SEQUENCE_WAIT_JOINTS:
        wait_joints(m)
    update_homed(m)


cdef void state(int number, const char* name, StateFunction function) noexcept:
    NAMES[number] = name
    STATES[number] = function


state(HOME_IDLE, b"IDLE", state_idle)
state(HOME_START, b"START", state_start)
state(HOME_UNLOCK, b"UNLOCK", state_unlock)
state(HOME_UNLOCK_WAIT, b"UNLOCK_WAIT", state_unlock_wait)
state(HOME_INITIAL_BACKOFF_START, b"INITIAL_BACKOFF_START", state_initial_backoff_start)
state(HOME_INITIAL_BACKOFF_WAIT, b"INITIAL_BACKOFF_WAIT", state_initial_backoff_wait)
state(HOME_INITIAL_SEARCH_START, b"INITIAL_SEARCH_START", state_initial_search_start)
state(HOME_INITIAL_SEARCH_WAIT, b"INITIAL_SEARCH_WAIT", state_initial_search_wait)
state(HOME_SET_COARSE_POSITION, b"SET_COARSE_POSITION", state_set_coarse_position)
state(HOME_FINAL_BACKOFF_START, b"FINAL_BACKOFF_START", state_final_backoff_start)
state(HOME_FINAL_BACKOFF_WAIT, b"FINAL_BACKOFF_WAIT", state_final_backoff_wait)
state(HOME_RISE_SEARCH_START, b"RISE_SEARCH_START", state_rise_search_start)
state(HOME_RISE_SEARCH_WAIT, b"RISE_SEARCH_WAIT", state_rise_search_wait)
state(HOME_FALL_SEARCH_START, b"FALL_SEARCH_START", state_fall_search_start)
state(HOME_FALL_SEARCH_WAIT, b"FALL_SEARCH_WAIT", state_fall_search_wait)
state(HOME_SET_SWITCH_POSITION, b"SET_SWITCH_POSITION", state_set_switch_position)
state(HOME_INDEX_ONLY_START, b"INDEX_ONLY_START", state_index_only_start)
state(HOME_INDEX_SEARCH_START, b"INDEX_SEARCH_START", state_index_search_start)
state(HOME_INDEX_SEARCH_WAIT, b"INDEX_SEARCH_WAIT", state_index_search_wait)
state(HOME_SET_INDEX_POSITION, b"SET_INDEX_POSITION", state_set_index_position)
state(HOME_FINAL_MOVE_START, b"FINAL_MOVE_START", state_final_move_start)
state(HOME_FINAL_MOVE_WAIT, b"FINAL_MOVE_WAIT", state_final_move_wait)
state(HOME_LOCK, b"LOCK", state_lock)
state(HOME_LOCK_WAIT, b"LOCK_WAIT", state_lock_wait)
state(HOME_FINISHED, b"FINISHED", state_finished)
state(HOME_ABORT, b"ABORT", state_abort)

cdef HomingInterface BUILTIN

BUILTIN.cycle = homing_cycle
BUILTIN.home_joint = home_joint
BUILTIN.home_all = home_all
BUILTIN.is_active = homing_is_active
BUILTIN.cancel = cancel_homing
BUILTIN.update_homed = update_homed


cdef const HomingInterface* homing_interface() noexcept nogil:
    return &BUILTIN
