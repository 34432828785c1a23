"""Encoding from the image gives what the codec gives, for every class of the vocabulary."""

from __future__ import annotations

import random

import numpy as np
import pytest

import nml.emc.emcmot  # noqa: F401
from nml.codecs import xdr
from nml.emc import EMC_STAT
from nml.errors import NmlError
from nml.message import Message, registry
from nml.net import xdr_images
from nml.net._gather import gather


def filled(cls: type[Message], seed: int) -> Message:
    """A message with something in every field."""
    source = random.Random(seed)

    def value(old: object) -> object:
        if isinstance(old, bool):
            return source.random() < 0.5
        if isinstance(old, int):
            return source.randint(0, 255)
        if isinstance(old, float):
            return source.uniform(-10.0, 10.0)
        return b"some text"

    message = cls()
    cls.FLAT.pack_into(message.data, 0, *map(value, message.astuple()))
    message.nml_type, message.nml_size = cls.TYPE_ID, cls.SIZE
    return message


@pytest.mark.parametrize("preamble", [True, False])
@pytest.mark.parametrize("cls", registry.values(), ids=lambda cls: cls.__name__)
def test_an_image_is_encoded_as_its_message_is(cls: type[Message], preamble: bool) -> None:
    message = filled(cls, cls.TYPE_ID)
    assert xdr_images.encode(bytearray(message.data), preamble) == xdr.encode(message, preamble)


def test_negative_numbers_and_long_ones_keep_their_low_bytes() -> None:
    message = registry[1999]()
    message.line = -5
    message.nml_size = -1
    assert xdr_images.encode(bytearray(message.data), True)[4:8] == b"\xff\xff\xff\xff"
    assert b"\xff\xff\xff\xfb" in xdr_images.encode(bytearray(message.data), True)[:40]


@pytest.mark.parametrize("image", [b"", b"\0\0\0", bytes(20), b"\xcf\x07\0\0" + bytes(100)])
def test_what_is_no_image_is_refused(image: bytes) -> None:
    with pytest.raises(NmlError):
        xdr_images.encode(bytearray(image), True)


def test_elements_are_gathered_in_runs() -> None:
    runs = np.array([(1, 0, 5, 2), (4, 2, 0, 1), (8, 6, 8, 1)], dtype=np.int32)
    image = bytes(range(16))
    assert gather(image, runs, bytes(15)) == bytes([5, 6, 3, 2, 1, 0, *range(15, 7, -1), 0])


@pytest.mark.parametrize(
    "run", [(4, 0, 13, 1), (1, 0, 0, 17), (8, 5, 0, 1), (1, -1, 0, 1), (4, 0, 0, -1), (2, 0, 0, 1)]
)
def test_runs_outside_are_refused(run: tuple[int, int, int, int]) -> None:
    with pytest.raises(ValueError, match=r"leave an image|are known"):
        gather(bytes(16), np.array([run], dtype=np.int32), bytes(12))


def test_neighbours_of_one_kind_are_one_run() -> None:
    runs, fixed = xdr_images._order(EMC_STAT, True)
    assert len(fixed) == 3876
    assert len(runs) < 300
