"""The REST interface, called within the process: the pages have no other way to the data.

What a page shows is what a user would be answered; what a form does is a call that a user could make.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import httpx
from fastapi import Depends, FastAPI, Request

from app.api.gate.clients import TheClient, from_inside

BASE = "/api/v1"
_CLIENT = "crankwright.client"
"""Extension of a request within the process: the client of the page's request."""


class Refused(Exception):
    """The interface answered with a problem; `problem` is it."""

    def __init__(self, status: int, problem: Mapping[str, Any]) -> None:
        self.status, self.problem = status, problem
        super().__init__(f"{status} {problem.get('detail', '')}")

    @property
    def faults(self) -> dict[str, str]:
        """What is wrong, by the name of the input."""
        return {fault["name"]: fault["detail"] for fault in self.problem.get("errors", ())}


class Api:
    """Calls of the interface by one request of a page, for the client who sent that."""

    def __init__(self, http: httpx.AsyncClient, client: str) -> None:
        self._http, self._client = http, client

    async def get(self, path: str, **query: Any) -> dict[str, Any]:
        """What a GET answers.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        return (await self.send("GET", path, params=query)).json()  # type: ignore[no-any-return]

    async def find(self, path: str, **query: Any) -> dict[str, Any] | None:
        """What a GET answers, or None where there is nothing."""
        try:
            return await self.get(path, **query)
        except Refused as refused:
            if refused.status != 404:
                raise
            return None

    async def post(self, path: str, body: Any = None, **query: Any) -> dict[str, Any]:
        """What a POST answers; it does not wait for geometry.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        return (await self.send("POST", path, json=body, params=query)).json()  # type: ignore[no-any-return]

    async def send(self, method: str, path: str, **more: Any) -> httpx.Response:
        """Any call.

        Raises
        ------
        Refused
            If the interface refuses.
        """
        extensions = {_CLIENT: self._client}
        try:
            answer = await self._http.request(method, BASE + path, extensions=extensions, **more)
        except httpx.InvalidURL:  # made from what a client typed
            raise Refused(404, {"title": "Not found", "detail": "there is nothing at this address"}) from None
        if answer.is_error:
            raise Refused(answer.status_code, answer.json())
        return answer


class Inside(httpx.AsyncBaseTransport):
    """Hands requests to the app itself, each with its client."""

    def __init__(self, app: FastAPI) -> None:
        self._app = app

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Call the app below its guard, which let the page's request pass."""
        app = from_inside(self._app, request.extensions[_CLIENT])
        return await httpx.ASGITransport(app, raise_app_exceptions=False).handle_async_request(request)


async def get_api(request: Request, client: TheClient) -> Api:
    """The interface of the app that serves this request; its HTTP client is made once."""
    state = request.app.state
    if not hasattr(state, "web_client"):
        # The host is a placeholder: the guard does not answer to it, and does not see these calls.
        inside = Inside(request.app)
        state.web_client = httpx.AsyncClient(transport=inside, base_url="http://crankwright", timeout=None)
    return Api(state.web_client, client)


TheApi = Annotated[Api, Depends(get_api)]
