"""The tool path of the loaded program."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from gui.web.calls import Caller, CallError, Right, method


@method("path.subscribe", Right.ANYBODY)
async def subscribe(caller: Caller) -> dict[str, int] | None:
    job = caller.server.preview.subscribe(caller.client)
    return None if job is None else {"job": job}


@method("path.unsubscribe", Right.ANYBODY)
async def unsubscribe(caller: Caller) -> None:
    caller.server.preview.unsubscribe(caller.client)


@method("path.again", Right.ANYBODY)
async def again(caller: Caller) -> None:
    caller.server.preview.restart()


@method("path.cancel", Right.OPERATOR)
async def cancel(caller: Caller) -> None:
    caller.server.preview.cancel()


@method("program.check", Right.ANYBODY)
async def check(caller: Caller, path: str | None = None, text: str | None = None) -> dict[str, Any]:
    if (path is None) == (text is None):
        raise CallError("argument", "either path or text is needed", argument="path")
    if path is not None:
        return {"errors": await caller.server.preview.check_file(caller.server.folder.existing(path))}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "check.ngc"
        file.write_text(text or "", "utf-8", "replace")
        return {"errors": await caller.server.preview.check_file(file)}
