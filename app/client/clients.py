"""The two clients, synchronous and asynchronous, with a method for each request.

The methods come from `operations`; `app.client.connections` sends the requests.
"""

from __future__ import annotations

import functools
from collections.abc import Awaitable, Callable
from typing import Generic, ParamSpec, Self, TypeVar, overload

from app.client import (
    approval_operations,
    identity_operations,
    model_operations,
    operations,
    variant_operations,
    worksheet_operations,
)
from app.client import studies as exchanges
from app.client.connections import AwaitedConnection, BlockingConnection
from app.client.exchange import Exchange
from app.client.studies import AsyncClientStudy, ClientStudy

Asked = ParamSpec("Asked")
Result = TypeVar("Result")


class Method(Generic[Asked, Result]):
    """A method of `Client` that runs an operation."""

    def __init__(self, operation: Callable[Asked, Exchange[Result]]) -> None:
        self.operation, self.__doc__ = operation, operation.__doc__

    @overload
    def __get__(self, client: None, owner: type) -> Self: ...
    @overload
    def __get__(self, client: BlockingConnection, owner: type) -> Callable[Asked, Result]: ...
    def __get__(self, client: BlockingConnection | None, owner: type) -> Self | Callable[Asked, Result]:
        if client is None:
            return self

        @functools.wraps(self.operation)
        def call(*given: Asked.args, **options: Asked.kwargs) -> Result:
            return client.run(self.operation(*given, **options))

        return call


class AsyncMethod(Generic[Asked, Result]):
    """A method of `AsyncClient` that runs an operation; what it returns is awaited."""

    def __init__(self, operation: Callable[Asked, Exchange[Result]]) -> None:
        self.operation, self.__doc__ = operation, operation.__doc__

    @overload
    def __get__(self, client: None, owner: type) -> Self: ...
    @overload
    def __get__(self, client: AwaitedConnection, owner: type) -> Callable[Asked, Awaitable[Result]]: ...
    def __get__(
        self, client: AwaitedConnection | None, owner: type
    ) -> Self | Callable[Asked, Awaitable[Result]]:
        if client is None:
            return self

        @functools.wraps(self.operation)
        def call(*given: Asked.args, **options: Asked.kwargs) -> Awaitable[Result]:
            return client.run(self.operation(*given, **options))

        return call


class Client(BlockingConnection):
    """A synchronous connection to a service.

    Parameters
    ----------
    url
        Address of the service, such as `http://127.0.0.1:8000`.
    timeout
        Longest wait for a response [s].
    name
        Name of this client, by which the service counts requests and takes turns between clients: up to 100
        printable ASCII characters. The default is `user@host`.
    key
        Key that authenticates the requests, `cw_…`; a service with keys requires one.
    patience
        Longest total wait of one request while the service is busy (429, or 503 where sending again cannot
        repeat a change) [s]. The client waits for the time in `Retry-After`; 0 raises `Problem` at once.

    Raises
    ------
    ValueError
        If the name or the key does not have the required form.
    """

    def study(self, design: str, *, key: str | None = None, **body: object) -> ClientStudy:
        """Start a study of a design: `method`, `vary`, `outputs` and so on, as in `POST /studies`."""
        return ClientStudy(self, self.run(exchanges.begin(design, body, key)))

    def open_study(self, id: str) -> ClientStudy:
        """Return a study that was started before."""
        return ClientStudy(self, self.run(exchanges.find(id)))

    studies = Method(exchanges.find_all)
    templates = Method(operations.templates)
    faults = Method(operations.faults)
    template = Method(operations.template)
    library = Method(operations.library)
    library_table = Method(operations.library_table)
    evaluate = Method(operations.evaluate)
    evaluate_array = Method(operations.evaluate_array)
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
    undelete = Method(operations.undelete)
    labels = Method(operations.labels)
    label = Method(operations.label)
    tags = Method(operations.tags)
    compare = Method(operations.compare)
    preview = Method(operations.preview)
    decide = Method(operations.decide)
    answer = Method(operations.answer)
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
    drawing_programs = Method(model_operations.drawing_programs)
    import_model = Method(model_operations.import_model)
    model_version = Method(model_operations.model_version)
    model_origin = Method(model_operations.model_origin)
    original_model = Method(model_operations.original_model)
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


class AsyncClient(AwaitedConnection):
    """An asynchronous connection to a service, with the parameters of `Client`; its calls are awaited."""

    async def study(self, design: str, *, key: str | None = None, **body: object) -> AsyncClientStudy:
        """Start a study of a design: `method`, `vary`, `outputs` and so on, as in `POST /studies`."""
        return AsyncClientStudy(self, await self.run(exchanges.begin(design, body, key)))

    async def open_study(self, id: str) -> AsyncClientStudy:
        """Return a study that was started before."""
        return AsyncClientStudy(self, await self.run(exchanges.find(id)))

    studies = AsyncMethod(exchanges.find_all)
    templates = AsyncMethod(operations.templates)
    faults = AsyncMethod(operations.faults)
    template = AsyncMethod(operations.template)
    library = AsyncMethod(operations.library)
    library_table = AsyncMethod(operations.library_table)
    evaluate = AsyncMethod(operations.evaluate)
    evaluate_array = AsyncMethod(operations.evaluate_array)
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
    undelete = AsyncMethod(operations.undelete)
    labels = AsyncMethod(operations.labels)
    label = AsyncMethod(operations.label)
    tags = AsyncMethod(operations.tags)
    compare = AsyncMethod(operations.compare)
    preview = AsyncMethod(operations.preview)
    decide = AsyncMethod(operations.decide)
    answer = AsyncMethod(operations.answer)
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
    drawing_programs = AsyncMethod(model_operations.drawing_programs)
    import_model = AsyncMethod(model_operations.import_model)
    model_version = AsyncMethod(model_operations.model_version)
    model_origin = AsyncMethod(model_operations.model_origin)
    original_model = AsyncMethod(model_operations.original_model)
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
