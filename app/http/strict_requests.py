"""Requirements on every request: a bounded body, valid JSON, a precondition on changes.

`StrictRoute` replaces FastAPI's lenient parsing of bodies: Pydantic's parser refuses lone surrogates and deep
nesting, and a missing or wrong content type is refused. `PlainRoute` parses just as strictly, and calls its
endpoint without FastAPI's machinery.
"""

from __future__ import annotations

import asyncio
import hashlib
import re
from collections.abc import AsyncIterator, Awaitable, Callable, Container, Coroutine, Iterator, Mapping
from inspect import iscoroutinefunction
from itertools import islice
from json import JSONDecodeError
from mmap import mmap
from typing import TYPE_CHECKING, Any

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from pydantic_core import from_json
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.types import Receive, Scope, Send

from app.http.connections import Pace
from app.http.openapi import CHANGES, operation_id
from app.observation.processor_time import metered
from app.observation.secrets import MARK, holds_key, without_keys
from app.plain import Json
from app.workers.pieces import PIECE
from templates.core.errors import Fault, InvalidInputs, plain

if TYPE_CHECKING:
    from fastapi._compat import ModelField

JSON_TYPES = {"application/json"}
PATCH_TYPES = {"application/json", "application/merge-patch+json"}
STEP_TYPES = ("model/step", "application/step", "application/p21")
"""The registered media type of STEP's clear text, and two older ones."""
SHEET_TYPES = {
    "application/octet-stream",
    "application/zip",
    "application/gzip",
    "application/xml",
    "text/xml",
}
"""Media types of a Mathcad sheet; Mathcad's own types are not registered."""
MODEL_TYPES = {"application/octet-stream", "application/zip", "model/step"}
"""Media types of a model; FreeCAD's own type is not registered."""
FORM_TYPES = {"application/x-www-form-urlencoded"}
MOST_BRACKETS, MOST_QUOTES = 250_000, 400_000
"""Largest number in one body. A list of numbers has one bracket; millions of brackets would block the
parser and the server."""


class HttpError(Exception):
    """A request that is refused for its form, before its meaning is examined."""


class TooIntricate(HttpError):
    """The body has more nesting or more names than any design or table needs."""


class NotJson(HttpError):
    """The content type is not one that the path accepts."""


class NotForm(HttpError):
    """The content type is not that of an HTML form."""


class NotCsv(HttpError):
    """The content type is not that of a table."""


class NotStep(HttpError):
    """The content type is not that of a STEP file."""


class NotSheet(HttpError):
    """The content type is not one that is accepted for a Mathcad sheet."""


class NotModel(HttpError):
    """The content type is not one that is accepted for a model."""


class PreconditionRequired(HttpError):
    """A change was sent without If-Match."""


class StrictRequest(Request):
    """A request whose JSON is parsed strictly, and whose body comes in pieces if it is large."""

    @property
    def pace(self) -> Pace:
        """Return the pace that all large bodies and answers of the app share."""
        return self.app.state.pace  # type: ignore[no-any-return]

    async def parts(self) -> tuple[bytes, ...]:
        """Return the pieces of the body as received."""
        if not hasattr(self, "_parts"):
            self._parts = tuple([part async for part in self.pieces()])
        return self._parts

    async def body(self) -> bytes:
        """Return the body as one object.

        Joining the pieces of a large body holds the interpreter lock; `parts` avoids that.
        """
        if not hasattr(self, "_body"):
            parts = await self.parts()
            self._body = parts[0] if len(parts) == 1 else b"".join(parts)
        return self._body

    async def file(self) -> mmap | bytes:
        """Return the body as one object, which may be mapped from disk."""
        return await self.body()

    async def discard(self) -> None:
        """Receive and discard the body, because a client that is still sending may not read an answer yet."""
        async for _ in self.pieces():
            pass

    async def pieces(self) -> AsyncIterator[bytes]:
        """Receive the body, and yield each piece that is not empty.

        Raises
        ------
        ClientDisconnect
            If the client leaves before the end.
        """
        size, is_complete = 0, False
        while not is_complete:
            message = await self.receive()
            if message["type"] == "http.disconnect":
                raise ClientDisconnect
            part = message.get("body", b"")
            if part:
                yield part
            is_complete = not message.get("more_body", False)
            size += len(part)
            if size > PIECE:
                await self.pace.step()

    async def json(self) -> Json:
        """Return the body as JSON.

        Raises
        ------
        JSONDecodeError
            If it is not JSON, not UTF-8, or nested too deeply; FastAPI answers this error as an invalid
            input.
        """
        if not hasattr(self, "_json"):
            try:
                self._json = from_json(await self.body())
            except ValueError as error:
                raise JSONDecodeError(str(error)[:200], "", 0) from None
        return self._json


