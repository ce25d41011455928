"""Find the toleranced values of a design, and decide which of them an analysis can vary."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from app.designs.network import Cell, Graph
from app.reference import Reference
from app.schemas.answers import Warning
from app.tolerances.factors import Factor
from templates.core.errors import Fault
from templates.core.language.spec import Choice, Table
from templates.core.language.tolerances import UNUSED
from templates.core.units.quantity import TypedQuantity, read, read_any
from templates.core.units.tolerance import is_toleranced

MOST = 40
"""Largest number of values that one analysis varies."""

SEVERAL = "its value is an array; an analysis varies single values"
EXACT = "both its limits are its value"
APART = "nothing that was asked for follows from it"


@dataclass(frozen=True)
class TolerancedVariable:
    """A toleranced value: its place in the design, its text as typed, and its factor in the analysis."""

    reference: Reference
    typed: TypedQuantity
    factor: Factor


def varied(graph: Graph, behind: Collection[Cell]) -> tuple[list[TolerancedVariable], list[Warning]]:
    """Return the toleranced values that affect the requested results, and a warning for every other one.

    `behind` are the values on which the requested results depend.
    """
    chosen: list[TolerancedVariable] = []
    warnings: list[Warning] = []
    for cell in graph.cells():
        if cell.relations or not is_toleranced(cell.raw) or isinstance(cell.declared, Choice):
            continue
        typed = read(cell.raw, cell.declared.meaning.accepted) if cell.declared else read_any(cell.raw)
        factor = _factor(cell, typed)
        reason = factor if isinstance(factor, str) else None if cell in behind else APART
        if isinstance(factor, Factor) and reason is None:
            chosen.append(TolerancedVariable(cell.reference, typed, factor))
        elif reason is not None:
            detail = f"its tolerance has no part in this analysis: {reason}"
            warnings.append(Warning(code=UNUSED, name=cell.name, detail=detail))
    return chosen, warnings


def _factor(cell: Cell, typed: TypedQuantity) -> Factor | str:
    """Return a toleranced value as a factor of the analysis, or the reason why it cannot be varied."""
    tolerance, value = typed.tolerance, typed.si
    assert tolerance is not None
    lower, upper = tolerance.lower, tolerance.upper
    is_single = isinstance(value, float) and isinstance(lower, float) and isinstance(upper, float)
    if not is_single or isinstance(cell.declared, Table):
        return SEVERAL
    assert isinstance(value, float)
    if value + lower == value + upper:
        return EXACT
    low, high = float(value + lower), float(value + upper)
    return Factor(cell.name, value, low, high, tolerance.distribution)


def faults(chosen: Sequence[TolerancedVariable], warnings: Sequence[Warning]) -> Iterator[Fault]:
    """Yield a fault if no value varies, or too many do."""
    if not chosen:
        others = "; ".join(f"{w.name}: {w.detail}" for w in warnings[:3])
        detail = f"no requested output depends on a toleranced value{others and ': ' + others}"
        yield Fault("design", "no_tolerance", f"{detail}; write it like `55 ± 5 um`")
    if len(chosen) > MOST:
        yield Fault("design", "too_many", f"{len(chosen)} values vary; an analysis takes at most {MOST}")
