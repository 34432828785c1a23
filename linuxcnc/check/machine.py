"""Rules about the machine: kinematics, joints and axes fit together, and limits and speeds make sense."""

from __future__ import annotations

import re
from collections.abc import Iterator

from hal.components import names as component_names
from hal.finder import realtime_modules
from linuxcnc.check.base import Checked, finding, listed_coordinates, nearest
from linuxcnc.inikeys import family

AXES = "XYZABCUVW"
SHORTEST_NS, LONGEST_NS = 20_000, 20_000_000  # servo periods that a machine can be run with
FEWEST_PERIODS = 2.0  # in which a joint may come to its full speed
SLACK = 1e-9  # lu or au, by which an axis may exceed its joint: what inch and mm differ in by rounding


def kinematics(checked: Checked) -> Iterator[str]:
    """The kinematics module is there, and its letters are those of the machine."""
    text = checked.ini.find("KINS", "KINEMATICS")
    if text is None:
        return
    place = checked.place("KINS", "KINEMATICS")
    module = text.split()[0]
    known = [*component_names(), *realtime_modules()]
    if module not in known:
        near = nearest(module, known)
        right = f"did you mean {near}?" if near else "trivkins, for example, is there"
        yield finding(place, f"[KINS]KINEMATICS: there is no module {module}", right)
    letters = listed_coordinates(text)
    if module != "trivkins" or not letters or not checked.joints():
        return
    if len(letters) > len(checked.joints()):
        what = f"coordinates={letters} is for {len(letters)} joints, [KINS]JOINTS = {len(checked.joints())}"
        yield finding(place, what, "one letter for each joint is needed")
    if set(letters) != set(checked.axes()):
        what = f"coordinates={letters}, but [TRAJ]COORDINATES = {' '.join(checked.axes())}"
        yield finding(place, what, "the same letters are needed")


def joint_sections(checked: Checked) -> Iterator[str]:
    """Every joint has a section, and no section is beyond the last joint."""
    there, count = checked.ini.sections(), len(checked.joints())
    for number in checked.joints():
        if f"JOINT_{number}" not in there:
            what = f"[KINS]JOINTS = {count}, but there is no section [JOINT_{number}]"
            yield finding(checked.place("KINS", "JOINTS"), what, "one is needed")
    for section in there:
        match = re.fullmatch(r"JOINT_(\d+)", section)
        if match and count and int(match[1]) >= count:
            what = f"[{section}] is beyond [KINS]JOINTS = {count}"
            yield finding(checked.place(section), what, "leave it out or count it")


def axis_sections(checked: Checked) -> Iterator[str]:
    """Every axis has a section, and no section is for another axis."""
    there, axes = checked.ini.sections(), checked.axes()
    place = checked.place("TRAJ", "COORDINATES")
    for letter in dict.fromkeys(axes):
        if letter not in AXES:
            yield finding(place, f"[TRAJ]COORDINATES: {letter!r} is no axis", f"letters of {AXES} are allowed")
        elif f"AXIS_{letter}" not in there:
            yield finding(place, f"axis {letter} has no section [AXIS_{letter}]", "its limits are needed there")
    for section in there:
        if family(section) == "AXIS_L" and axes and section[-1] not in axes:
            what = f"axis {section[-1]} is not in [TRAJ]COORDINATES = {' '.join(axes)}"
            yield finding(checked.place(section), what, "leave the section out")


def limits(checked: Checked) -> Iterator[str]:
    """Limits leave room, and everything can move."""
    wanted = [f"AXIS_{letter}" for letter in dict.fromkeys(checked.axes())] + [f"JOINT_{n}" for n in checked.joints()]
    for section in wanted:
        if section not in checked.ini.sections():
            continue
        low, high = checked.number(section, "MIN_LIMIT"), checked.number(section, "MAX_LIMIT")
        if low is not None and high is not None and low >= high:
            what = f"[{section}]MIN_LIMIT = {low:g}"
            yield finding(checked.place(section, "MIN_LIMIT"), what, f"a number below MAX_LIMIT = {high:g} is needed")
        for key in ("MAX_VELOCITY", "MAX_ACCELERATION"):
            place, top = checked.place(section, key), checked.number(section, key)
            if key not in checked.ini.keys(section):
                yield finding(place, f"[{section}]{key} is missing, which means 1", "a number above 0 is needed")
            elif top is not None and top <= 0.0:
                yield finding(place, f"[{section}]{key} = {top:g} never moves", "a number above 0 is needed")


