"""Waiting on channels in asyncio programs: the event loop goes on while a worker thread sleeps on the buffer.

    async for message in aio.messages(Channel(None, "emcError")):
        print(message.error)
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from nml import clock
from nml.channel import Channel
from nml.message import Message

_SLICE = 0.1  # s; longest time that a thread outlives a cancelled wait


async def wait(channel: Channel, timeout: float = -1.0) -> bool:
    """As ``Channel.wait``; may be cancelled."""
    end = clock.host_now() + timeout
    while True:
        left = end - clock.host_now() if timeout >= 0.0 else _SLICE
        if await asyncio.to_thread(channel.wait, min(_SLICE, max(0.0, left))):
            return True
        if timeout >= 0.0 and left <= 0.0:
            return False


async def read(channel: Channel, timeout: float = -1.0) -> Message | None:
    """As ``Channel.blocking_read``: the next message, None if none came within ``timeout`` s."""
    message = channel.read()
    while message is None and await wait(channel, timeout):
        message = channel.read()
    return message


async def messages(channel: Channel) -> AsyncIterator[Message]:
    """Every message that can be read from now on."""
    while True:
        message = await read(channel)
        if message is not None:
            yield message
