"""Which process a number and a start time stand for."""

from __future__ import annotations

import os
import subprocess
import sys

from hal.process import alive, own_identity, start_time


def test_a_process_that_ended_before_its_start_was_noted_is_not_alive() -> None:
    child = subprocess.Popen([sys.executable, "-c", ""])
    os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)
    noted = start_time(child.pid)
    assert not alive(child.pid, noted)
    child.wait()
    assert not alive(child.pid, noted)


def test_this_process_is_alive_and_its_number_with_another_start_is_not() -> None:
    pid, start = own_identity()
    assert alive(pid, start)
    assert not alive(pid, start + 1)
