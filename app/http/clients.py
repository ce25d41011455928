"""The client of a request. Limits and turns are counted by client.

Who has signed in is the client as a principal. Where nothing asks for a key, a client is the header
`Crankwright-Client`, else the session of a page, else the address that the request came from.
"""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import Depends, Request
from starlette.datastructures import Headers
from starlette.types import Scope

from app.identity.principal import client_of
from templates.core.errors import Fault, InvalidInputs

HEADER, COOKIE = "Crankwright-Client", "crankwright_session"
_NAME = re.compile(r"[!-~][ -~]{0,98}[!-~]|[!-~]")  # up to 100 printable ASCII characters
_SESSION = re.compile(r"[A-Za-z0-9_-]{16,64}")
_IN_COOKIES = re.compile(rf"(?:^|;)[ ]*{COOKIE}=([A-Za-z0-9_-]{{16,64}})(?:;|$)")
_MOST_COOKIES = 8192  # characters that are looked at
PRINCIPAL = "crankwright.principal"
"""Key of an ASGI scope: the principal of the request, where keys are asked for."""


def is_session(text: str) -> bool:
    """Return whether a cookie's value can be a session of a page."""
    return _SESSION.fullmatch(text) is not None


async def get_client(request: Request) -> str:
    """Return the client of a request; its prefix says how: `principal:`, `name:`, `session:` or `address:`.

    Raises
    ------
    InvalidInputs
        If the header is not a name.
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
    """Return the client of a request as `get_client` has it; a name that is none counts as none."""
    if (who := scope.get(PRINCIPAL)) is not None:
        return client_of(who.id)
    headers = Headers(scope=scope)
    if _NAME.fullmatch(named := headers.get(HEADER, "")):
        return f"name:{named}"
    session = _IN_COOKIES.search(headers.get("cookie", "")[:_MOST_COOKIES])
    if session:
        return f"session:{session[1]}"
    return f"address:{scope['client'][0] if scope.get('client') else 'unknown'}"


TheClient = Annotated[str, Depends(get_client)]
