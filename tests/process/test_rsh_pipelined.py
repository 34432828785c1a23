"""linuxcncrsh fed by a pipe, as ``nc`` does it: all lines at once, the replies in their order, and an end to it."""

import socket

import pytest

from tests.support.machine import copy_mill, running, traces

pytestmark = pytest.mark.process

BLOCKS = 60

PREPARE = """
hello EMC pipe 1.1
set echo off
set enable EMCTOO
set verbose on
set mode mdi
set estop off
set machine on
set mode manual
set joint_home 0
set joint_wait_homed 0
set joint_home 1
set joint_wait_homed 1
set joint_home 2
set joint_wait_homed 2
get joint_homed
get teleop_enable
set mode mdi
set probe 0 0 0
get error
set mdi f600
set mdi g1 x3 y2
get abs_act_pos x
set wait_heartbeat 5
set spindle forward
get spindle
set spindle off -1
get spindle
""".strip().splitlines()

REPLIES = """
HELLO ACK EMCNETSVR 1.1
set echo off
SET VERBOSE ACK
error: Machine must be 'ON' for SET MODE
SET MODE NAK
SET ESTOP ACK
SET MACHINE ACK
SET MODE ACK
SET JOINT_HOME ACK
SET JOINT_WAIT_HOMED ACK
SET JOINT_HOME ACK
SET JOINT_WAIT_HOMED ACK
SET JOINT_HOME ACK
SET JOINT_WAIT_HOMED ACK
JOINT_HOMED YES YES YES
TELEOP_ENABLE ON
SET MODE ACK
SET PROBE NAK
ERROR Cannot probe with zero feed rate
SET MDI ACK
SET MDI ACK
ABS_ACT_POS X 3.000000
SET WAIT_HEARTBEAT ACK
SET SPINDLE ACK
SPINDLE 0 FORWARD
SET SPINDLE ACK
SPINDLE 0 OFF
""".strip().splitlines()


def test_lines_that_come_all_at_once_are_answered_in_their_order(tmp_path):
    folder = tmp_path / "codes"
    folder.mkdir()
    program = folder / "M100"
    program.write_text(f'#!/bin/sh\necho "$1 $2" >> {tmp_path}/called\n')
    program.chmod(0o755)
    ini = copy_mill(tmp_path)
    ini.write_text(ini.read_text().replace("[RS274NGC]\n", f"[RS274NGC]\nUSER_M_PATH = {folder}\n"))
    blocks = [f"set mdi m100 p{number} q-1" for number in range(BLOCKS)]
    with running(ini, speed=10.0) as run:
        with socket.create_connection(("localhost", run.port()), timeout=60) as sock:
            sock.sendall("".join(f"{line}\n" for line in [*PREPARE, *blocks, "shutdown"]).encode())
            sock.shutdown(socket.SHUT_WR)
            heard = b"".join(iter(lambda: sock.recv(65536), b"")).decode().splitlines()
        assert run.finish() == 0
    assert heard == [*REPLIES, *["SET MDI ACK"] * BLOCKS, "SHUTDOWN ACK"]
    called = (tmp_path / "called").read_text().split()
    assert [float(word) for word in called[::2]] == list(range(BLOCKS))
    assert traces() == []
