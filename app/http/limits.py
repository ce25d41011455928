"""Limits on every request: the sizes of head and body, and the speed of the body.

FastAPI parses the cookies of every request by a function of the standard library whose time is quadratic in
the length of a quoted cookie. The service sets no quoted cookies, so quoted ones are dropped. FastAPI's own
limit on bodies answers in plain text, not with a problem.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain

from starlette.types import Message, Receive, Scope

from app.http.connections import LONGEST_HEAD, WHOLE
from app.http.strict_requests import HttpError

MOST_HEADERS, MOST_FIELDS = 200, 1000  # headers and query fields


class HeadTooLarge(HttpError):
    """The address and the headers are longer than the service accepts."""


class AddressCrowded(HttpError):
    """One address has too many requests in progress."""

    headers = {"Retry-After": "5"}


class BodyTooLarge(HttpError):
    """The body is larger than the service accepts."""


class BodyTooSlow(HttpError):
    """The body arrives more slowly than the service allows."""

    headers = {"Connection": "close"}  # the rest of the body may never arrive


class ServiceStopping(HttpError):
    """The service stops before the response to a request is ready."""

    headers = {"Retry-After": "5"}  # until a restarted service is ready [s]


@dataclass(frozen=True)
class BodyLimits:
    """Limits on the body of a request, in addition to those on its head.

    Parameters
    ----------
    size
        Largest body [bytes].
    seconds
        Longest wait for the next piece of a body [s], also added to the time that the size and `rate` allow.
    rate
        Lowest average rate at which a body must arrive [bytes/s].
    upload_size
        Largest body that is an uploaded file [bytes].
    uploads
        Paths to which files are uploaded.
    """

    size: int
    seconds: float
    rate: float
    upload_size: int = 0
    uploads: frozenset[str] = frozenset()

    def admit(self, scope: Scope, receive: Receive) -> Receive:
        """Return a `receive` that raises BodyTooLarge and BodyTooSlow; drop quoted cookies from the request.

        Raises
        ------
        HeadTooLarge, BodyTooLarge
            If the head, or the stated length of the body, exceeds the limits.
        """
        headers = dict(scope["headers"])
        length = headers.get(b"content-length", b"0")
        self._check(scope, length)
        if b"cookie" in headers:
            scope["headers"] = list(_without_quoted_cookies(scope["headers"]))
        if WHOLE not in scope and (length != b"0" or b"transfer-encoding" in headers):
            receive = self._timed(receive)
        return self._counted(scope, receive) if length == b"0" else receive

    def _check(self, scope: Scope, length: bytes) -> None:
        """Refuse a request whose head or stated length exceeds the limits."""
        headers, query = scope["headers"], scope["query_string"]
        size = sum(map(len, chain.from_iterable(headers))) + len(query) + len(scope.get("raw_path") or b"")
        if size > LONGEST_HEAD:
            most = f"at most {LONGEST_HEAD // 1024} KiB"
            raise HeadTooLarge(f"the address and the headers together may be {most} long")
        if len(headers) > MOST_HEADERS:
            raise HeadTooLarge(f"a request may have at most {MOST_HEADERS} headers")
        if query.count(b"&") >= MOST_FIELDS:
            raise HeadTooLarge(f"the query of an address may have at most {MOST_FIELDS} fields")
        if not (length.isdigit() and int(length) <= self._largest(scope)):
            raise self._too_large(scope)

    def _largest(self, scope: Scope) -> int:
        return self.upload_size if scope["path"] in self.uploads else self.size

    def _too_large(self, scope: Scope) -> BodyTooLarge:
        is_upload = scope["path"] in self.uploads
        what, setting = ("an uploaded file", "UPLOAD") if is_upload else ("a body", "BODY")
        most = f"{self._largest(scope) / 2**20:g} MiB in size"
        return BodyTooLarge(f"{what} may be at most {most} (CRANKWRIGHT_{setting}_LIMIT)")

    def _counted(self, scope: Scope, receive: Receive) -> Receive:
        """Return a `receive` that raises an error once a body of unknown length exceeds the limit."""
        size, largest = 0, self._largest(scope)

        async def counted() -> Message:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > largest:
                raise self._too_large(scope)
            return message

        return counted

    def _timed(self, receive: Receive) -> Receive:
        """Return a `receive` that measures only the waiting for the client, not the service's own work."""
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
                raise self._too_slow(size) from None
            waited += time.monotonic() - start
            size += len(message.get("body", b""))
            whole = not message.get("more_body", False)
            return message

        return timed

    def _too_slow(self, size: int) -> BodyTooSlow:
        pause, rate = self.seconds, self.rate
        wanted = f"it may pause for {pause:g} s and must bring {rate:g} bytes/s on average"
        return BodyTooSlow(f"the body arrives too slowly ({size} bytes so far): {wanted}")


def _without_quoted_cookies(headers: Iterable[tuple[bytes, bytes]]) -> Iterable[tuple[bytes, bytes]]:
    """Yield the headers without quoted cookies, which take quadratic time to parse."""
    for name, value in headers:
        yield name, (_plain_cookies(value) if name == b"cookie" and b'"' in value else value)


def _plain_cookies(header: bytes) -> bytes:
    return b";".join(cookie for cookie in header.split(b";") if b'"' not in cookie)
