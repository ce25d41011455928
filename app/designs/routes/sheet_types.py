"""Media types of variant sheets: how requests and routes choose between JSON, CSV and XLSX."""

from __future__ import annotations

from pydantic.config import JsonDict
from starlette.requests import Request
from starlette.routing import Match
from starlette.types import Scope

from app.api.responses import accepted_weights
from app.designs.variant_sheets.service import Kind
from app.http.strict_requests import StrictRoute
from app.presentation.spreadsheets import XLSX

MEDIA: dict[Kind, str] = {
    "csv": "text/csv",
    "xlsx": XLSX,
}
KINDS: dict[str, Kind] = {media: kind for kind, media in MEDIA.items()}
JSON = "application/json"

_FILE: JsonDict = {"type": "string", "format": "binary"}
_EXAMPLE = "variant,scale\nunit,1\nmain_1,1.02\nmain_2,1.04\n"
BODIES: JsonDict = {
    "requestBody": {
        "content": {
            MEDIA["csv"]: {"schema": {"type": "string", "minLength": 1, "examples": [_EXAMPLE]}},
            MEDIA["xlsx"]: {"schema": _FILE},
        }
    }
}
"""Media types that a route accepts besides JSON."""
ANSWERS: dict[str, object] = {media: {"schema": _FILE} for media in MEDIA.values()}
"""Media types that a route returns besides JSON."""


class SheetRoute(StrictRoute):
    """A route that shares its path with a JSON route; it matches only if the client names a sheet type."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Return whether the path, the method and the media type match."""
        match, child_scope = super().matches(scope)
        if match is Match.FULL and sheet_kind(Request(scope)) is None:
            return Match.NONE, {}
        return match, child_scope


def sheet_kind(request: Request) -> Kind | None:
    """Return the kind of sheet that a client sends or prefers; None for JSON."""
    if request.method == "PUT":
        sent = request.headers.get("content-type", "").partition(";")[0]
        return KINDS.get(sent.strip().lower())
    accepted = accepted_weights(request.headers.get("accept"))
    weights = {media: accepted[media] for media in (JSON, *KINDS) if media in accepted}
    return KINDS.get(max(weights, key=lambda media: weights[media], default=JSON))
