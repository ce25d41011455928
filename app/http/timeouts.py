"""A limit on how slowly the body of a request may come."""

from __future__ import annotations

import asyncio
import time

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.strict_requests import HttpError

WHOLE = "crankwright.whole"
"""Key of an ASGI scope of which all has come already: most have, and to time them costs a twentieth."""


class BodyTooSlow(HttpError):
    """The body comes more slowly than the service waits for."""

    headers = {"Connection": "close"}  # what is left of the body may never come


class BodyTime:
    """ASGI middleware that bounds the time in which a body comes.

    Parameters
    ----------
    seconds
        Longest wait for the next piece of a body [s], and what the whole may take beside its size.
    rate
        What a body must bring on average [bytes/s].
    """

    def __init__(self, app: ASGIApp, seconds: float, rate: float) -> None:
        self.app, self.seconds, self.rate = app, seconds, rate

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with a `receive` that raises BodyTooSlow."""
        is_whole = scope["type"] != "http" or WHOLE in scope or not _has_body(scope)
        await self.app(scope, receive if is_whole else self._timed(receive), send)

    def _timed(self, receive: Receive) -> Receive:
        """Time only what is waited for: while the service does something else, the client may wait."""
        waited, size, whole = 0.0, 0, False

        async def timed() -> Message:
            nonlocal waited, size, whole
            if whole:
                return await receive()
            start = time.monotonic()
            left = self.seconds + size / self.rate - waited
            try:
                async with asyncio.timeout(min(left, self.seconds)):
                    message = await receive()
            except TimeoutError:
                raise BodyTooSlow(self._explained(size)) from None
            waited += time.monotonic() - start
            size += len(message.get("body", b""))
            whole = not message.get("more_body", False)
            return message

        return timed

    def _explained(self, size: int) -> str:
        wanted = f"it may pause for {self.seconds:g} s and must bring {self.rate:g} bytes/s on average"
        return f"the body comes too slowly ({size} bytes came): {wanted}"


def _has_body(scope: Scope) -> bool:
    return any(
        name == b"transfer-encoding" or (name == b"content-length" and value != b"0")
        for name, value in scope["headers"]
    )
