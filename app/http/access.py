"""Identify who sends a request: the principal, the client, and the role that the route needs.

Every request acts for the principal whose key or session it carries. Limits and turns are counted by client.
If keys are in use, the client is the principal. Otherwise it is the header `Crankwright-Client`, else the
session of a page, else the address that the request came from.

A route declares the role that it needs; without a declaration its HTTP method decides. The role is checked
before the route runs. A router or a route declares by `dependencies=[needs("author")]`; of several
declarations the last one counts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from typing import Annotated
from urllib.parse import unquote_plus

from fastapi import Depends, FastAPI, Request, params
from starlette.datastructures import Headers
from starlette.routing import BaseRoute, Mount, Route
from starlette.types import ASGIApp, Receive, Scope, Send

from app.identity.door import Door
from app.identity.errors import KeyInAddress, NotSignedIn, RoleNeeded
from app.identity.principal import ANONYMOUS, Principal, Role, acting, client_of
from app.identity.rows import Guest
from app.observation.secrets import LENGTH, MARK, holds_key
from templates.core.errors import Fault, InvalidInputs

SIGN_IN = "crankwright_sign_in"
"""The cookie of a browser in which somebody has signed in."""
FORM_TOKEN = "crankwright.form_token"
"""Key of an ASGI scope: the token that forms of the session carry."""
HEALTH = frozenset({"/healthz", "/readyz"})
"""Answered to anybody, whether or not the database can be reached."""
STILL = "crankwright.still"
"""Key of an ASGI scope: asks whether the key or session of the request lets in the same roles as before."""
_BEARER = re.compile(rb"bearer +([!-~]{1,200})", re.IGNORECASE)
_SIGN_IN_COOKIE = re.compile(rb"(?:^|;) *" + SIGN_IN.encode() + rb"=([A-Za-z0-9_-]{43})(?:;|$)")
_MOST_COOKIES = 8192  # bytes that are looked at
_ESCAPED = b"%"


async def identify(scope: Scope) -> Principal:
    """Return who sends a request; if it carries a key, only the key counts, valid or not.

    Where keys are asked for, the scope keeps the principal and what its session needs.

    Raises
    ------
    KeyInAddress
        If a key stands in path or query.
    LimitReached
        If the principal has sent too many requests.
    DatabaseUnavailable
        If the database cannot be asked.
    """
    if _has_key_in_address(scope):
        raise KeyInAddress
    services = getattr(scope["app"].state, "services", None)  # none before the start: there is no data
    door: Door | None = services and services.identity.door
    if door is None or scope["path"] in HEALTH:  # they need no role, and say so if the database is away
        return acting()
    if await door.is_open():
        return acting()
    guest = await _guest(door, scope)
    scope[PRINCIPAL] = who = guest.principal if guest else ANONYMOUS
    if guest:
        scope[STILL] = partial(_is_still, door, scope, who)
        scope[FORM_TOKEN] = guest.form_token
        door.count(guest)
    return who


async def _is_still(door: Door, scope: Scope, who: Principal) -> bool:
    """Return whether a request would still be admitted as the same principal.

    A stream may outlive its key.
    """
    guest = await _guest(door, scope)
    return guest is not None and guest.principal == who


async def _guest(door: Door, scope: Scope) -> Guest | None:
    """Return whom the key or the session of a request lets in."""
    cookies = b""
    for name, value in scope["headers"]:
        if name == b"authorization":
            sent = _BEARER.fullmatch(value)
            return await door.by_key(sent[1].decode()) if sent else None
        if name == b"cookie":
            cookies = value
    match = _SIGN_IN_COOKIE.search(cookies[:_MOST_COOKIES])
    return await door.by_session(match[1].decode()) if match else None


def _has_key_in_address(scope: Scope) -> bool:
    """Return whether path or query contain a key."""
    query: bytes = scope["query_string"]
    if len(scope["path"]) >= LENGTH and MARK in scope["path"] and holds_key(scope["path"]):
        return True
    if len(query) < LENGTH or not (MARK.encode() in query or _ESCAPED in query):
        return False
    return holds_key(unquote_plus(query.decode("latin-1")))


HEADER, COOKIE = "Crankwright-Client", "crankwright_session"
_NAME = re.compile(r"[!-~][ -~]{0,98}[!-~]|[!-~]")  # up to 100 printable ASCII characters
_SESSION = re.compile(r"[A-Za-z0-9_-]{16,64}")
_SESSION_COOKIE = re.compile(rf"(?:^|;)[ ]*{COOKIE}=([A-Za-z0-9_-]{{16,64}})(?:;|$)")
PRINCIPAL = "crankwright.principal"
"""Key of an ASGI scope: the principal of the request, where keys are asked for."""


def is_session(text: str) -> bool:
    """Return whether a cookie's value can be a session of a page."""
    return _SESSION.fullmatch(text) is not None


