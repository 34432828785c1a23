"""Ctrl-C while the machine starts: one line, exit code 130, and nothing stays behind, at whichever instant it comes."""

import os
import re
import signal
import time
from pathlib import Path

import pytest

from tests.support.machine import Run, copy_mill, traces, wait_until

pytestmark = pytest.mark.process

TERMINATED = 1 << (signal.SIGTERM - 1)  # which Python itself leaves alone


def catches_signals(pid: int) -> bool:
    """Whether a process has come to its own first lines, and treats signals in its own way."""
    caught = re.search(r"^SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)
    return bool(caught and int(caught[1], 16) & TERMINATED)


@pytest.mark.parametrize("delay", [0.0, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3])
def test_ctrl_c_while_the_machine_starts_ends_it_with_one_line(tmp_path, delay):
    """Each delay falls into another step on a computer of another speed; the promise is the same in each."""
    run = Run(copy_mill(tmp_path))
    wait_until(lambda: catches_signals(run.process.pid), "its first lines")
    time.sleep(delay)
    os.killpg(run.process.pid, signal.SIGINT)
    assert run.finish() == 130
    assert (run.output, run.errors) == ("", "linuxcnc: stopped by SIGINT\n")
    wait_until(lambda: not traces(), "the end of everything")


def test_a_signal_whose_exception_python_drops_ends_the_start_at_its_next_wait(tmp_path):
    """As in a destructor, which no exception can leave."""
    startup = tmp_path / "sitecustomize.py"
    startup.write_text(
        "import os, signal\n"
        "class Deaf:\n"
        "    def __del__(self):\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "import argparse\n"
        "plain = argparse.ArgumentParser.parse_args\n"
        "def parse_args(*arguments):\n"
        "    Deaf()\n"
        "    return plain(*arguments)\n"
        "argparse.ArgumentParser.parse_args = parse_args\n"
    )
    ini = copy_mill(tmp_path)
    search_path = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH")]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", search_path)
        run = Run(ini)
    assert run.finish() == 130
    assert run.errors.endswith("linuxcnc: stopped by SIGINT\n")
    wait_until(lambda: not traces(), "the end of everything")
