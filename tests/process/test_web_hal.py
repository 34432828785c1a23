"""HAL seen and set through the web display, its scope, and the questions that HAL pins ask."""

import subprocess
import sys

import numpy as np
import pytest

import hal
from nml import namespace
from tests.support.machine import PATIENCE, wait_until
from tests.support.webclient import Refused, WebClient, shared_web_mill

pytestmark = pytest.mark.process

WEB = "[WEB]\nHAL_WRITE = yes"
QUESTIONS = {
    "DISPLAY.CYCLE_TIME": "0.05\n"
    "MESSAGE_BOLDTEXT = Door\nMESSAGE_TEXT = The door is open\nMESSAGE_DETAILS = Close it\n"
    "MESSAGE_TYPE = yesnodialog status\nMESSAGE_PINNAME = door\n"
    "MULTIMESSAGE_ID = VFD\nMULTIMESSAGE_VFD_NUMBER = 3\nMULTIMESSAGE_VFD_TYPE = okdialog\n"
    "MULTIMESSAGE_VFD_TITLE = Drive\nMULTIMESSAGE_VFD_TEXT = Too hot"
}
CHANGER = """
loadusr -W hal_manualtoolchange
unlinkp iocontrol.0.tool-change
unlinkp iocontrol.0.tool-changed
net change iocontrol.0.tool-change => hal_manualtoolchange.change
net changed hal_manualtoolchange.changed => iocontrol.0.tool-changed
net number iocontrol.0.tool-prep-number => hal_manualtoolchange.number
"""


@pytest.fixture(scope="module")
def mill(tmp_path_factory):
    with shared_web_mill(tmp_path_factory.mktemp("mill"), extra=WEB, changes=QUESTIONS, hal=CHANGER) as mill:
        yield mill


@pytest.fixture
def page(mill, monkeypatch):
    name, port = mill
    monkeypatch.setenv(namespace.VARIABLE, name)
    with WebClient(port) as page:
        yield page


def shown(page, kind):
    return [frame for frame in page.frames if frame["t"] == kind]


def start_scope(page, **order):
    """Start a scope; that of the page before may still be about to end."""

    def started():
        try:
            page.call("scope.start", **order)
        except Refused as refused:
            if refused.code != "busy":
                raise
            return False
        return True

    wait_until(started, "the scope is free")


def halcmd(*words):
    subprocess.run([sys.executable, "-P", "-m", "hal.halcmd", *words], check=True, timeout=PATIENCE)


def test_the_tree_shows_what_there_is_and_filters_it(page):
    found = page.call("hal.tree", filter="joint.0 motor-pos-cmd")
    assert found["total"] == 1
    assert found["items"][0] | {"value": 0.0} == {
        "name": "joint.0.motor-pos-cmd", "kind": "pin", "type": "float", "dir": "OUT", "signal": "x-position",
        "owner": "motmod", "value": 0.0, "writable": False,
    }  # fmt: skip
    assert {item["kind"] for item in page.call("hal.tree", kinds=["sig"])["items"]} == {"sig"}


def test_watched_values_come_when_they_change(page):
    page.ready()
    page.call("mdi.run", text="G0 X0")
    page.call("hal.watch", names=["joint.0.pos-cmd", "x-position", "no.such"])
    page.call("mdi.run", text="G0 X7")
    page.wait(lambda _: any(frame["values"].get("joint.0.pos-cmd") == 7.0 for frame in shown(page, "hal")), "seen")
    assert any("x-position" in frame["values"] for frame in shown(page, "hal"))


def test_values_are_set_by_the_operator_in_control_and_nobody_else(page):
    halcmd("newsig", "lamp", "bit")
    with pytest.raises(Refused) as refused:
        page.call("hal.set", name="lamp", value=True)
    assert refused.value.code == "controls"
    page.take()
    page.call("hal.set", name="lamp", value=True)
    assert page.call("hal.tree", filter="lamp")["items"][0]["value"] is True
    with pytest.raises(Refused, match="drives it"):
        page.call("hal.set", name="joint.0.motor-pos-cmd", value=5.0)


