"""Every request acts for the principal whose key or session it carries; its route then asks for a role."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from urllib.parse import unquote_plus

from fastapi import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.http.clients import PRINCIPAL
from app.identity.door import Door
from app.identity.errors import IdentityError, KeyInAddress
from app.identity.limits import LimitReached
from app.identity.principal import ANONYMOUS, Principal, acting_as
from app.identity.rows import Guest
from app.observation.secrets import LENGTH, MARK, holds_key
from app.storage.errors import DatabaseUnavailable

SIGN_IN = "crankwright_sign_in"
"""The cookie of a browser in which somebody has signed in."""
FORM_TOKEN = "crankwright.form_token"
"""Key of an ASGI scope: the token that forms of the session carry."""
HEALTH = frozenset({"/healthz", "/readyz"})
"""Answered to anybody, whether or not the database can be reached."""
STILL = "crankwright.still"
"""Key of an ASGI scope: asks whether the key or session of the request lets in the same roles as before."""
_BEARER = re.compile(rb"bearer +([!-~]{1,200})", re.IGNORECASE)
_IN_COOKIES = re.compile(rb"(?:^|;) *" + SIGN_IN.encode() + rb"=([A-Za-z0-9_-]{43})(?:;|$)")
_MOST_COOKIES = 8192  # bytes that are looked at
_ESCAPED = b"%"


class Access:
    """ASGI middleware that finds out who sends a request.

    Parameters
    ----------
    app
        The application.
    refuse
        Makes the answer to an error.
    """

    def __init__(
        self, app: ASGIApp, refuse: Callable[[IdentityError | DatabaseUnavailable], Response]
    ) -> None:
        self.app, self.refuse = app, refuse

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a key in the address, or pass on as somebody."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        if _has_key_in_address(scope):
            await self.refuse(KeyInAddress())(scope, receive, send)
            return
        services = getattr(scope["app"].state, "services", None)  # none before the start: there is no data
        door: Door | None = services and services.identity.door
        if door is None or scope["path"] in HEALTH:  # they need no role, and say so if the database is away
            await self.app(scope, receive, send)
            return
        try:
            is_open = await door.is_open()
            guest = None if is_open else await self._guest(door, scope)
        except DatabaseUnavailable as error:
            await self.refuse(error)(scope, receive, send)
            return
        if is_open:
            await self.app(scope, receive, send)
            return
        scope[PRINCIPAL] = who = guest.principal if guest else ANONYMOUS
        with acting_as(who):
            try:
                if guest:
                    scope[STILL] = partial(self._is_still, door, scope, who)
                    scope[FORM_TOKEN] = guest.form_token
                    door.count(guest)
            except LimitReached as error:
                await self.refuse(error)(scope, receive, send)
                return
            await self.app(scope, receive, send)

    async def _is_still(self, door: Door, scope: Scope, who: Principal) -> bool:
        """Return whether a request would be let in as the same principal now.

        A stream lasts longer than a key.
        """
        guest = await self._guest(door, scope)
        return guest is not None and guest.principal == who

    async def _guest(self, door: Door, scope: Scope) -> Guest | None:
        """Return whoever sends a request; a key that is sent counts alone, even where it is not valid."""
        cookies = b""
        for name, value in scope["headers"]:
            if name == b"authorization":
                sent = _BEARER.fullmatch(value)
                return await door.by_key(sent[1].decode()) if sent else None
            if name == b"cookie":
                cookies = value
        match = _IN_COOKIES.search(cookies[:_MOST_COOKIES])
        return await door.by_session(match[1].decode()) if match else None


def _has_key_in_address(scope: Scope) -> bool:
    """Return whether a key stands in path or query."""
    query: bytes = scope["query_string"]
    if len(scope["path"]) >= LENGTH and MARK in scope["path"] and holds_key(scope["path"]):
        return True
    if len(query) < LENGTH or not (MARK.encode() in query or _ESCAPED in query):
        return False
    return holds_key(unquote_plus(query.decode("latin-1")))
