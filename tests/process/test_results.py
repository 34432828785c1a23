"""Results of commands on a whole machine: what became of each, and the messages that belong to it alone."""

import asyncio
import threading
from collections import Counter
from collections.abc import Callable

import pytest

import hal
import linuxcnc
from linuxcnc.aio import Machine, Outcome, Result
from tests.support.desk import switched_on_and_homed
from tests.support.machine import PATIENCE, copy_mill, running

pytestmark = pytest.mark.process


@pytest.fixture
def mill(tmp_path):
    """A mill that is on, homed and in MDI mode."""
    with running(copy_mill(tmp_path), speed=10.0) as run:
        run.port()
        status, command = switched_on_and_homed()
        command.mode(linuxcnc.MODE_MDI)
        command.wait_complete()
        yield status


def test_two_clients_get_their_own_results_and_messages(mill):
    async def both():
        async with Machine() as one, Machine() as other:
            return await one.mdi("G1 X5"), await other.mdi("G1 Y Q bad"), await one.mdi("G0 X2 (MSG,from one)")

    no_feed, bad, told = asyncio.run(both())
    assert (no_feed.outcome, bad.outcome) == (Outcome.REFUSED, Outcome.REFUSED)
    assert told.outcome is Outcome.DONE
    assert len(no_feed.messages) == len(bad.messages) == 1
    assert no_feed.messages != bad.messages
    assert told.messages == ("from one",)
    assert len({no_feed.serial, bad.serial, told.serial}) == 3


def test_a_move_that_is_cut_short_by_somebody_else_is_aborted(mill):
    async def cut():
        async with Machine() as one, Machine() as other:
            dwell = asyncio.create_task(one.mdi("G4 P600"))
            await one.until(lambda status: status.delay_left > 0.0, PATIENCE)
            return await other.abort(), await dwell

    abort, dwell = asyncio.run(cut())
    assert abort.outcome is Outcome.DONE
    assert dwell.outcome is Outcome.ABORTED


