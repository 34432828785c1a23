"""Whether a partner of task, motion or io, still writes its status; asked by the supervisor in every cycle.

Silence counts only while task is awake to hear it: on a computer that stood still for a second everybody was silent,
and who runs first afterwards must not take the others for dead.
"""

from __future__ import annotations

import math

from nml import clock
from nml.channel import Channel

DEAD_S = 0.85  # host time without a new status after which a partner counts as gone
LONGEST_LOOK_S = 0.05  # host time between two looks that counts; more of it task was held up itself


class SignOfLife:
    """The age of a partner's status, without the time in which task did not look."""

    def __init__(self, status: Channel) -> None:
        self._status = status
        self._looked = clock.host_now()
        self._silence = math.inf  # s; until the first look a status may be one of long ago

    def seen(self) -> bool:
        """Does the partner still write?"""
        now, age = clock.host_now(), self._status.age()
        awake, self._looked = min(now - self._looked, LONGEST_LOOK_S), now
        self._silence = math.inf if age is None else min(age, self._silence + awake)
        return self._silence < DEAD_S
