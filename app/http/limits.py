"""Limits on every request: the sizes of head and body, the speed of the body, the shutdown of the service.

FastAPI reads the cookies of every request by a function of the standard library whose time is quadratic in
the length of a quoted cookie; none of ours is quoted, so quoted ones are dropped. FastAPI's own limit on
bodies answers in plain text, not with a problem.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.connections import LONGEST_HEAD, WHOLE
from app.http.strict_requests import HttpError

MOST_HEADERS, MOST_FIELDS = 200, 1000  # headers, and fields in the address


class HeadTooLarge(HttpError):
    """The address and the headers are longer than the service takes."""


class BodyTooLarge(HttpError):
    """The body is larger than the service takes."""


class BodyTooSlow(HttpError):
    """The body comes more slowly than the service waits for."""

    headers = {"Connection": "close"}  # what is left of the body may never come


class ServiceStopping(HttpError):
    """The service stops before the answer to a request is ready."""

    headers = {"Retry-After": "5"}  # until the service is back, if it is started again [s]


@dataclass(frozen=True)
class BodyLimits:
    """Limits on the body of a request.

    Parameters
    ----------
    size
        Largest body [bytes].
    seconds
        Longest wait for the next piece of a body [s], and what the whole may take beside its size.
    rate
        What a body must bring on average [bytes/s].
    """

    size: int
    seconds: float
    rate: float


class RequestLimits:
    """ASGI middleware that refuses what is too large, what comes too slowly, and what the service cannot end.

    uvicorn cancels what is in flight at the end of the drain time, and answers with a bare 500 where nothing
    was sent yet; this answers 503. Nothing else in the service cancels a request.

    Parameters
    ----------
    app
        The application.
    body
        Limits on the body.
    refuse
        Makes the answer to an error.
    """

    def __init__(self, app: ASGIApp, body: BodyLimits, refuse: Callable[[HttpError], Response]) -> None:
        self.app, self.body, self.refuse = app, body, refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on, with a `receive` that raises BodyTooLarge and BodyTooSlow."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        length = dict(scope["headers"]).get(b"content-length", b"0")
        if error := self._excess(scope, length):
            await self.refuse(error)(scope, receive, send)
            return
        scope["headers"] = list(_without_quoted_cookies(scope["headers"]))
        if WHOLE not in scope and _has_body(scope):
            receive = self._timed(receive)
        await self._passed(scope, self._counted(receive) if length == b"0" else receive, send)

    async def _passed(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer for the application if it is cancelled before its answer."""
        has_begun = False

        async def noted(message: Message) -> None:
            nonlocal has_begun
            has_begun = True
            await send(message)

        try:
            await self.app(scope, receive, noted)
        except asyncio.CancelledError:
            if has_begun:
                raise
            stopping = ServiceStopping("the service stopped before the answer was ready")
            await self.refuse(stopping)(scope, receive, send)

    def _excess(self, scope: Scope, length: bytes) -> HttpError | None:
        """Return the error for a head or a stated length beyond the limits; None within them."""
        headers, query = scope["headers"], scope["query_string"]
        size = sum(len(name) + len(value) for name, value in headers) + len(query)
        if size + len(scope.get("raw_path") or b"") > LONGEST_HEAD:
            most = f"at most {LONGEST_HEAD // 1024} KiB together"
            return HeadTooLarge(f"the address and the headers may have {most}")
        if len(headers) > MOST_HEADERS:
            return HeadTooLarge(f"a request may have at most {MOST_HEADERS} headers")
        if query.count(b"&") >= MOST_FIELDS:
            return HeadTooLarge(f"an address may have at most {MOST_FIELDS} fields")
        is_short = length.isdigit() and int(length) <= self.body.size
        return None if is_short else self._too_large()

    def _too_large(self) -> BodyTooLarge:
        return BodyTooLarge(f"a body may have at most {self.body.size / 2**20:g} MiB")

    def _counted(self, receive: Receive) -> Receive:
        """Raise once a body of unknown length exceeds the limit."""
        size = 0

        async def counted() -> Message:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > self.body.size:
                raise self._too_large()
            return message

        return counted

    def _timed(self, receive: Receive) -> Receive:
        """Time only the waiting for the client, not the time in which the service is busy."""
        waited, size, whole = 0.0, 0, False

        async def timed() -> Message:
            nonlocal waited, size, whole
            if whole:
                return await receive()
            start = time.monotonic()
            left = self.body.seconds + size / self.body.rate - waited
            try:
                async with asyncio.timeout(min(left, self.body.seconds)):
                    message = await receive()
            except TimeoutError:
                raise self._too_slow(size) from None
            waited += time.monotonic() - start
            size += len(message.get("body", b""))
            whole = not message.get("more_body", False)
            return message

        return timed

    def _too_slow(self, size: int) -> BodyTooSlow:
        pause, rate = self.body.seconds, self.body.rate
        wanted = f"it may pause for {pause:g} s and must bring {rate:g} bytes/s on average"
        return BodyTooSlow(f"the body comes too slowly ({size} bytes came): {wanted}")


def _has_body(scope: Scope) -> bool:
    return any(
        name == b"transfer-encoding" or (name == b"content-length" and value != b"0")
        for name, value in scope["headers"]
    )


def _without_quoted_cookies(headers: Iterable[tuple[bytes, bytes]]) -> Iterable[tuple[bytes, bytes]]:
    """Yield the headers without quoted cookies, which take quadratic time to parse."""
    for name, value in headers:
        yield name, (_plain_cookies(value) if name == b"cookie" and b'"' in value else value)


def _plain_cookies(header: bytes) -> bytes:
    return b";".join(cookie for cookie in header.split(b";") if b'"' not in cookie)
