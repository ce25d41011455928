"""Return pages: the rendered template, a strict Content-Security-Policy, and the display units."""

from __future__ import annotations

from pathlib import Path
from typing import get_args
from urllib.parse import urlencode

from fastapi import Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from app.http.guard import PAGE_POLICY
from app.identity.principal import acting
from app.presentation.environment import environment
from app.presentation.units import System
from app.reports.pictures import axis_of
from app.web.plots import plotly
from app.web.shared.session import keep_session, who_signed_in, with_form_token

HEADERS = {
    "Content-Security-Policy": PAGE_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cache-Control": "no-store",  # going back must show the present state
    "Vary": "Cookie",
}
YEAR = 365 * 24 * 3600  # s
SCHEMES = ("light", "dark")

jinja = environment(Path(__file__).parents[1])
jinja.globals["ids_of_styles"] = plotly.ids_of_styles
jinja.globals["axis_of"] = axis_of


def units_of(request: Request) -> System:
    """Return the system of units that the address names, otherwise that of the cookie, otherwise SI."""
    asked = request.query_params.get("units") or request.cookies.get("units")
    return next((system for system in get_args(System) if system == asked), "si")


def has_decimal_comma(request: Request) -> bool:
    """Return whether the user chose the decimal comma for what is typed."""
    return request.cookies.get("decimal") == "comma"


def show(request: Request, name: str, status: int = 200, **context: object) -> Response:
    """Return a rendered page as a response."""
    units = units_of(request)
    page = jinja.get_template(name)
    html = page.render(
        units=units,
        scheme=_scheme(request),
        path=request.url.path,
        query=_beside_units(request),
        signed_in=who_signed_in(request),
        is_admin=acting().may("admin"),
        **context,
    )
    response = HTMLResponse(with_form_token(html, request), status, headers=HEADERS)
    if "units" in request.query_params:
        response.set_cookie("units", units, max_age=YEAR, samesite="lax", httponly=True)
    keep_session(request, response)
    return response


def _scheme(request: Request) -> str:
    """Return the chosen colour scheme; an empty text selects the system's scheme."""
    kept = request.cookies.get("scheme")
    return next((scheme for scheme in SCHEMES if scheme == kept), "")


def _beside_units(request: Request) -> str:
    """Return the query without `units`, so that another system of units can be appended."""
    rest = [(name, text) for name, text in request.query_params.multi_items() if name != "units"]
    return f"{urlencode(rest)}&" if rest else ""


def go(path: str) -> Response:
    """Redirect to another page after a form was processed."""
    return RedirectResponse(path, 303)
