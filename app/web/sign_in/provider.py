"""Sign in through the organisation's provider: redirect the browser there, and handle its return."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheIdentity, services_of
from app.http.access import public
from app.identity.oidc import Begun, Provider, ProviderRefused, begin
from app.web.shared.responses import go, show
from app.web.shared.session import keep_signed_in
from app.web.sign_in.routes import own, sent

COOKIE = "crankwright_begun"
"""Name of the cookie of a started sign-in. The provider's site redirects back to the service, so the
cookie is not Strict."""
PLACE = "/sign-in/oidc"
_MINUTES = 10
_KEPT = re.compile(r"([\w-]{43})\.([\w-]{43})\.([\w-]{43})\.((?:[0-9a-f]{2}){1,2000})")

router = APIRouter(include_in_schema=False, dependencies=[public()])
Text = Annotated[str, Query(max_length=4000)]


@router.get(PLACE)
async def leave(request: Request, back: Text = "/") -> Response:
    """Redirect the browser to the provider."""
    begun = begin()
    response = go(await Provider(services_of(request).settings).address(begun, _address(request)))
    response.set_cookie(
        COOKIE,
        f"{begun.state}.{begun.nonce}.{begun.verifier}.{own(back).encode().hex()}",
        path=PLACE,
        max_age=_MINUTES * 60,
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="lax",
    )
    return response


@router.get(PLACE + "/back")
async def come_back(
    request: Request, identity: TheIdentity, state: Text = "", code: Text = "", error: Text = ""
) -> Response:
    """Finish the sign-in, then redirect, so that the browser sends the new cookie.

    Raises
    ------
    ProviderRefused
        If the provider or its answer cannot be trusted, or the user cancelled.
    """
    kept = _KEPT.fullmatch(request.cookies.get(COOKIE, "")[:5000])
    if kept is None or error:
        raise ProviderRefused("the sign-in was not completed: start again in this browser")
    provider = Provider(services_of(request).settings)
    person = await provider.person(Begun(*kept.groups()[:3]), state, code, _address(request))
    id = await run_in_threadpool(identity.signed_in_as, person.subject, person.name)
    token = await run_in_threadpool(identity.sign_in, id, None, sent(request))
    response = show(request, "sign_in/signed_in.html", back=own(bytes.fromhex(kept[4]).decode("latin-1")))
    keep_signed_in(request, response, token, services_of(request).settings.session_hours)
    response.delete_cookie(COOKIE, path=PLACE)
    return response


def _address(request: Request) -> str:
    """Return the callback address, with the host name by which the browser reaches the service."""
    return f"{request.url.scheme}://{request.url.netloc}{PLACE}/back"
