"""Read a document as its user sent it, pin the versions of its steps and models, and start its iterations."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import ValidationError

from app.catalogue.catalogues import Catalogues
from app.designs.analyses import measured_unit
from app.designs.document import Document
from app.designs.graph import raise_if
from app.plain import Json, Raw
from app.reference import Reference
from templates.core.errors import Fault, FaultyText, InvalidInputs, plain
from templates.core.units.quantity import Value, read
from templates.core.units.units import unit

LONGEST_PLACE = 200  # characters of where in a document something is wrong


def read_document(raw: Mapping[str, Raw]) -> Document:
    """Return a document from JSON.

    Raises
    ------
    InvalidInputs
        With everything that has not the shape of a design.
    """
    try:
        return Document.model_validate(raw)
    except ValidationError as error:
        raise InvalidInputs(map(_fault, error.errors(include_url=False, include_input=False))) from None


def _fault(error: Mapping[str, Json]) -> Fault:
    place = ".".join(str(part)[:LONGEST_PLACE] for part in error["loc"])
    return Fault(plain(place, LONGEST_PLACE) or "design", error["type"], error["msg"])


def resolved(document: Document, catalogues: Catalogues) -> Document:
    """Return the document with every version pinned.

    Latest is resolved once, when a step or model comes in.
    """
    versions = [step.version for step in document.steps.values()]
    versions += [model.version for model in document.models.values()]
    if all(isinstance(version, int) for version in versions):
        return document
    plain = document.model_copy(deep=True)
    for step in plain.steps.values():
        if not isinstance(step.version, int) and step.template in catalogues.templates.ids:
            step.version = catalogues.templates.latest(step.template).version
    for model in plain.models.values():
        if not isinstance(model.version, int) and model.id in catalogues.models.ids:
            model.version = catalogues.models.latest(model.id).version
    return plain


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
