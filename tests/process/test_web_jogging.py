"""Continuous jogs from the page end when anything between the operator's finger and the machine fails."""

import os
import signal
import time

import pytest

import linuxcnc
from tests.support.machine import processes, wait_until
from tests.support.webclient import Refused, WebClient, web_mill

pytestmark = pytest.mark.process

SPEED = 5.0  # mm/s
LONGEST_WAY = 40.0  # mm after the failure; generous, a jog that goes on passes it within seconds
STILL_SECONDS = 0.3  # of controller time


class Watch:
    """The position as a program without the server sees it."""

    def __init__(self) -> None:
        self.status = linuxcnc.stat()

    def x(self) -> float:
        self.status.poll()
        return self.status.position[0]

    def stands(self) -> bool:
        """Whether it stands still, seen over some time."""
        before = self.x()
        time.sleep(STILL_SECONDS)
        return self.x() == before and self.status.inpos


@pytest.fixture
def mill(tmp_path):
    with web_mill(tmp_path) as (run, port):
        run.web = port
        yield run


@pytest.fixture
def page(mill):
    with WebClient(mill.web) as page:
        page.ready()
        yield page


def start(page: WebClient, watch: Watch, velocity: float = SPEED) -> int:
    """A jog that is under way."""
    begin = watch.x()
    return page.jog_until(lambda: abs(watch.x() - begin) > 3.0, velocity, axis="X")


def comes_to_rest(watch: Watch) -> None:
    at = watch.x()
    wait_until(watch.stands, "at rest")
    assert abs(watch.x() - at) < LONGEST_WAY


def test_a_jog_goes_on_while_the_button_is_held_and_stops_with_it(page):
    watch = Watch()
    jog = page.jog_until(lambda: watch.x() > 10.0, SPEED, axis="X")
    page.call("jog.stop", jog=jog)
    comes_to_rest(watch)
    page.wait(lambda state: state["jog"] == [], "over")


def test_a_jog_runs_at_its_speed_without_stopping_between_increments(page):
    """On a busy computer a jog may be slowed down or end, but not at each increment: one quiet stretch will do."""
    watch = Watch()
    stretch = 0  # looks in a row in which it ran at its speed

    def ran() -> bool:
        nonlocal stretch
        watch.x()
        stretch = stretch + 1 if abs(watch.status.current_vel) > 0.9 * SPEED else 0
        return stretch > 20  # of 10 ms or more each, and an increment is extended every 40 ms

    page.jog_until(ran, SPEED, axis="X")


def test_no_beats_stop_the_jog(page):
    watch = Watch()
    jog = start(page, watch)
    page.let_go(jog)
    comes_to_rest(watch)


def test_a_network_that_falls_silent_stops_the_jog(page):
    watch = Watch()
    start(page, watch)
    page.cut()
    comes_to_rest(watch)


def test_a_closed_socket_stops_the_jog_and_frees_the_controls(mill):
    watch = Watch()
    with WebClient(mill.web) as other:
        with WebClient(mill.web) as page:
            page.ready()
            start(page, watch)
        comes_to_rest(watch)
        other.wait(lambda state: state["control"] is None, "controls are free")


def test_a_killed_server_stops_the_jog(mill, page):
    watch = Watch()
    page.let_go(start(page, watch))
    pid = mill.pids()["display"]
    os.kill(pid, signal.SIGSTOP)  # a server that hangs is no better
    comes_to_rest(watch)
    os.kill(pid, signal.SIGCONT)


def test_a_server_killed_in_mid_jog_leaves_a_machine_at_rest_by_its_own_increment(mill, page):
    watch = Watch()
    start(page, watch)
    at = watch.x()
    os.kill(mill.pids()["display"], signal.SIGKILL)
    mill.finish()
    assert mill.errors.count("killed by signal 9") == 1
    wait_until(lambda: processes() == [], "its workers end with it")
    assert abs(watch.x() - at) < LONGEST_WAY


def test_losing_the_controls_stops_the_jog(mill, page):
    watch = Watch()
    start(page, watch)
    with WebClient(mill.web, name="other") as other:
        other.call("control.take", force=True)
        comes_to_rest(watch)
        with pytest.raises(Refused) as refused:
            page.call("jog.start", axis="X", velocity=SPEED)
    assert refused.value.code == "controls"


def test_an_abort_of_another_program_stops_the_jog(page):
    watch = Watch()
    start(page, watch)
    linuxcnc.command().abort()
    comes_to_rest(watch)
    page.wait(lambda state: state["jog"] == [], "over")


def test_estop_by_an_operator_without_the_controls_stops_the_jog(mill, page):
    watch = Watch()
    start(page, watch)
    with WebClient(mill.web) as other:
        other.call("machine.estop")
    comes_to_rest(watch)
    wait_until(lambda: watch.status.poll() or watch.status.task_state == linuxcnc.STATE_ESTOP, "E-stop")


def test_a_jog_ends_at_the_soft_limit_without_an_error(page):
    watch = Watch()
    page.call("mdi.run", text="G0 X297")
    jog = page.jog_until(lambda: abs(watch.x() - 300.0) < 1e-6, SPEED, axis="X")
    page.call("jog.stop", jog=jog)
    assert [message for message in page.messages if message["kind"] == "error"] == []


def test_steps_add_up(page):
    watch = Watch()
    for _ in range(3):
        page.call("jog.step", axis="Y", velocity=20.0, distance=-0.5)
    wait_until(lambda: watch.x() == 0.0 and abs(watch.status.position[1] + 1.5) < 1e-9, "there")


def test_joints_are_jogged_before_homing(mill):
    with WebClient(mill.web) as page:
        page.take()
        page.call("machine.estop_reset")
        page.call("machine.power", on=True)
        page.jog_until(lambda: page.state["joint_position"][1] < -3.0, -SPEED, joint=1)
        page.call("jog.stop")
