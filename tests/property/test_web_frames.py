"""Whatever bytes a client of the web display sends, they are a frame or they are refused."""

import msgpack
from hypothesis import given
from hypothesis import strategies as st

import gui.web.methods  # noqa: F401  registers the methods
from gui.web import frames, gateway
from gui.web.calculator import calculate
from gui.web.calls import METHODS, CallError

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**64 - 1) | st.floats() | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text() | st.integers(0, 9), inner),
    max_leaves=20,
)


@given(st.binary() | PLAIN.map(msgpack.packb))
def test_bytes_are_a_frame_or_refused(data):
    try:
        frame = frames.decode(data)
    except frames.BadFrame:
        return
    assert isinstance(frame["t"], str)
    assert frames.decode(msgpack.packb(frame)).keys() == frame.keys()


@given(st.sampled_from(sorted(METHODS)), PLAIN | st.dictionaries(st.text(max_size=8), PLAIN))
def test_arguments_are_what_a_method_declares_or_refused(name, given_arguments):
    row = METHODS[name]
    try:
        checked = row.arguments(given_arguments)
    except CallError:
        return
    assert set(checked) <= set(row.parameters)


@given(st.text(alphabet='0123456789.+-*/()^ inm"eE,x', max_size=40))
def test_the_calculator_gives_a_finite_number_or_refuses(text):
    try:
        value = calculate(text, 1.0)
    except CallError:
        return
    assert abs(value) <= 1e9


@given(st.sampled_from(sorted(gateway.NAMES)), PLAIN | st.dictionaries(st.text(max_size=8), PLAIN))
def test_a_command_of_the_gateway_is_whole_or_refused(name, fields):
    try:
        message = gateway.command_message(name, fields)
    except gateway.Wrong:
        return
    assert type(message).__name__ == name
