"""Connections to a service over httpx: a blocking connection, and one for coroutines."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from typing import Self, TypedDict, TypeVar

import httpx

from app.client.exchange import Exchange, Query, Request, job_of
from app.client.names import CLIENT_HEADER, authorization, checked_name

_RETRIES = 3  # attempts of the transport to open a refused connection
PATIENCE = 60.0  # longest total wait for one request [s]
_SHORTEST = 0.1  # also bounds the number of attempts [s]
_REPEATABLE = frozenset({"GET", "HEAD"})

Result = TypeVar("Result")


class Patience:
    """The time that one request may still wait [s]; it gets less with every wait.

    A 429 refuses a request before any work. A 503 may come after a change was stored, so only requests that
    change nothing, or whose Idempotency-Key prevents a second change, are sent again.
    """

    def __init__(self, seconds: float) -> None:
        self.left = seconds

    def wait(self, request: Request, response: httpx.Response) -> float | None:
        """Return the time after which to send a request again [s]; None if its response is final."""
        stated = response.headers.get("Retry-After", "")
        if not (stated.isdecimal() and stated.isascii()) or not _may_repeat(request, response):
            return None
        seconds = max(_SHORTEST, float(stated))
        if seconds > self.left:
            return None
        self.left -= seconds
        return seconds


def _may_repeat(request: Request, response: httpx.Response) -> bool:
    if response.status_code == 429:
        return True
    is_safe = request.method in _REPEATABLE or request.is_safe or "Idempotency-Key" in request.headers
    return response.status_code == 503 and is_safe and job_of(response) is None


class _Options(TypedDict):
    """The options of an httpx client, the same for both connections."""

    base_url: str
    timeout: float
    headers: dict[str, str]
    trust_env: bool


class _Message(TypedDict):
    """The arguments of a request in httpx."""

    method: str
    url: str
    content: bytes | None
    params: Query | None
    headers: Mapping[str, str]


class _Connection:
    """The address of the service, and the name and key of the client."""

    def __init__(
        self,
        url: str,
        *,
        timeout: float = 60.0,
        name: str | None = None,
        key: str | None = None,
        patience: float = PATIENCE,
    ) -> None:
        self.url, self.name, self.patience = url, checked_name(name), patience
        self._options: _Options = {
            "base_url": url,
            "timeout": timeout,
            "headers": {CLIENT_HEADER: self.name, **authorization(key)},
            "trust_env": False,
        }


def message(request: Request) -> _Message:
    """Return a request as arguments for httpx."""
    return {
        "method": request.method,
        "url": request.path,
        "content": request.content,
        "params": request.params or None,  # an empty mapping would remove a query from the path
        "headers": request.headers,
    }


class BlockingConnection(_Connection):
    """A connection that sends one request at a time and blocks until the response arrives."""

    def __init__(
        self,
        url: str,
        *,
        timeout: float = 60.0,
        name: str | None = None,
        key: str | None = None,
        patience: float = PATIENCE,
    ) -> None:
        super().__init__(url, timeout=timeout, name=name, key=key, patience=patience)
        transport = httpx.HTTPTransport(retries=_RETRIES)
        self._http = httpx.Client(transport=transport, **self._options)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._http.close()

    def healthy(self) -> bool:
        """Return whether the service answers."""
        try:
            return (self._http.get("/healthz")).is_success
        except httpx.TransportError:
            return False

    def run(self, exchange: Exchange[Result]) -> Result:
        """Send the requests of an exchange, and return its result."""
        try:
            request = next(exchange)
            while True:
                request = exchange.send(self._send(request))
        except StopIteration as end:
            result: Result = end.value
            return result

    def _send(self, request: Request) -> httpx.Response:
        """Send a request, and again after the stated time while the service is busy."""
        patience = Patience(self.patience)
        while (wait := patience.wait(request, response := self._sent(request))) is not None:
            time.sleep(wait)
        return response

    def _sent(self, request: Request) -> httpx.Response:
        parts = message(request)
        if request.listen is None:
            return self._http.request(**parts)
        with self._http.stream(**parts, timeout=None) as response:
            if response.is_error:
                response.read()
            else:
                for line in response.iter_lines():
                    request.listen(line)
            return response


class AwaitedConnection(_Connection):
    """A connection that sends a request and awaits its response."""

    def __init__(
        self,
        url: str,
        *,
        timeout: float = 60.0,
        name: str | None = None,
        key: str | None = None,
        patience: float = PATIENCE,
    ) -> None:
        super().__init__(url, timeout=timeout, name=name, key=key, patience=patience)
        transport = httpx.AsyncHTTPTransport(retries=_RETRIES)
        self._http = httpx.AsyncClient(transport=transport, **self._options)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *exception: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connection."""
        await self._http.aclose()

    async def healthy(self) -> bool:
        """Return whether the service answers."""
        try:
            return (await self._http.get("/healthz")).is_success
        except httpx.TransportError:
            return False

    async def run(self, exchange: Exchange[Result]) -> Result:
        """Send the requests of an exchange, and return its result."""
        try:
            request = next(exchange)
            while True:
                request = exchange.send(await self._send(request))
        except StopIteration as end:
            result: Result = end.value
            return result

    async def _send(self, request: Request) -> httpx.Response:
        """Send a request, and again after the stated time while the service is busy."""
        patience = Patience(self.patience)
        while (wait := patience.wait(request, response := await self._sent(request))) is not None:
            await asyncio.sleep(wait)
        return response

    async def _sent(self, request: Request) -> httpx.Response:
        parts = message(request)
        if request.listen is None:
            return await self._http.request(**parts)
        async with self._http.stream(**parts, timeout=None) as response:
            if response.is_error:
                await response.aread()
            else:
                async for line in response.aiter_lines():
                    request.listen(line)
            return response
