"""The common form of several designs, and the quantities in which they differ.

Two documents have the same form if they differ only in single quantities of the same kind: parameters, inputs
of steps, parameters of models. Everything else, such as relations, choices, curves, limits and criteria, is
unchanged in the form.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.plain import Raw
from app.reference import Reference
from app.storage.tables import canonical_json
from templates.core.errors import FaultyText
from templates.core.language.spec import Choice, Curve, Input, Table
from templates.core.language.template import Template
from templates.core.units.nodes import kind_of
from templates.core.units.quantity import read, read_any
from templates.core.units.relation import is_relation

Quantities = Mapping[Reference, float]
"""Values [SI] of the places in which documents of the same form may differ."""


@dataclass(frozen=True)
class Form:
    """A document as text without its single quantities, and these quantities."""

    text: str
    quantities: Quantities


def form_of(document: Document, catalogues: Catalogues) -> Form:
    """Return the form of a document whose templates and models are in the catalogues."""
    plain = document.model_dump(mode="json", exclude={"name", "variants"})
    opening = _PlaceRemoval({})
    plain["parameters"] = {n: opening.parameter(n, raw) for n, raw in document.parameters.items()}
    for name, step in document.steps.items():
        cls = catalogues.templates.versions.get((step.template, int(step.version or 0)))
        plain["steps"][name]["inputs"] = opening.inputs(name, step.inputs, cls)
    for name, model in document.models.items():
        shape = catalogues.models.versions.get((model.id, int(model.version or 0)))
        plain["models"][name]["parameters"] = opening.inputs(name, model.parameters, shape)
    return Form(canonical_json(plain), opening.values)


@dataclass(frozen=True)
class _PlaceRemoval:
    """Replaces single quantities in a document with placeholders, and records their values."""

    values: dict[Reference, float]

    def parameter(self, name: str, raw: Raw) -> Raw:
        """Return a parameter of the design; a single quantity becomes a placeholder of the same kind."""
        if _is_written_out(raw):
            return raw
        try:
            typed = read_any(raw)
        except FaultyText:
            return raw
        if not isinstance(typed.si, float):
            return raw
        self.values[Reference(name)] = typed.si
        return {"open": kind_of(typed.unit).unit}

    def inputs(self, block: str, values: Mapping[str, Raw], cls: type[Template] | None) -> dict[str, Raw]:
        """Return the inputs of a step or parameters of a model, with placeholders for single quantities."""
        declared = cls.inputs if cls else {}
        return {name: self._input(block, name, raw, declared.get(name)) for name, raw in values.items()}

    def _input(self, block: str, name: str, raw: Raw, declared: Input | None) -> Raw:
        if declared is None or isinstance(declared, (Choice, Curve, Table)) or _is_written_out(raw):
            return raw
        try:
            typed = read(raw, declared.meaning.accepted)
        except FaultyText:
            return raw
        if not isinstance(typed.si, float):
            return raw
        self.values[Reference(block, None, name)] = typed.si
        return {"open": True}


def _is_written_out(raw: Raw) -> bool:
    """Return whether a value is a relation or a list, which are part of the form."""
    return isinstance(raw, list) or is_relation(raw)
