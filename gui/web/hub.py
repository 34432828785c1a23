"""The people at the browsers: who is there, who has the controls, and what all of them are told. No I/O of its own."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gui.web.access import Role
from gui.web.calls import CallError, Right
from gui.web.state import State

if TYPE_CHECKING:
    from gui.web.client import Client
    from gui.web.messages import Message

MOST_CLIENTS = 200


class Hub:
    """All clients of one server."""

    def __init__(self, state: State, notice: Callable[..., None]) -> None:
        self.state = state
        self.clients: dict[int, Client] = {}
        self.holder: Client | None = None
        self._notice = notice
        self._since = 0.0
        self._asks: Client | None = None
        self._next = 1
        self._released: list[Callable[[Client], None]] = []
        state.listen(self._spread)
        self._publish()

    def on_release(self, action: Callable[[Client], None]) -> None:
        """Call ``action`` with each client that loses the controls."""
        self._released.append(action)

    # --- coming and going ------------------------------------------------------------------------------------------

    def enter(self, client: Client) -> None:
        """A client has said hello."""
        client.id = self._next
        self._next += 1
        self.clients[client.id] = client
        self._publish()

    def leave(self, client: Client) -> None:
        """A client's socket is gone: it lets go of everything."""
        if self.clients.pop(client.id, None) is None:
            return
        if self._asks is client:
            self._asks = None
        if self.holder is client:
            self._give_to(None)
        self._publish()

    # --- controls --------------------------------------------------------------------------------------------------

    def require(self, client: Client, right: Right) -> None:
        """CallError if a client has not the right."""
        if right is Right.ANYBODY:
            return
        if client.role is not Role.OPERATOR:
            raise CallError("role", "readers may look, not operate")
        if right is Right.CONTROLS and self.holder is not client:
            if self.holder is None:
                raise CallError("controls", "take the controls first", holder=None)
            raise CallError("controls", "{name} has the controls", name=self.holder.name, holder=self.holder.id)

    def take(self, client: Client, force: bool) -> None:
        """Give the controls to who wants them, if they are free or with force."""
        if self.holder is client:
            return
        if self.holder is not None and not force:
            raise CallError("controls", "{name} has the controls", name=self.holder.name, holder=self.holder.id)
        if self.holder is not None:
            self._notice("{name} took the controls from {other}", name=client.name, other=self.holder.name)
        self._give_to(client)

    def request(self, client: Client) -> None:
        """Ask the holder."""
        if self.holder is None:
            self._give_to(client)
        elif self.holder is not client:
            self._asks = client
            self._publish()

    def hand(self, client: Client, other: int) -> None:
        """Hand the controls over."""
        receiver = self.clients.get(other)
        if receiver is None or receiver.role is not Role.OPERATOR:
            raise CallError("argument", "there is no such operator", argument="client")
        self._notice("{name} handed the controls to {other}", name=client.name, other=receiver.name)
        self._give_to(receiver)

    def release(self) -> None:
        self._give_to(None)

    def _give_to(self, client: Client | None) -> None:
        former, self.holder = self.holder, client
        self._since = time.time()
        if client is None or self._asks is client:
            self._asks = None
        if former is not None and former is not client:
            for action in self._released:
                action(former)
        self._publish()

    # --- telling ---------------------------------------------------------------------------------------------------

    def _publish(self) -> None:
        self.state.update(
            {
                "clients": [client.card() for client in self.clients.values()],
                "control": self.holder and {"client": self.holder.id, "name": self.holder.name, "since": self._since},
                "control_request": self._asks and {"client": self._asks.id, "name": self._asks.name},
            }
        )

    def _spread(self, changed: dict[str, Any]) -> None:
        for client in self.clients.values():
            client.state_changed(changed)

    def tell_message(self, message: Message) -> None:
        """A message to everybody, in their languages."""
        for client in list(self.clients.values()):
            client.send("message", message.frame(client.language))
