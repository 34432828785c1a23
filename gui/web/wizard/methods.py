"""What the wizard's page may ask for; operators only, because files are written and a machine is started."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from gui.web.calls import Caller, CallError, Right, method
from gui.web.wizard import answers as answers_module
from gui.web.wizard import make, questions, samples
from nml.errors import ConfigError

if TYPE_CHECKING:
    from gui.web.wizard.server import WizardServer


def _wizard(caller: Caller) -> WizardServer:
    """The server of these calls; ``gui.web.calls`` lets nobody else come here."""
    return cast("WizardServer", caller.server)


@method("wizard.samples", Right.OPERATOR)
async def list_samples(caller: Caller) -> list[dict[str, Any]]:
    return await asyncio.to_thread(samples.listing)


@method("wizard.copy", Right.OPERATOR)
async def copy(caller: Caller, path: str, name: str) -> dict[str, Any]:
    return await _written(samples.copy, path, name, _wizard(caller).place)


@method("wizard.questions", Right.OPERATOR)
async def ask(caller: Caller) -> list[dict[str, Any]]:
    return questions.as_maps()


@method("wizard.check", Right.OPERATOR)
async def check(caller: Caller, answers: dict[str, Any]) -> dict[str, Any]:
    return {"errors": answers_module.errors(answers)}


@method("wizard.generate", Right.OPERATOR)
async def generate(caller: Caller, answers: dict[str, Any], name: str) -> dict[str, Any]:
    return await _written(make.generate, answers, name, _wizard(caller).place)


@method("wizard.start", Right.OPERATOR)
async def start(caller: Caller, ini: str) -> None:
    path, wizard = Path(ini).resolve(), _wizard(caller)
    if wizard.place.resolve() not in path.parents or path.suffix != ".ini" or not path.is_file():
        raise CallError("file", "{path} is none of the wizard's configurations", path=ini)
    wizard.start_machine(path, wizard.settings.port)


async def _written(function: Any, *arguments: Any) -> dict[str, Any]:
    """Make a folder; what the page is told of it."""
    try:
        ini, wrong = await asyncio.to_thread(function, *arguments)
    except ConfigError as reason:
        raise CallError("file", "{reason}", reason=str(reason)) from None
    folder = ini.parent
    names = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    return {"folder": str(folder), "ini": str(ini), "files": names, "check": wrong}
