"""The two clients: they send the requests of `operations`, one at once, one by `await`."""

from __future__ import annotations

import functools
from collections.abc import Awaitable, Callable, Mapping
from typing import Generic, ParamSpec, Self, TypedDict, TypeVar, overload

import httpx

from app.client import operations, variant_operations
from app.client import studies as exchanges
from app.client.exchange import Exchange, Query, Request
from app.client.names import CLIENT_HEADER, checked_name
from app.client.studies import AsyncClientStudy, ClientStudy

_RETRIES = 3  # of the transport, for a connection that is refused

Asked = ParamSpec("Asked")
Result = TypeVar("Result")


class _Method(Generic[Asked, Result]):
    """A method of `Client` that runs an operation."""

    def __init__(self, operation: Callable[Asked, Exchange[Result]]) -> None:
        self.operation, self.__doc__ = operation, operation.__doc__

    @overload
    def __get__(self, client: None, owner: type) -> Self: ...
    @overload
    def __get__(self, client: Client, owner: type) -> Callable[Asked, Result]: ...
    def __get__(self, client: Client | None, owner: type) -> Self | Callable[Asked, Result]:
        if client is None:
            return self

        @functools.wraps(self.operation)
        def call(*given: Asked.args, **options: Asked.kwargs) -> Result:
            return client.run(self.operation(*given, **options))

        return call


class _AsyncMethod(Generic[Asked, Result]):
    """A method of `AsyncClient` that runs an operation; what it returns is awaited."""

    def __init__(self, operation: Callable[Asked, Exchange[Result]]) -> None:
        self.operation, self.__doc__ = operation, operation.__doc__

    @overload
    def __get__(self, client: None, owner: type) -> Self: ...
    @overload
    def __get__(self, client: AsyncClient, owner: type) -> Callable[Asked, Awaitable[Result]]: ...
    def __get__(self, client: AsyncClient | None, owner: type) -> Self | Callable[Asked, Awaitable[Result]]:
        if client is None:
            return self

        @functools.wraps(self.operation)
        def call(*given: Asked.args, **options: Asked.kwargs) -> Awaitable[Result]:
            return client.run(self.operation(*given, **options))

        return call


class _Options(TypedDict):
    """What every connection of httpx is made with."""

    base_url: str
    timeout: float
    headers: dict[str, str]
    trust_env: bool


class _Message(TypedDict):
    """A request as httpx takes it."""

    method: str
    url: str
    content: bytes | None
    params: Query | None
    headers: Mapping[str, str]


class _Connection:
    """Where a client connects to, and under which name."""

    def __init__(self, url: str, *, timeout: float = 60.0, name: str | None = None) -> None:
        self.url, self.name = url, checked_name(name)
        self._options: _Options = {
            "base_url": url,
            "timeout": timeout,
            "headers": {CLIENT_HEADER: self.name},
            "trust_env": False,
        }


def message(request: Request) -> _Message:
    """A request as httpx takes it."""
    return {
        "method": request.method,
        "url": request.path,
        "content": request.content,
        "params": request.params or None,  # an empty mapping would remove a query from the path
        "headers": request.headers,
    }


class Client(_Connection):
    """A connection to a service, which answers every call before it returns.

    Parameters
    ----------
    url
        Where the service listens, such as `http://127.0.0.1:8000`.
    timeout
        How long an answer may take [s].
    name
        Under which name the service counts this client's requests, and takes turns between clients: up to 100
        printable ASCII characters. If not given, `user@host`.

    Raises
    ------
    ValueError
        If the name is no such text.
    """

    def __init__(self, url: str, *, timeout: float = 60.0, name: str | None = None) -> None:
        super().__init__(url, timeout=timeout, name=name)
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
        """Whether the service answers."""
        try:
            return (self._http.get("/healthz")).is_success
        except httpx.TransportError:
            return False

    def run(self, exchange: Exchange[Result]) -> Result:
        """Send the requests of an exchange, and return what it makes of their responses."""
        try:
            request = next(exchange)
            while True:
                request = exchange.send(self._send(request))
        except StopIteration as end:
            result: Result = end.value
            return result

    def _send(self, request: Request) -> httpx.Response:
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

    def study(self, design: str, *, key: str | None = None, **body: object) -> ClientStudy:
        """Begin a study of a design: `method`, `vary`, `outputs` and so on, as `POST /studies` takes them."""
        return ClientStudy(self, self.run(exchanges.begin(design, body, key)))

    def open_study(self, id: str) -> ClientStudy:
        """A study that was begun before."""
        return ClientStudy(self, self.run(exchanges.find(id)))

    studies = _Method(exchanges.find_all)
    templates = _Method(operations.templates)
    faults = _Method(operations.faults)
    template = _Method(operations.template)
    library = _Method(operations.library)
    library_table = _Method(operations.library_table)
    evaluate = _Method(operations.evaluate)
    worksheet = _Method(operations.worksheet)
    solve = _Method(operations.solve)
    curves = _Method(operations.curves)
    analyse = _Method(operations.analyse)
    surface = _Method(operations.surface)
    designs = _Method(operations.designs)
    design = _Method(operations.design)
    create = _Method(operations.create)
    change = _Method(operations.change)
    copy = _Method(operations.copy)
    restore = _Method(operations.restore)
    delete = _Method(operations.delete)
    labels = _Method(operations.labels)
    label = _Method(operations.label)
    tags = _Method(operations.tags)
    compare = _Method(operations.compare)
    preview = _Method(operations.preview)
    decide = _Method(operations.decide)
    solve_design = _Method(operations.solve_design)
    tolerance = _Method(operations.tolerance)
    impact = _Method(operations.impact)
    upgrade = _Method(operations.upgrade)
    auto_map = _Method(operations.auto_map)
    explain = _Method(operations.explain)
    network = _Method(operations.network)
    revision = _Method(operations.revision)
    revisions = _Method(operations.revisions)
    measurements = _Method(operations.measurements)
    design_worksheet = _Method(operations.design_worksheet)
    build = _Method(operations.build)
    model = _Method(operations.model)
    download = _Method(operations.download)
    report = _Method(operations.report)
    picture = _Method(operations.picture)
    variants = _Method(variant_operations.variants)
    put_variants = _Method(variant_operations.put_variants)
    download_variant = _Method(variant_operations.download_variant)
    download_variants = _Method(variant_operations.download_variants)
    verify = _Method(operations.verify)
    job = _Method(operations.job)
    follow = _Method(operations.follow)


