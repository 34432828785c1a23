"""Frames on a serial line: whole packets or none."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from nml.net.serial_line import Unframer, frame
from nml.net.wire import LARGEST_FRAME

MARKS = st.lists(st.sampled_from([0xC0, 0xDB, 0xDC, 0xDD]), min_size=1).map(bytes)
PACKET = st.binary(min_size=1, max_size=100) | MARKS


@given(st.lists(PACKET, max_size=5), st.integers(1, 11))
def test_packets_come_out_as_they_went_in(packets: list[bytes], step: int) -> None:
    line = b"".join(map(frame, packets))
    unframer = Unframer()
    got = [packet for at in range(0, len(line), step) for packet in unframer.receive(line[at : at + step])]
    assert got == packets


@given(PACKET, st.binary(max_size=40), st.data())
def test_a_packet_after_noise_and_damage_is_found(packet: bytes, noise: bytes, data: st.DataObject) -> None:
    damaged = bytearray(frame(b"another packet"))
    damaged[data.draw(st.integers(1, len(damaged) - 2))] ^= 0x55
    assert list(Unframer().receive(bytes(damaged) + noise + frame(packet)))[-1:] == [packet]


def test_a_frame_without_end_is_forgotten() -> None:
    unframer = Unframer()
    for _ in range(20):
        assert list(unframer.receive(b"x" * (LARGEST_FRAME // 10))) == []
    assert list(unframer.receive(frame(b"packet"))) == [b"packet"]