def axes_within_joints(checked: Checked) -> Iterator[str]:
    """Where each joint is an axis, no axis has more room or speed than its joint."""
    text = checked.ini.find("KINS", "KINEMATICS", "")
    if text.split()[:1] != ["trivkins"]:
        return
    for joint, letter in zip(checked.joints(), listed_coordinates(text) or AXES, strict=False):
        axis = f"AXIS_{letter}"
        for key, sign in (("MIN_LIMIT", -1.0), ("MAX_LIMIT", 1.0), ("MAX_VELOCITY", 1.0), ("MAX_ACCELERATION", 1.0)):
            wanted, there = checked.number(axis, key), checked.number(f"JOINT_{joint}", key)
            if wanted is not None and there is not None and sign * (wanted - there) > SLACK:
                what = f"[{axis}]{key} = {wanted:g} is more than joint {joint} has"
                bound = "most" if sign > 0 else "least"
                yield finding(checked.place(axis, key), what, f"at {bound} {there:g} is needed")


def homing(checked: Checked) -> Iterator[str]:
    """Homing ends inside the limits and measures its switch; following errors are in order."""
    for number in checked.joints():
        section = f"JOINT_{number}"
        home = checked.number(section, "HOME", 0.0) or 0.0
        low, high = checked.number(section, "MIN_LIMIT"), checked.number(section, "MAX_LIMIT")
        if low is not None and high is not None and low < high and not low <= home <= high:
            what = f"[{section}]HOME = {home:g} is outside the limits"
            yield finding(checked.place(section, "HOME"), what, f"from {low:g} to {high:g} is needed")
        if checked.number(section, "HOME_SEARCH_VEL") and not checked.number(section, "HOME_LATCH_VEL"):
            what = f"[{section}] searches its switch, but HOME_LATCH_VEL is 0"
            yield finding(checked.place(section, "HOME_SEARCH_VEL"), what, "a speed is needed")
        small, large = checked.number(section, "MIN_FERROR"), checked.number(section, "FERROR", 1.0)
        if small is not None and large is not None and small > large:
            what = f"[{section}]MIN_FERROR = {small:g}"
            yield finding(checked.place(section, "MIN_FERROR"), what, f"at most FERROR = {large:g} is needed")


def home_sequence(checked: Checked) -> Iterator[str]:
    """The order of homing begins with 0 or 1."""
    found = {joint: checked.number(f"JOINT_{joint}", "HOME_SEQUENCE") for joint in checked.joints()}
    numbers = {joint: abs(int(value)) for joint, value in found.items() if value is not None}
    if numbers and min(numbers.values()) > 1:
        joint = min(numbers, key=lambda one: numbers[one])
        what = f"the first HOME_SEQUENCE is {numbers[joint]}"
        yield finding(checked.place(f"JOINT_{joint}", "HOME_SEQUENCE"), what, "0, 1 or -1 is needed")


def periods(checked: Checked) -> Iterator[str]:
    """The base thread is the faster one."""
    servo, base = checked.number("EMCMOT", "SERVO_PERIOD"), checked.number("EMCMOT", "BASE_PERIOD")
    if servo and base and base > servo:
        what = f"[EMCMOT]BASE_PERIOD = {base:g}"
        yield finding(checked.place("EMCMOT", "BASE_PERIOD"), what, f"at most SERVO_PERIOD = {servo:g} is needed")


def servo_period(checked: Checked) -> Iterator[str]:
    """The servo period is one that machines have, and short beside what its joints do in one."""
    period_ns = checked.number("EMCMOT", "SERVO_PERIOD", 1e6)
    if not period_ns or period_ns <= 0.0:
        return
    place = checked.place("EMCMOT", "SERVO_PERIOD")
    what = f"[EMCMOT]SERVO_PERIOD = {period_ns:g} ns"
    if not SHORTEST_NS <= period_ns <= LONGEST_NS:
        yield finding(place, what, f"from {SHORTEST_NS} to {LONGEST_NS} is usual, 1000000 is a millisecond")
        return
    period = period_ns * 1e-9
    for number in checked.joints():
        section = f"JOINT_{number}"
        speed, rate = checked.number(section, "MAX_VELOCITY"), checked.number(section, "MAX_ACCELERATION")
        if speed and rate and speed < rate * period * FEWEST_PERIODS:
            right = f"at most {speed / (period * FEWEST_PERIODS):g} is needed, or a shorter period"
            said = f"[{section}]MAX_ACCELERATION = {rate:g} reaches full speed within {FEWEST_PERIODS:g} servo periods"
            yield finding(checked.place(section, "MAX_ACCELERATION"), said, right)
