"""Every declared component: its table fits its struct, and it loads, runs and goes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hal import components
from hal.components.declare import DECLARED, Declaration
from hal.realtime import Host
from nml.errors import HalError

FOLDER = Path(components.__file__).parent
components.names()  # imports the groups

STRUCT = re.compile(r"^cdef struct (\w+):\n((?:    .*\n)+)", re.M)
DECLARE = re.compile(r'^\s*declare\(f?"(\w+)".*?sizeof\((\w+)\)', re.M | re.S)


def structs() -> dict[str, list[tuple[str, int]]]:
    """By struct: (member, length or 0) of the pins it begins with."""
    found = {}
    for path in FOLDER.glob("*.p[xy][dx]"):
        text = path.read_text()
        lengths = dict(re.findall(r"^    ([A-Z_]+) = (\d+)$", text, re.M))
        for name, body in STRUCT.findall(text):
            members = []
            for line in body.splitlines():
                kind, _, rest = line.strip().partition(" ")
                if kind != "hal_pin":
                    break
                for part in rest.partition("#")[0].split(","):
                    member, _, length = part.strip().rstrip("]").partition("[")
                    members.append((member, int(lengths.get(length, length or "0"))))
            found[f"{path.stem}.{name}"] = members
    return found


def struct_of(declaration: Declaration) -> str | None:
    """The struct that a literal declaration names; None where it is made in a loop."""
    for path in FOLDER.glob("*.pyx"):
        for name, struct in DECLARE.findall(path.read_text()):
            if name == declaration.name:
                return f"{path.stem}.{struct}"
    return None


def plain(name: str) -> str:
    """A pin's or a member's name without numbers, dashes and underscores, which C and HAL spell differently.

    Where the pin's begins with a word of its own, as `A-value`, the member's begins with each_.
    """
    return re.sub(r"^each_|bit\.\{\}\.|-\{type\}|\{.*?\}|[-_.0-9]", "", name).lower()


SPECIAL = {
    "mux_generic": "bb2,fs3", "matrix_kb": "2x3,4x8s", "bldc": "qi6,aH", "charge_pump": "1", "thc": "1", "thcud": "1",
    "watchdog": "3", "plasmac": "1",
}  # fmt: skip
"""What `loadrt` is given where two instances, or sizes of 2 and 1, are not possible."""
LITERAL = sorted(name for name, declaration in DECLARED.items() if struct_of(declaration))


@pytest.mark.parametrize("name", LITERAL)
def test_the_table_names_the_members_of_the_struct_in_order(name: str) -> None:
    declaration = DECLARED[name]
    struct = struct_of(declaration)
    assert struct is not None
    members = []
    spelled_out = all(entry.count == 1 for entry in declaration.entries)
    for member, length in structs()[struct]:
        members += [member] * (length if spelled_out and length else 1)
    assert [plain(entry.name) for entry in declaration.entries] == [plain(member) for member in members]


@pytest.mark.parametrize("name", sorted(DECLARED))
def test_it_loads_runs_in_a_thread_and_unloads(host: Host, name: str) -> None:
    declaration = DECLARED[name]
    words = [f"{declaration.counted_by}={SPECIAL.get(name, '2,1' if declaration.sizes else '2')}"]
    host.load("threads", ["name1=t", "period1=100000"])
    host.load(name, words)
    functions = [funct.name for funct in host.hal.segment.functs()]
    for function in functions:
        host.add_function(function, "t")
    host.hal.start_threads()
    thread = host.hal.segment.find_thread("t")
    assert thread is not None
    seen = thread.cycles
    while thread.cycles < seen + 3:
        pass
    host.unload(name)
    assert functions
    assert host.hal.segment.functs() == []
    assert [pin.name for pin in host.hal.segment.items(0)] == ["t.threadbeat", "t.time"]


@pytest.mark.parametrize("name", sorted(DECLARED))
def test_names_become_instances(host: Host, name: str) -> None:
    if DECLARED[name].sizes or not DECLARED[name].takes_names or DECLARED[name].most == 1:
        pytest.skip("its instances are counted by a list, have no names of their own, or there is one only")
    personality = [] if DECLARED[name].personality is None else ["personality=0x1F02,0x1F02"]
    host.load(name, ["names=one,two", *personality])
    owners = {pin.name.split(".")[0] for pin in host.hal.segment.items(0) if not pin.name.endswith(".time")}
    assert owners == {"one", "two"}


def test_every_component_has_a_text() -> None:
    assert [name for name, declaration in DECLARED.items() if not declaration.doc] == []


def test_names_without_any_name_are_not_given_or_refused(host: Host) -> None:
    host.load("or2", ["names="])
    assert host.hal.find("or2.0.out") is not None
    with pytest.raises(HalError, match="pid: names=: at least one name"):
        host.load("pid", ["names="])
    with pytest.raises(HalError, match="and2: names=,: at least one name"):
        host.load("and2", ["names=,"])


def test_more_names_than_channels_are_refused(host: Host) -> None:
    with pytest.raises(HalError, match="9 names; up to 8 are possible"):
        host.load("encoder", ["names=" + ",".join(f"e{n}" for n in range(9))])
    assert host.hal.segment.find_comp("encoder") is None


@pytest.mark.parametrize(("name", "made"), [("encoder", 3), ("pid", 3), ("siggen", 1)])
def test_no_channels_are_the_usual_number_where_names_are_possible(host: Host, name: str, made: int) -> None:
    host.load(name, ["num_chan=0"])
    assert len({p.name.split(".")[1] for p in host.hal.segment.items(0) if p.name[len(name) + 1].isdigit()}) == made


def test_no_channels_are_refused_where_names_are_not_possible(host: Host) -> None:
    with pytest.raises(HalError, match="num_chan=0: from 1 to 8 would be right"):
        host.load("counter", ["num_chan=0"])
