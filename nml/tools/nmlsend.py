"""nmlsend MESSAGE [FIELD=VALUE ...]: sends a command and says what became of it.

    nmlsend EMC_TASK_SET_STATE state=4
    nmlsend EMC_TASK_PLAN_EXECUTE command="G0 X1"
    nmlsend EMC_TRAJ_SET_G92 origin=1,2,3,0,0,0,0,0,0

Exit code 0: done; 1: the command failed; 2: it could not be sent; 3: not done in time.
"""

from __future__ import annotations

import argparse
import sys

from nml import clock
from nml.channel import Channel
from nml.config import NmlConfig
from nml.emc.constants import RCS_STATUS
from nml.errors import PyemcError
from nml.message import Message, Status
from nml.tools.paths import common_arguments, configuration, flat, message_class, observe, put

STATUS_OF = {"emcCommand": "emcStatus", "toolCmd": "toolSts"}
"""Where the answer to a command of a buffer stands."""


def main(argv: list[str] | None = None) -> int:
    """Send one command."""
    arguments = _arguments(argv)
    try:
        config = configuration(arguments)
        message = build(arguments.message, arguments.fields)
        return send(config, message, arguments)
    except PyemcError as error:
        print(error, file=sys.stderr)
        return 2


def build(name: str, assignments: list[str]) -> Message:
    """The message that the command line describes."""
    message = message_class(name)()
    for assignment in assignments:
        path, equals, text = assignment.partition("=")
        if not equals:
            raise PyemcError(f"{assignment!r} is no FIELD=VALUE")
        put(message, path, text)
    return message


def send(config: NmlConfig, message: Message, arguments: argparse.Namespace) -> int:
    """Write the message and wait for the answer, if one is to be expected."""
    answers = STATUS_OF.get(arguments.buffer)
    with Channel(config, arguments.buffer, arguments.process) as channel:
        if answers is None or arguments.timeout <= 0.0:
            print(f"{type(message).__name__} sent, number {channel.write(message)}")
            return 0
        with observe(config, answers, "nmlsend") as status, observe(config, "emcError", "nmlsend") as texts:
            while texts.read() is not None:
                pass
            number = channel.write(message)
            result = wait_for_answer(status, number, arguments.timeout)
            while (text := texts.read()) is not None:
                print(*(value for _, value in flat(text) if isinstance(value, str) and value), file=sys.stderr)
    if result in (None, RCS_STATUS.RCS_EXEC):
        what = "no answer" if result is None else "taken, but not done"
        print(f"{type(message).__name__} number {number}: {what} within {arguments.timeout} s", file=sys.stderr)
        return 3
    assert result is not None
    print(f"{type(message).__name__} number {number}: {result.name.removeprefix('RCS_').lower()}")
    return 0 if result is RCS_STATUS.RCS_DONE else 1


def wait_for_answer(status: Channel, number: int, timeout: float) -> RCS_STATUS | None:
    """How the command ended; within ``timeout`` s of host time RCS_EXEC if it was only taken, None if not even that."""
    reached = None
    end = clock.host_now() + timeout
    while (left := end - clock.host_now()) > 0.0:
        answer = status.read()
        if not isinstance(answer, Status):
            status.wait(left)
            continue
        if answer.echo_serial_number > number:
            return RCS_STATUS.RCS_DONE
        if answer.echo_serial_number == number and answer.status in (RCS_STATUS.RCS_DONE, RCS_STATUS.RCS_ERROR):
            return RCS_STATUS(answer.status)
        if answer.echo_serial_number == number:
            reached = RCS_STATUS.RCS_EXEC
    return reached


def _arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="nmlsend", description="Send a command and say what became of it.")
    common_arguments(parser)
    parser.add_argument("message", help="name or number of the message, e.g. EMC_TASK_ABORT")
    parser.add_argument("fields", nargs="*", metavar="FIELD=VALUE")
    parser.add_argument("--buffer", default="emcCommand")
    parser.add_argument("--process", default="xemc", help="whose line of the NML file to use")
    parser.add_argument("--timeout", type=float, default=5.0, help="s to wait for the answer; 0: do not wait")
    return parser.parse_args(argv)


if __name__ == "__main__":
    sys.exit(main())
