"""HTTP: the page and its files, texts, programs up and down, and the way into the WebSockets. Nothing changes by
GET.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web

from gui.web import access, frames, gateway, texts
from gui.web.access import Role
from gui.web.calls import CallError
from gui.web.client import Client
from gui.web.programjogs import ProgramJogs
from gui.web.server import Server
from gui.web.wizard.server import WizardServer

log = logging.getLogger(__name__)

PAGE = Path(__file__).resolve().with_name("page")
MARK = ("X-Requested-With", "linuxcnc-web")
HEARTBEAT = 10.0  # s between WebSocket pings
STATUS_OF = {"file": 400, "argument": 400, "role": 403, "conflict": 409, "state": 409}
SITE: web.AppKey[Any] = web.AppKey("site")  # whatever server: a machine's or the wizard's
SERVER: web.AppKey[Server] = web.AppKey("server", Server)
TYPES = {".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".html": "text/html"}


def application(server: Server | WizardServer) -> web.Application:
    """The site of one server: the page and its socket, and with a machine also programs and the NML gateway."""
    app = web.Application(middlewares=[_guard], client_max_size=server.settings.upload_limit + 1)
    app[SITE] = server
    app.add_routes(
        [
            web.get("/", _page),
            web.get("/page/{path:.+}", _file),
            web.get("/catalogue/{language}.json", _catalogue),
            web.get("/health", _health),
            web.get("/ws", _websocket),
        ]
    )
    if isinstance(server, Server):
        app[SERVER] = server
        app.add_routes([web.get("/program", _program), web.post("/upload", _upload), web.get("/nml", _gateway)])
    return app


def refusal(status: int, code: str, text: str) -> web.Response:
    """An error as JSON."""
    return web.json_response({"code": code, "text": text}, status=status)


@web.middleware
async def _guard(request: web.Request, handler: Any) -> web.StreamResponse:
    """Foreign names, foreign pages and unforeseen failures end here; every answer gets the page's security headers."""
    server = request.app[SITE]
    if not server.access.host_allowed(request.headers.get("Host")):
        return refusal(403, "host", "this server goes by another name; [WEB]NAMES adds names")
    try:
        answer: web.StreamResponse = await handler(request)
    except web.HTTPException as reason:
        answer = refusal(reason.status, "http", reason.reason)
    except CallError as reason:
        text = reason.text.format(**reason.more)
        answer = refusal(STATUS_OF.get(reason.code, 400), reason.code, text)
    if not answer.prepared:
        for name, value in security_headers(server.config["embed_tabs"], request.headers.get("Host", "")).items():
            answer.headers.setdefault(name, value)
    return answer


