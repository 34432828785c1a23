"""The thread that writes the parameter file: a folder where nothing can be written is told once, not at each line."""

import threading

from emctask.saver import Saver
from tests.support.machine import PATIENCE, wait_until

FULL, READ_ONLY = OSError(28, "No space left on device"), OSError(30, "Read-only file system")


class Disk:
    """Where a saver writes; fails as it is told."""

    def __init__(self) -> None:
        self.failure: OSError | None = None
        self.tries = threading.Semaphore(0)
        self.saver = Saver(self._save)

    def _save(self) -> None:
        self.tries.release()
        if self.failure is not None:
            raise self.failure

    def write(self, failure: OSError | None) -> None:
        """Have one write tried, which fails as said."""
        self.failure = failure
        self.saver.request()
        assert self.tries.acquire(timeout=PATIENCE)

    def told(self) -> str:
        """The failure that is told, waited for."""
        wait_until(lambda: self.saver.failure, "a failure")
        return self.saver.take_failure()


def test_a_failure_that_lasts_is_told_once(caplog):
    disk = Disk()
    disk.write(READ_ONLY)
    assert "Read-only file system" in disk.told()
    for _ in range(3):
        disk.write(READ_ONLY)
    disk.saver.close()
    assert (disk.saver.take_failure(), caplog.text) == ("", "")


def test_another_failure_is_told_and_the_same_one_after_a_success(caplog):
    disk = Disk()
    disk.write(READ_ONLY)
    assert "Read-only file system" in disk.told()
    disk.write(FULL)
    assert "No space left" in disk.told()
    disk.write(None)
    disk.write(FULL)
    assert "No space left" in disk.told()
    disk.failure = None
    disk.saver.close()
    assert (disk.saver.take_failure(), caplog.text) == ("", "")


def test_a_failure_at_the_end_which_no_operator_hears_is_logged(caplog):
    disk = Disk()
    disk.failure = FULL
    disk.saver.close()
    assert "No space left" in caplog.text
