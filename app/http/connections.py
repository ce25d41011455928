"""Connections: limits on request headers and on slow clients, and turns among large transfers.

uvicorn sets no time limit on receiving request headers or on a client that reads its answer slowly. It
accepts headers of any length, and copies all of them again whenever another piece arrives.

If the request target is more than a path, such as `GET http://evil.example/healthz`, uvicorn drops its host
and serves the path, although RFC 9112 gives that host priority over the header `Host`. No client of this
service sends such a target, so the protocol marks the request, and the guard refuses it.

Requests begin one after another, and large bodies and answers are transferred in pieces, one per turn of the
event loop. Otherwise each of twenty simultaneous uploads would transfer a piece in every turn, and a short
request would wait for all of them several times.
"""

from __future__ import annotations

import asyncio
import json
import socket
import struct
from asyncio import Transport
from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from ipaddress import IPv4Network, IPv6Address, IPv6Network, ip_address, ip_network

from fastapi import Response
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.protocols.http.httptools_impl import STATUS_LINE, HttpToolsProtocol

from app.observation import logs, metrics
from app.plain import JsonObject
from app.workers.pieces import Pieces

LONGEST_HEAD = 2**16  # bytes
WHOLE = "crankwright.whole"
"""Key of an ASGI scope whose request has arrived completely: then no time limit is needed."""
_NO_PATH = "crankwright.target"
"""Name of an extension in an ASGI scope: the target of the request is not a plain path."""
_RESERVE = 64  # connections beyond the limit that are still answered, with 503

_DEAD = 60.0  # extra time for a silent machine, compared with a slow reader [s]
_USER_TIMEOUT = getattr(socket, "TCP_USER_TIMEOUT", 0)  # Linux


Network = IPv4Network | IPv6Network


class AddressLimit:
    """Counts what each address has open; at most `most`, unless it is a proxy's.

    The connections of a trusted proxy belong to many clients, whose requests are counted by the address that
    the proxy forwards.

    Parameters
    ----------
    most
        Largest number for one address.
    proxies
        Addresses and networks of the trusted proxies.
    """

    def __init__(self, most: int, proxies: Iterable[str]) -> None:
        self.most, self._proxies = most, tuple(ip_network(proxy) for proxy in proxies)
        self.open: Counter[str] = Counter()

    def enter(self, client: tuple[str, int] | None) -> int:
        """Count one more of a client's address; return by how many the address exceeds the limit."""
        if client is None or _is_within(client[0], self._proxies):
            return 0
        self.open[client[0]] += 1
        return max(0, self.open[client[0]] - self.most)

    def leave(self, client: tuple[str, int] | None) -> None:
        """Count one less of a client's address."""
        if client is not None and client[0] in self.open:
            self.open[client[0]] -= 1
            if not self.open[client[0]]:
                del self.open[client[0]]


@lru_cache(maxsize=4096)
def _is_within(host: str, networks: tuple[Network, ...]) -> bool:
    """Return whether a host is an address of some network; an IPv4 address may be written as IPv6."""
    with suppress(ValueError):
        address = ip_address(host)
        if isinstance(address, IPv6Address) and address.ipv4_mapped is not None:
            address = address.ipv4_mapped
        return any(address in network for network in networks)
    return False


@dataclass(frozen=True)
class ConnectionLimits:
    """Limits that one server sets on the connections of its clients.

    Parameters
    ----------
    count
        Largest number of simultaneous connections.
    addresses
        Limit on those of one address.
    header_seconds
        Longest time from the first byte of a request to the end of its head [s].
    write_seconds
        Longest time in which a client may read more slowly than `rate` [s].
    rate
        Lowest average rate at which a client must read [bytes/s].
    """

    count: int
    addresses: AddressLimit
    header_seconds: float
    write_seconds: float
    rate: float


class Pace:
    """Lets large transfers take turns; a transfer holds no turn while it waits for its client."""

    def __init__(self) -> None:
        self._turn = asyncio.Lock()

    async def step(self) -> None:
        """Wait for the turn to move the next piece."""
        async with self._turn:
            await asyncio.sleep(0)


