"""[DISPLAY] and its neighbours as the page gets them."""

import pytest

from gui.web import displaykeys, settings
from nml.errors import ConfigError
from nml.inifile import IniFile

BASE = """
[TRAJ]
COORDINATES = {coordinates}
LINEAR_UNITS = {units}
MAX_LINEAR_VELOCITY = 100
[KINS]
JOINTS = {joints}
KINEMATICS = trivkins coordinates={letters}
[DISPLAY]
"""


@pytest.fixture
def ini(tmp_path):
    """Makes an INI file: lines of [DISPLAY] and, behind them, other sections."""

    def make(text="", coordinates="X Y Z", units="mm"):
        letters = coordinates.replace(" ", "")
        path = tmp_path / "a.ini"
        base = BASE.format(coordinates=coordinates, units=units, joints=len(letters), letters=letters)
        path.write_text(base + text + "\n")
        return IniFile(path)

    return make


def configuration(ini):
    return displaykeys.configuration(ini, settings.read(ini))


def test_a_file_that_says_nothing_gets_the_usual_values(ini):
    found = configuration(ini())
    assert found["machine_type"] == "mill"
    assert found["cycle_time"] == 0.05
    assert found["increments"][0] == {"text": "continuous", "value": None}
    assert found["overrides"] == {"feed_max": 1.0, "rapid_max": 1.0}
    assert found["program_extensions"][0]["extensions"] == [".ngc", ".nc", ".tap"]


@pytest.mark.parametrize(
    ("text", "units", "values"),
    [
        ("INCREMENTS = 1 mm, 0.1 mm", "mm", [1.0, 0.1]),
        ("INCREMENTS = 1 in, 1/8 in, 1 mil", "mm", [25.4, 3.175, 0.0254]),
        ("INCREMENTS = 25.4 mm, 1", "inch", [1.0, 1.0]),
        ("INCREMENTS = continuous, 10um .5", "mm", [0.01, 0.5]),
    ],
)
def test_increments_may_mix_units(ini, text, units, values):
    found = configuration(ini(text, units=units))["increments"]
    assert [one["value"] for one in found[1:]] == pytest.approx(values)


@pytest.mark.parametrize("text", ["1 parsec", "1/0 mm", "..", "ten"])
def test_an_increment_that_is_none_is_named_with_its_line(ini, text):
    with pytest.raises(ConfigError, match=r"a\.ini:\d+.*INCREMENTS"):
        configuration(ini(f"INCREMENTS = {text}"))


@pytest.mark.parametrize(("text", "seconds"), [("100", 0.1), ("0.2", 0.2), ("1", 1.0), ("5000", 1.0), ("0", 0.02)])
def test_cycle_time_may_be_s_or_ms(ini, text, seconds):
    assert configuration(ini(f"CYCLE_TIME = {text}"))["cycle_time"] == seconds


@pytest.mark.parametrize(("text", "factor"), [("120", 1.2), ("1.2", 1.2), ("2", 2.0), ("50", 0.5)])
def test_overrides_may_be_percent(ini, text, factor):
    found = configuration(ini(f"MAX_FEED_OVERRIDE = {text}\nMAX_SPINDLE_0_OVERRIDE = {text}"))
    assert found["overrides"]["feed_max"] == pytest.approx(factor)
    assert found["spindles"][0]["max_override"] == pytest.approx(factor)


@pytest.mark.parametrize(
    ("text", "kind"),
    [("MACHINE_TYPE_HINT = LATHE", "lathe"), ("LATHE = 1", "lathe"), ("FOAM = yes", "foam"), ("", "mill")],
)
def test_the_machine_type_comes_from_its_hint_or_the_old_keys(ini, text, kind):
    assert configuration(ini(text))["machine_type"] == kind


def test_an_unknown_machine_type_is_refused(ini):
    with pytest.raises(ConfigError, match="mill, lathe, foam"):
        configuration(ini("MACHINE_TYPE_HINT = boat"))


def test_buttons_of_the_mdi_command_list_have_a_label_and_their_lines(ini):
    text = "[MDI_COMMAND_LIST]\nMDI_COMMAND_MACRO0 = G0 Z25;X0 Y0;Z0, Goto\\nUser\\nZero\nMDI_COMMAND_MACRO1 = M3 S100"
    first, second = configuration(ini(text))["mdi_commands"]
    assert first == {"index": 0, "label": "Goto\nUser\nZero", "commands": ["G0 Z25", "X0 Y0", "Z0"]}
    assert second["label"] == "M3 S100"


def test_only_addresses_become_tabs(ini):
    text = (
        "EMBED_TAB_NAME = Camera\nEMBED_TAB_COMMAND = http://cam.local:8000/\nEMBED_TAB_LOCATION = right\n"
        "EMBED_TAB_NAME = Panel\nEMBED_TAB_COMMAND = qtvcp panel\nEMBED_TAB_NAME = Evil\n"
        "EMBED_TAB_COMMAND = javascript:alert(1)"
    )
    assert configuration(ini(text))["embed_tabs"] == [
        {"name": "Camera", "url": "http://cam.local:8000/", "location": "right"}
    ]


def test_a_gantry_has_two_joints_for_one_axis(ini):
    found = configuration(ini(coordinates="X Y Y Z"))
    assert [axis["letter"] for axis in found["axes"]] == ["X", "Y", "Z"]
    assert found["axes"][1]["joints"] == [1, 2]
    assert found["joints"][3]["axis"] == "Z"


def test_filters_and_extensions_come_from_their_section(ini):
    text = "[FILTER]\nPROGRAM_EXTENSION = .png,gif Images\npng = image-to-gcode"
    found = configuration(ini(text))
    assert found["program_extensions"] == [{"extensions": [".png", ".gif"], "text": "Images"}]
    assert found["filters"] == [".png"]


def test_a_program_folder_that_is_not_there_is_said(ini):
    with pytest.raises(ConfigError, match="no such folder"):
        configuration(ini("PROGRAM_PREFIX = nowhere"))


def test_geometry_is_carried_out_from_right_to_left(ini):
    assert displaykeys.geometry(ini("GEOMETRY = XY-Z")) == [{"steps": [["Z", -1], ["Y", 1], ["X", 1]], "height": 0.0}]
    assert displaykeys.geometry(ini("GEOMETRY = !CXYB")) == [{"steps": [["Y", 1], ["X", 1]], "height": 0.0}]
    with pytest.raises(ConfigError, match=r"GEOMETRY.*XYQ"):
        displaykeys.geometry(ini("GEOMETRY = XYQ"))


def test_a_foam_cutter_is_shown_in_two_planes(ini):
    parts = displaykeys.geometry(ini("MACHINE_TYPE_HINT = foam\nGEOMETRY = XY;UV", "X Y U V"))
    assert [("".join(letter for letter, _ in part["steps"]), part["height"]) for part in parts] == [
        ("XY", 0.0), ("UV", 1.5),
    ]  # fmt: skip


def test_grids_are_given_as_increments_are(ini):
    assert [grid["value"] for grid in displaykeys.grids(ini("GRIDS = 5 mm, 1/2 in"), 1.0)] == [5.0, 12.7]
    assert len(displaykeys.grids(ini(), 1.0)) == 8


def test_an_icon_that_browsers_show_goes_with_the_page(ini, tmp_path):
    assert displaykeys.icon(ini("ICON = none.png")) is None
    (tmp_path / "shop.png").write_bytes(b"\x89PNG")
    assert displaykeys.icon(ini("ICON = shop.png")) == "data:image/png;base64,iVBORw=="
    assert displaykeys.icon(ini("ICON = shop.xpm")) is None