def security_headers(tabs: list[dict[str, Any]], host: str) -> dict[str, str]:
    """What a browser may do with our answers: our own files only, frames only of the embedded tabs."""
    origins = {f"{parts.scheme}://{parts.netloc}" for tab in tabs if (parts := urlsplit(tab["url"]))}
    sources = " ".join(sorted(origins)) or "'none'"
    return {
        "Content-Security-Policy": (
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
            f"connect-src 'self' ws://{host} wss://{host}; worker-src 'self'; manifest-src 'self'; "
            f"frame-src {sources}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        ),
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cache-Control": "no-cache",
    }


# --- the page --------------------------------------------------------------------------------------------------------


async def _page(request: web.Request) -> web.StreamResponse:
    return _static("index.html")


async def _file(request: web.Request) -> web.StreamResponse:
    return _static(request.match_info["path"])


def _static(name: str) -> web.StreamResponse:
    path = (PAGE / name).resolve()
    if PAGE not in path.parents or not path.is_file():
        raise web.HTTPNotFound
    answer = web.FileResponse(path)
    if path.suffix in TYPES:
        answer.content_type = TYPES[path.suffix]
    return answer


async def _catalogue(request: web.Request) -> web.Response:
    language = request.match_info["language"]
    if language not in texts.codes():
        raise web.HTTPNotFound
    return web.json_response(texts.catalogue(language))


async def _health(request: web.Request) -> web.Response:
    return web.json_response({"machine": request.app[SITE].state.get("machine")})


# --- programs --------------------------------------------------------------------------------------------------------


def _role(request: web.Request) -> Role:
    role = request.app[SERVER].access.role(access.bearer(request.headers.get("Authorization")))
    if role is None:
        raise web.HTTPUnauthorized
    return role


async def _program(request: web.Request) -> web.StreamResponse:
    """The text of a program of the folder, or of the loaded one."""
    _role(request)
    server = request.app[SERVER]
    wanted = request.query.get("path")
    if wanted is not None:
        path = server.folder.existing(wanted)
    elif server.programs.text is not None:
        path = server.programs.text.path
    else:
        raise web.HTTPNotFound
    answer = web.FileResponse(path)
    answer.content_type = "text/plain"
    return answer


async def _upload(request: web.Request) -> web.Response:
    """A new program, or a new version of one."""
    server = request.app[SERVER]
    if not server.access.origin_allowed(request.headers.get("Origin"), request.headers.get("Host")):
        return refusal(403, "origin", "uploads come from this server's own page only")
    if request.headers.get(MARK[0]) != MARK[1]:
        return refusal(403, "origin", f"the header {MARK[0]}: {MARK[1]} is missing")
    if _role(request) is not Role.OPERATOR:
        return refusal(403, "role", "readers may look, not operate")
    name = request.query.get("name", "")
    if "/" in name or "\\" in name:
        return refusal(400, "file", "this is no name for a program")
    path = server.folder.new_file(name)
    if path.exists() and request.query.get("replace") != "1":
        return refusal(409, "conflict", f"{name} is there already")
    text = server.programs.text
    if text is not None and text.path == path and server.machine.values.get("interp_state", 1) != 1:
        return refusal(409, "state", f"{name} runs")
    if request.content_length is not None and request.content_length > server.settings.upload_limit:
        return refusal(413, "file", f"a program may have {server.settings.upload_limit} bytes")
    size = await _receive(request, server, path)
    await server.programs.changed(name)
    return web.json_response({"path": name, "size": size})


async def _receive(request: web.Request, server: Server, path: Path) -> int:
    """Write the body beside its place, then put it there in one step; its size."""
    part = server.folder.temporary(path)
    size = 0
    try:
        with part.open("xb") as file:
            async for data in request.content.iter_chunked(1 << 18):
                size += len(data)
                if size > server.settings.upload_limit:
                    raise web.HTTPRequestEntityTooLarge(server.settings.upload_limit, size)
                await asyncio.to_thread(file.write, data)
        part.replace(path)
    except OSError as reason:
        raise CallError("file", "{path} cannot be written: {reason}", path=path.name, reason=reason.strerror) from None
    finally:
        part.unlink(missing_ok=True)
    return size


# --- the page's WebSocket --------------------------------------------------------------------------------------------


async def _websocket(request: web.Request) -> web.StreamResponse:
    server = request.app[SITE]
    if not server.access.origin_allowed(request.headers.get("Origin"), request.headers.get("Host")):
        return refusal(403, "origin", "only this server's own page may connect here")
    socket = web.WebSocketResponse(heartbeat=HEARTBEAT, max_msg_size=frames.LONGEST_FRAME, compress=False)
    await socket.prepare(request)
    client = Client(server, socket, request.remote or "?", access.bearer(request.headers.get("Authorization")))
    with contextlib.suppress(ConnectionError):
        await client.converse()
    return socket


async def _gateway(request: web.Request) -> web.StreamResponse:
    """NML messages by name, for programs; a page that is not ours is not among them."""
    server = request.app[SERVER]
    origin = request.headers.get("Origin")
    if origin is not None and not server.access.origin_allowed(origin, request.headers.get("Host")):
        return refusal(403, "origin", "pages of other servers may not connect here")
    if not server.access.needs_token:
        return refusal(403, "token", "the gateway needs tokens; [WEB]TOKEN_FILE names their file")
    jogs = ProgramJogs(server.machine, server.jogging, server.config)
    return await gateway.serve(request, jogs, server.access.role)
