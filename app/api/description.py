"""The description of the interface at /openapi.json, made to say what the service does.

FastAPI derives it from the routes. It is wrong in four things, which are corrected here: a parameter of
a path, query or header has no null; a change needs If-Match; a name that does not fit the pattern of names is
refused; `itemSchema` is OpenAPI 3.2.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fastapi import FastAPI

NEEDED, STALE = "428", "412"
PRECONDITIONS = {
    STALE: "the design has changed since the revision that If-Match names",
    NEEDED: "a change needs If-Match",
}


def describe_interface(app: FastAPI) -> dict[str, Any]:
    """Return the OpenAPI 3.1 description of the application."""
    if app.openapi_schema is None:
        FastAPI.openapi(app)
        assert app.openapi_schema is not None
        for method, operation in _operations(app.openapi_schema):
            _drop_item_schemas(operation)
            _drop_nulls(operation)
            _declare_preconditions(method, operation)
        for schema in app.openapi_schema["components"]["schemas"].values():
            _close(schema)
    return app.openapi_schema


def _operations(described: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for item in described["paths"].values():
        yield from item.items()


def _drop_item_schemas(operation: dict[str, Any]) -> None:
    for response in operation["responses"].values():
        for content in response.get("content", {}).values():
            content.pop("itemSchema", None)


def _drop_nulls(operation: dict[str, Any]) -> None:
    """An optional parameter may be absent; there is no way to write null in a URL or a header."""
    for parameter in operation.get("parameters", ()):
        schema = parameter["schema"]
        kinds = [kind for kind in schema.get("anyOf", ()) if kind != {"type": "null"}]
        if len(kinds) == 1:
            del schema["anyOf"]
            parameter["schema"] = {**kinds[0], **schema}


def _declare_preconditions(method: str, operation: dict[str, Any]) -> None:
    """If-Match is needed for PATCH and compared wherever it is sent."""
    matching = [one for one in operation.get("parameters", ()) if one["name"] == "if-match"]
    if not matching:
        return
    matching[0]["required"] = method == "patch"
    responses = operation["responses"]
    statuses = (STALE, NEEDED) if method == "patch" else (STALE,)
    for status in statuses:
        responses[status] = {**responses["4XX"], "description": PRECONDITIONS[status]}


def _close(schema: Any) -> None:
    """Where names follow a pattern, no others are taken."""
    if isinstance(schema, list):
        for part in schema:
            _close(part)
    if isinstance(schema, dict):
        if "patternProperties" in schema:
            schema["additionalProperties"] = False
        for part in schema.values():
            _close(part)
