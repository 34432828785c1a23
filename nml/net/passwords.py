"""Password files of buffers (``passwd=FILE`` in a B line), and how a client proves that it knows its password.

A file has lines ``name:password`` or ``name:$sha256$HEX``, as ``python -m nml.net.passwords NAME`` prints it; ``#``
begins a comment. A client that asked for keys first sends a proof made with them, so that its password does not cross
the network; one that did not sends the password itself. ``protocol`` asks here, and ``remote`` for the other end.
"""

from __future__ import annotations

import getpass
import hashlib
import hmac
import sys
from pathlib import Path

from nml.errors import ConfigError, Place

FIELD = 16
"""Bytes that a request has for a name, a password or a proof."""

_HASHED = "$sha256$"
_ROUNDS = 1000


def secret(user: str, password: str) -> bytes:
    """What both ends derive from a password; it is as good as the password."""
    return hashlib.pbkdf2_hmac("sha256", password.encode(), user.encode(), _ROUNDS)


def proof(key: bytes, challenge: bytes) -> bytes:
    """What a client sends instead of its password."""
    return hmac.digest(key, challenge, "sha256")[:FIELD]


class PasswordFile:
    """The users of a buffer. ConfigError names file and line of what is wrong."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.secrets: dict[bytes, bytes] = {}
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"cannot read the password file: {error}", Place(str(path))) from None
        for number, line in enumerate(lines, 1):
            if line.strip() and not line.startswith("#"):
                self._take(line.strip(), Place(str(path), number))

    def _take(self, line: str, place: Place) -> None:
        user, colon, password = line.partition(":")
        if not user or not colon or not password or len(user.encode()) > FIELD:
            raise ConfigError(f"a line 'name:password' is needed, the name of at most {FIELD} bytes", place)
        if not password.startswith(_HASHED):
            self.secrets[user.encode()] = secret(user, password)
            return
        try:
            self.secrets[user.encode()] = bytes.fromhex(password[len(_HASHED) :])
        except ValueError:
            raise ConfigError(f"after {_HASHED} a hexadecimal number is needed", place) from None

    def accepts(self, user: bytes, password: bytes, challenge: bytes) -> bool:
        """Whether ``password`` is the one of ``user``, or its proof where there was a challenge."""
        key = self.secrets.get(user)
        if key is None:
            return False
        if challenge:
            return hmac.compare_digest(password, proof(key, challenge))
        try:
            given = secret(user.decode(), password.rstrip(b"\0").decode())
        except UnicodeDecodeError:
            return False
        return hmac.compare_digest(given, key)


def credentials(path: Path) -> tuple[bytes, bytes]:
    """User name and secret of a client: the only line of its password file."""
    users = list(PasswordFile(path).secrets.items())
    if len(users) != 1:
        raise ConfigError(f"a client's password file has one line, this one has {len(users)}", Place(str(path)))
    return users[0]


def plain_credentials(place: Place, passwd: str) -> bytes:
    """``name password`` of a client's password file, for links that send the password itself."""
    path = Path(place.file).parent / passwd
    user, _ = credentials(path)
    for line in path.read_text(encoding="utf-8").splitlines():
        name, _, password = line.strip().partition(":")
        if name.encode() == user and not password.startswith(_HASHED):
            return user + b" " + password.encode()
    raise ConfigError("this link needs the password itself, not its hash", Place(str(path)))


def main() -> int:
    """Ask for a password and print the line of a password file."""
    if len(sys.argv) != 2 or not 0 < len(sys.argv[1].encode()) <= FIELD:
        print(f"usage: python -m nml.net.passwords NAME    (at most {FIELD} bytes)", file=sys.stderr)
        return 2
    user = sys.argv[1]
    print(f"{user}:{_HASHED}{secret(user, getpass.getpass()).hex()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
