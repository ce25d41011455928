"""The gate: one layer that every request passes before its route is looked up.

It refuses requests that another site may have made a browser send (`guard`), requests that are too large or
too slow (`limits`), and invalid keys if keys are required (`access`). It also answers unexpected errors, and
requests that are cancelled when the service ends. Only uvicorn cancels requests: those still running at the
end of the drain time.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import cast

from fastapi import FastAPI, Request, Response
from fastapi.middleware.asyncexitstack import AsyncExitStackMiddleware
from starlette.middleware.exceptions import ExceptionMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http import access, guard
from app.http.connections import AddressLimit, Pace
from app.http.limits import AddressCrowded, BodyLimits, ServiceStopping
from app.http.strict_requests import HttpError
from app.http.uploads import UploadRoute
from app.identity.errors import IdentityError
from app.identity.principal import ACTING
from app.observation.processor_time import METER, Meter, Metered
from app.settings.hosts import Hosts
from app.storage.errors import DatabaseUnavailable

Refusal = HttpError | IdentityError | DatabaseUnavailable
Unexpected = Callable[[Request, Exception], Awaitable[Response]]


class Gate:
    """ASGI middleware with all checks that do not depend on the route.

    Parameters
    ----------
    app
        The application.
    hosts
        The hosts whose requests it accepts.
    body
        Limits on the body.
    addresses
        Limit on the requests in progress of one address.
    refuse
        Function that returns the response to a refused request.
    unexpected
        Function that returns the response to an unexpected error; without it, the gate sends none.
    """

    def __init__(
        self,
        app: ASGIApp,
        hosts: Hosts,
        body: BodyLimits,
        addresses: AddressLimit,
        refuse: Callable[[Refusal], Response],
        unexpected: Unexpected | None = None,
    ) -> None:
        self.app, self.hosts, self.body, self.addresses = app, hosts, body, addresses
        self.refuse, self.unexpected = refuse, unexpected
        self._turns = Pace()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or pass it on as its principal; add the headers to the response."""
        if scope["type"] != "http":
            await self._passed(scope, receive, send)
            return
        answer, client = _Answer(send), scope.get("client")
        try:
            if self.addresses.enter(client):
                about = f"at most {self.addresses.most} requests of one address may be in progress"
                await self.refuse(AddressCrowded(about))(scope, receive, answer)
            else:
                await self._admitted(scope, receive, answer)
        except asyncio.CancelledError:
            if answer.has_begun:
                raise
            stopping = ServiceStopping("the service stopped before the answer was ready")
            await self.refuse(stopping)(scope, receive, answer)
        except Exception as error:
            if self.unexpected is not None and not answer.has_begun:
                await (await self.unexpected(Request(scope), error))(scope, receive, answer)
            raise  # the server logs it
        finally:
            self.addresses.leave(client)

    async def _admitted(self, scope: Scope, receive: Receive, answer: _Answer) -> None:
        if scope["path"] not in access.HEALTH:
            await self._turns.step()
        try:
            guard.check(scope, self.hosts)
            limited = self.body.admit(scope, receive)
            sender = await access.identify(scope)
        except (HttpError, IdentityError, DatabaseUnavailable) as error:
            await self.refuse(error)(scope, receive, answer)
            return
        token = ACTING.set(sender)
        try:
            await self._counted(scope, limited, answer)
        finally:
            ACTING.reset(token)

    async def _counted(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on; count its processor time if its principal has a budget."""
        if (settle := scope.get(access.SETTLE)) is None:
            await self.app(scope, receive, send)
            return
        meter = Meter()
        token = METER.set(meter)
        try:
            await Metered(self.app(scope, receive, send), meter)
        finally:
            METER.reset(token)
            settle(meter.seconds)

    async def _passed(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on whatever is not an HTTP request; refuse a WebSocket from another site."""
        if scope["type"] == "websocket":
            try:
                guard.check(scope, self.hosts)
            except HttpError as error:
                await send({"type": "websocket.close", "code": 1008, "reason": type(error).__name__})
                return
        await self.app(scope, receive, send)


class _Answer:
    """The `send` of a request, which adds the headers that every response has."""

    __slots__ = ("_send", "has_begun")

    def __init__(self, send: Send) -> None:
        self._send, self.has_begun = send, False

    async def __call__(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self.has_begun = True
            message["headers"] = guard.protected(message.get("headers", ()))
        await self._send(message)


def install(
    app: FastAPI,
    hosts: Hosts,
    body: BodyLimits,
    addresses: AddressLimit,
    refuse: Callable[[Refusal], Response],
) -> None:
    """Put the gate around the whole app, including its middleware and its responses to errors.

    It replaces Starlette's layer for unexpected errors, which would be inside the gate.
    """

    def built() -> ASGIApp:
        handlers = {kind: one for kind, one in app.exception_handlers.items() if kind is not Exception}
        unexpected = cast("Unexpected | None", app.exception_handlers.get(Exception))
        inner: ASGIApp = ExceptionMiddleware(AsyncExitStackMiddleware(app.router), handlers)
        for layer in reversed(app.user_middleware):
            inner = layer.cls(inner, *layer.args, **layer.kwargs)
        uploads = frozenset(one.path for one in app.routes if isinstance(one, UploadRoute))
        return Gate(inner, hosts, replace(body, uploads=uploads), addresses, refuse, unexpected)

    app.build_middleware_stack = built  # type: ignore[method-assign]
