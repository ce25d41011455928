"""The heads of requests are bounded: the line with the address, and the headers.

uvicorn reads a head of any length, and copies all of it again whenever another piece comes in. FastAPI reads
the cookies of every request by a function of the standard library whose time is quadratic in the length of a
quoted cookie.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

LONGEST_HEAD = 2**16  # bytes
MOST_HEADERS, MOST_FIELDS = 200, 1000  # headers, and fields in the address
_CLOSED = (
    b"HTTP/1.1 431 Request Header Fields Too Large\r\n"
    b"Content-Type: text/plain; charset=utf-8\r\nContent-Length: 26\r\nConnection: close\r\n\r\n"
    b"The headers are too large\n"
)


class BoundedHead(HttpToolsProtocol):
    """uvicorn's protocol, which ends a connection whose head goes on and on.

    Every piece of a head, of a chunk's extension or of a trailer counts, until the parser has understood it.
    """

    _pending = 0  # bytes since the parser understood something

    def data_received(self, data: bytes) -> None:
        """Parse; refuse what the parser still waits for beyond the limit."""
        self._pending += len(data)
        super().data_received(data)
        if self._pending > LONGEST_HEAD and not self.transport.is_closing():
            if self.cycle is None or self.cycle.response_complete:
                self.refuse_head()
            self.transport.close()

    def refuse_head(self) -> None:
        """Answer a head that is too large."""
        self.transport.write(_CLOSED)

    def on_headers_complete(self) -> None:
        """Go on, with a new count."""
        self._pending = 0
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Go on, with a new count."""
        self._pending = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Go on, with a new count."""
        self._pending = 0
        super().on_message_complete()


class HeadLimit:
    """ASGI middleware that refuses a head beyond the limit by a 431 problem, and drops quoted cookies."""

    def __init__(self, app: ASGIApp, refuse: Callable[[str], Response]) -> None:
        self.app, self.refuse = app, refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
        elif message := _too_large(scope):
            await self.refuse(message)(scope, receive, send)
        else:
            scope["headers"] = list(_without_quoted_cookies(scope["headers"]))
            await self.app(scope, receive, send)


def _too_large(scope: Scope) -> str:
    """Return the limit that a head exceeds; empty if it exceeds none."""
    headers, query = scope["headers"], scope["query_string"]
    size = sum(len(name) + len(value) for name, value in headers) + len(query)
    if size + len(scope.get("raw_path") or b"") > LONGEST_HEAD:
        return f"the address and the headers may have at most {LONGEST_HEAD // 1024} KiB together"
    if len(headers) > MOST_HEADERS:
        return f"a request may have at most {MOST_HEADERS} headers"
    return f"an address may have at most {MOST_FIELDS} fields" if query.count(b"&") >= MOST_FIELDS else ""


def _without_quoted_cookies(headers: Iterable[tuple[bytes, bytes]]) -> Iterable[tuple[bytes, bytes]]:
    """Yield the headers without cookies in quotes, which take quadratic time to read.

    None of ours is quoted.
    """
    for name, value in headers:
        yield name, (_plain_cookies(value) if name == b"cookie" and b'"' in value else value)


def _plain_cookies(header: bytes) -> bytes:
    return b";".join(cookie for cookie in header.split(b";") if b'"' not in cookie)
