"""Give every request an id, count and time requests, and log one line for each."""

from __future__ import annotations

import logging
import time

from fastapi import FastAPI
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.access import from_whom
from app.observation import logs, metrics

logger = logging.getLogger(__name__)

CLIENT_LEFT = 499  # nginx's status for a client that disconnected before the answer
_LONGEST = 200  # characters of a path in the log
_METHODS = {"GET", "POST", "PUT", "PATCH", "DELETE", "HEAD", "OPTIONS"}


in_flight: dict[int, tuple[str, str, str, float]] = {}
"""Requests in flight, by the identity of their scope: id, method, path, start."""


metrics.IN_FLIGHT.set_function(lambda: len(in_flight))


class RequestLog:
    """ASGI middleware, installed outermost so that it also sees refused requests."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with an id, and observe the response."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start, status, is_gone = time.perf_counter(), 0, False
        id_ = logs.request_id(scope["headers"])
        header = (b"x-request-id", id_.encode())
        token = logs.REQUEST_ID.set(id_)

        async def received() -> Message:
            nonlocal is_gone
            message = await receive()
            is_gone = is_gone or message["type"] == "http.disconnect"
            return message

        async def observed(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = (
                    CLIENT_LEFT if is_gone else message["status"]
                )  # the client will not receive this answer
                message["headers"] = [*message.get("headers", ()), header]
                metrics.REQUESTS.add(route_of(scope), method_of(scope), status, time.perf_counter() - start)
            await send(message)

        in_flight[id(scope)] = (id_, scope["method"], scope["path"], start)
        try:
            await self.app(scope, received, observed)
        finally:
            del in_flight[id(scope)]
            if status >= 500 or logger.isEnabledFor(logging.INFO):
                _log(scope, status, time.perf_counter() - start)
            logs.REQUEST_ID.reset(token)


def what_is_in_flight() -> list[str]:
    """Return a short description of each request that is being answered."""
    now = time.perf_counter()
    return [
        f"{method} {path[:_LONGEST]} for {now - start:.1f} s [{id_}]"
        for id_, method, path, start in list(in_flight.values())
    ]


def install(app: FastAPI) -> None:
    """Wrap the whole app, including its response to an unexpected error."""
    build = app.build_middleware_stack  # with `add_middleware`, Starlette's error handler would stay outside
    app.build_middleware_stack = lambda: RequestLog(build())  # type: ignore[method-assign]


def route_of(scope: Scope) -> str:
    """Return the path template of the route, never the path itself; the number of templates is small."""
    route = scope.get("route")
    if route is not None:
        return route.path  # type: ignore[no-any-return]
    return "/static" if scope["path"].startswith("/static/") else "unknown"


def method_of(scope: Scope) -> str:
    """Return the method, or `other`: a client may invent methods."""
    return scope["method"] if scope["method"] in _METHODS else "other"


def _log(scope: Scope, status: int, seconds: float) -> None:
    """Write one log line; without a status, the client disconnected before the answer."""
    path = scope["path"][:_LONGEST]
    about = {
        "client": logs.without_secret(from_whom(scope)),
        "method": scope["method"],
        "route": route_of(scope),
        "path": path,
        "status": status,
        "ms": round(seconds * 1e3, 2),
    }
    level = logging.WARNING if status >= 500 else logging.INFO
    logger.log(
        level, "%s %s %d %.1f ms %s", scope["method"], path, status, about["ms"], about["client"], extra=about
    )
