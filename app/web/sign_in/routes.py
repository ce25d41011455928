"""Sign-in, sign-out, and the account page: roles, limits, keys.

Only browsers have sessions, so these pages create and end them.
"""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheIdentity, services_of
from app.http.access import SIGN_IN, needs, public
from app.identity.errors import NotSignedIn
from app.identity.keys import key_prefix
from app.identity.routes import principals as routes
from app.identity.schemas.principals import Key, KeyIn, NewKey
from app.web.shared.forms import fields, forms_only
from app.web.shared.responses import go, show
from app.web.shared.services import PageServices, ThePageServices
from app.web.shared.session import keep_signed_in

_BACK = re.compile(r"/(?![/\\])[!-~]*")
LONGEST = 300  # longest text accepted as a key [characters]

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

Prefix = Annotated[str, Path(pattern=r"^[a-z0-9]{10}$")]


@router.get("/sign-in", dependencies=[public()])
async def sign_in_page(request: Request, back: str = "/") -> Response:
    """Return the form for a key."""
    return _page(request, back)


@forms.post("/sign-in", dependencies=[public()])
async def sign_in(request: Request, identity: TheIdentity) -> Response:
    """Start a session with a key, and redirect to the requested page."""
    typed = await fields(request)
    key, back = typed.get("key", "").strip()[:LONGEST], typed.get("back", "/")
    guest = await identity.door.by_key(key)
    if guest is None:
        return _page(request, back, status=401, wrong=str(NotSignedIn()))
    token = await run_in_threadpool(identity.sign_in, guest.principal.id, key_prefix(key), sent(request))
    return begun(request, token, back)


def begun(request: Request, token: str, back: str) -> Response:
    """Redirect to a page and set the cookie of a new session."""
    response = go(own(back))
    keep_signed_in(request, response, token, services_of(request).settings.session_hours)
    return response


@forms.post("/sign-out", dependencies=[public()])
async def sign_out(request: Request, identity: TheIdentity) -> Response:
    """End the session."""
    await run_in_threadpool(identity.sign_out, sent(request))
    response = go("/sign-in")
    response.delete_cookie(SIGN_IN, path="/", httponly=True, samesite="strict")
    return response


@router.get("/account", dependencies=[needs()])
async def account(request: Request, services: ThePageServices) -> Response:
    """Return the page of the principal: name, roles, usage, and keys."""
    return await _account(request, services)


@forms.post("/account/keys", dependencies=[needs()])
async def add_key(request: Request, services: ThePageServices) -> Response:
    """Create a key, and show it once on this page."""
    typed = await fields(request)
    me = await services.run(routes.show_me, services.identity)
    days = typed.get("days", "").strip()
    body = services.read(KeyIn, {"name": typed.get("name", "").strip(), "expires_days": days or None})
    key = await services.run(routes.add_key, me.id, body, services.identity)
    return await _account(request, services, key)


@forms.post("/account/keys/{prefix}/revoke", dependencies=[needs()])
async def revoke_key(prefix: Prefix, services: ThePageServices) -> Response:
    """Revoke a key."""
    me = await services.run(routes.show_me, services.identity)
    await services.run(routes.revoke_key, me.id, prefix, services.identity)
    return go("/account")


async def _account(request: Request, services: PageServices, new_key: NewKey | None = None) -> Response:
    me = await services.run(routes.show_me, services.identity)
    keys: list[Key] = []
    if me.usage.limits is not None:
        keys = (await services.run(routes.list_keys, me.id, services.identity, limit=500)).items
    return show(request, "sign_in/account.html", me=me, keys=keys, new_key=new_key)


def _page(request: Request, back: str, *, status: int = 200, wrong: str = "") -> Response:
    provider = services_of(request).settings.oidc_issuer
    return show(request, "sign_in/sign_in.html", status, back=own(back), wrong=wrong, provider=provider)


def sent(request: Request) -> str:
    """Return the session cookie that a browser sent, whether or not the session exists."""
    return request.cookies.get(SIGN_IN, "")[:LONGEST]


def own(back: str) -> str:
    """Return an address of this service; the home page for any other address."""
    return back if len(back) <= 2000 and _BACK.fullmatch(back) else "/"