async def get_client(request: Request) -> str:
    """Return the client of a request, with a prefix: `principal:`, `name:`, `session:` or `address:`.

    Raises
    ------
    InvalidInputs
        If the header is not a valid name.
    """
    if (who := request.scope.get(PRINCIPAL)) is not None:
        return client_of(who.id)
    if (named := request.headers.get(HEADER)) is not None:
        if not _NAME.fullmatch(named):
            detail = "a client's name has 1 to 100 printable ASCII characters, such as design-office-7"
            raise InvalidInputs([Fault(HEADER, "client_name", detail)])
        return f"name:{named}"
    session = request.cookies.get(COOKIE, "")
    if is_session(session):
        return f"session:{session}"
    return f"address:{request.client.host if request.client else 'unknown'}"


def from_whom(scope: Scope) -> str:
    """Return the client of a request like `get_client`; an invalid name is ignored."""
    if (who := scope.get(PRINCIPAL)) is not None:
        return client_of(who.id)
    headers = Headers(scope=scope)
    if _NAME.fullmatch(named := headers.get(HEADER, "")):
        return f"name:{named}"
    session = _SESSION_COOKIE.search(headers.get("cookie", "")[:_MOST_COOKIES])
    if session:
        return f"session:{session[1]}"
    return f"address:{scope['client'][0] if scope.get('client') else 'unknown'}"


TheClient = Annotated[str, Depends(get_client)]

READING = frozenset({"GET", "HEAD", "OPTIONS"})
OPEN_FOLDERS = frozenset({"/static", "/static-offline-docs"})
"""Mounted files, which are those of the program: the page to sign in needs them."""


@dataclass(frozen=True)
class Needs:
    """The roles of which a caller needs one; without any, who has signed in, or anybody if `is_public`."""

    roles: tuple[Role, ...]
    is_public: bool = False

    async def __call__(self) -> None:
        """Do nothing as a dependency of a route; `RoleGuard` has read the declaration."""

    def check(self) -> None:
        """Check the role of the acting principal.

        Raises
        ------
        NotSignedIn, RoleNeeded
            If the principal may not use the route.
        """
        if self.is_public:
            return
        who = acting()
        if who is ANONYMOUS:
            raise NotSignedIn
        if self.roles and who.included.isdisjoint(self.roles):
            raise RoleNeeded(who, self.roles)


VIEWER, AUTHOR, SIGNED_IN, PUBLIC = (
    Needs(("viewer",)),
    Needs(("author",)),
    Needs(()),
    Needs((), is_public=True),
)


def needs(*roles: Role) -> params.Depends:
    """Declare that a route needs one of these roles; without roles it only needs a signed-in sender."""
    return params.Depends(Needs(roles))


def public() -> params.Depends:
    """Declare that a route needs no key."""
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


class RoleGuard:
    """A route's or a router's way to handle a request, behind the check of the role."""

    def __init__(self, handle: ASGIApp, needed: Needs) -> None:
        self.handle, self.needed = handle, needed

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check, then handle."""
        self.needed.check()
        await self.handle(scope, receive, send)


def install(app: FastAPI) -> None:
    """Guard all present routes of an app, and unknown paths."""
    for route in app.router.routes:
        if not isinstance(route.handle, RoleGuard):
            route.handle = RoleGuard(route.handle, needs_of(route))  # type: ignore[method-assign]
    app.router.default = RoleGuard(app.router.default, SIGNED_IN)
