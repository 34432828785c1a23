"""Message classes: layout, live views, errors that name what is wrong, and lean construction."""

import pytest

from nml.emc.emcmot import EMCMOT_COMMAND, EMCMOT_ERROR, EMCMOT_STATUS, MotCommand
from nml.emc.structs import EmcPose, PmCartesian
from nml.errors import DecodeError, EncodeError
from nml.message import Command, Struct, boolean, char, decode, double, integer, long, registry, struct, uchar


class Inner(Struct):
    """A structure with padding behind its last member."""

    x = double()
    flag = uchar()


class Base(Command):
    """A base that ends in the middle of an alignment."""

    first = uchar()


class Derived(Base, type_id=900001):
    """Every kind of field."""

    second = uchar()
    number = integer(default=-1)
    big = long()
    on = boolean()
    name = char(8)
    inner = struct(Inner)
    inners = struct(Inner, 3)
    values = double(4)


def test_members_follow_the_base_without_padding_and_align_themselves():
    offsets = {field.name: field.offset for field in Derived.FIELDS}
    assert offsets == {
        "nml_type": 0,
        "nml_size": 8,
        "serial_number": 16,
        "first": 20,
        "second": 21,
        "number": 24,
        "big": 32,
        "on": 40,
        "name": 41,
        "inner": 56,
        "inners": 72,
        "values": 120,
    }
    assert Derived.SIZE == 152


def test_a_fresh_message_has_type_size_and_defaults():
    message = Derived()
    assert (message.nml_type, message.nml_size, message.number) == (900001, 152, -1)


def test_keywords_and_attributes_set_every_kind_of_field():
    message = Derived(big=-(2**40), on=True, name="käse", values=[1, 2, 3, 4], inner=(2.5, 7))
    message.inners[2].x = 9.0
    assert message.big == -(2**40)
    assert message.on is True
    assert message.name == "käse"
    assert list(message.values) == [1.0, 2.0, 3.0, 4.0]
    assert (message.inner.x, message.inner.flag) == (2.5, 7)
    assert [inner.x for inner in message.inners] == [0.0, 0.0, 9.0]


def test_nested_values_are_live_views_of_the_same_bytes():
    message = EMCMOT_STATUS()
    joint = message.joint_status[2]
    joint.homed = 1
    assert message.joint_status[2].homed == 1
    assert EMCMOT_STATUS.from_bytes(message.data).joint_status[2].homed == 1


def test_a_pose_is_set_from_nine_numbers_or_from_another_pose():
    message = EMCMOT_COMMAND(pos=range(9))
    message.tool_offset = message.pos
    assert message.tool_offset.tran == PmCartesian(x=0.0, y=1.0, z=2.0)
    assert message.tool_offset.astuple() == (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)


def test_arrays_index_like_lists():
    values = Derived(values=[1, 2, 3, 4]).values
    values[-1] = 8
    assert values[1:] == [2.0, 3.0, 8.0]
    assert len(values) == 4
    with pytest.raises(IndexError, match=r"Derived.values\[4\]: 4 elements"):
        values[4]


def test_copies_are_independent_and_equal():
    message = Derived(number=3)
    copy = message.copy()
    assert copy == message
    copy.number = 4
    assert copy != message


def test_repr_shows_what_was_set():
    assert repr(EMCMOT_COMMAND(command=MotCommand.ABORT)) == "EMCMOT_COMMAND(command=1)"


def test_to_dict_is_plain():
    shown = Derived(name="a", inner=(1, 2)).to_dict()
    assert shown["inner"] == {"x": 1.0, "flag": 2}
    assert shown["name"] == "a"


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"wrong": 1}, "Derived has no field 'wrong'; it has nml_type"),
        ({"number": 2**31}, "Derived.number: 2147483648 does not fit into int"),
        ({"number": "one"}, "Derived.number: 'one' does not fit into int"),
        ({"first": 256}, "Base.first: 256 does not fit into unsigned char"),
        ({"name": "12345678"}, "8 bytes, 7 are allowed"),
        ({"name": "a\0b"}, "a zero byte would end it"),
        ({"inner": (1, 2, 3)}, "does not fit into Inner"),
        ({"inners": []}, "0 elements, 3 are needed"),
        ({"values": [1]}, r"does not fit into double[4]"),
    ],
)
def test_a_value_that_does_not_fit_names_field_and_type(values: dict, text: str):
    with pytest.raises(EncodeError) as caught:
        Derived(**values)
    assert text in str(caught.value)


def test_texts_for_the_operator_are_cut_between_characters():
    class Cut(Command):
        """A text that may be cut."""

        text = char(8, cut=True)

    assert Cut(text="abcdefé").text == "abcdef"


def test_bytes_that_are_no_such_message_are_refused():
    size = EMCMOT_COMMAND.SIZE
    with pytest.raises(DecodeError, match=f"needs {size} bytes, here are 10"):
        EMCMOT_COMMAND.from_bytes(bytes(10))
    with pytest.raises(DecodeError, match="is type 3001, here is type 3003"):
        EMCMOT_COMMAND.from_bytes(bytes(EMCMOT_ERROR(text="x")) + bytes(size))
    with pytest.raises(DecodeError, match="unknown message type 12345"):
        decode(bytearray((12345).to_bytes(4, "little") + bytes(20)))
    with pytest.raises(DecodeError, match=rf"EMCMOT_COMMAND \(type 3001\) needs {size} bytes, here are 100"):
        decode(EMCMOT_COMMAND().data[:100])


def test_two_classes_cannot_have_one_number():
    with pytest.raises(EncodeError, match="type number 3001 belongs to EMCMOT_COMMAND"):

        class Thief(Command, type_id=3001):
            """Takes a number that is taken."""

    assert registry[3001] is EMCMOT_COMMAND


def test_a_path_leads_to_a_field_and_its_offset():
    field, offset = EMCMOT_STATUS.field("joint_status[2].homed")
    message = EMCMOT_STATUS()
    message.joint_status[2].homed = 7
    assert field.name == "homed"
    assert message.data[offset] == 7
    with pytest.raises(EncodeError, match=r"has no field 'joint_status\.nothing'"):
        EMCMOT_STATUS.field("joint_status.nothing")


def test_a_view_reads_memory_that_somebody_else_owns():
    memory = bytearray(100)
    pose = EmcPose.view(memory, 28)
    pose.tran.z = 4.5
    assert memory[44:52] == EmcPose(tran=(0, 0, 4.5)).data[16:24]