class StrictRoute(APIRoute):
    """A route that checks the precondition and the content type, in this order, before anything else.

    Its responses leave out fields that were not set.
    """

    request_class = StrictRequest

    def __init__(
        self, path: str, endpoint: Callable[..., object], **options: Any
    ) -> None:  # signature of FastAPI
        own = {"response_model_exclude_unset": True, "generate_unique_id_function": operation_id}
        super().__init__(path, endpoint, **{**options, **own})
        self.takes = frozenset(self.methods or ())
        reads_etag = any(one.alias.lower() == "if-match" for one in self.dependant.header_params)
        self.needs_etag = reads_etag and bool(self.takes & CHANGES)

    def get_route_handler(self) -> Callable[[Request], Coroutine[object, None, Response]]:
        """Return FastAPI's handler, preceded by the checks."""
        if not iscoroutinefunction(self.endpoint):  # FastAPI calls it in a thread
            self.dependant.call = metered(self.endpoint)
        handler = super().get_route_handler()

        async def strict(request: Request) -> Response:
            strictly = self.request_class(request.scope, request.receive)
            await self.check(strictly)
            return await handler(strictly)

        return strict

    async def check(self, request: StrictRequest) -> None:
        """Refuse requests with a wrong form, before their meaning is examined.

        Raises
        ------
        HttpError
            If the precondition is missing, or the body has a wrong type, is too large or too complex.
        HTTPException, InvalidInputs
            If a text contains U+0000 or a key of the service.
        """
        await _refreshed(request)
        refuse_nul_in_address(request)
        is_patch = "PATCH" in self.takes
        if self.needs_etag and "if-match" not in request.headers:
            raise PreconditionRequired('send If-Match with the ETag of what you read, such as "3"')
        if self.body_field is not None:
            check_type(request, PATCH_TYPES if is_patch else JSON_TYPES)
            # Read the body here, because FastAPI answers any error raised while it reads with 400.
            await self._admit(request)
            if await _check_intricacy(request) and is_forbidden(await request.body()):
                refuse_forbidden_in(await _read(request))

    async def _admit(self, request: StrictRequest) -> None:
        try:
            await self.admit(request)
        except Exception:
            await request.discard()
            raise

    async def admit(self, request: StrictRequest) -> None:
        """Raise an error that the head of a request implies, before its body arrives; none by default."""


class _Parameter:
    """A parameter of an endpoint that comes from the path, the query or a header."""

    def __init__(self, kind: str, field: ModelField) -> None:
        self.name, self.alias, self._place = field.name, field.alias, (kind, field.alias)
        self._validate, self._default = field.validate, field.field_info.default
        self._is_required = field.field_info.is_required()

    def value(self, received: Mapping[str, str], faults: list[object]) -> object:
        """Return the received value or the default; add any faults to the list."""
        if (text := received.get(self.alias)) is None:
            faults += [_missing(*self._place)] if self._is_required else ()
            return self._default
        value, wrong = self._validate(text, loc=self._place)
        faults += wrong
        return value


