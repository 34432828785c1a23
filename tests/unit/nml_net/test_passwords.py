"""Password files of server and client."""

from __future__ import annotations

from pathlib import Path

import pytest

from nml.errors import ConfigError
from nml.net.passwords import FIELD, PasswordFile, credentials, proof, secret

HASHED = f"eve:$sha256${secret('eve', 'tree').hex()}"


@pytest.fixture
def users(tmp_path: Path) -> PasswordFile:
    path = tmp_path / "users.pwd"
    path.write_text(f"# operators\n\nadam:a b:c\n{HASHED}\n")
    return PasswordFile(path)


@pytest.mark.parametrize(("user", "password"), [("adam", "a b:c"), ("eve", "tree")])
def test_the_right_password_or_its_proof_is_accepted(users: PasswordFile, user: str, password: str) -> None:
    challenge = b"0123456789abcdef"
    assert users.accepts(user.encode(), password.encode().ljust(FIELD, b"\0"), b"")
    assert users.accepts(user.encode(), proof(secret(user, password), challenge), challenge)


@pytest.mark.parametrize(
    ("user", "password", "challenge"),
    [
        (b"adam", b"tree", b""),
        (b"adam", b"", b""),
        (b"snake", b"a b:c", b""),
        (b"adam", b"\xff\xfe", b""),
        (b"\xff", b"a b:c", b""),
        (b"adam", b"a b:c", b"0123456789abcdef"),
        (b"adam", proof(secret("adam", "a b:c"), b"yesterday"), b"today"),
    ],
)
def test_anything_else_is_not(users: PasswordFile, user: bytes, password: bytes, challenge: bytes) -> None:
    assert not users.accepts(user, password, challenge)


@pytest.mark.parametrize(
    ("text", "problem"),
    [("adam\n", "1: a line 'name:password'"), ("\n:x\n", "2: a line"), ("a:$sha256$xyz\n", "1: after .* hexadecimal")],
)
def test_a_bad_line_is_named(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "bad.pwd"
    path.write_text(text)
    with pytest.raises(ConfigError, match=f"bad.pwd:{problem}"):
        PasswordFile(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none.pwd: cannot read the password file"):
        PasswordFile(tmp_path / "none.pwd")


def test_a_client_has_one_user(tmp_path: Path) -> None:
    path = tmp_path / "me.pwd"
    path.write_text("adam:a\n")
    assert credentials(path) == (b"adam", secret("adam", "a"))
    path.write_text("adam:a\neve:b\n")
    with pytest.raises(ConfigError, match="has one line, this one has 2"):
        credentials(path)
