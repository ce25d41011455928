"""Examples of answers in the OpenAPI document.

Each is a real answer, shortened, under the name of its schema; `tests/app/real_answers.py` records them. An
answer without a schema of its own is recorded under the name of its operation.
"""

from __future__ import annotations

import json
from pathlib import Path

from app.plain import JsonObject

EXAMPLES = Path(__file__).with_name("answer_examples.json")
ANSWERED = ("200", "201")
Part = JsonObject
"""A part of the OpenAPI document, or an answer."""


def add_examples(document: Part) -> None:
    """Add an example to each JSON answer of the document; each example is written once."""
    recorded: Part = json.loads(EXAMPLES.read_text(encoding="utf-8"))
    used = set[str]()
    for item in document["paths"].values():
        for operation in item.values():
            used.update(_refer(operation, recorded))
    document["components"]["examples"] = {name: {"value": recorded[name]} for name in sorted(used)}


def _refer(operation: Part, recorded: Part) -> list[str]:
    """Refer from the answers of an operation to their examples; return the names of these."""
    names = list[str]()
    for status in ANSWERED:
        contents = operation["responses"].get(status, {}).get("content", {})
        if content := contents.get("application/json"):
            own = [n for n in example_names(content["schema"], operation["operationId"]) if n in recorded]
            content["examples"] = {name: {"$ref": f"#/components/examples/{name}"} for name in own}
            names += own
    return names


def example_names(schema: Part, operation: str) -> list[str]:
    """Return the names of the examples of a schema: those of its models, or that of the operation."""
    models = [one["$ref"].rpartition("/")[2] for one in schema.get("anyOf", [schema]) if "$ref" in one]
    return models or [operation]