class PlainRoute(StrictRoute):
    """A route that parses its requests and calls its endpoint itself, for the most frequent operations.

    It is declared and described as any other route, and refuses requests with the same errors. Its endpoint
    is a coroutine that takes the request first, then path, query, headers and body, and returns a Response;
    it has no dependencies except the role that it needs.
    """

    def __init__(self, path: str, endpoint: Callable[..., Awaitable[Response]], **options: Json) -> None:
        super().__init__(path, endpoint, **options)
        declared = self.dependant
        self._in_path = [_Parameter("path", field) for field in declared.path_params]
        self._in_query = [_Parameter("query", field) for field in declared.query_params]
        self._in_headers = [_Parameter("header", field) for field in declared.header_params]
        self._body = declared.body_params[0].name if self.body_field else None

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Parse the request, and send the endpoint's response."""
        if scope["method"] not in self.takes:
            await super().handle(scope, receive, send)  # 405
            return
        request = StrictRequest(scope, receive)
        await self.check(request)
        response = await self.shortcut(request) or await self.endpoint(request, **await self._values(request))
        await response(scope, receive, send)

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """Return a response that does not need the parsed body; None by default."""
        return None

    async def _values(self, request: StrictRequest) -> dict[str, object]:
        """Return the arguments of the endpoint.

        Raises
        ------
        RequestValidationError
            If there are faults; the error lists all of them.
        """
        faults: list[object] = []
        values = {one.name: one.value(request.path_params, faults) for one in self._in_path}
        values |= {one.name: one.value(request.query_params, faults) for one in self._in_query}
        values |= {one.name: one.value(request.headers, faults) for one in self._in_headers}
        if self._body is not None:
            values[self._body] = await self._read_body(request, faults)
        if faults:
            raise RequestValidationError(faults)
        return values

    async def _read_body(self, request: StrictRequest, faults: list[object]) -> object:
        assert self.body_field is not None
        if not await request.body():
            if self.body_field.field_info.is_required():
                faults.append(_missing("body"))
            return None
        try:
            raw = await request.json()
        except JSONDecodeError as error:
            raise RequestValidationError([_not_json(error)]) from None
        body, wrong = self.body_field.validate(raw, loc=("body",))
        faults += wrong
        return body


def _missing(*place: str) -> dict[str, object]:
    """Return the fault for a required value that was not sent."""
    return {"type": "missing", "loc": place, "msg": "Field required", "input": None}


def _not_json(error: JSONDecodeError) -> dict[str, object]:
    """Return the fault for a body that is not JSON."""
    place, reason = ("body", error.pos), {"error": error.msg}
    return {"type": "json_invalid", "loc": place, "msg": "JSON decode error", "input": {}, "ctx": reason}


async def _refreshed(request: Request) -> None:
    """Check whether a team's files have changed, before the request uses them."""
    services = getattr(request.app.state, "services", None)
    if services is not None:
        await services.catalogues.refresh()


def check_type(request: Request, allowed: set[str], error: type[HttpError] = NotJson) -> None:
    """Refuse a body whose content type is not allowed.

    Raises
    ------
    HttpError
        The given error, if there is a body whose type is missing or not allowed.
    """
    if request.headers.get("content-type") in allowed:
        return
    length = request.headers.get("content-length")
    if length in (None, "0") and "transfer-encoding" not in request.headers:
        return  # the route decides whether it accepts an empty body
    _require_type(request, allowed, error, " or ".join(sorted(allowed)))


def _require_type(request: Request, allowed: Container[str], error: type[HttpError], right: str) -> None:
    given = request.headers.get("content-type", "")
    if given.partition(";")[0].strip().lower() not in allowed:
        raise error(f"content type {given[:80]!r} is not accepted here; send {right}")


def require_step(request: Request) -> None:
    """Refuse a body that is not declared as a STEP file; compressed files (`+zip`) are not supported.

    Raises
    ------
    NotStep
        If the content type is missing or not that of STEP.
    """
    _require_type(request, STEP_TYPES, NotStep, "the STEP file itself as model/step")


def require_sheet(request: Request) -> None:
    """Refuse a body that is not declared as a Mathcad sheet.

    Raises
    ------
    NotSheet
        If the content type is missing or not allowed.
    """
    _require_type(request, SHEET_TYPES, NotSheet, "the file itself as application/octet-stream")


def require_model(request: Request) -> None:
    """Refuse a body that is not declared as the file of a model.

    Raises
    ------
    NotModel
        If the content type is missing or not allowed.
    """
    _require_type(request, MODEL_TYPES, NotModel, "the file itself as application/octet-stream")


async def _read(request: StrictRequest) -> object:
    """Return the body as JSON, or nothing if it is not valid JSON, which another check refuses."""
    try:
        return await request.json()
    except JSONDecodeError:
        return None


async def _check_intricacy(request: StrictRequest) -> bool:
    """Check that the body has not too many nested or named parts; return whether a text may be forbidden.

    A large body is checked in pieces, so that other requests run in between.
    """
    brackets = quotes = 0
    is_suspect, end = False, b""
    parts = await request.parts()
    if len(parts) == 1 and len(parts[0]) <= MOST_BRACKETS:  # too short to have too many brackets
        return may_be_forbidden(parts[0])
    for number, part in enumerate(parts):
        if number:
            await request.pace.step()
        brackets += part.count(b"[") + part.count(b"{")
        quotes += part.count(b'"')
        is_suspect = is_suspect or may_be_forbidden(part) or may_be_forbidden(end + part[:5])
        end = part[-5:]
    if brackets > MOST_BRACKETS or quotes > MOST_QUOTES:
        message = f"a body may open {MOST_BRACKETS} brackets and have {MOST_QUOTES // 2} texts and names"
        raise TooIntricate(
            f'{message}; send numbers as one list with one unit: {{"value": [1, 2], "unit": "mm"}}'
        )
    return is_suspect


