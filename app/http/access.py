"""Identify who sends a request: the principal, the client, and the role that the route needs.

Every request acts for the principal of its key or session. Limits and turns are counted by client. If keys
are in use, the client is the principal. Otherwise it is the header `Crankwright-Client`, else the session of
a page, else the address that the request came from.

A route declares the role that it needs; without a declaration its HTTP method decides. The role is checked
before the route runs. A router or a route declares a role by `dependencies=[needs("author")]`; of several
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
"""Name of the cookie of a signed-in browser."""
FORM_TOKEN = "crankwright.form_token"
"""Key of an ASGI scope: the token in forms of the session."""
HEALTH = frozenset({"/healthz", "/readyz"})
"""Paths that answer everyone, whether or not the database can be reached."""
STILL = "crankwright.still"
"""Key of an ASGI scope: a function that checks whether the key or session still has the same roles."""
SETTLE = "crankwright.settle"
"""Key of an ASGI scope: a function that takes the processor time of the request when it ends [s]."""
_SCHEME = b"bearer"
_BEARER = re.compile(rb"bearer +([!-~]{1,200})", re.IGNORECASE)
_SIGN_IN_COOKIE = re.compile(rb"(?:^|;) *" + SIGN_IN.encode() + rb"=([A-Za-z0-9_-]{43})(?:;|$)")
_MOST_COOKIES = 8192  # bytes of the header that are searched
_ESCAPED = b"%"


async def identify(scope: Scope) -> Principal:
    """Return the principal that sends a request; if the request has a key, only the key counts, valid or not.

    If keys are required, the scope keeps the principal and the form token of its session.

    Raises
    ------
    KeyInAddress
        If the path or the query contains a key.
    LimitReached
        If the principal has used up its processor time, and another principal uses the server.
    DatabaseUnavailable
        If the database cannot be reached.
    """
    if _has_key_in_address(scope):
        raise KeyInAddress
    services = getattr(
        scope["app"].state, "services", None
    )  # before the start there are no services and no data
    door: Door | None = services and services.identity.door
    if door is None or scope["path"] in HEALTH:  # they need no role, and report an unreachable database
        return acting()
    if await door.is_open():
        return acting()
    guest = await _guest(door, scope)
    scope[PRINCIPAL] = who = guest.principal if guest else ANONYMOUS
    if guest:
        scope[STILL] = partial(_is_still, door, scope, who)
        scope[FORM_TOKEN] = guest.form_token
        scope[SETTLE] = door.admit(guest)
    return who


async def _is_still(door: Door, scope: Scope, who: Principal) -> bool:
    """Return whether a request would still be admitted as the same principal.

    It is needed for streams, which may outlive their key.
    """
    guest = await _guest(door, scope)
    return guest is not None and guest.principal == who


async def _guest(door: Door, scope: Scope) -> Guest | None:
    """Return the guest whom the key or session of a request identifies.

    Only the scheme Bearer carries a key of the service; others, such as Basic, are for a proxy before it.
    """
    cookies = b""
    for name, value in scope["headers"]:
        if name == b"authorization" and value[: len(_SCHEME)].lower() == _SCHEME:
            sent = _BEARER.fullmatch(value)
            return await door.by_key(sent[1].decode()) if sent else None
        if name == b"cookie":
            cookies = value
    match = _SIGN_IN_COOKIE.search(cookies[:_MOST_COOKIES])
    return await door.by_session(match[1].decode()) if match else None


def _has_key_in_address(scope: Scope) -> bool:
    """Return whether the path or the query contains a key."""
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
"""Key of an ASGI scope: the principal of the request, if the service requires keys."""


def is_session(text: str) -> bool:
    """Return whether a cookie's value has the form of a page's session."""
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
    """Return the client of a request as `get_client` does, but ignore an invalid name."""
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
"""Paths of the program's own files, which need no key: the sign-in page uses them."""


@dataclass(frozen=True)
class Needs:
    """The roles that a route needs, one of which is enough.

    Without roles, anyone who has signed in may use the route, or everyone if `is_public`.
    """

    roles: tuple[Role, ...]
    is_public: bool = False

    async def __call__(self) -> None:
        """Do nothing when called as a dependency; `RoleGuard` reads this declaration instead."""

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
    """Declare that a route needs one of these roles; without roles the sender only has to be signed in."""
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
    """A handler of a route or router that checks the role first."""

    def __init__(self, handle: ASGIApp, needed: Needs) -> None:
        self.handle, self.needed = handle, needed

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check the role, then handle the request."""
        self.needed.check()
        await self.handle(scope, receive, send)


def install(app: FastAPI) -> None:
    """Guard all present routes of an app, and unknown paths."""
    for route in app.router.routes:
        if not isinstance(route.handle, RoleGuard):
            route.handle = RoleGuard(route.handle, needs_of(route))  # type: ignore[method-assign]
    app.router.default = RoleGuard(app.router.default, SIGNED_IN)
