"""Frames of /ws: msgpack maps with a kind ``t``. Encoding, and refusing what no page of ours sends; no I/O."""

from __future__ import annotations

from typing import Any

import msgpack

VERSION = 1
LONGEST_FRAME = 1 << 20  # bytes from a page, uploads go over HTTP
DEEPEST = 8  # maps and lists within each other


class BadFrame(Exception):
    """Not a frame; the text goes into the close reason."""


def encode(kind: str, fields: dict[str, Any]) -> bytes:
    """One frame."""
    data: bytes = msgpack.packb({"t": kind, **fields})
    return data


def decode(data: bytes) -> dict[str, Any]:
    """The map of one frame; BadFrame for anything else."""
    try:
        frame = msgpack.unpackb(data, raw=False)
    except Exception as reason:  # msgpack raises many kinds, ValueError and its own among them
        raise BadFrame(f"not msgpack: {reason}"[:100]) from None
    if not isinstance(frame, dict) or not isinstance(frame.get("t"), str):
        raise BadFrame("not a map with a kind t")
    if not _shallow(frame, DEEPEST):
        raise BadFrame("maps and lists are too deep")
    return frame


def _shallow(value: Any, levels: int) -> bool:
    if isinstance(value, dict):
        return levels > 0 and all(isinstance(key, str) and _shallow(one, levels - 1) for key, one in value.items())
    if isinstance(value, list):
        return levels > 0 and all(_shallow(one, levels - 1) for one in value)
    return value is None or isinstance(value, (bool, int, float, str, bytes))
