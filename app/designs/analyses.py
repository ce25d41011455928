"""Finite-element analyses that the models of a design declare: outputs used by relations, and faults.

`"throw": {…, "analyses": {"torsion": {"tolerance": 0.005}}}` lets relations use `throw.torsion.stiffness`.
The service computes only outputs that a relation or an iteration uses. An unused analysis costs nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from app.designs.document import Model
from app.reference import Reference
from app.solids.questions import Question, faults, in_order, not_offered, question
from cad.analysis.kinds import KINDS, LISTS, TABLES
from cad.inspect import MEASURES
from cad.model import BETWEEN, CadModel
from templates.core.errors import Fault, unknown_name
from templates.core.language.template import Template


def measured_unit(reference: Reference) -> str:
    """Return the unit of a measurement of a solid: `model.mass`, or `throw.torsion.stiffness`."""
    if reference.analysis is None:
        output = reference.output or ""
        return MEASURES.get(output) or BETWEEN[output.rpartition("_")[2]]
    return KINDS[reference.analysis][reference.output or ""]


def is_measured(reference: Reference, declared: Iterable[str], cls: type[Template]) -> bool:
    """Return whether a name within a model is a measurement of its solid or an output of an analysis."""
    if reference.analysis is None:
        return reference.output in MEASURES or reference.output in _further(cls)
    return reference.analysis in declared and reference.output in KINDS[reference.analysis]


def is_table(reference: Reference) -> bool:
    """Return whether a name refers to an analysis output that is a table or a list, not a single value."""
    return axes_of(reference) > 0


def axes_of(reference: Reference) -> int:
    """Return the number of axes of an analysis output: 2 for a table, 1 for a list, 0 for a single value."""
    if reference.analysis not in KINDS:
        return 0
    return 2 if reference.output in TABLES else int(reference.output in LISTS)


def measured_names(declared: Iterable[str], cls: type[Template]) -> Iterator[str]:
    """Yield the names of all measurements and analysis outputs that a model provides."""
    yield from MEASURES
    yield from _further(cls)
    yield from (f"{kind}.{output}" for kind in declared for output in KINDS[kind])


def _further(cls: type[Template]) -> Mapping[str, str]:
    return cls.further_measures() if issubclass(cls, CadModel) else {}


def questions(name: str, model: Model, cls: type[CadModel]) -> tuple[dict[str, Question], list[Fault]]:
    """Return the valid analyses that a model declares, by kind, and the faults of the others."""
    if not model.analyses:
        return {}, []
    declared = {kind: options for kind, options in model.analyses.items() if kind in KINDS}
    place = f"models.{name}.analyses"
    unknown = model.analyses.keys() - declared.keys()
    wrong = [unknown_name(kind, KINDS, "analysis").within(place) for kind in unknown]
    for kind, options in declared.items():
        wrong += [fault.within(f"{place}.{kind}") for fault in faults(kind, options)]
    refused = [fault for kind in declared if (fault := not_offered(cls, kind))]
    wrong += [Fault(place, fault.code, fault.detail) for fault in refused[:1]]
    return {kind: question(kind, options) for kind, options in declared.items()}, wrong


def remedy(reference: Reference, models: Mapping[str, Mapping[str, Question]]) -> str | None:
    """Return a remedy for an unknown name that looks like an analysis output; None for other names."""
    model, kind, output = reference.block, reference.analysis, reference.output
    if model not in models or kind not in KINDS or not output:
        return None
    if kind not in models[model]:
        declared = f'declare "analyses": {{"{kind}": {{}}}} in models.{model}'
        return f"{model} has no analysis {kind}; {declared} to use {reference}"
    return f"{model}.{kind} has the outputs {', '.join(KINDS[kind])}, no {output[:60]}"


def used(kind: str, references: Iterable[Reference]) -> tuple[str, ...]:
    """Return the outputs of one kind of analysis that relations use."""
    return in_order(
        kind,
        {reference.output for reference in references if reference.analysis == kind and reference.output},
    )
