"""Requirements for every request: a small body, valid JSON, a precondition on changes.

`StrictRoute` replaces FastAPI's lenient reading of bodies: pydantic's parser refuses lone surrogates and deep
nesting, and nothing is guessed from a missing or wrong content type.
"""

from __future__ import annotations

import hashlib
from collections.abc import AsyncIterator, Awaitable, Callable, Container, Coroutine
from json import JSONDecodeError
from typing import Any

from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic_core import from_json
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http import nul
from app.http.pace import Pace
from app.plain import Json
from app.workers.pieces import PIECE, Pieces

JSON_TYPES = {"application/json"}
PATCH_TYPES = {"application/json", "application/merge-patch+json"}
STEP_TYPES = ("model/step", "application/step", "application/p21")
"""The registered name of STEP's clear text, and two that were in use before it."""
SHEET_TYPES = {"application/octet-stream", "application/zip", "application/xml", "text/xml"}
"""Media types of a sheet of Mathcad: its own ones are not registered."""
MODEL_TYPES = {"application/octet-stream", "application/zip", "model/step"}
"""Media types of a model: FreeCAD's own one is not registered."""
FORM_TYPES = {"application/x-www-form-urlencoded"}
MOST_BRACKETS, MOST_QUOTES = 250_000, 400_000
"""In one body. A list of numbers has one bracket; millions of them keep the parser, and the server, busy."""


class HttpError(Exception):
    """A request that is refused before its meaning is looked at."""


class BodyTooLarge(HttpError):
    """The body is larger than the service takes."""


class HeadTooLarge(HttpError):
    """The address and the headers are longer than the service takes."""


class TooIntricate(HttpError):
    """The body nests or names more than any design or table does."""


class NotJson(HttpError):
    """The content type is not one that the path takes."""


class NotForm(HttpError):
    """The content type is not that of a form."""


class NotCsv(HttpError):
    """The content type is not that of a table."""


class NotStep(HttpError):
    """The content type is not that of a STEP file."""


class NotSheet(HttpError):
    """The content type is not one under which a sheet of Mathcad is sent."""


class NotModel(HttpError):
    """The content type is not one under which a model is sent."""


class PreconditionRequired(HttpError):
    """A change without If-Match."""


class StrictRequest(Request):
    """A request whose JSON is parsed strictly, and whose body comes in pieces if it is large."""

    @property
    def pace(self) -> Pace:
        """The pace of all large bodies and answers of the app."""
        return self.app.state.pace  # type: ignore[no-any-return]

    async def pieces(self) -> Pieces:
        """The body as it came."""
        if not hasattr(self, "_pieces"):
            self._pieces = Pieces(tuple([part async for part in self._received()]))
        return self._pieces

    async def body(self) -> bytes:
        """The body as one object; to join a large one holds the interpreter, see `pieces`."""
        if not hasattr(self, "_body"):
            self._body = (await self.pieces()).joined()
        return self._body

    async def discard(self) -> None:
        """Receive the body and forget it: a client that still sends may not read an answer yet."""
        async for _ in self._received():
            pass

    async def _received(self) -> AsyncIterator[bytes]:
        size = 0
        async for part in self.stream():
            if part:
                yield part
            size += len(part)
            if size > PIECE:
                await self.pace.step()

    async def json(self) -> Json:
        """The body as JSON.

        Raises
        ------
        JSONDecodeError
            If it is none, no UTF-8, or nested too deep; FastAPI answers it as an invalid input.
        """
        if not hasattr(self, "_json"):
            try:
                self._json = from_json(await self.body())
            except ValueError as error:
                raise JSONDecodeError(str(error)[:200], "", 0) from None
        return self._json


class StrictRoute(APIRoute):
    """A route that checks precondition and content type, in this order, before anything else.

    Its answers leave out the fields that nobody has set.
    """

    def __init__(self, path: str, endpoint: Callable[..., object], **options: Any) -> None:  # as FastAPI
        super().__init__(path, endpoint, **{**options, "response_model_exclude_unset": True})

    def get_route_handler(self) -> Callable[[Request], Coroutine[object, None, Response]]:
        """FastAPI's handler behind the checks."""
        handler = super().get_route_handler()
        takes_json = self.body_field is not None
        is_patch = "PATCH" in (self.methods or ())
        is_change = is_patch or "PUT" in (self.methods or ())

        async def strict(request: Request) -> Response:
            await _refreshed(request)
            nul.refuse_in_address(request)
            if is_change and "if-match" not in request.headers:
                raise PreconditionRequired('send If-Match with the ETag of what you read, such as "3"')
            strictly = StrictRequest(request.scope, request.receive)
            if takes_json:
                check_type(request, PATCH_TYPES if is_patch else JSON_TYPES)
                # here, because FastAPI answers whatever is raised in its reading with 400
                await self._admit(strictly)
                if await _check_intricacy(strictly) and nul.has(await strictly.body()):
                    nul.refuse_in(await _read(strictly))
            return await self.shortcut(strictly) or await handler(strictly)

        return strict

    async def _admit(self, request: StrictRequest) -> None:
        try:
            await self.admit(request)
        except Exception:
            await request.discard()
            raise

    async def admit(self, request: StrictRequest) -> None:
        """Raise what refuses a request by its head alone; its body has not come yet."""

    async def shortcut(self, request: StrictRequest) -> Response | None:
        """An answer past FastAPI's general machinery, where a route can read a plain request by itself."""
        return None


