"""What the server and a job process say to each other."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.workers.base import Limits


@dataclass(frozen=True)
class Request:
    """To the process: what to run, within what limits, and whether another request may follow."""

    function: Callable[..., Any]
    args: tuple[Any, ...]
    limits: Limits
    reusable: bool = False


@dataclass(frozen=True)
class Progress:
    """From the process: how far it is."""

    fraction: float
    text: str


@dataclass(frozen=True)
class Returned:
    """From the process: the result, and whether it waits for another request."""

    value: Any
    reusable: bool = False


@dataclass(frozen=True)
class Raised:
    """From the process: the exception, and whether it waits for another request."""

    error: BaseException
    reusable: bool = False