class PiecesResponse(Response):
    """A response that is sent in pieces, each after the client has read most of the previous ones."""

    def __init__(self, pieces: Pieces, pace: Pace, media_type: str = "application/json") -> None:
        length: Mapping[str, str] = {"Content-Length": str(len(pieces))}
        super().__init__(headers=length, media_type=media_type)
        self.pieces, self.pace = pieces, pace

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the head, then the pieces."""
        await send({"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers})
        last = len(self.pieces.parts) - 1
        for number, piece in enumerate(self.pieces):
            if number:
                await self.pace.step()
            await send({"type": "http.response.body", "body": piece, "more_body": number < last})


class TimedProtocol(HttpToolsProtocol):
    """One connection with its limits; `busy` answers connections beyond the limit.

    `protocol` sets `limits` and `busy`.
    """

    limits: ConnectionLimits
    busy: ASGIApp

    _head_timer: asyncio.TimerHandle | None = None
    _write_timer: asyncio.TimerHandle | None = None
    _in_head = False
    _pending = 0  # unparsed bytes so far: of a head, a chunk extension or a trailer

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        """Start to wait for the first request."""
        super().connection_made(transport)
        self._drop_dead_peer()
        of_address = self.limits.addresses.enter(self.client)
        surplus = max(len(self.connections) - self.limits.count, of_address)
        if surplus > _RESERVE:
            self._cut("too many")
            return
        if surplus > 0:
            self.app = self.busy
        self._head_timer = self.loop.call_later(self.limits.header_seconds, self._head_is_late)

    def _drop_dead_peer(self) -> None:
        """Let the kernel close the connection of a dead machine, which does not acknowledge pings."""
        sock = self.transport.get_extra_info("socket")
        if sock is not None and sock.family in (socket.AF_INET, socket.AF_INET6) and _USER_TIMEOUT:
            milliseconds = int(
                1000 * (self.limits.write_seconds + _DEAD)
            )  # later than the check of slow readers
            sock.setsockopt(socket.IPPROTO_TCP, _USER_TIMEOUT, milliseconds)

    def connection_lost(self, exc: Exception | None) -> None:
        """Cancel the timers, and make room for another connection."""
        self.limits.addresses.leave(self.client)
        for timer in (self._head_timer, self._write_timer):
            if timer is not None:
                timer.cancel()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Parse data; unless an answer is being sent, the data must become a complete request in time.

        This also applies to the rest of a body after its head was refused.
        """
        before = self.cycle
        is_idle = before is None or before.response_complete
        self._pending += len(data)
        super().data_received(data)
        if self._pending > LONGEST_HEAD and not self.transport.is_closing():
            if self.cycle is None or self.cycle.response_complete:
                detail = f"send the request line and all headers in at most {LONGEST_HEAD} bytes"
                self._refuse(431, "head-too-large", "The headers are too large", detail)
            self.transport.close()
        if self.cycle is not before:
            if self._head_timer is not None:
                self._head_timer.cancel()
                self._head_timer = None
        elif is_idle and self._head_timer is None and not self.transport.is_closing():
            self._head_timer = self.loop.call_later(self.limits.header_seconds, self._head_is_late)

    def _unsupported_upgrade_warning(self) -> None:
        """Suppress a warning: upgrades are ignored, as HTTP permits."""

    def on_message_begin(self) -> None:
        """Record the start of a request; the parser calls this at its first byte."""
        self._in_head = True
        super().on_message_begin()

    def on_headers_complete(self) -> None:
        """Record the end of a request's head; the parser calls this."""
        self._in_head, self._pending = False, 0
        if not self.url.startswith(b"/"):
            self.scope["extensions"] = {_NO_PATH: {}}
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Receive a piece of a body; the parser calls this for each piece."""
        self._pending = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Record the end of a request; the parser calls this."""
        self._pending = 0
        self.scope[WHOLE] = True  # type: ignore[literal-required]
        super().on_message_complete()

    def _head_is_late(self) -> None:
        self._head_timer = None
        if self._in_head:
            detail = f"send the request line and all headers within {self.limits.header_seconds:g} s"
            self._refuse(408, "too-slow", "The request arrives too slowly", detail)
        else:
            self._cut("silent")

    def send_400_response(self, msg: str) -> None:
        """Answer bytes that are not HTTP with a 400 response."""
        self._refuse(400, "not-http", "Not HTTP", msg)

    def _refuse(self, status: int, slug: str, title: str, detail: str) -> None:
        metrics.CUT.labels(slug).inc()
        about = {"type": f"/problems/{slug}", "title": title, "status": status, "detail": detail}
        self._write_problem(status, about)

    def _write_problem(self, status: int, about: JsonObject) -> None:
        """Send a problem without the application, and close the connection."""
        if self.transport.is_closing():
            return
        id_ = logs.new_id()
        body = json.dumps({**about, "request_id": id_}).encode()
        lines = [
            STATUS_LINE[status].rstrip(),
            *(name + b": " + value for name, value in self.server_state.default_headers),
            b"content-type: application/problem+json",
            b"x-request-id: " + id_.encode(),
            b"content-length: %d" % len(body),
            b"connection: close",
        ]
        self.transport.write(b"\r\n".join(lines) + b"\r\n\r\n" + body)
        self.transport.close()

    def pause_writing(self) -> None:
        """Pause writing; the transport calls this if the client does not read."""
        super().pause_writing()
        self._watch_reader()

    def resume_writing(self) -> None:
        """Resume writing; the transport calls this once the client has read most of the data."""
        super().resume_writing()
        if self._write_timer is not None:
            self._write_timer.cancel()
            self._write_timer = None

    def _watch_reader(self) -> None:
        left = self.transport.get_write_buffer_size()
        self._write_timer = self.loop.call_later(self.limits.write_seconds, self._judge_reader, left)

    def _judge_reader(self, before: int) -> None:
        """Close the connection unless its client has read enough since the last check."""
        read = before - self.transport.get_write_buffer_size()
        if read < self.limits.rate * self.limits.write_seconds:
            self._reset_on_close()
            self._cut("unread")
        else:
            self._watch_reader()

    def _cut(self, why: str) -> None:
        metrics.CUT.labels(why).inc()
        if self.cycle is not None:  # otherwise it might write before it notices the loss
            self.cycle.disconnected = True
        self.transport.abort()

    def _reset_on_close(self) -> None:
        """Let the kernel drop the unsent bytes, instead of delivering megabytes for hours."""
        sock = self.transport.get_extra_info("socket")
        if sock is not None and sock.family in (socket.AF_INET, socket.AF_INET6):
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


def protocol(limits: ConnectionLimits, busy: ASGIApp) -> type[TimedProtocol]:
    """Return the protocol class for a server with these limits; `busy` answers excess connections."""
    return type("Protocol", (TimedProtocol,), {"limits": limits, "busy": staticmethod(busy)})


def is_mere_path(scope: Scope) -> bool:
    """Return whether the target of a request is a path, or the `*` of OPTIONS."""
    if scope["path"] == "*":
        return True
    return scope["path"].startswith("/") and _NO_PATH not in (scope.get("extensions") or {})