def test_a_program_that_comes_to_a_wrong_line_has_failed(mill, tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94 F3000\nG1 X1\nG1 X20\nG4 P0.2\nG2 X30 Y0 I1 J0\nM2\n")

    async def run():
        async with Machine() as one:
            await one.mode(linuxcnc.MODE_AUTO)
            await one.program_open(str(part))
            return await one.auto(linuxcnc.AUTO_RUN, 0)

    result = asyncio.run(run())
    assert result.outcome is Outcome.FAILED
    assert any("Radius to end of arc differs" in message for message in result.messages)
    mill.poll()
    assert mill.position[0] == pytest.approx(20.0)


def test_what_io_says_of_an_order_belongs_to_its_result(mill, tmp_path):
    (tmp_path / "mill_mm.tbl").write_text("T1 P1 Zx\n")

    async def reload():
        async with Machine() as one:
            return await one.load_tool_table()

    result = asyncio.run(reload())
    assert result.outcome is Outcome.FAILED
    (message,) = result.messages
    assert "mill_mm.tbl:1: 'Zx' is no word of a tool table" in message


MANY: list[tuple[Callable[[linuxcnc.command], None], Outcome, str]] = [
    (lambda command: command.feedrate(0.5), Outcome.DONE, ""),
    (lambda command: command.text_msg("hello"), Outcome.DONE, "hello"),
    (lambda command: command.error_msg("look out"), Outcome.DONE, "look out"),
    (lambda command: command.home(0), Outcome.REFUSED, "EMC_JOINT_HOME"),
    (lambda command: command.jog(linuxcnc.JOG_INCREMENT, False, 0, 1.0, 1.0), Outcome.REFUSED, "EMC_JOG_INCR"),
    (lambda command: command.program_open("/no/such/file.ngc"), Outcome.REFUSED, "/no/such/file.ngc"),
    (lambda command: command.mdi("G0 X1000000"), Outcome.FAILED, "X"),
    (lambda command: command.mdi("G4 P0.05"), Outcome.DONE, ""),
    (lambda command: command.mode(77), Outcome.REFUSED, "77"),
    (lambda command: command.flood(1), Outcome.DONE, ""),
    (lambda command: command.mode(linuxcnc.MODE_MANUAL), Outcome.DONE, ""),
    (lambda command: command.teleop_enable(0), Outcome.DONE, ""),
    (lambda command: command.unhome(-1), Outcome.DONE, ""),
    (lambda command: command.jog(linuxcnc.JOG_CONTINUOUS, False, 0, 1.0), Outcome.REFUSED, "teleop"),
    (lambda command: command.home(-1), Outcome.DONE, ""),
    (lambda command: command.state(linuxcnc.STATE_OFF), Outcome.DONE, ""),
    (lambda command: command.flood(1), Outcome.REFUSED, "EMC_COOLANT_FLOOD_ON"),
    (lambda command: command.state(linuxcnc.STATE_ESTOP), Outcome.DONE, ""),
    (lambda command: command.state(linuxcnc.STATE_ON), Outcome.REFUSED, "E-stop"),
]


def test_what_becomes_of_an_order_one_after_the_other(mill):
    command = linuxcnc.command()
    for give, outcome, text in MANY:
        give(command)
        result = command.result(60.0)
        assert result.outcome is outcome, result
        assert len(result.messages) == bool(text), result
        assert not text or text in result.messages[0]


def test_a_joint_is_homed_when_the_order_is_done(mill):
    command = linuxcnc.command()
    command.mode(linuxcnc.MODE_MANUAL)
    command.result()
    command.teleop_enable(0)
    assert command.result()
    command.unhome(-1)
    assert command.result()
    command.home(-1)
    assert command.result(60.0)
    mill.poll()
    assert all(mill.homed[: mill.joints])


def test_a_setting_is_done_while_a_program_runs_and_the_program_when_it_has_ended(mill, tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21 G90 G94 F3000\nM66 P0 L3 Q100000\nG1 X1\nM2\n")  # goes on when the test has looked
    operator, pendant = linuxcnc.command(), linuxcnc.command()
    operator.mode(linuxcnc.MODE_AUTO)
    assert operator.result()
    operator.program_open(str(part))
    assert operator.result()
    operator.auto(linuxcnc.AUTO_RUN, 0)
    pendant.feedrate(0.7)
    assert pendant.result(60.0)
    mill.poll()
    assert mill.feedrate == 0.7
    assert operator.result(0.0) is None
    hal.set_p("motion.digital-in-00", "1")
    assert operator.result(60.0)
    mill.poll()
    assert mill.position[0] == pytest.approx(1.0)


def test_a_result_can_be_asked_for_late_and_twice_refused_clients_do_not_mix(mill):
    first, second = linuxcnc.command(), linuxcnc.command()
    first.mode(99)
    second.mode(98)
    later, sooner = second.result(60.0), first.result(60.0)
    assert "99" in sooner.messages[0]
    assert "98" in later.messages[0]


ROUNDS = 250
Check = Callable[[Result, int], None]


class Client(threading.Thread):
    """One of ten: gives its orders one after the other, and checks each result against what it sees and knows."""

    def __init__(self, number: int, kind: str, stop: threading.Event) -> None:
        super().__init__(name=f"{kind} {number}")
        self.number, self.kind, self.stop = number, kind, stop
        self.outcomes: Counter[Outcome] = Counter()
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            self.status, self.command = linuxcnc.stat(), linuxcnc.command()
            for turn in range(ROUNDS):
                if self.stop.is_set():
                    return
                give: Callable[[int], Check] = getattr(self, self.kind)
                check = give(turn)
                result = self.command.result(120.0)
                assert result is not None
                assert result.serial == self.command.serial
                self.outcomes[result.outcome] += 1
                check(result, turn)
        except BaseException as reason:
            self.failure = reason
            self.stop.set()

    def output(self, turn: int) -> Check:
        value = turn + 1
        self.command.mdi(f"M68 E{self.number} Q{value}")
        return self.seen(lambda: self.status.aout[self.number] == value, may_abort=True)

    def told(self, turn: int) -> Check:
        self.command.mdi(f"(MSG,{self.name} turn {turn}) G4 P0.001")
        return self.seen(lambda: True, may_abort=True, text=f"{self.name} turn {turn}")

    def feed(self, turn: int) -> Check:
        scale = 0.5 + turn / 1000.0
        self.command.feedrate(scale)
        return self.seen(lambda: self.status.feedrate == pytest.approx(scale))

    def wrong(self, turn: int) -> Check:
        self.command.mdi(f"O<none_{self.number}_{turn}> call")
        return self.refused(f"none_{self.number}_{turn}", may_abort=True)

    def forbidden(self, turn: int) -> Check:
        self.command.mode(1000 + turn)
        return self.refused(str(1000 + turn))

    def aborter(self, turn: int) -> Check:
        self.stop.wait(0.02)
        self.command.abort()
        return self.seen(lambda: True)

    def seen(self, effect: Callable[[], bool], *, may_abort: bool = False, text: str = "") -> Check:
        def check(result: Result, turn: int) -> None:
            assert result.outcome is Outcome.DONE or (may_abort and result.outcome is Outcome.ABORTED), result
            if result:
                self.status.poll()
                assert effect(), (self.name, turn, result)
                assert result.messages == ((text,) if text else ())
            else:
                assert set(result.messages) <= {text}

        return check

    def refused(self, token: str, *, may_abort: bool = False) -> Check:
        def check(result: Result, turn: int) -> None:
            if may_abort and result.outcome is Outcome.ABORTED:
                assert result.messages == ()
                return
            assert result.outcome is Outcome.REFUSED, result
            assert len(result.messages) == 1
            assert token in result.messages[0]

        return check


def test_ten_clients_at_once_get_the_right_result_for_each_of_thousands_of_orders(mill):
    stop = threading.Event()
    kinds = ["output"] * 3 + ["told"] * 2 + ["feed", "wrong", "forbidden", "forbidden", "aborter"]
    clients = [Client(number, kind, stop) for number, kind in enumerate(kinds)]
    for client in clients:
        client.start()
    for client in clients:
        client.join()
    assert [client.failure for client in clients if client.failure] == []
    assert sum(sum(client.outcomes.values()) for client in clients) == 10 * ROUNDS
    totals = sum((client.outcomes for client in clients), Counter())
    assert totals[Outcome.DONE] > ROUNDS
    assert totals[Outcome.REFUSED] >= 2 * ROUNDS
