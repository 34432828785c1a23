"""State and mode transitions: E-stop, E-stop reset, on; manual, MDI, auto.

The state that EMC_STAT shows is always what motion and io report (``emctask.supervisor``); the functions here give the
orders that bring it about, and a command is done when the report agrees. As in LinuxCNC 'off' shows as E-stop reset.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emctask import positionfile
from emctask.commandtable import PassedOver, Refused
from nml.emc import EMC_AUX_ESTOP_OFF, EMC_AUX_ESTOP_ON, EMC_LUBE_OFF, EMC_LUBE_ON, EMC_TOOL_ABORT
from nml.emc.constants import EMC_IO_ABORT_REASON_ENUM as Reason
from nml.emc.constants import EMC_TASK_INTERP_ENUM as Interp
from nml.emc.constants import EMC_TASK_MODE_ENUM as Mode
from nml.emc.constants import EMC_TASK_STATE_ENUM as State
from nml.emc.constants import EMC_TRAJ_MODE_ENUM as TrajMode
from nml.emc.emcmot import MotCommand, MotionState

if TYPE_CHECKING:
    from emctask.task import Task

UNHOME_VOLATILE = -2


def set_state(task: Task, state: int) -> None:
    """EMC_TASK_SET_STATE."""
    orders = {
        State.ESTOP: to_estop,
        State.ESTOP_RESET: to_estop_reset,
        State.OFF: to_off,
        State.ON: to_on,
    }
    if state not in orders:
        raise Refused(f"EMC_TASK_SET_STATE: {state} is no state; 1 E-stop, 2 E-stop reset, 3 off, 4 on are")
    orders[State(state)](task)


def to_estop(task: Task) -> None:
    """Everything off, and the chain is opened."""
    emergency_stop(task, Reason.TASK_STATE_ESTOP)
    task.expect(lambda: task.state is State.ESTOP, "the E-stop chain does not open: emc-enable-in stays TRUE")


def to_estop_reset(task: Task) -> None:
    """Ask for the chain to be closed; the machine stays off, or on: then this is an abort."""
    task.runner.abort(Reason.TASK_STATE_ESTOP_RESET)
    task.io.send(EMC_AUX_ESTOP_OFF())
    task.io.send(EMC_LUBE_OFF())
    complaint = "E-stop cannot be reset: iocontrol.0.emc-enable-in stays FALSE"
    task.expect(lambda: task.state is not State.ESTOP, complaint)


def to_off(task: Task) -> None:
    """Motion off, the chain stays closed."""
    if task.state is State.ESTOP:
        return
    task.runner.abort(Reason.TASK_STATE_OFF)
    _switch_off(task)
    task.expect(lambda: task.state is not State.ON, "motion does not switch off")


def to_on(task: Task) -> None:
    """Motion on; only from E-stop reset."""
    if task.state is State.ESTOP:
        raise PassedOver("the machine cannot be turned on while it is in E-stop; reset the E-stop first")
    if task.state is State.ON:
        return
    task.motion.send(MotCommand.ENABLE)
    task.io.send(EMC_LUBE_ON())
    _resume_mode(task)
    complaint = "motion does not switch on; is motion.enable TRUE, and no joint at a limit or faulted?"
    task.expect(lambda: task.state is State.ON, complaint)
    task.plan.must_synch = True


def _resume_mode(task: Task) -> None:
    """The mode stays as it was while the machine was off, where motion can take it up without being homed anew."""
    if task.mode is Mode.MANUAL:
        return
    if task.motion.may_coordinate:
        task.motion.send(MotCommand.COORD)
    else:
        task.mode = Mode.MANUAL


def emergency_stop(task: Task, reason: Reason) -> None:
    """Stop everything and open the chain, whoever of motion and io still listens."""
    task.runner.abort(reason)
    _switch_off(task)
    task.io.send_first(EMC_AUX_ESTOP_ON(), EMC_TOOL_ABORT(reason=reason), EMC_LUBE_OFF())


def shut_down(task: Task) -> None:
    """Task ends: the machine stops and is switched off, the parameters are on the disk."""
    emergency_stop(task, Reason.TASK_STATE_ESTOP)
    task.motion.send(MotCommand.SET_HEARTBEAT_TIMEOUT, timeout=0.0)
    if task.config.position_file is not None:
        task.motion.poll()
        positionfile.save(task.config.position_file, task.motion, len(task.config.joints))
    task.plan.close()
    task.runner.saver.close()


def _switch_off(task: Task) -> None:
    task.motion.send(MotCommand.DISABLE)
    task.runner.stop_spindles()


def left_on(task: Task, state: State) -> None:
    """The machine is no longer on, by order or by itself: nothing may go on."""
    task.motion.send(MotCommand.ABORT)
    task.results.homing_aborted()
    if task.busy_with_program:
        task.runner.abort(Reason.AUX_ESTOP if state is State.ESTOP else Reason.TASK_STATE_NOT_ON)
    if state is State.ESTOP:
        emergency_stop(task, Reason.AUX_ESTOP)
    else:
        _switch_off(task)
    if any(joint.volatile_home for joint in task.config.joints):
        task.motion.send(MotCommand.JOINT_UNHOME, joint=UNHOME_VOLATILE)


def set_mode(task: Task, mode: int) -> None:
    """EMC_TASK_SET_MODE."""
    if mode not in list(Mode):
        raise Refused(f"EMC_TASK_SET_MODE: {mode} is no mode; 1 manual, 2 auto, 3 MDI are")
    wanted = Mode(mode)
    if task.mode is Mode.AUTO and wanted is not Mode.AUTO and task.interp_state is not Interp.IDLE:
        raise Refused("Can't switch mode while mode is AUTO and interpreter is not IDLE")
    if wanted is task.mode and motion_suits(task, wanted):
        return
    if task.interp_state is not Interp.IDLE:
        task.runner.abort(Reason.TASK_ABORT)
    request_mode(task, wanted)


def request_mode(task: Task, wanted: Mode) -> None:
    """Bring motion into the mode's way of moving, then change the mode."""
    if wanted is not Mode.MANUAL:
        task.motion.send(MotCommand.COORD)
    else:
        choose_jogs(task, axes=task.motion.all_homed)
    task.mode = wanted
    task.plan.must_synch = True
    task.plan.forget_line()
    task.status.forget_line(task.motion.status.id)
    if task.state is State.ON:
        complaint = f"motion does not go into {wanted.name.lower()} mode"
        task.expect(lambda: motion_suits(task, wanted) or task.motion.refused_last, complaint)


def choose_jogs(task: Task, *, axes: bool) -> None:
    """Jogs move axes, or single joints; a machine that is off will do so when it is on."""
    task.motion.send(MotCommand.TELEOP if axes else MotCommand.FREE)
    task.status.jogs_when_on(TrajMode.TELEOP if axes else TrajMode.FREE)


def motion_suits(task: Task, mode: Mode) -> bool:
    """Does motion move in the way that the mode begins with? A homed machine jogs axes until joints are asked for."""
    state = task.motion.state
    if mode is Mode.MANUAL:
        return state is MotionState.TELEOP or (state is MotionState.FREE and not task.motion.all_homed)
    return state is MotionState.COORD
