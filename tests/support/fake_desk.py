"""A server's side of buffers that needs no shared memory: what the tests of the protocol put behind a session."""

from __future__ import annotations

from dataclasses import dataclass, field

from nml.net.wire import CmsStatus, Request


@dataclass
class FakeView:
    """A buffer that the test fills: a list of (id, body), of which a slot shows the last and a queue the first."""

    name: str = "emcStatus"
    queue: bool = False
    confirm_write: bool = False
    may_read: bool = True
    can_block: bool = False
    largest_body: int = 4096
    messages: list[tuple[int, bytes]] = field(default_factory=list)
    written: list[bytes] = field(default_factory=list)
    seen: bool = False
    answer: tuple[int, int] = (16, CmsStatus.WRITE_OK)
    password: bytes = b"secret"
    introduced: bytes = b""
    challenge: bytes = b""

    def fetch(self, consume: bool, last: int) -> tuple[int, int, int, bytes]:
        if not self.messages:
            return CmsStatus.READ_OLD, last, 1, b""
        message_id, body = self.messages[0 if self.queue else -1]
        if self.queue and consume:
            self.messages.pop(0)
        elif not self.queue and message_id == last:
            return CmsStatus.READ_OLD, last, 1, b""
        self.seen = self.seen or consume
        return CmsStatus.READ_OK, message_id, self.seen, body

    def store(self, body: bytes, only_if_read: bool) -> tuple[int, int]:
        self.written.append(body)
        return self.answer

    def ask(self, question: int) -> tuple[int, int]:
        return 0, {Request.CHECK_IF_READ: 1, Request.MESSAGE_COUNT: 77, Request.QUEUE_LENGTH: 3}.get(question, 8072)

    def clear(self) -> int:
        self.messages.clear()
        return CmsStatus.CLEARED

    def log_in(self, user: bytes, password: bytes, challenge: bytes) -> bool:
        self.challenge = challenge
        return (user, password.rstrip(b"\0")) == (b"operator", self.password)

    def introduce(self, info: bytes) -> None:
        self.introduced = info

    def diagnostics(self, little_endian: bool) -> tuple[int, bytes]:
        return CmsStatus.SERVER_SIDE_ERROR, b""


class FakeDesk:
    """The buffers of a test by number."""

    def __init__(self, **views: FakeView) -> None:
        self.views = {int(name.lstrip("n")): view for name, view in views.items()}
        self.checksum = 12345

    def view(self, number: int) -> FakeView | None:
        return self.views.get(number)

    def agree(self, checksum: int) -> bool:
        return checksum == self.checksum
