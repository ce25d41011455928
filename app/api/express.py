"""`POST …/evaluate` and small saves past the general machinery of the web framework, which costs more.

What is plainly right is answered here: a short JSON body of stated length for a version whose every level is
quick, or for a design of such steps without geometry. All else is handed on as it came, and gets its answer,
or its error, the general way.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from fastapi.routing import APIRoute
from pydantic_core import from_json, to_json
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.express_saves import PlainSave, plain_save, saved
from app.api.services import Services
from app.api.waiting import as_json
from app.calculations.bodies import EvaluateIn
from app.calculations.cost import is_quick
from app.calculations.prepared import prepared
from app.calculations.routes.evaluate import FEW, evaluate_template, router
from app.calculations.service import run_evaluate
from app.calculations.size import points
from app.designs.schemas.designs import Design
from app.http import nul
from app.http.roles import VIEWER
from app.http.strict_requests import JSON_TYPES, MOST_BRACKETS, MOST_QUOTES
from templates.core.language.template import Template

LONGEST = min(65_536, MOST_BRACKETS, MOST_QUOTES)  # bytes: too short to be intricate
_PATH = re.compile(r"/api/v1/templates/([a-z0-9_]{1,64})/versions/([1-9][0-9]{0,5})/evaluate")
_TYPES = frozenset(kind.encode() for kind in JSON_TYPES)
_ROUTE = next(
    route for route in router.routes if isinstance(route, APIRoute) and route.endpoint is evaluate_template
)
_PLAIN_MEMBERS = {"inputs", "outputs"}
_METHODS = frozenset({"POST", "PATCH"})
_HEADER = (b"content-type", b"application/json")


class Express:
    """ASGI middleware for the paths that are called most; the innermost: all others see its answers."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or hand on what was received."""
        if scope["type"] != "http" or scope["method"] not in _METHODS or scope["query_string"]:
            await self.app(scope, receive, send)
        elif named := _named(scope):
            message = await receive()
            content = await _answer(scope["app"].state.services, *named, message)
            if content is None:
                await self.app(scope, _again(message, receive), send)
                return
            scope["route"] = _ROUTE  # by which requests are counted and traced
            await _send(send, 200, content)
        elif save := plain_save(scope, LONGEST):
            message = await receive()
            design = await _saved(scope, save, message)
            if design is None:
                await self.app(scope, _again(message, receive), send)
                return
            place, tag = f"/api/v1/designs/{design.id}", f'"{design.revision}"'
            headers = [(b"location", place.encode()), (b"etag", tag.encode())]
            await _send(send, 200 if save.id else 201, as_json(design), headers)
        else:
            await self.app(scope, receive, send)


async def _send(send: Send, status: int, content: bytes, headers: Iterable[tuple[bytes, bytes]] = ()) -> None:
    head = [*headers, (b"content-length", b"%d" % len(content)), _HEADER]
    await send({"type": "http.response.start", "status": status, "headers": head})
    await send({"type": "http.response.body", "body": content})


def _named(scope: Scope) -> tuple[str, int] | None:
    """The template and the version of a plain request to evaluate; None if it is anything else."""
    match = _PATH.fullmatch(scope["path"]) if scope["method"] == "POST" else None
    return (match[1], int(match[2])) if match and _is_plain(scope["headers"]) else None


def _is_plain(headers: list[tuple[bytes, bytes]]) -> bool:
    """Return whether a short body of JSON comes, and JSON may be the answer; each said once."""
    length = kind = b""
    for name, value in headers:
        if name == b"content-length":
            length = b"-" if length else value
        elif name == b"content-type":
            kind = b"-" if kind else value
        elif name == b"transfer-encoding" or (name == b"accept" and b"application/x-" in value):
            return False
    return kind in _TYPES and len(length) < 6 and length.isdigit() and int(length) <= LONGEST


async def _answer(services: Services, id: str, version: int, message: Message) -> bytes | None:
    """The answer's bytes, or None where the general way has to say what is wrong, or to do the work."""
    body = _whole(message)
    if body is None:
        return None
    try:
        await services.catalogues.refresh()
        cls = services.catalogues.templates.versions.get((id, version))
        if cls is None or not is_quick(cls):
            return None
        VIEWER.check()
        raw = from_json(body)
        if (content := _prepared(cls, raw)) is not None:
            return content
        asked = EvaluateIn.model_validate(raw)
        if len(asked.inputs) > FEW or points(asked.inputs) > FEW:
            return None
        return to_json(run_evaluate(cls, asked))
    except Exception:  # whatever it is, the general way meets it too, and answers it
        return None


def _prepared(cls: type[Template], raw: object) -> bytes | None:
    """The answer to a request of texts of single values alone; None to any other."""
    if not (isinstance(raw, dict) and raw.keys() <= _PLAIN_MEMBERS):
        return None
    inputs, outputs = raw.get("inputs"), raw.get("outputs")
    if not (isinstance(inputs, dict) and len(inputs) <= FEW and all(map(_is_text, inputs.values()))):
        return None
    if outputs is not None and not (isinstance(outputs, list) and all(map(_is_text, outputs))):
        return None
    ready = prepared(cls, outputs) if outputs is None or len(outputs) <= FEW else None
    return None if ready is None else ready.answer(inputs)


def _is_text(value: object) -> bool:
    return type(value) is str


async def _saved(scope: Scope, asked: PlainSave, message: Message) -> Design | None:
    """The design that was saved; None where the general way has to say what is wrong, or to do the work."""
    services: Services = scope["app"].state.services
    body = _whole(message)
    if body is None or services.database.is_shared:
        return None
    try:
        await services.catalogues.refresh()
        return await saved(services, asked, scope, body)
    except Exception:  # nothing is stored; the general way meets it too, and answers it
        return None


def _whole(message: Message) -> bytes | None:
    """The body, if all of it has come and no text in it may have U+0000."""
    body: bytes = message.get("body", b"")
    if message["type"] != "http.request" or message.get("more_body") or nul.may_have(body):
        return None
    return body


def _again(message: Message, receive: Receive) -> Receive:
    """To receive a message again before what follows it."""
    waiting = [message]

    async def again() -> Message:
        return waiting.pop() if waiting else await receive()

    return again
