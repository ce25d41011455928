"""Plain creates and changes of designs, past the general machinery of the web framework (`app.api.express`).

`app.designs.quick` saves them, on SQLite only: there one writer runs units one after another.
"""

from __future__ import annotations

import asyncio
import hashlib
import re
from typing import NamedTuple

from fastapi.routing import APIRoute
from pydantic_core import from_json
from starlette.types import Scope

from app.api.services import Services
from app.designs.routes.designs import change_design, create_design, router
from app.designs.schemas.designs import Design
from app.http.clients import from_whom
from app.http.roles import AUTHOR
from app.http.strict_requests import JSON_TYPES, PATCH_TYPES
from app.storage.database import Unit
from app.storage.idempotency import Once

_DESIGNS = "/api/v1/designs"
_DESIGN = re.compile(_DESIGNS + r"/([0-9a-f]{24})")
_LONGEST_KEY = 200
_TYPES = {
    method: frozenset(kind.encode() for kind in kinds)
    for method, kinds in (("POST", JSON_TYPES), ("PATCH", PATCH_TYPES))
}
_ROUTES = {
    method: next(one for one in router.routes if isinstance(one, APIRoute) and one.endpoint is endpoint)
    for method, endpoint in (("POST", create_design), ("PATCH", change_design))
}
_ONCE = {b"content-length", b"content-type", b"if-match", b"idempotency-key"}
_ELSEWHERE = {b"transfer-encoding", b"cookie", b"crankwright-client"}
"""Headers that the general way reads."""


class PlainSave(NamedTuple):
    """A request that creates a design, or changes the one whose id it names."""

    id: str | None
    headers: dict[bytes, bytes]  # those of `_ONCE`


def plain_save(scope: Scope, longest: int) -> PlainSave | None:
    """A plain request to save a design, as read; None for any other request."""
    if scope.get("root_path"):
        return None
    if scope["method"] == "POST":
        if scope["path"] != _DESIGNS:
            return None
        id = None
    elif scope["method"] == "PATCH" and (match := _DESIGN.fullmatch(scope["path"])):
        id = match[1]
    else:
        return None
    headers = dict[bytes, bytes]()
    for name, value in scope["headers"]:
        if name in _ELSEWHERE or name in headers:
            return None
        if name in _ONCE:
            headers[name] = value
    length = headers.get(b"content-length", b"")
    is_json = headers.get(b"content-type") in _TYPES[scope["method"]]
    is_short = len(length) < 6 and length.isdigit() and int(length) <= longest
    return PlainSave(id, headers) if is_json and is_short and (id is None or b"if-match" in headers) else None


async def saved(services: Services, asked: PlainSave, scope: Scope, body: bytes) -> Design:
    """Save a design as asked.

    Raises
    ------
    Exception
        Whatever is wrong: nothing is stored, and the general way meets it too.
    """
    AUTHOR.check()
    raw = from_json(body)
    if not isinstance(raw, dict):
        raise TypeError("a design is an object")
    digest = hashlib.sha256(body).hexdigest()
    once = Once(_key(asked), f"{scope['method']} {scope['path']}", digest, from_whom(scope))
    unit: Unit[Design]
    if asked.id is None:
        unit = services.quick.creation(raw, once)
    else:
        expected = asked.headers[b"if-match"].decode("latin-1")
        unit = services.quick.change(asked.id, raw, expected, once)
    answer = await asyncio.wrap_future(services.database.submit(unit))
    scope["route"] = _ROUTES[scope["method"]]
    return answer


def _key(asked: PlainSave) -> str | None:
    """The Idempotency-Key of a request."""
    sent = asked.headers.get(b"idempotency-key")
    if sent is None:
        return None
    if not 1 <= len(sent) <= _LONGEST_KEY:
        raise ValueError("the general way says how long a key may be")
    return sent.decode("latin-1")
