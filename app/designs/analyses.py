"""Analyses that models of a design declare: what of them relations use, and what is wrong with them.

`"throw": {…, "analyses": {"torsion": {"tolerance": 0.005}}}` lets relations use `throw.torsion.stiffness`.
Only what a relation, or an iteration, uses is ever found; an analysis that nobody uses costs nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from app.designs.document import Model
from app.solids.questions import Question, faults, in_order, no_shaft, question
from cad.analysis.kinds import KINDS
from cad.inspect import MEASURES
from templates.core.errors import Fault, unknown_name


def measured_unit(tail: str) -> str:
    """The unit of what is measured on a solid: `mass`, or `torsion.stiffness`."""
    kind, _, output = tail.partition(".")
    return KINDS[kind][output] if output else MEASURES[tail]


def is_measured(tail: str, declared: Iterable[str]) -> bool:
    """Whether a name within a model is a measure of its solid, or an output of a declared analysis."""
    kind, _, output = tail.partition(".")
    return tail in MEASURES or (kind in declared and output in KINDS[kind])


def measured_names(declared: Iterable[str]) -> Iterator[str]:
    """Every name of that sort."""
    yield from MEASURES
    yield from (f"{kind}.{output}" for kind in declared for output in KINDS[kind])


def questions(name: str, model: Model, cls: Any, found: list[Fault]) -> dict[str, Question]:
    """The analyses that a model declares, as far as they can be made; faults are added to those found."""
    known = {kind: options for kind, options in model.analyses.items() if kind in KINDS}
    place = f"models.{name}.analyses"
    for kind in model.analyses.keys() - known.keys():
        found.append(unknown_name(kind, KINDS, "analysis").within(place))
    for kind, options in known.items():
        found += [fault.within(f"{place}.{kind}") for fault in faults(options)]
    if known and (reason := no_shaft(cls)):
        found.append(Fault(place, "no_shaft", reason))
    return {kind: question(kind, options) for kind, options in known.items()}


def remedy(name: str, models: Mapping[str, Mapping[str, Question]]) -> str | None:
    """What to do about an unknown name that means an analysis; None if it does not."""
    model, _, tail = name.partition(".")
    kind, _, output = tail.partition(".")
    if model not in models or kind not in KINDS or not output:
        return None
    if kind not in models[model]:
        declared = f'declare "analyses": {{"{kind}": {{}}}} in models.{model}'
        return f"{model} has no analysis {kind}; {declared} to use {name}"
    return f"{model}.{kind} tells {', '.join(KINDS[kind])}, no {output[:60]}"


def used(kind: str, names: Iterable[str]) -> tuple[str, ...]:
    """The outputs of an analysis that are among the names which relations use of its model."""
    prefix = f"{kind}."
    return in_order(kind, {name.removeprefix(prefix) for name in names if name.startswith(prefix)})
