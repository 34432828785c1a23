"""A whole machine operated through the web display's WebSocket, as its page does it."""

import numpy as np
import pytest

import linuxcnc
from tests.support.machine import PATIENCE, wait_until
from tests.support.webclient import Refused, WebClient, web_mill

pytestmark = pytest.mark.process

SQUARE = "G21 G90\nG0 X10\nG1 F6000 X20\nY10\nX10\nY0\nM2\n"
CORNERS = [(10.0, 0.0), (20.0, 0.0), (20.0, 10.0), (10.0, 10.0)]
LONG = "G21 G90 G1 F600\n" + "".join(f"X{k % 2 * 50}\n" for k in range(1, 40)) + "M2\n"


@pytest.fixture
def client(tmp_path):
    extra = "[MDI_COMMAND_LIST]\nMDI_COMMAND_A = G0 X3;G0 Y4,Go\\nthere"
    with web_mill(tmp_path, extra=extra, square=SQUARE, long=LONG) as (_, port), WebClient(port) as page:
        page.folder = tmp_path
        yield page


def test_a_page_switches_on_homes_and_shows_where_the_machine_is(client):
    client.ready()
    assert client.state["task_state"] == linuxcnc.STATE_ON
    client.call("mdi.run", text="G0 X12.5 Y-3")
    client.wait(lambda state: abs(state["work_position"][0] - 12.5) < 1e-9, "there")
    assert client.hello["config"]["axes"][0]["letter"] == "X"
    client.wait(lambda state: "G0" in state["gcode_text"], "the code of the line")


def test_touching_off_an_axis_moves_the_coordinate_system(client):
    client.ready()
    client.call("mdi.run", text="G0 X10")
    client.call("touchoff.axis", axis="X", value="2+1/2")
    client.wait(lambda state: abs(state["work_position"][0] - 2.5) < 1e-6, "touched off")
    assert client.call("offsets.read")["systems"][0]["offset"][0] == pytest.approx(7.5)
    client.call("offsets.write", system=3, values={"Y": 4.0, "R": 30.0})
    client.wait(lambda _: client.call("offsets.read")["systems"][2]["rotation"] == 30.0, "written")
    assert client.call("offsets.read")["systems"][2]["offset"][1] == pytest.approx(4.0)


def test_touching_off_a_tool_writes_the_tool_table(client):
    client.ready()
    client.call("toolchange.load", tool=1)
    client.wait(lambda state: state["tool_in_spindle"] == 1, "tool 1")
    client.call("mdi.run", text="G0 Z-20")
    client.call("touchoff.tool", axis="Z", value=5.0)
    client.wait(lambda state: abs(state["work_position"][2] - 5.0) < 1e-6, "touched off")
    client.wait(lambda _: client.call("tools.read")["tools"][0]["offset"][2] == pytest.approx(-25.0), "in the table")


def test_a_program_is_uploaded_opened_run_paused_and_aborted(client):
    client.ready()
    assert client.upload("mine.ngc", LONG) == 200
    client.call("program.open", path="mine.ngc")
    client.wait(lambda state: state["program"], "loaded")
    assert client.state["program"]["lines"] == LONG.count("\n")
    assert client.call("program.lines", first=1, count=2)["lines"] == ["G21 G90 G1 F600", "X50"]
    client.call("program.run")
    client.wait(lambda state: state["motion_line"] >= 2, "running")
    client.call("program.pause")
    client.wait(lambda state: state["interp_state"] == linuxcnc.INTERP_PAUSED, "paused")
    client.call("program.resume")
    client.wait(lambda state: state["interp_state"] != linuxcnc.INTERP_PAUSED, "on")
    client.call("override.feed", value=0.5)
    client.wait(lambda state: state["feedrate"] == 0.5, "override")
    client.call("machine.abort")
    client.wait(lambda state: state["interp_state"] == linuxcnc.INTERP_IDLE and state["inpos"], "aborted")


def test_a_program_that_cannot_start_is_refused_in_the_machines_words(client):
    client.take()
    client.call("machine.estop_reset")
    client.call("machine.power", on=True)
    client.call("program.open", path="square.ngc")
    client.wait(lambda state: state["program"], "loaded")
    assert not client.state["all_homed"]
    with pytest.raises(Refused, match="homed") as refused:
        client.call("program.run")
    assert refused.value.code == "machine"


def test_steps_execute_a_line_each(client):
    client.ready()
    client.call("program.open", path="square.ngc")
    watch, places = linuxcnc.stat(), []
    idle_or_held = (linuxcnc.INTERP_IDLE, linuxcnc.INTERP_PAUSED)
    for _ in range(20):
        before = watch.echo_serial_number
        client.call("program.step")
        wait_until(lambda before=before: watch.poll() or watch.echo_serial_number > before, "taken")
        wait_until(lambda: watch.poll() or (watch.inpos and watch.interp_state in idle_or_held), "stepped")
        places.append(tuple(round(place, 6) for place in watch.position[:2]))
        if watch.interp_state == linuxcnc.INTERP_IDLE:
            break
    assert list(dict.fromkeys(places))[-len(CORNERS) :] == CORNERS  # a line before them may be a stop too
    assert places[-1] == CORNERS[0]


