"""The acting principal: set for each request and job, and read when an action is recorded.

Units of work run in the context of their caller, so each row that they write has the right author.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

Role = Literal["viewer", "author", "checker", "admin"]
ROLES: tuple[Role, ...] = ("viewer", "author", "checker", "admin")
INCLUDED: dict[Role, frozenset[Role]] = {
    "viewer": frozenset({"viewer"}),
    "author": frozenset({"viewer", "author"}),
    "checker": frozenset({"viewer", "author", "checker"}),
    "admin": frozenset({"admin"}),
}
"""The roles that each role includes. An administrator needs a further role to work on designs."""


@dataclass(frozen=True)
class Principal:
    """A person or a service; `roles` are those that the key or session of the request allows.

    `key` is the prefix of the key in the request, or of the key that started its session.
    """

    id: str
    name: str
    kind: Literal["person", "service"]
    roles: frozenset[Role]
    key: str | None = None

    @cached_property
    def included(self) -> frozenset[Role]:
        """Return the roles together with the roles that they include."""
        return frozenset(role for own in self.roles for role in INCLUDED[own])

    def may(self, role: Role) -> bool:
        """Return whether the principal has a role, directly or by inclusion."""
        return role in self.included


LOCAL = Principal("local", "local", "person", frozenset(ROLES))
"""The user of a service on the same machine, which requires no key."""
SYSTEM = Principal("system", "Crankwright", "service", frozenset(ROLES))
"""The service itself, for example when it deletes old files."""

ANONYMOUS = Principal("anonymous", "nobody", "person", frozenset())
"""A client that has sent no valid key to a service that requires keys."""

BUILT_IN = frozenset({LOCAL.id, SYSTEM.id, ANONYMOUS.id})
"""Principals without a row: the service neither limits them nor counts their usage."""


def client_of(principal: str) -> str:
    """Return the client name of a principal, under which its jobs take turns."""
    return f"principal:{principal}"


ACTING: ContextVar[Principal] = ContextVar("acting", default=LOCAL)
acting: Callable[[], Principal] = ACTING.get
"""Returns the principal for whom the current request or job runs."""


@contextmanager
def acting_as(principal: Principal) -> Iterator[None]:
    """Make a principal the acting one within a context."""
    token = ACTING.set(principal)
    try:
        yield
    finally:
        ACTING.reset(token)
