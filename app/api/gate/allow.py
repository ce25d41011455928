"""Which methods a path takes: the header Allow of a 405.

Starlette names the methods of the first route that fits the path; a path has a route for each method here.
"""

from __future__ import annotations

from fastapi import Request
from starlette.routing import Match, Mount

METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")


def allowed_methods(request: Request) -> str:
    """Return all methods that some route takes for the path of a request, as the header Allow has them."""
    root = request.scope.get("app_root_path", request.scope.get("root_path", ""))
    return ", ".join(method for method in METHODS if _takes(request, method, root))


def _takes(request: Request, method: str, root: str) -> bool:
    scope = {**request.scope, "method": method, "root_path": root}
    for route in request.app.router.routes:
        if route.matches(dict(scope))[0] is Match.FULL:
            # what is mounted matches for every method; files are only read
            return method in ("GET", "HEAD") if isinstance(route, Mount) else True
    return False
