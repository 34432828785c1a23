"""Who may come in: tokens with their roles, and the origins and host names of requests.

The token file has a line ``operator TOKEN`` or ``reader TOKEN`` for each token, and ``#`` remarks. Nobody but its
owner may be able to read it. A browser tells with Origin which page asks; only our own page may, so a foreign page
in the operator's browser reaches nothing. Host is checked too, so that a foreign name that leads to this address is
of no use.
"""

from __future__ import annotations

import enum
import hmac
from pathlib import Path
from urllib.parse import urlsplit

from gui.web.settings import Settings, is_loopback
from nml.errors import ConfigError, Place

SHORTEST_TOKEN = 16  # characters
LOOPBACK_NAMES = ("127.0.0.1", "localhost", "::1")


class Role(enum.Enum):
    """What a client may do."""

    READER = "reader"
    OPERATOR = "operator"


class Access:
    """The tokens of one server and the names by which it goes."""

    def __init__(self, settings: Settings) -> None:
        self._tokens = read_tokens(settings.token_file) if settings.token_file else {}
        self.needs_token = settings.token_file is not None
        self._names = {settings.host.lower(), *(name.lower() for name in settings.names)}
        if is_loopback(settings.host):
            self._names.update(LOOPBACK_NAMES)
        self._any_name = settings.host in ("0.0.0.0", "::") and not settings.names  # TLS and token protect it

    def role(self, token: str | None) -> Role | None:
        """The role that a token gives; without a token file everybody on this computer is an operator."""
        if not self.needs_token:
            return Role.OPERATOR
        found = None
        for known, role in self._tokens.items():
            if hmac.compare_digest(known.encode(), (token or "").encode("utf-8", "replace")):
                found = role
        return found

    def host_allowed(self, host: str | None) -> bool:
        """Whether a request's Host header names this server."""
        name = host_name(f"//{host}") if host else None
        return name is not None and (self._any_name or name in self._names)

    def origin_allowed(self, origin: str | None, host: str | None) -> bool:
        """Whether a request's Origin header is this server's own page."""
        return (
            origin is not None and self.host_allowed(host) and urlsplit(origin).netloc.lower() == (host or "").lower()
        )


def host_name(address: str) -> str | None:
    """The name in ``//name:port``; None where there is none."""
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None


def bearer(header: str | None) -> str | None:
    """The token in an Authorization header."""
    kind, _, token = (header or "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else None


def read_tokens(path: Path) -> dict[str, Role]:
    """The tokens of a file by their text; ConfigError names the line that is wrong."""
    try:
        mode = path.stat().st_mode
        lines = path.read_text().splitlines()
    except (OSError, UnicodeDecodeError) as reason:
        raise ConfigError(f"[WEB]TOKEN_FILE cannot be read: {reason}", Place(str(path))) from None
    if mode & 0o077:
        raise ConfigError(f"other users may read the tokens; do: chmod 600 {path}", Place(str(path)))
    tokens: dict[str, Role] = {}
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if len(words) != 2 or words[0] not in ("reader", "operator"):
            raise ConfigError("'operator TOKEN' or 'reader TOKEN' would be right", Place(str(path), number))
        if len(words[1]) < SHORTEST_TOKEN:
            raise ConfigError(f"the token is too short; {SHORTEST_TOKEN} characters at least", Place(str(path), number))
        tokens[words[1]] = Role(words[0])
    if not tokens:
        raise ConfigError("there is no token in the file", Place(str(path)))
    return tokens