async def fingerprint(request: Request) -> str:
    """Return the SHA-256 of a request's body and query parameters."""
    content = await (request.file() if isinstance(request, StrictRequest) else request.body())
    is_large = len(content) > PIECE  # hashing releases the interpreter lock, but would hold the event loop
    digest = await asyncio.to_thread(hashlib.sha256, content) if is_large else hashlib.sha256(content)
    if query := request.scope["query_string"]:
        digest.update(b"?" + query)
    return digest.hexdigest()


NUL = "\0"
"""U+0000, which PostgreSQL cannot store. For both kinds of database, the service refuses it while reading
a request and names the field that contains it."""
MOST_PLACES = 20
_NUL_DETAIL = "no text may contain the character U+0000 (NUL); remove it: {}"
_KEY_DETAIL = "no text may contain a key of the service: others would read it; remove it, and revoke the key"
_ESCAPED_NUL, _KEY_MARK = b"\\u0000", MARK.encode()
_JSON_NUL = re.compile(rb"(?<!\\)(?:\\\\)*\\u0000")
"""U+0000 in JSON; an escaped backslash may precede `u0000`."""


def refuse_nul_in_address(request: Request) -> None:
    """Refuse an address that contains U+0000.

    Raises
    ------
    HTTPException
        If the path contains it; the status is 404, because no resource has such a name.
    InvalidInputs
        If query parameters contain it.
    """
    if NUL in request.scope["path"]:
        raise HTTPException(404, "a name cannot contain U+0000")
    if b"%00" in request.scope["query_string"]:
        given = request.query_params.multi_items()
        having = [(name, value) for name, value in given if NUL in name or NUL in value]
        _refuse({name: value if NUL in value else name for name, value in having})


def may_be_forbidden(part: bytes) -> bool:
    """Return whether a piece of JSON may contain a text with U+0000 or with a key."""
    return _ESCAPED_NUL in part or _KEY_MARK in part


def is_forbidden(body: bytes) -> bool:
    """Return whether a text in JSON contains U+0000 or a key of the service, in linear time."""
    return _JSON_NUL.search(body) is not None or (_KEY_MARK in body and holds_key(body.decode("latin-1")))


def refuse_forbidden_in(value: object) -> None:
    """Refuse JSON that contains U+0000 or a key of the service in a text or a name.

    Raises
    ------
    InvalidInputs
        If fields contain them; the error names the fields.
    """
    _refuse(dict(_forbidden_places(value)))


def _refuse(texts: Mapping[str, str]) -> None:
    """Raise InvalidInputs if there are forbidden texts; each is named with its text or name."""
    if texts:
        raise InvalidInputs([_forbidden(name, text) for name, text in islice(texts.items(), MOST_PLACES)])


def _forbidden(name: str, text: str) -> Fault:
    shown = plain(without_keys(name).replace(NUL, "\\0"))
    if NUL in text:
        return Fault(shown, "nul", _NUL_DETAIL.format(_nul_position(text)))
    return Fault(shown, "key", _KEY_DETAIL)


def _nul_position(text: str) -> str:
    """Return the line and column of the first U+0000 in a text, numbered as in editors."""
    before = text[: text.index(NUL)]
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    return f"line {line}, column {column}" if "\n" in text else f"character {column}"


def _forbidden_places(value: object) -> Iterator[tuple[str, str]]:
    """Yield each forbidden text in JSON with its location: the dotted path, and the text or name itself."""
    waiting: list[tuple[str, object]] = [("", value)]
    while waiting:
        place, part = waiting.pop()
        within = f"{place[:200]}." if place else ""
        if isinstance(part, str) and (NUL in part or holds_key(part)):
            yield place or "body", part
        elif isinstance(part, dict):
            yield from ((f"{within}{name[:80]}", name) for name in part if NUL in name or holds_key(name))
            waiting += [(f"{within}{name[:80]}", inner) for name, inner in part.items()]
        elif isinstance(part, list):
            waiting += [(f"{within}{number}", inner) for number, inner in enumerate(part)]
