"""The two clients: they send the requests of `operations`, one at once, one by `await`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Self, TypedDict, TypeVar

import httpx

from app.client import (
    approval_operations,
    identity_operations,
    operations,
    variant_operations,
    worksheet_operations,
)
from app.client import studies as exchanges
from app.client.exchange import Exchange, Query, Request
from app.client.methods import AsyncMethod, Method
from app.client.names import CLIENT_HEADER, authorization, checked_name
from app.client.studies import AsyncClientStudy, ClientStudy

_RETRIES = 3  # of the transport, for a connection that is refused

Result = TypeVar("Result")


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

    def __init__(
        self, url: str, *, timeout: float = 60.0, name: str | None = None, key: str | None = None
    ) -> None:
        self.url, self.name = url, checked_name(name)
        self._options: _Options = {
            "base_url": url,
            "timeout": timeout,
            "headers": {CLIENT_HEADER: self.name, **authorization(key)},
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
    key
        By which the service knows whose requests they are, `cw_…`, where it asks for one.

    Raises
    ------
    ValueError
        If the name is no such text, or the key has not the form of one.
    """

    def __init__(
        self, url: str, *, timeout: float = 60.0, name: str | None = None, key: str | None = None
    ) -> None:
        super().__init__(url, timeout=timeout, name=name, key=key)
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

    studies = Method(exchanges.find_all)
    templates = Method(operations.templates)
    faults = Method(operations.faults)
    template = Method(operations.template)
    library = Method(operations.library)
    library_table = Method(operations.library_table)
    evaluate = Method(operations.evaluate)
    worksheet = Method(operations.worksheet)
    solve = Method(operations.solve)
    curves = Method(operations.curves)
    analyse = Method(operations.analyse)
    surface = Method(operations.surface)
    designs = Method(operations.designs)
    design = Method(operations.design)
    create = Method(operations.create)
    change = Method(operations.change)
    copy = Method(operations.copy)
    restore = Method(operations.restore)
    delete = Method(operations.delete)
    labels = Method(operations.labels)
    label = Method(operations.label)
    tags = Method(operations.tags)
    compare = Method(operations.compare)
    preview = Method(operations.preview)
    decide = Method(operations.decide)
    solve_design = Method(operations.solve_design)
    tolerance = Method(operations.tolerance)
    impact = Method(operations.impact)
    upgrade = Method(operations.upgrade)
    auto_map = Method(operations.auto_map)
    explain = Method(operations.explain)
    network = Method(operations.network)
    revision = Method(operations.revision)
    revisions = Method(operations.revisions)
    measurements = Method(operations.measurements)
    design_worksheet = Method(operations.design_worksheet)
    build = Method(operations.build)
    model = Method(operations.model)
    download = Method(operations.download)
    report = Method(operations.report)
    approvals = Method(approval_operations.approvals)
    approve = Method(approval_operations.approve)
    released = Method(approval_operations.released)
    comments = Method(approval_operations.comments)
    comment = Method(approval_operations.comment)
    resolve_comment = Method(approval_operations.resolve_comment)
    picture = Method(operations.picture)
    variant = Method(variant_operations.variant)
    variants = Method(variant_operations.variants)
    put_variants = Method(variant_operations.put_variants)
    download_variant = Method(variant_operations.download_variant)
    download_variants = Method(variant_operations.download_variants)
    worksheets = Method(worksheet_operations.worksheets)
    read_worksheet = Method(worksheet_operations.read_worksheet)
    worksheet_text = Method(worksheet_operations.worksheet_text)
    check_worksheet = Method(worksheet_operations.check_worksheet)
    create_worksheet = Method(worksheet_operations.create_worksheet)
    import_worksheet = Method(worksheet_operations.import_worksheet)
    read_import = Method(worksheet_operations.read_import)
    change_worksheet = Method(worksheet_operations.change_worksheet)
    test_worksheet = Method(worksheet_operations.test_worksheet)
    review_worksheet = Method(worksheet_operations.review_worksheet)
    release_worksheet = Method(worksheet_operations.release_worksheet)
    withdraw_worksheet = Method(worksheet_operations.withdraw_worksheet)
    delete_worksheet = Method(worksheet_operations.delete_worksheet)
    verify = Method(operations.verify)
    job = Method(operations.job)
    follow = Method(operations.follow)
    me = Method(identity_operations.me)
    principals = Method(identity_operations.principals)
    add_principal = Method(identity_operations.add_principal)
    change_principal = Method(identity_operations.change_principal)
    usage = Method(identity_operations.usage)
    keys = Method(identity_operations.keys)
    add_key = Method(identity_operations.add_key)
    revoke_key = Method(identity_operations.revoke_key)


