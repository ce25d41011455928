"""The REST interface, called within the process: the pages have no other way to the data.

What a page shows is what a user would be answered; what a form does is a call that a user could make.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import httpx
from fastapi import Depends, Request

from app import logs

BASE = "/api/v1"


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
    """Calls of the interface by one request of a page."""

    def __init__(self, http: httpx.AsyncClient) -> None:
        self._http = http

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
        headers = {"X-Request-ID": logs.REQUEST_ID.get(), **(more.pop("headers", None) or {})}
        answer = await self._http.request(method, BASE + path, headers=headers, **more)
        if answer.is_error:
            raise Refused(answer.status_code, answer.json())
        return answer


async def get_api(request: Request) -> Api:
    """The interface of the app that serves this request; its client is made once."""
    state = request.app.state
    if not hasattr(state, "web_client"):
        transport = httpx.ASGITransport(app=request.app, raise_app_exceptions=False)
        state.web_client = httpx.AsyncClient(transport=transport, base_url="http://crankwright", timeout=None)
    return Api(state.web_client)


TheApi = Annotated[Api, Depends(get_api)]
