"""[TRAJ]POSITION_FILE: joint positions survive the controller's end, for machines without home switches.

One number a line, joint by joint, machine units, in LinuxCNC's layout. It is true only as long as nobody moves the
machine while the controller is off.
"""

from __future__ import annotations

import logging
import os
from pathlib import Path

from emctask.motion import MotionClient
from nml.emc.emcmot import MAX_JOINTS, MotCommand
from nml.errors import ConfigError, Place

log = logging.getLogger(__name__)


def restore(path: Path, motion: MotionClient, joints: int) -> None:
    """Tell motion where the joints stood; ConfigError for a file that is none. A file that is missing is made later."""
    if not path.exists():
        return
    for joint, position in enumerate(_read(path)[:joints]):
        motion.send(MotCommand.SET_JOINT_MOTOR_OFFSET, joint=joint, motor_offset=-position)


def _read(path: Path) -> list[float]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise ConfigError(f"the position file cannot be read: {error.strerror}", Place(str(path))) from None
    positions = []
    for number, line in enumerate(lines, 1):
        try:
            positions.append(float(line))
        except ValueError:
            raise ConfigError(f"{line!r}: one number in each line is needed", Place(str(path), number)) from None
    return positions


def save(path: Path, motion: MotionClient, joints: int) -> None:
    """Write where the joints stand, in one step; a disk that refuses is only logged, for the machine is ending."""
    states = motion.status.joint_status
    positions = [states[n].pos_fb if n < joints else 0.0 for n in range(MAX_JOINTS)]
    fresh = path.with_name(f".{path.name}.new")
    try:
        with fresh.open("w", encoding="utf-8") as stream:
            stream.write("".join(f"{position:.17f}\n" for position in positions))
            stream.flush()
            os.fsync(stream.fileno())
        fresh.replace(path)
    except OSError as error:
        log.error("%s: the position file cannot be written: %s", path, error.strerror)
