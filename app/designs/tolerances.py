"""Tolerances in a design that nothing calculates with: those of its own parameters and of its models.

Those of a step's inputs are among the warnings of the step.
"""

from __future__ import annotations

from app.plain import JsonObject
from app.schemas.answers import Warning
from templates.core.language.ledger import Notice
from templates.core.language.tolerances import unused


def warnings(document: JsonObject) -> list[Warning]:
    """A warning for every parameter of a design's document that has `plus` or `minus`."""
    listed = list(map(_warning, unused(document["parameters"])))
    for name, model in document["models"].items():
        listed += (_warning(notice, f"{name}.") for notice in unused(model["parameters"]))
    return listed


def _warning(notice: Notice, prefix: str = "") -> Warning:
    return Warning(code=notice.code, name=prefix + notice.name, detail=notice.detail)
