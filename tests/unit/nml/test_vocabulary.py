"""The EMC vocabulary against LinuxCNC 2.9's: numbers, sizes, wire order; and C declarations against the C compiler."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import nml.emc
import nml.emc.emcmot
from nml import cheader, message
from nml.codecs import xdr
from nml.emc.constants import EMC_TASK_MODE_ENUM
from nml.fields import Field
from nml.message import Command, Struct, integer

CATALOGUE = json.loads(Path(__file__).with_name("catalogue.json").read_text())


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_message_is_the_one_of_linuxcnc(name: str):
    expected = CATALOGUE[name]
    cls = getattr(nml.emc, name)
    assert getattr(nml.emc, f"{name}_TYPE") == cls.TYPE_ID == expected["type"]
    assert expected["sizeof"] == cls.SIZE
    assert [field.name for field in cls.WIRE] == expected["wire"]
    assert xdr.size_of(cls) == expected["xdr"]
    assert nml.emc.emc_symbol_lookup(cls.TYPE_ID) == name
    assert cls.__doc__


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="EMC_NOTHING_TYPE"):
        _ = nml.emc.EMC_NOTHING_TYPE


def test_emc_format_passes_the_fields_on_the_wire_in_order():
    class Names:
        """Collects the names of what it is given."""

        def __init__(self) -> None:
            self.seen: list[str] = []

        def scalar(self, view: Struct, field: Field) -> None:
            self.seen.append(field.name)

        array = text = scalar

    cms = Names()
    move = nml.emc.EMC_TRAJ_SET_G5X()
    assert nml.emc.emc_format(move.TYPE_ID, move, cms) == 1
    assert cms.seen == ["g5x_index", "x", "y", "z", "a", "b", "c", "u", "v", "w"]
    assert nml.emc.emc_format(1, move, cms) == 0


def test_task_has_a_state_of_its_own_beside_that_of_the_preamble():
    status = nml.emc.EMC_TASK_STAT(state=4, mode=EMC_TASK_MODE_ENUM.MDI)
    preamble = next(field for field in status.FIELDS if field.name == "state" and field.part == "preamble")
    assert (status.state, preamble.plain(status)) == (4, 0)


def test_a_new_message_is_one_class(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(message, "registry", dict(message.registry))  # other tests look at the vocabulary as it is

    class EMC_IO_GENERIC(nml.emc.EMC_IO_CMD_MSG, type_id=1605):
        """The manual's example."""

        arg = integer()

    assert EMC_IO_GENERIC.SIZE == 24
    assert xdr.encode(EMC_IO_GENERIC(serial_number=1, arg=-2)).hex() == "000006450000001800000001fffffffe"
    assert issubclass(EMC_IO_GENERIC, Command)


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_the_cython_structs_have_the_layout_of_the_declarations(tmp_path: Path):
    text = cheader.pxd(nml.emc.emcmot)
    structs = re.findall(r"ctypedef struct (\w+):\n((?:    .+\n)+)", text)
    source = ["#include <stddef.h>", "#include <stdio.h>"]
    for name, members in structs:
        body = "".join(f"{member.strip()};" for member in members.splitlines())
        source.append(f"typedef struct {{{body}}} {name};")
    source.append("int main(void) {")
    classes = {cls.__name__: cls for cls in cheader.own_structs(nml.emc.emcmot)}
    expected = []
    for name, _ in structs:
        expected.append(f"{name} {classes[name].SIZE}")
        source.append(f'printf("{name} %zu\\n", sizeof({name}));')
        for field in classes[name].FIELDS:
            expected.append(f"{name}.{field.name} {field.offset}")
            source.append(f'printf("{name}.{field.name} %zu\\n", offsetof({name}, {field.name}));')
    source.append("return 0; }")
    (tmp_path / "layout.c").write_text("\n".join(source))
    subprocess.run(["cc", "-o", tmp_path / "layout", tmp_path / "layout.c"], check=True)
    printed = subprocess.run([tmp_path / "layout"], check=True, capture_output=True, text=True).stdout.splitlines()
    assert printed == expected
