"""Every route × every role: what a role does not include is refused before the route runs.

The routes are those of the app. One that declares nothing needs viewer for reading and author for the rest;
these tables name what is declared otherwise, so a new route that does is looked at here.
"""

import re

import pytest
from described import APP
from fastapi.routing import iter_route_contexts
from starlette.routing import Mount

from app.http.access import needs_of
from app.identity.principal import INCLUDED, ROLES

PUBLIC = {
    "GET /healthz",
    "GET /readyz",
    "GET /problems/{slug}",
    "GET /sign-in",
    "POST /sign-in",
    "POST /sign-out",
    "GET /sign-in/oidc",
    "GET /sign-in/oidc/back",
    "MOUNT /static",
    "MOUNT /static-offline-docs",
}
SIGNED_IN = {
    "GET /metrics",
    "GET /account",
    "POST /account/keys",
    "POST /account/keys/{prefix}/revoke",
    "GET /api/v1/me",
    "GET /api/v1/principals/{id}/usage",
    "GET /api/v1/principals/{id}/keys",
    "POST /api/v1/principals/{id}/keys",
    "DELETE /api/v1/principals/{id}/keys/{prefix}",
}
READS = {  # by POST: nothing of a design or a worksheet changes; to save, `answer` checks the role itself
    "POST /api/v1/answer",
    "POST /api/v1/worksheets/check",
    "POST /api/v1/designs/{id}/preview",
    "POST /api/v1/designs/{id}/decide",
    "POST /api/v1/designs/{id}/solve",
    "POST /api/v1/designs/{id}/tolerance",
    "POST /api/v1/verify",
    "POST /tables",
    "POST /verdicts",
}
CALCULATES = {
    "POST /api/v1/templates/{id}/versions/{number}/evaluate",
    "POST /api/v1/templates/{id}/versions/{number}/solve",
    "POST /api/v1/templates/{id}/versions/{number}/worksheet",
    "POST /api/v1/film-pressure",
    "POST /api/v1/curves",
}
CHECKS = {
    f"POST {place}/worksheets/{{id}}/{step}"
    for place in ("/api/v1", "")
    for step in ("review", "release", "withdraw")
}
ADMINISTERS = {
    "GET /api/v1/principals",
    "POST /api/v1/principals",
    "GET /api/v1/principals/{id}",
    "POST /api/v1/principals/{id}",
    "GET /api/v1/audit",
    "GET /api/v1/audit/head",
    "GET /audit",
}
JOBS = {
    "GET /api/v1/jobs",
    "GET /api/v1/jobs/{id}",
    "GET /api/v1/jobs/{id}/events",
    "DELETE /api/v1/jobs/{id}",
}

ROUTES = [
    (method, context.path, context.original_route)
    for context in iter_route_contexts(APP.router.routes)
    for method in sorted(getattr(context.original_route, "methods", None) or ["MOUNT"])
    if method != "HEAD"
]


def wanted(method, path):
    """The roles of which one is needed, as the tables above have it; none: any; "public": nobody is asked."""
    name = f"{method} {path}".replace("{id:sheet}", "{id}")
    if name in PUBLIC:
        return "public"
    for table, roles in (
        (SIGNED_IN, ()), (READS, ("viewer",)), (CHECKS, ("checker",)), (ADMINISTERS, ("admin",)),
        (JOBS, ("viewer", "admin")), (CALCULATES, ("viewer", "admin")),
    ):  # fmt: skip
        if name in table:
            return roles
    return ("viewer",) if method == "GET" else ("author",)


@pytest.mark.parametrize(("method", "path", "route"), ROUTES, ids=[f"{m} {p}" for m, p, _ in ROUTES])
def test_a_route_needs_what_the_tables_say(method, path, route):
    needed = needs_of(route)
    assert ("public" if needed.is_public else needed.roles) == wanted(method, path)


def test_every_name_in_the_tables_is_a_route():
    names = {f"{method} {path}".replace("{id:sheet}", "{id}") for method, path, _ in ROUTES}
    assert (PUBLIC | SIGNED_IN | READS | CHECKS | ADMINISTERS | JOBS) - names == set()


def filled(path):
    """A path that names nothing that there is."""
    return re.sub(r"\{(number|version)[^}]*\}", "1", re.sub(r"\{(?!number|version)[^}]*\}", "nothing", path))


@pytest.mark.parametrize("role", [None, *ROLES])
def test_a_role_is_asked_for_before_anything_else(team, role):
    """Without an object, a body or a precondition: who may not is answered 401 or 403, nobody else is."""
    wrong = []
    with team.http(role) as http:
        for method, path, route in ROUTES:
            if method == "MOUNT" or path.endswith("/events") or path == "/sign-out":
                continue
            needed = needs_of(route)
            answer = http.request(method, filled(path))
            denied = "/problems/not-signed-in" in answer.text or "/problems/role-needed" in answer.text
            own = () if role is None else INCLUDED[role]
            allowed = (
                needed.is_public
                or (role is not None and not needed.roles)
                or bool(set(needed.roles) & set(own))
            )
            if denied == allowed or (answer.status_code >= 500 and path != "/readyz"):
                wrong.append((method, path, answer.status_code))
    assert wrong == []


def test_the_gate_sees_all_routes_that_fastapi_serves():
    served = [context.original_route for context in iter_route_contexts(APP.router.routes)]
    assert len(served) > 200
    assert list(map(id, APP.router.routes)) == list(map(id, served)), "a router is included whole"


def test_no_route_of_an_app_is_left_unguarded():
    from app.http.access import RoleGuard

    unguarded = [path for _, path, route in ROUTES if not isinstance(route.handle, RoleGuard)]
    assert unguarded == []
    assert isinstance(APP.router.default, RoleGuard)
    assert any(isinstance(route, Mount) for _, _, route in ROUTES)