class AsyncClient(_Connection):
    """A connection to a service, whose calls are awaited. It is made as `Client` is."""

    def __init__(self, url: str, *, timeout: float = 60.0, name: str | None = None) -> None:
        super().__init__(url, timeout=timeout, name=name)
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
        """Whether the service answers."""
        try:
            return (await self._http.get("/healthz")).is_success
        except httpx.TransportError:
            return False

    async def run(self, exchange: Exchange[Result]) -> Result:
        """Send the requests of an exchange, and return what it makes of their responses."""
        try:
            request = next(exchange)
            while True:
                request = exchange.send(await self._send(request))
        except StopIteration as end:
            result: Result = end.value
            return result

    async def _send(self, request: Request) -> httpx.Response:
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

    async def study(self, design: str, *, key: str | None = None, **body: object) -> AsyncClientStudy:
        """Begin a study of a design: `method`, `vary`, `outputs` and so on, as `POST /studies` takes them."""
        return AsyncClientStudy(self, await self.run(exchanges.begin(design, body, key)))

    async def open_study(self, id: str) -> AsyncClientStudy:
        """A study that was begun before."""
        return AsyncClientStudy(self, await self.run(exchanges.find(id)))

    studies = _AsyncMethod(exchanges.find_all)
    templates = _AsyncMethod(operations.templates)
    faults = _AsyncMethod(operations.faults)
    template = _AsyncMethod(operations.template)
    library = _AsyncMethod(operations.library)
    library_table = _AsyncMethod(operations.library_table)
    evaluate = _AsyncMethod(operations.evaluate)
    worksheet = _AsyncMethod(operations.worksheet)
    solve = _AsyncMethod(operations.solve)
    curves = _AsyncMethod(operations.curves)
    analyse = _AsyncMethod(operations.analyse)
    surface = _AsyncMethod(operations.surface)
    designs = _AsyncMethod(operations.designs)
    design = _AsyncMethod(operations.design)
    create = _AsyncMethod(operations.create)
    change = _AsyncMethod(operations.change)
    copy = _AsyncMethod(operations.copy)
    restore = _AsyncMethod(operations.restore)
    delete = _AsyncMethod(operations.delete)
    labels = _AsyncMethod(operations.labels)
    label = _AsyncMethod(operations.label)
    tags = _AsyncMethod(operations.tags)
    compare = _AsyncMethod(operations.compare)
    preview = _AsyncMethod(operations.preview)
    decide = _AsyncMethod(operations.decide)
    solve_design = _AsyncMethod(operations.solve_design)
    tolerance = _AsyncMethod(operations.tolerance)
    impact = _AsyncMethod(operations.impact)
    upgrade = _AsyncMethod(operations.upgrade)
    auto_map = _AsyncMethod(operations.auto_map)
    explain = _AsyncMethod(operations.explain)
    network = _AsyncMethod(operations.network)
    revision = _AsyncMethod(operations.revision)
    revisions = _AsyncMethod(operations.revisions)
    measurements = _AsyncMethod(operations.measurements)
    design_worksheet = _AsyncMethod(operations.design_worksheet)
    build = _AsyncMethod(operations.build)
    model = _AsyncMethod(operations.model)
    download = _AsyncMethod(operations.download)
    report = _AsyncMethod(operations.report)
    picture = _AsyncMethod(operations.picture)
    variants = _AsyncMethod(variant_operations.variants)
    put_variants = _AsyncMethod(variant_operations.put_variants)
    download_variant = _AsyncMethod(variant_operations.download_variant)
    download_variants = _AsyncMethod(variant_operations.download_variants)
    verify = _AsyncMethod(operations.verify)
    job = _AsyncMethod(operations.job)
    follow = _AsyncMethod(operations.follow)
