"""The REST interface, called within the process: the pages have no other way to the data.

What a page shows is what a user would be answered; what a form does is a call that a user could make.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated, TypeVar

import httpx
from fastapi import Depends, FastAPI, Request
from pydantic import TypeAdapter
from starlette.types import Message, Scope

from app.http.clients import TheClient, from_inside
from app.schemas.problems import Problem
from app.web.same_answers import Same, same
from app.web.services import PageServices, Refused, get_services

Kind = TypeVar("Kind")
Scalar = str | int | float | bool | None

BASE = "/api/v1"
_CLIENT = "crankwright.client"
"""Extension of a request within the process: the client of the page's request."""


@dataclass(frozen=True)
class Api(PageServices):
    """Calls of the interface by one request of a page, for the client who sent that."""

    http: httpx.AsyncClient

    async def get(self, path: str, kind: type[Kind], **query: Scalar) -> Kind:
        """The answer of a GET, as a model.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        return read(await self.send("GET", path, params=query), kind)

    async def same(self, path: str, kind: type[Kind], **query: Scalar) -> Same[Kind]:
        """The answer of a GET as a model that is shared with earlier answers of equal bytes.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        return same((await self.send("GET", path, params=query)).content, kind)

    async def get_or_none(self, path: str, kind: type[Kind], **query: Scalar) -> Kind | None:
        """The answer of a GET, or None where there is nothing."""
        try:
            return await self.get(path, kind, **query)
        except Refused as refused:
            if refused.status != 404:
                raise
            return None

    async def post(self, path: str, kind: type[Kind], body: object = None, **query: Scalar) -> Kind:
        """The answer of a POST, as a model; it does not wait for geometry.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        return read(await self.send("POST", path, json=body, params=query), kind)

    async def send(
        self,
        method: str,
        path: str,
        *,
        json: object = None,
        content: bytes | None = None,
        params: Mapping[str, Scalar] | None = None,
        headers: Mapping[str, str] | None = None,
    ) -> httpx.Response:
        """Send a request and return the response.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        extensions = {_CLIENT: self.client}
        try:
            response = await self.http.request(
                method,
                BASE + path,
                json=json,
                content=content,
                params=params,
                headers=headers,
                extensions=extensions,
            )
        except httpx.InvalidURL:  # the path holds what a client typed
            raise Refused.because(404, "there is nothing at this address") from None
        if response.is_error:
            raise Refused(Problem.model_validate_json(response.content))
        return response


def read(response: httpx.Response, kind: type[Kind]) -> Kind:
    """The body of a response as a model, or as a dictionary of models."""
    return TypeAdapter(kind).validate_json(response.content)


class Inside(httpx.AsyncBaseTransport):
    """Hands requests to the app itself, each with its client."""

    def __init__(self, app: FastAPI) -> None:
        self._app = app

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Call the app below its guard, which let the page's request pass."""
        exchange = _Exchange(await request.aread())
        with suppress(Exception):  # the app has answered it with 500, and logged it
            await from_inside(self._app, request.extensions[_CLIENT])(
                _scope(request), exchange.receive, exchange.send
            )
        return httpx.Response(exchange.status, headers=exchange.headers, content=b"".join(exchange.parts))


class _Exchange:
    """A request's body and the answer to it, as ASGI passes them.

    httpx has a transport for this, which looks for a package of another event loop at each request.
    """

    def __init__(self, body: bytes) -> None:
        self.status, self.headers, self.parts = 500, list[tuple[bytes, bytes]](), list[bytes]()
        self._body: bytes | None = body
        self._answered = asyncio.Event()

    async def receive(self) -> Message:
        """The body; then nothing until the answer is complete."""
        if self._body is None:
            await self._answered.wait()
            return {"type": "http.disconnect"}
        body, self._body = self._body, None
        return {"type": "http.request", "body": body, "more_body": False}

    async def send(self, message: Message) -> None:
        """Take a part of the answer."""
        if message["type"] == "http.response.start":
            self.status, self.headers = message["status"], list(message.get("headers", ()))
        elif message["type"] == "http.response.body":
            self.parts.append(message.get("body", b""))
            if not message.get("more_body", False):
                self._answered.set()


def _scope(request: httpx.Request) -> Scope:
    url = request.url
    return {
        "type": "http",
        "asgi": {"version": "3.0"},
        "http_version": "1.1",
        "method": request.method,
        "headers": [(name.lower(), value) for name, value in request.headers.raw],
        "scheme": url.scheme,
        "path": url.path,
        "raw_path": url.raw_path.partition(b"?")[0],
        "query_string": url.query,
        "server": (url.host, url.port),
        "client": ("127.0.0.1", 0),
        "root_path": "",
    }


async def get_api(request: Request, client: TheClient) -> Api:
    """The interface of the app that serves this request; its HTTP client is shared."""
    state = request.app.state
    if not hasattr(state, "web_client"):
        # The host is a placeholder: the guard does not answer to it, and does not see these calls.
        inside = Inside(request.app)
        state.web_client = httpx.AsyncClient(
            transport=inside,
            base_url="http://crankwright",
            timeout=None,
            headers={"Accept-Encoding": "identity"},  # nothing is compressed within the process
        )
    services = await get_services(request, client)
    return Api(**vars(services), http=state.web_client)


TheApi = Annotated[Api, Depends(get_api)]
