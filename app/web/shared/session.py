"""Cookies of a browser: one that identifies its requests, and one for a session after sign-in.

The first does not identify a principal. With the second, every form contains a token of the session, in
addition to the rule that forms must come from the service's own pages.
"""

from __future__ import annotations

import hmac
import re
import secrets

from fastapi import Request, Response

from app.http.access import COOKIE, FORM_TOKEN, PRINCIPAL, SIGN_IN, is_session
from app.http.guard import CrossSite
from app.identity.principal import ANONYMOUS

BYTES = 16  # 128 random bits
FIELD = "form_token"
_FORM = re.compile(r'<form\b[^>]*\bmethod="post"[^>]*>')


def keep_session(request: Request, response: Response) -> None:
    """Give a browser a session cookie, unless it has one; the service does not store the session."""
    if is_session(request.cookies.get(COOKIE, "")):
        return
    response.set_cookie(
        COOKIE,
        secrets.token_urlsafe(BYTES),
        path="/",
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="strict",
    )


def who_signed_in(request: Request) -> str:
    """Return the name of the principal of the session or key; an empty text if there is neither."""
    who = request.scope.get(PRINCIPAL, ANONYMOUS)
    return "" if who is ANONYMOUS else str(who.name)


def with_form_token(html: str, request: Request) -> str:
    """Return a page whose forms carry the token of the session, if there is one."""
    token = request.scope.get(FORM_TOKEN)
    return _FORM.sub(rf'\g<0><input type="hidden" name="{FIELD}" value="{token}">', html) if token else html


def check_form_token(request: Request, typed: dict[str, str]) -> None:
    """Compare the token of a form with that of the session, if the request has a session.

    Raises
    ------
    CrossSite
        If it differs or is missing.
    """
    token = request.scope.get(FORM_TOKEN)
    if token and not hmac.compare_digest(typed.get(FIELD, "").encode(), token.encode()):
        raise CrossSite("the form belongs to another session: open its page again, and send it from there")


def keep_signed_in(request: Request, response: Response, token: str, hours: float) -> None:
    """Set the cookie of a signed-in session, valid for a time [h]."""
    response.set_cookie(
        SIGN_IN,
        token,
        path="/",
        max_age=int(hours * 3600),
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="strict",
    )
