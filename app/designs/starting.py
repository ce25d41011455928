"""The values with which the iterations of a design begin."""

from __future__ import annotations

from collections.abc import Mapping

from app.designs.analyses import measured_unit
from app.designs.document import Document
from app.designs.graph import raise_if
from app.plain import Raw
from app.reference import Reference
from templates.core.errors import Fault, FaultyText
from templates.core.units.quantity import Value, read
from templates.core.units.units import unit


def starts(document: Document) -> dict[Reference, float]:
    """Return the SI values with which the iterations of a document begin.

    Raises
    ------
    InvalidInputs
        If a start is not a quantity of its measure's kind.
    """
    faults, values = list[Fault](), dict[Reference, float]()
    for iteration in document.iterations:
        through = Reference.parse(iteration.through)
        try:
            values[through] = _single(read(iteration.start, measured_unit(through)).si)
        except FaultyText as error:
            faults.append(error.fault("iterations.start"))
    raise_if(faults)
    return values


def settled(results: Mapping[str, list[Mapping[str, Raw]]] | None) -> dict[Reference, float]:
    """Return the values [SI] with which the iterations of a revision ended, by its results."""
    rounds = (results or {}).get("iterations", [])
    values = {str(one["through"]): (float(str(one["assumed"])), str(one["unit"])) for one in rounds}
    return {Reference.parse(name): float(unit(scale).to_si(value)) for name, (value, scale) in values.items()}


def _single(value: Value) -> float:
    if not isinstance(value, float):
        raise FaultyText("not_a_number", "give a single value here, not an array")
    return value