def test_a_wrong_line_of_mdi_comes_back_with_the_machines_words(client):
    client.ready()
    with pytest.raises(Refused) as refused:
        client.call("mdi.run", text="G1 X5")
    assert refused.value.code == "machine"
    assert "zero feed" in refused.value.frame["text"]
    client.wait(lambda _: client.messages and client.messages[-1]["kind"] == "error", "the message for everybody")


def test_an_order_of_the_page_has_an_end_of_its_own_whatever_others_order_meanwhile(client):
    client.ready()
    watch, other = linuxcnc.stat(), linuxcnc.command()
    moving = client.start("mdi.run", text="G1 F1200 X20")
    wait_until(lambda: watch.poll() or watch.position[0] > 0.5, "under way")
    other.feedrate(1.0)
    assert other.result(PATIENCE)
    moving.result(PATIENCE)
    watch.poll()
    assert watch.position[0] == pytest.approx(20.0)
    moving = client.start("mdi.run", text="G1 F60 X-20")
    wait_until(lambda: watch.poll() or watch.position[0] < 19.9, "under way")
    other.abort()
    with pytest.raises(Refused) as refused:
        moving.result(PATIENCE)
    assert refused.value.code == "aborted"


def test_overrides_beyond_the_ini_files_limit_are_refused(client):
    client.ready()
    with pytest.raises(Refused, match="0 to 2"):
        client.call("override.feed", value=2.5)
    assert client.state["feedrate"] == 1.0


def test_spindle_and_coolant_obey(client):
    client.ready()
    client.call("spindle.on", speed=1200.0)
    client.wait(lambda state: state["spindle"][0]["speed"] == 1200.0, "spindle")
    client.wait(lambda state: state["spindle"][0]["actual_speed"] == pytest.approx(1200.0), "turns")
    client.wait(lambda state: state["spindle"][0]["at_speed"] is True, "at speed")
    client.call("spindle.off")
    client.call("coolant.flood", on=True)
    client.wait(lambda state: state["flood"] and state["spindle"][0]["direction"] == 0, "coolant")


def test_the_buttons_of_the_mdi_command_list_run_all_their_lines(client):
    client.ready()
    assert client.hello["config"]["mdi_commands"][0]["label"] == "Go\nthere"
    client.call("mdi.command", index=0)
    client.wait(lambda state: state["position"][:2] == [3.0, 4.0], "there")


def test_the_tool_table_is_written_as_a_whole_or_not_at_all(client):
    client.ready()
    table = client.call("tools.read")
    table["tools"][0]["diameter"] = 12.25
    fresh = client.call("tools.write", **table)
    assert client.call("tools.read")["tools"][0]["diameter"] == 12.25
    with pytest.raises(Refused) as refused:
        client.call("tools.write", **table)
    assert refused.value.code == "conflict"
    table["tools"].append(dict(table["tools"][0]))
    with pytest.raises(Refused, match="twice"):
        client.call("tools.write", version=fresh["version"], tools=table["tools"])


def test_the_editor_saves_and_notices_other_peoples_changes(client):
    read = client.call("program.read", path="square.ngc")
    version = client.call("program.save", path="square.ngc", text="M2\n", version=read["version"])["version"]
    with pytest.raises(Refused) as refused:
        client.call("program.save", path="square.ngc", text="M30\n", version=read["version"])
    assert refused.value.frame["version"] == version


def test_the_mdi_history_outlives_the_page(client):
    client.ready()
    client.call("mdi.run", text="G0 X1")
    assert client.call("mdi.history")[-1] == "G0 X1"


def test_the_preview_is_whole_and_comes_in_machine_coordinates(client):
    client.ready()
    client.call("path.subscribe")
    client.call("program.open", path="square.ngc")
    client.wait(lambda _: any(frame["t"] == "path_end" for frame in client.frames), "preview")
    end = next(frame for frame in client.frames if frame["t"] == "path_end")
    assert end["whole"], end
    client.wait(lambda state: state["preview"]["state"] == "whole", "published")


def test_a_wrong_program_is_a_part_and_says_so(client):
    client.ready()
    client.upload("wrong.ngc", "G21 G90 G0 X5\nG1 X10 (no feed)\nM2\n")
    client.call("path.subscribe")
    client.call("program.open", path="wrong.ngc")
    client.wait(lambda _: any(frame["t"] == "path_end" for frame in client.frames), "preview")
    end = next(frame for frame in client.frames if frame["t"] == "path_end")
    assert not end["whole"]
    assert "line 2" in end["text"]


def test_mdi_is_checked_from_where_the_machine_stands(client):
    client.ready()
    client.call("mdi.run", text="G0 X290 Y4")
    assert client.call("mdi.check", text="G91 G0 X5")["end"][:2] == [295.0, 4.0]
    assert client.call("mdi.check", text="G91 G0 X50")["outside"][0]["axis"] == "X"
    with pytest.raises(Refused) as refused:
        client.call("mdi.check", text="G1 X")
    assert refused.value.code == "gcode"
    client.wait(lambda state: state["position"][0] == 290.0 and state["inpos"], "still there")


