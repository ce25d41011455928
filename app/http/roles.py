"""The role that a route needs, by its declaration, else by its method; checked before it runs.

A router or a route declares by `dependencies=[needs("author")]`; of several declarations the last one counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fastapi import FastAPI, params
from starlette.routing import BaseRoute, Mount, Route
from starlette.types import ASGIApp, Receive, Scope, Send

from app.identity.errors import NotSignedIn, RoleNeeded
from app.identity.principal import ANONYMOUS, Role, acting

READING = frozenset({"GET", "HEAD", "OPTIONS"})
OPEN_FOLDERS = frozenset({"/static", "/static-offline-docs"})
"""Mounted files, which are those of the program: the page to sign in needs them."""


@dataclass(frozen=True)
class Needs:
    """The roles of which a caller needs one; without any, who has signed in, or anybody if `is_public`."""

    roles: tuple[Role, ...]
    is_public: bool = False

    async def __call__(self) -> None:
        """As a dependency of a route it does nothing: the gate has read it."""

    def check(self) -> None:
        """Let the acting principal pass.

        Raises
        ------
        NotSignedIn, RoleNeeded
            If it may not.
        """
        if self.is_public:
            return
        who = acting()
        if who is ANONYMOUS:
            raise NotSignedIn
        if self.roles and not any(who.may(role) for role in self.roles):
            raise RoleNeeded(who, self.roles)


VIEWER, AUTHOR, SIGNED_IN, PUBLIC = (
    Needs(("viewer",)),
    Needs(("author",)),
    Needs(()),
    Needs((), is_public=True),
)


def needs(*roles: Role) -> params.Depends:
    """Declare that a route needs one of these roles; none: that whoever sends the request has signed in."""
    return params.Depends(Needs(roles))


def public() -> params.Depends:
    """Declare that a route asks nobody for a key."""
    return params.Depends(PUBLIC)


def needs_of(route: BaseRoute) -> Needs:
    """Return the roles that a route needs."""
    declared = [one.dependency for one in getattr(route, "dependencies", ())]
    needed = [one for one in declared if isinstance(one, Needs)]
    if needed:
        return needed[-1]
    if isinstance(route, Mount) and route.path in OPEN_FOLDERS:
        return PUBLIC
    return VIEWER if isinstance(route, Route) and _only_reads(route.methods or ()) else AUTHOR


def _only_reads(methods: Iterable[str]) -> bool:
    methods = set(methods)
    return bool(methods) and methods <= READING


class Guarded:
    """A route's or a router's way to handle a request, behind the check of the role."""

    def __init__(self, handle: ASGIApp, needed: Needs) -> None:
        self.handle, self.needed = handle, needed

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check, then handle."""
        self.needed.check()
        await self.handle(scope, receive, send)


def install(app: FastAPI) -> None:
    """Guard all routes that an app has by now, and paths that it has not. Routes are shared by all apps."""
    for route in routes_of(app):
        if not isinstance(route.handle, Guarded):
            route.handle = Guarded(route.handle, needs_of(route))  # type: ignore[method-assign]
    app.router.default = Guarded(app.router.default, SIGNED_IN)


def routes_of(app: FastAPI) -> list[BaseRoute]:
    """Return all routes of an app, those of its routers included.

    `fastapi.routing.iter_route_contexts` gives the same, but prepares each route for requests: 0.3 s at the
    start that belong to the first requests. A test compares the two.
    """
    return list(_within(app.router.routes))


def _within(routes: Iterable[BaseRoute]) -> Iterator[BaseRoute]:
    for route in routes:
        router = getattr(route, "original_router", None)  # of an included router, which FastAPI keeps whole
        if router is None:
            yield route
        else:
            yield from _within(router.routes)