def test_the_nets_name_writer_and_readers(page):
    nets = page.call("hal.nets", filter="estop-loop")
    assert nets["edges"] == [
        {
            "from": "iocontrol.0", "to": "iocontrol.0", "signal": "estop-loop",
            "from_pin": "iocontrol.0.user-enable-out", "to_pin": "iocontrol.0.emc-enable-in",
        }
    ]  # fmt: skip


def test_the_scope_triggers_in_the_servo_period_of_the_event(page):
    page.ready()
    page.call("mdi.run", text="G0 X0")
    pin = "joint.0.pos-cmd"
    start_scope(page, pins=[pin, "joint.0.vel-cmd"], samples=400, trigger={"pin": pin, "level": 5.0}, before=100)
    page.call("mdi.run", text="G1 F600 X20")
    page.wait(lambda _: shown(page, "scope"), "record")
    record = shown(page, "scope")[0]
    assert (record["text"], record["period"], record["done"]) == ("", 0.001, True)
    values = np.frombuffer(record["data"], "<f4").reshape(record["samples"], 2)
    assert values[99, 0] <= 5.0 < values[100, 0]


def test_a_scope_of_something_that_is_not_there_says_so(page):
    start_scope(page, pins=["no.such"])
    page.wait(lambda _: shown(page, "scope"), "answer")
    assert "no.such" in shown(page, "scope")[0]["text"]


def test_one_scope_at_a_time_and_it_ends_with_its_client(page):
    with WebClient(int(page.base.rpartition(":")[2])) as other:
        start_scope(other, pins=["joint.0.vel-cmd"], repeat=True)
        with pytest.raises(Refused) as refused:
            page.call("scope.start", pins=["joint.0.vel-cmd"])
        assert refused.value.code == "busy"
    start_scope(page, pins=["joint.0.vel-cmd"], samples=10)


def test_processes_buffers_and_threads_are_shown(page):
    found = page.call("system.processes")
    assert {"task", "io", "display"} <= {process["name"] for process in found["processes"]}
    assert "emcStatus" in {buffer["buffer"] for buffer in found["buffers"]}
    assert found["threads"][0]["name"] == "servo-thread"


def test_a_question_of_a_pin_is_answered_by_the_operator(page):
    page.take()
    halcmd("setp", "web.door", "1")
    page.wait(lambda state: state["dialogs"], "asked")
    dialog = page.state["dialogs"][0]
    assert (dialog["kind"], dialog["title"], dialog["text"]) == ("yesno", "Door", "The door is open")
    assert hal.get_value("web.door-waiting") is True
    page.call("dialog.answer", id=dialog["id"], answer=True)
    page.wait(lambda state: not state["dialogs"], "closed")
    wait_until(lambda: hal.get_value("web.door-response") is True and hal.get_value("web.door") is False, "answered")


def test_a_number_chooses_among_many_messages(page):
    page.take()
    halcmd("setp", "web.VFD", "3")
    page.wait(lambda state: state["dialogs"], "asked")
    dialog = page.state["dialogs"][0]
    assert dialog["text"] == "Too hot"
    page.call("dialog.answer", id=dialog["id"], answer=True)
    page.wait(lambda state: not state["dialogs"], "closed")


def test_a_manual_tool_change_waits_for_the_operator(page):
    page.ready()
    assert page.hello["config"]["manual_tool_change"]
    change = page.start("toolchange.load", tool=3)
    page.wait(lambda state: state["toolchange"] or change.done(), "asked")
    assert not change.done(), change.exception()
    assert page.state["toolchange"]["tool"] == 3
    assert page.state["tool_in_spindle"] != 3
    page.call("toolchange.confirm")
    change.result(PATIENCE)
    page.wait(lambda state: state["tool_in_spindle"] == 3 and state["toolchange"] is None, "changed")
