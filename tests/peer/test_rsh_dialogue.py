"""linuxcncrsh beside Debian's: the same lines said to both, on machines with the same files, and the replies compared.

Debian's is 2.9, ours speaks as 2.10 does; ``CHANGED`` lists how 2.10 changed a reply, and its reasons before refusals
are left out. Not asked is what crashes Debian's: a spindle or INI word without arguments.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.support import stock_machine
from tests.support.compared import each_time
from tests.support.nml_server import free_port
from tests.support.stock_machine import needs_stock_machine

pytestmark = [pytest.mark.peer, pytest.mark.process, needs_stock_machine]

TALK = r'''
import socket

def start():
    return subprocess.Popen([*RSH, "--port", str(PORT), "--", "-ini", "machine.ini"], stdout=subprocess.DEVNULL)

def connect():
    end = time.time() + 60
    while True:
        try:
            return socket.create_connection(("127.0.0.1", PORT), 5)
        except OSError:
            assert time.time() < end, "linuxcncrsh does not listen"
            time.sleep(0.05)

def hear(sock, quiet):
    sock.settimeout(quiet)
    heard = b""
    try:
        while (data := sock.recv(65536)):
            heard += data
    except TimeoutError:
        pass
    return heard.decode("latin-1").replace("\r", "").splitlines()

server = start()
try:
    client = connect()
    for line in LINES:
        client.sendall(line.encode() + b"\r\n")
        heard = hear(client, 0.12)
        end = time.time() + 5
        while not heard and time.time() < end:
            heard = hear(client, 0.12)
        out.append([text for text in heard if text])
finally:
    server.terminate()
    server.wait()
'''

LINES = """
hello XX tester 1.0
hello EMC tester 1.0
get plat
set echo off
get echo
set verbose on
set estop off
set enable wrong
set enable EMCTOO
get enable
get comm_mode
get angular_unit_conversion
get linear_unit_conversion
get display_angular_units
get display_linear_units
get user_angular_units
get user_linear_units
get program_angular_units
get program_linear_units
get program_units
get kinematics_type
get config
get error
get operator_text
get operator_display
get estop
get machine
get mode
get mist
get flood
get lube
get lube_level
get program
get program_line
get program_status
get program_codes
get tool
get home
get jog
get joint_pos 0
get joint_homed 1
get joint_limit 2
get joint_fault 0
get joint_type 0
get joint_units 0
get bogus
set bogus 1
set set_wait done
get set_wait
set mode mdi
set estop off
get estop
set machine on
get machine
set mode manual
set home 0
set home 1
set home 2
set teleop_enable off
set jog 0 60
set jog_stop 0
set jog_incr 1 600 1.5
set jog 99 1
set teleop_enable on
set jog_incr y 600 -1.5
set jog x 60
set jog_stop x
set jog 0 1
set mode mdi
get mode
set mdi g21 g90 g0 x10 y5 z-3
get program_codes
set mdi g1 bad
get error
get error
set mist on
get mist
set mist off
set flood on
get flood
set flood maybe
set flood off
set spindle forward 0
get spindle 0
set spindle off 0
get spindle 0
set spindle sideways 0
set brake off 0
set feed_override 50
set feed_override 100
set feed_override abc
set optional_stop 1
set task_plan_init
set linear_unit_conversion inch
get display_linear_units
set linear_unit_conversion furlong
set linear_unit_conversion auto
set angular_unit_conversion grad
get display_angular_units
set angular_unit_conversion auto
set update none
set update auto
set wait done
set wait x
set timeout 5
set timeout 0
set comm_mode binary
set comm_mode ascii
set mode auto
set open part.ngc
set run
get program_status
get joint_pos 0
set abort
set mode manual
set machine off
get machine
set estop on
get estop
get error
set enable off
set estop off
""".strip().splitlines()

PREPARE = r'''
open("part.ngc", "w").write("G21 G90 F3000\nG0 X0 Y0\nG1 X5\nG1 Y5\nM2\n")
'''

# What 2.9 says, and 2.10 and ours say otherwise
CHANGED = {
    "get bogus": "GET NAK",
    "set bogus 1": "SET NAK",
    "get joint_units 0": "JOINT_UNITS 0 MM",  # 2.9 calls it JOINT_TYPE and repeats the type
}
REASONS = ("error: ", "warning: ")


def said(command: list[str], port: int) -> str:
    """The script with the command that starts a linuxcncrsh."""
    return f"{PREPARE}\nRSH = {command!r}\nPORT = {port}\nLINES = {LINES!r}\n{TALK}"


@each_time
def test_every_line_gets_the_stock_servers_reply(tmp_path: Path) -> None:
    theirs = stock_machine.display(said(["/usr/bin/linuxcncrsh"], 5107))
    ours = stock_machine.ours(tmp_path, said([sys.executable, "-m", "gui.linuxcncrsh"], free_port()))
    for line, stock, heard in zip(LINES, theirs, ours, strict=True):
        expected = [CHANGED[line]] if line in CHANGED else [" ".join(text.split()) for text in stock]
        assert [text for text in heard if not text.startswith(REASONS)] == expected, line
