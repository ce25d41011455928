"""Methods of the two clients: each runs an operation, a function that returns an exchange."""

from __future__ import annotations

import functools
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Generic, ParamSpec, Self, TypeVar, overload

from app.client.exchange import Exchange

if TYPE_CHECKING:
    from app.client.connections import AwaitedConnection, BlockingConnection

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
