"""Targets of requests that are no mere path, such as `GET http://evil.example/healthz`.

uvicorn drops the host from such a target and serves the path, although RFC 9112 wants that host to count
instead of the header `Host`. No client of this service sends one, so the guard refuses it.
"""

from __future__ import annotations

from starlette.types import Scope

from app.http.heads import BoundedHead

_KEY = "crankwright.target"


class WholeTarget(BoundedHead):
    """uvicorn's protocol, which leaves a note in the scope where the target is no mere path."""

    def on_headers_complete(self) -> None:
        """Note it, and go on."""
        if not self.url.startswith(b"/"):
            self.scope["extensions"] = {_KEY: {}}
        super().on_headers_complete()


def is_mere_path(scope: Scope) -> bool:
    """Return whether the target of a request is a path, or the `*` of OPTIONS."""
    if scope["path"] == "*":
        return True
    return scope["path"].startswith("/") and _KEY not in (scope.get("extensions") or {})