async def _refreshed(request: Request) -> None:
    """Take notice of a team's files that have changed."""
    services = getattr(request.app.state, "services", None)
    if services is not None:
        await services.catalogues.refresh()


def check_type(request: Request, allowed: set[str], error: type[HttpError] = NotJson) -> None:
    """Refuse a body that is of no allowed type.

    Raises
    ------
    HttpError
        The error given, if there is a body, and its type is another or is not named.
    """
    length = request.headers.get("content-length")
    if length in (None, "0") and "transfer-encoding" not in request.headers:
        return  # an empty body is judged by what the route needs
    _require_type(request, allowed, error, " or ".join(sorted(allowed)))


def _require_type(request: Request, allowed: Container[str], error: type[HttpError], right: str) -> None:
    given = request.headers.get("content-type", "")
    if given.partition(";")[0].strip().lower() not in allowed:
        raise error(f"content type {given[:80]!r} is not taken here; send {right}")


def require_step(request: Request) -> None:
    """Refuse a body that does not say that it is a STEP file; packed ones (`+zip`) are not understood.

    Raises
    ------
    NotStep
        If the content type is another, or missing.
    """
    _require_type(request, STEP_TYPES, NotStep, "the STEP file itself as model/step")


def require_sheet(request: Request) -> None:
    """Refuse a body that is said to be something else than a sheet of Mathcad.

    Raises
    ------
    NotSheet
        If the content type is another, or missing.
    """
    _require_type(request, SHEET_TYPES, NotSheet, "the file itself as application/octet-stream")


def require_model(request: Request) -> None:
    """Refuse a body that is said to be something else than a file of a model.

    Raises
    ------
    NotModel
        If the content type is another, or missing.
    """
    _require_type(request, MODEL_TYPES, NotModel, "the file itself as application/octet-stream")


async def _read(request: StrictRequest) -> object:
    """The body as JSON, or nothing if it is none: that is refused elsewhere."""
    try:
        return await request.json()
    except JSONDecodeError:
        return None


async def _check_intricacy(request: StrictRequest) -> bool:
    """Count what makes parsing expensive; of a large body piece by piece, so that others get their turn.

    Returns whether a text may have U+0000.
    """
    brackets = quotes = 0
    may_have_nul, end = False, b""
    for number, piece in enumerate(await request.pieces()):
        if number:
            await request.pace.step()
        part = bytes(piece)
        brackets += part.count(b"[") + part.count(b"{")
        quotes += part.count(b'"')
        may_have_nul = may_have_nul or nul.may_have(part) or nul.may_have(end + part[:5])
        end = part[-5:]
    if brackets > MOST_BRACKETS or quotes > MOST_QUOTES:
        message = f"a body may open {MOST_BRACKETS} brackets and have {MOST_QUOTES // 2} texts and names"
        raise TooIntricate(
            f'{message}; send numbers as one list with one unit: {{"value": [1, 2], "unit": "mm"}}'
        )
    return may_have_nul


class BodyLimit:
    """ASGI middleware that ends the reading of a body beyond the limit [bytes] with a 413 problem."""

    # FastAPI's own max_body_size answers in plain text, not with a problem.
    def __init__(self, app: ASGIApp, limit: int, refuse: Callable[[str], Response]) -> None:
        self.app, self.limit, self.refuse = app, limit, refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        detail = f"a body may have at most {self.limit / 2**20:g} MiB"
        length = dict(scope["headers"]).get(b"content-length", b"0")
        if not length.isdigit() or int(length) > self.limit:
            await self.refuse(detail)(scope, receive, send)
            return
        await self.app(scope, self._counted(receive, detail) if length == b"0" else receive, send)

    def _counted(self, receive: Receive, detail: str) -> Callable[[], Awaitable[Message]]:
        """For a body of unknown length: raise once it grows beyond the limit."""
        size = 0

        async def counted() -> Message:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > self.limit:
                raise BodyTooLarge(detail)
            return message

        return counted


async def fingerprint(request: Request) -> str:
    """SHA-256 of a request's body; with parameters in its address, of these too."""
    digest = hashlib.sha256(await request.body())
    if query := request.scope["query_string"]:
        digest.update(b"?" + query)
    return digest.hexdigest()
