"""The session cookie of the pages: it shows which requests come from one browser, not whose."""

from __future__ import annotations

import secrets

from fastapi import Request, Response

from app.api.gate.clients import COOKIE, is_session

BYTES = 16  # 128 random bits


def keep_session(request: Request, response: Response) -> None:
    """Give a browser a session, unless it has one; the service keeps nothing of it."""
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
