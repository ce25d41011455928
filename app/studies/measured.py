"""Measures of solids that are built already and do not follow from what varies: one value for all rows."""

from __future__ import annotations

from app.designs.analyses import is_measured, is_table
from app.designs.engine.calculation import Calculation
from app.designs.service import Designs
from app.plain import JsonObject
from app.reference import Reference
from templates.core.errors import FaultyText


def measured_in(designs: Designs, document: JsonObject) -> dict[str, float]:
    """Return the measures [SI] that relations of a document use, as far as they are known."""
    if not document.get("models"):
        return {}
    calculation = designs.prepare(document)[1]
    values = {str(reference): _value(calculation, reference) for reference in _used(calculation)}
    return {name: value for name, value in values.items() if value is not None}


def _used(calculation: Calculation) -> set[Reference]:
    """Return the measures and results of analyses that relations name, but for tables."""
    blocks = calculation.graph.blocks
    used = {reference for cell in calculation.graph.cells() for reference in cell.uses.values()}
    models = {
        reference for reference in used if reference.block in blocks and blocks[reference.block].is_model
    }
    measured = {r for r in models if is_measured(r, blocks[r.block].analyses, blocks[r.block].cls)}
    return {reference for reference in measured if not is_table(reference)}


def _value(calculation: Calculation, reference: Reference) -> float | None:
    try:
        return float(calculation.measure(reference))
    except (FaultyText, KeyError):  # not built, or not analysed
        return None
