"""Types of plain JSON values that only their readers check; every layer uses them.

`Json` is `Any` because Pydantic's `JsonValue` would require a type check at every index into a value that a
model, a migration or the language already checks as a whole.
"""

from __future__ import annotations

from typing import Any

Json = Any
"""A JSON value of any shape: a number, a text, a list of any depth, an object."""

JsonObject = dict[str, Json]
"""A JSON object, such as the content of a JSON column of the database."""

Raw = object
"""A value as the user typed it. It is untrusted; the language of templates reads it and reports faults."""