def test_lines_are_checked_and_pictures_made_after_a_program_that_left_no_feed(client):
    client.ready()
    client.upload("short.ngc", "G21 G90 G0 X5\nM2\n")
    client.call("program.open", path="short.ngc")
    client.wait(lambda state: state["program"], "loaded")
    client.call("program.run")
    ended = {"interp_state": linuxcnc.INTERP_IDLE, "inpos": True, "position": [5.0] + [0.0] * 8}
    client.wait(lambda state: {key: state[key] for key in ended} == ended and "G1" in state["gcode_text"], "the end")
    assert client.call("mdi.check", text="G0 X7")["end"][0] == 7.0
    client.call("program.open", path="square.ngc")
    client.wait(lambda state: state["program"]["name"] == "square.ngc", "loaded")
    client.wait(lambda state: state["preview"]["state"] == "whole" and "square" in state["preview"]["file"], "picture")


def test_run_from_a_line_shows_the_difference_first(client):
    client.ready()
    client.upload("later.ngc", "G21 G90\nG55\nM3 S500\nG0 X5\nG1 F600 X10\nX20\nM2\n")
    client.call("program.open", path="later.ngc")
    client.wait(lambda state: state["program"], "loaded")
    with pytest.raises(Refused, match="difference"):
        client.call("program.run", line=5)
    check = client.call("program.run_from_check", line=5)
    assert {"G codes", "M codes", "position"} <= {one["what"] for one in check["differences"]}
    assert client.state["position"][0] == 0.0
    client.call("program.run", line=5, token=check["token"])
    client.wait(lambda state: state["position"][0] == 20.0, "ran")


def test_run_from_a_line_that_is_never_reached_is_blocked(client):
    client.ready()
    client.upload("short.ngc", "G21 G90\nM2\nG0 X5\n")
    client.call("program.open", path="short.ngc")
    client.wait(lambda state: state["program"], "loaded")
    check = client.call("program.run_from_check", line=3)
    assert check["blocked"]
    with pytest.raises(Refused):
        client.call("program.run", line=3, token=check["token"])


def test_a_file_with_a_filter_is_opened_as_what_the_filter_makes_of_it(tmp_path):
    extra = "[FILTER]\nPROGRAM_EXTENSION = .pts Points\npts = sed s/^/G0X/"
    with web_mill(tmp_path, extra=extra) as (_, port), WebClient(port) as page:
        assert page.upload("a.pts", "1\n2\n") == 200
        page.ready()
        page.call("program.open", path="a.pts")
        page.wait(lambda state: state["program"], "loaded")
        assert page.call("program.lines", first=1, count=9)["lines"] == ["G0X1", "G0X2"]


def test_post_gui_hal_files_find_the_displays_pins(tmp_path):
    post = "net door-open <= web.door\nsetp web.nothing 1\n"
    changes = {"DISPLAY.CYCLE_TIME": "50\nMESSAGE_TEXT = Door\nMESSAGE_TYPE = status\nMESSAGE_PINNAME = door"}
    with (
        web_mill(tmp_path, post=post, changes=changes) as (_, port),
        WebClient(port) as page,
    ):
        assert page.hello["config"]["cycle_time"] == 0.05
        assert page.call("hal.tree", filter="web.door")["items"][0]["signal"] == "door-open"
        assert "web.nothing" in page.hello["messages"][0]["text"]


def test_the_forecast_of_the_loaded_program_tells_when_each_line_is_done(client):
    client.ready()
    client.call("path.subscribe")
    client.call("program.open", path="square.ngc")
    client.wait(lambda _: any(frame["t"] == "forecast" for frame in client.frames), "forecast")
    frame = next(frame for frame in client.frames if frame["t"] == "forecast")
    lines, times = np.frombuffer(frame["lines"], "<u4"), np.frombuffer(frame["times"], "<f4")
    assert {3, 4, 5, 6} <= {*lines.tolist()}
    assert (np.diff(times) >= 0).all()
    assert frame["seconds"] == pytest.approx(times[-1], abs=0.01)
    client.wait(lambda state: state["forecast"]["state"] == "whole", "published")


def test_picture_and_forecast_begin_as_the_machine_stands(client):
    client.ready()
    client.call("mdi.run", text="F600")
    client.upload("bare.ngc", "G1 X10\nM2\n")
    client.call("program.open", path="bare.ngc")
    client.wait(lambda state: state["preview"]["state"] == "whole", "a whole picture, for the feed is the machine's")
    client.wait(lambda state: state["forecast"] and 1.0 < state["forecast"]["seconds"] < 1.2, "ten mm at this feed")
    client.call("mdi.run", text="G20")
    client.wait(lambda state: state["forecast"]["seconds"] > 25.0, "ten inches take longer")
