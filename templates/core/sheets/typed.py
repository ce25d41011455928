"""The default of an input, as it was typed."""

from __future__ import annotations

from typing import Any

from templates.core.language.meaning import Meaning
from templates.core.sheets.body import TreeBody
from templates.core.units.operations import Constant


def default_of(node: Any, meant: Meaning, body: TreeBody) -> Any:
    """A constant default: as typed where it is one number, else calculated, in the declared unit."""
    if isinstance(node, Constant) and node.text:
        return node.text if " " in node.text or meant.unit == "1" else f"{node.text} {meant.unit}"
    return {"value": float(meant.scale.from_si(float(body(None)))), "unit": meant.unit}
