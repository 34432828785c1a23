"""What each command does, by groups of the manual's chapter 4. Importing the package fills the command table."""

from __future__ import annotations

from emctask.handlers import io, jog, joint, operator, program, spindle, task, traj

LOADED = (io, jog, joint, operator, program, spindle, task, traj)