class AsyncClient(_Connection):
    """A connection to a service, whose calls are awaited. It is made as `Client` is."""

    def __init__(
        self, url: str, *, timeout: float = 60.0, name: str | None = None, key: str | None = None
    ) -> None:
        super().__init__(url, timeout=timeout, name=name, key=key)
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

    studies = AsyncMethod(exchanges.find_all)
    templates = AsyncMethod(operations.templates)
    faults = AsyncMethod(operations.faults)
    template = AsyncMethod(operations.template)
    library = AsyncMethod(operations.library)
    library_table = AsyncMethod(operations.library_table)
    evaluate = AsyncMethod(operations.evaluate)
    worksheet = AsyncMethod(operations.worksheet)
    solve = AsyncMethod(operations.solve)
    curves = AsyncMethod(operations.curves)
    analyse = AsyncMethod(operations.analyse)
    surface = AsyncMethod(operations.surface)
    designs = AsyncMethod(operations.designs)
    design = AsyncMethod(operations.design)
    create = AsyncMethod(operations.create)
    change = AsyncMethod(operations.change)
    copy = AsyncMethod(operations.copy)
    restore = AsyncMethod(operations.restore)
    delete = AsyncMethod(operations.delete)
    labels = AsyncMethod(operations.labels)
    label = AsyncMethod(operations.label)
    tags = AsyncMethod(operations.tags)
    compare = AsyncMethod(operations.compare)
    preview = AsyncMethod(operations.preview)
    decide = AsyncMethod(operations.decide)
    solve_design = AsyncMethod(operations.solve_design)
    tolerance = AsyncMethod(operations.tolerance)
    impact = AsyncMethod(operations.impact)
    upgrade = AsyncMethod(operations.upgrade)
    auto_map = AsyncMethod(operations.auto_map)
    explain = AsyncMethod(operations.explain)
    network = AsyncMethod(operations.network)
    revision = AsyncMethod(operations.revision)
    revisions = AsyncMethod(operations.revisions)
    measurements = AsyncMethod(operations.measurements)
    design_worksheet = AsyncMethod(operations.design_worksheet)
    build = AsyncMethod(operations.build)
    model = AsyncMethod(operations.model)
    download = AsyncMethod(operations.download)
    report = AsyncMethod(operations.report)
    approvals = AsyncMethod(approval_operations.approvals)
    approve = AsyncMethod(approval_operations.approve)
    released = AsyncMethod(approval_operations.released)
    comments = AsyncMethod(approval_operations.comments)
    comment = AsyncMethod(approval_operations.comment)
    resolve_comment = AsyncMethod(approval_operations.resolve_comment)
    picture = AsyncMethod(operations.picture)
    variant = AsyncMethod(variant_operations.variant)
    variants = AsyncMethod(variant_operations.variants)
    put_variants = AsyncMethod(variant_operations.put_variants)
    download_variant = AsyncMethod(variant_operations.download_variant)
    download_variants = AsyncMethod(variant_operations.download_variants)
    worksheets = AsyncMethod(worksheet_operations.worksheets)
    read_worksheet = AsyncMethod(worksheet_operations.read_worksheet)
    worksheet_text = AsyncMethod(worksheet_operations.worksheet_text)
    check_worksheet = AsyncMethod(worksheet_operations.check_worksheet)
    create_worksheet = AsyncMethod(worksheet_operations.create_worksheet)
    import_worksheet = AsyncMethod(worksheet_operations.import_worksheet)
    read_import = AsyncMethod(worksheet_operations.read_import)
    change_worksheet = AsyncMethod(worksheet_operations.change_worksheet)
    test_worksheet = AsyncMethod(worksheet_operations.test_worksheet)
    review_worksheet = AsyncMethod(worksheet_operations.review_worksheet)
    release_worksheet = AsyncMethod(worksheet_operations.release_worksheet)
    withdraw_worksheet = AsyncMethod(worksheet_operations.withdraw_worksheet)
    delete_worksheet = AsyncMethod(worksheet_operations.delete_worksheet)
    verify = AsyncMethod(operations.verify)
    job = AsyncMethod(operations.job)
    follow = AsyncMethod(operations.follow)
    me = AsyncMethod(identity_operations.me)
    principals = AsyncMethod(identity_operations.principals)
    add_principal = AsyncMethod(identity_operations.add_principal)
    change_principal = AsyncMethod(identity_operations.change_principal)
    usage = AsyncMethod(identity_operations.usage)
    keys = AsyncMethod(identity_operations.keys)
    add_key = AsyncMethod(identity_operations.add_key)
    revoke_key = AsyncMethod(identity_operations.revoke_key)
