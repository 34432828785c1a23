"""The program folder, [DISPLAY]PROGRAM_PREFIX: the only place where clients read and write files.

Every path that a client gives is relative to it and is resolved, symbolic links and all; what then lies outside does
not exist for the client. Files are written beside the target and put in its place in one step.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import secrets
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gui.web.calls import CallError

LONGEST_NAME = 200  # bytes
EDITOR_LIMIT = 8 << 20  # bytes of a file that is read or saved as one text
MOST_ENTRIES = 5000
ALWAYS = (".ngc", ".nc", ".tap", ".txt")


def version_of(path: Path) -> str:
    """Changes whenever the content of a file does; empty where there is none."""
    try:
        found = path.stat()
    except OSError:
        return ""
    return f"{found.st_mtime_ns:x}-{found.st_size:x}-{found.st_ino:x}"


def text_version(data: bytes) -> str:
    """Fingerprint of a text."""
    return hashlib.blake2b(data, digest_size=12).hexdigest()


@dataclass(frozen=True, slots=True)
class ProgramFolder:
    """The folder and the extensions that count as programs."""

    root: Path  # resolved
    extensions: frozenset[str]  # lower case, with the dot

    @classmethod
    def of(cls, root: Path, groups: Iterable[dict[str, Any]]) -> ProgramFolder:
        known = {extension for group in groups for extension in group["extensions"]}
        return cls(root.resolve(), frozenset(known | set(ALWAYS)))

    def resolve(self, relative: str) -> Path:
        """The absolute path that a client means; CallError for anything outside."""
        if "\0" in relative or len(relative.encode("utf-8", "replace")) > 4096:
            raise CallError("file", "this is no file name")
        try:
            path = (self.root / relative).resolve()
        except (OSError, RuntimeError):
            raise CallError("file", "this is no file name") from None
        if path != self.root and self.root not in path.parents:
            raise CallError("file", "{path} is not in the program folder", path=relative)
        return path

    def existing(self, relative: str) -> Path:
        """As `resolve`, for a regular file that is there."""
        path = self.resolve(relative)
        if not path.is_file():
            raise CallError("file", "there is no file {path}", path=relative)
        return path

    def relative(self, path: str | Path) -> str | None:
        """How clients call a file; None for one outside."""
        with contextlib.suppress(OSError, ValueError):
            return Path(path).resolve().relative_to(self.root).as_posix()
        return None

    def new_file(self, relative: str) -> Path:
        """The path of a file that a client wants to write; CallError for a name that is not allowed."""
        path = self.root / relative
        name = path.name
        if not name or name.startswith(".") or len(name.encode("utf-8", "replace")) > LONGEST_NAME:
            raise CallError("file", "this is no name for a program")
        if not name.isprintable() or any(character in '\\/:*?"<>|' for character in name):
            raise CallError("file", "this is no name for a program")
        if path.suffix.lower() not in self.extensions:
            allowed = ", ".join(sorted(self.extensions))
            raise CallError("file", "a program's name ends in one of {allowed}", allowed=allowed)
        parent = self.resolve(os.path.dirname(relative))
        if not parent.is_dir():
            raise CallError("file", "there is no such folder")
        path = parent / name
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise CallError("file", "{path} is not a regular file", path=relative)
        return path

    def listing(self, relative: str) -> dict[str, Any]:
        """A folder's sub-folders and programs."""
        folder = self.resolve(relative)
        if not folder.is_dir():
            raise CallError("file", "there is no such folder")
        entries = []
        for entry in sorted(folder.iterdir(), key=lambda path: (not path.is_dir(), path.name.lower()))[:MOST_ENTRIES]:
            described = self._entry(entry)
            if described is not None:
                entries.append(described)
        parent = None if folder == self.root else self.relative(folder.parent)
        return {"folder": _shown(self.relative(folder)), "parent": parent and _shown(parent), "entries": entries}

    def _entry(self, path: Path) -> dict[str, Any] | None:
        shown = self.relative(path)
        if path.name.startswith(".") or shown is None:
            return None
        try:
            found = path.stat()
        except OSError:
            return None
        folder = stat.S_ISDIR(found.st_mode)
        if not folder and not (stat.S_ISREG(found.st_mode) and path.suffix.lower() in self.extensions):
            return None
        return {
            "name": path.name, "path": shown, "folder": folder, "size": found.st_size, "mtime": found.st_mtime,
        }  # fmt: skip

    def read(self, relative: str) -> dict[str, str]:
        """Text and version of a file."""
        path = self.existing(relative)
        if path.stat().st_size > EDITOR_LIMIT:
            raise CallError("file", "{path} is too large for the editor", path=relative)
        data = path.read_bytes()
        return {
            "text": data.decode("utf-8", "surrogateescape").encode("utf-8", "replace").decode(),
            "version": text_version(data),
        }

    def save(self, relative: str, text: str, version: str | None) -> str:
        """Write a text; ``version`` is what the client has read, None for a new file. The new version."""
        path = self.new_file(relative)
        data = text.encode("utf-8", "replace")
        if len(data) > EDITOR_LIMIT:
            raise CallError("file", "{path} is too large for the editor", path=relative)
        present = text_version(path.read_bytes()) if path.exists() else None
        if present != version:
            raise CallError("conflict", "{path} was changed meanwhile", path=relative, version=present)
        replace_file(path, data)
        return text_version(data)

    def remove(self, relative: str) -> None:
        self.existing(relative)
        self.new_file(relative).unlink()

    def rename(self, relative: str, to: str) -> None:
        self.existing(relative)
        source, target = self.new_file(relative), self.new_file(to)
        if target.exists():
            raise CallError("conflict", "{path} is there already", path=to, version=version_of(target))
        source.rename(target)

    def temporary(self, path: Path) -> Path:
        """Where to write what will replace ``path``."""
        return path.with_name(f".{secrets.token_hex(8)}.part")


def replace_file(path: Path, data: bytes) -> None:
    """Write a file in one step, or leave the old one as it is."""
    part = path.with_name(f".{secrets.token_hex(8)}.part")
    try:
        with part.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            part.chmod(stat.S_IMODE(path.stat().st_mode))
        part.replace(path)
    except OSError as reason:
        part.unlink(missing_ok=True)
        raise CallError("file", "{path} cannot be written: {reason}", path=path.name, reason=reason.strerror) from None


def _shown(relative: str | None) -> str:
    return "" if relative in (None, ".") else str(relative)
