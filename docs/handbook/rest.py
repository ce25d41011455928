"""The REST reference: every call of openapi.json, and every schema that one refers to."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from app.main import create_app
from app.settings import Settings
from handbook.rendering import render

METHODS = ("get", "put", "post", "patch", "delete")


def pages() -> Iterator[tuple[str, str]]:
    """The reference, and the document it is written from."""
    document = interface()
    yield "reference/rest.md", page(document)
    yield "reference/openapi.json", json.dumps(document, indent=1, ensure_ascii=False)


def interface() -> dict[str, Any]:
    """The OpenAPI document of a service with default settings; nothing is started."""
    with tempfile.TemporaryDirectory() as folder:
        return create_app(Settings(data=Path(folder) / "data")).openapi()


def page(document: dict[str, Any]) -> str:
    """The reference as Markdown."""
    schemas = document["components"]["schemas"]
    return render(
        "rest.md.j2",
        groups=dict(_groups(document)),
        schemas={name: _schema(schema) for name, schema in sorted(schemas.items())},
    )


def _groups(document: dict[str, Any]) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Calls by tag, in the order of the document's tags."""
    calls = [
        _call(method, path, operation)
        for path, item in document["paths"].items()
        for method, operation in item.items()
        if method in METHODS
    ]
    for tag in document["tags"]:
        yield tag["name"], [call for call in calls if call["tag"] == tag["name"]]


def _call(method: str, path: str, operation: dict[str, Any]) -> dict[str, Any]:
    return {
        "tag": operation["tags"][0],
        "title": operation["summary"],
        "method": method.upper(),
        "path": path,
        "text": operation.get("description") or operation.get("summary", ""),
        "parameters": [_parameter(one) for one in operation.get("parameters", ())],
        "body": _contents(operation.get("requestBody", {})),
        "responses": [
            {"status": status, "text": one.get("description", ""), "content": _contents(one)}
            for status, one in operation.get("responses", {}).items()
        ],
    }


def _parameter(one: dict[str, Any]) -> dict[str, Any]:
    return {
        "name": one["name"],
        "where": one["in"],
        "required": one.get("required", False),
        "type": kind(one.get("schema", {})),
        "text": one.get("description", ""),
    }


def _contents(holder: dict[str, Any]) -> list[dict[str, Any]]:
    """Media types with the type of each body."""
    return [
        {"media": media, "type": kind(content.get("schema", {}))}
        for media, content in holder.get("content", {}).items()
    ]


def _schema(schema: dict[str, Any]) -> dict[str, Any]:
    required = schema.get("required", ())
    return {
        "text": schema.get("description", ""),
        "type": kind(schema),
        "properties": [
            {
                "name": name,
                "type": kind(one),
                "required": name in required,
                "text": one.get("description", ""),
            }
            for name, one in schema.get("properties", {}).items()
        ],
    }


def kind(schema: Any) -> dict[str, Any]:
    """The type in words, and the names of the schemas that it refers to."""
    return {"words": _words(schema), "schemas": list(dict.fromkeys(_references(schema)))}


def _words(schema: Any) -> str:
    if not isinstance(schema, dict):
        return "anything"
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "const" in schema or "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema.get("enum", [schema.get("const")]))
    for joined in ("anyOf", "oneOf", "allOf"):
        if joined in schema:
            return " or ".join(dict.fromkeys(_words(one) for one in schema[joined]))
    match schema.get("type"):
        case "array":
            return f"list of {_words(schema.get('items', {}))}"
        case list() as several:
            return " or ".join(map(str, several))
        case str() as one:
            return one
    return "anything"


def _references(schema: Any) -> Iterator[str]:
    """The schemas that a type names, not those within its properties."""
    if not isinstance(schema, dict):
        return
    if "$ref" in schema:
        yield str(schema["$ref"]).rpartition("/")[2]
    for joined in ("anyOf", "oneOf", "allOf"):
        for one in schema.get(joined, ()):
            yield from _references(one)
    if "items" in schema:
        yield from _references(schema["items"])
