"""What the server and a job process say to each other."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.workers.base import Limits


@dataclass(frozen=True)
class Request:
    """To the process: what to run, and within what limits."""

    function: Callable[..., Any]
    args: tuple[Any, ...]
    limits: Limits


@dataclass(frozen=True)
class Progress:
    """From the process: how far it is."""

    fraction: float
    text: str


@dataclass(frozen=True)
class Returned:
    """From the process: the result."""

    value: Any


@dataclass(frozen=True)
class Raised:
    """From the process: the exception."""

    error: BaseException
