"""Every member of every message against LinuxCNC's own classes, as g++ lays them out with Debian's headers."""

import shutil
import subprocess
from pathlib import Path

import pytest

import nml.emc
from nml.fields import Field
from nml.message import Message, Status, Struct, registry

HEADERS = Path("/usr/include/linuxcnc/emc_nml.hh")
NOT_IN_HEADERS = {"EMC_CALL_STACKS", "EMC_ORDER_NOTE", "EMC_ORDER_RESULT", "EMC_TOOL_TABLE"}
HIDDEN = {"base_spindle"}
"""Members of a base class that C++ knows under the name of a member of the derived one."""
TYPES = [
    cls
    for _, cls in sorted(registry.items())
    if getattr(nml.emc, cls.__name__, None) is cls and cls.__name__ not in NOT_IN_HEADERS
]

pytestmark = [
    pytest.mark.peer,
    pytest.mark.skipif(not HEADERS.exists(), reason="Debian's linuxcnc-uspace-dev is not installed"),
    pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler"),
]


def members(cls: type[Struct]) -> list[Field]:
    """The members whose address C++ can take by name."""
    names = [field.name for field in cls.FIELDS]
    return [
        field
        for field in cls.FIELDS
        if field.part != "header" and names.count(field.name) == 1 and field.name not in HIDDEN
    ]


def test_sizes_and_offsets_are_those_of_linuxcncs_classes(tmp_path: Path):
    boost = tmp_path / "boost"
    boost.mkdir()
    (boost / "noncopyable.hpp").write_text("namespace boost { class noncopyable {}; }\n")
    headers = ("<cstddef>", "<cstdio>", '"emc_nml.hh"', '"nml_oi.hh"')
    source = [*(f"#include {header}" for header in headers), "int main() {"]
    expected = []
    for cls in TYPES:
        name = cls.__name__
        source.append(f'printf("{name} %zu\\n", sizeof({name}));')
        expected.append(f"{name} {cls.SIZE}")
        for field in members(cls):
            source.append(f'printf("{name}.{field.name} %zu\\n", offsetof({name}, {field.name}));')
            expected.append(f"{name}.{field.name} {field.offset}")
    source.append("}")
    (tmp_path / "layout.cc").write_text("\n".join(source))
    include = ["-I", str(tmp_path), "-I", str(HEADERS.parent)]
    program = tmp_path / "layout"
    subprocess.run(["g++", "-w", "-DULAPI", *include, "-o", program, tmp_path / "layout.cc"], check=True)
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    assert printed == expected


def test_the_header_and_preambles_stand_where_linuxcnc_has_them():
    offsets = {field.name: field.offset for field in Status.FIELDS}
    assert offsets == {
        "nml_type": 0,
        "nml_size": 8,
        "command_type": 16,
        "echo_serial_number": 20,
        "status": 24,
        "state": 28,
        "line": 32,
        "source_line": 36,
        "source_file": 40,
    }
    assert Message.SIZE == 16
