"""Compare the designs of a batch with both versions, in a calculation process."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.variants.table import applied
from app.impact.effect import impact_of
from app.impact.forms import Form, Quantities, form_of
from app.impact.outcome import Outcome
from app.impact.schemas import DesignImpact
from app.impact.single import outcome_alone
from app.impact.solids import Solids
from app.impact.task import Batch, DesignAt, upgraded
from app.impact.together import Together
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.progress import report


@dataclass(frozen=True)
class BatchResult:
    """The designs of a batch that change or refuse the version, and the counts of others and of variants."""

    designs: tuple[DesignImpact, ...]
    unchanged: int
    variants: int


@dataclass(frozen=True)
class Case:
    """A design, or one of its variants, before and after the upgrade."""

    design: DesignAt
    variant: str | None
    before: Document
    after: Document


Pair = tuple[Outcome, Outcome]


def compared(batch: Batch) -> BatchResult:
    """Return the comparison of every design of a batch between its present versions and the new one."""
    catalogues = batch.parts.read()
    documents = {design.id: design.read() for design in batch.designs}
    cases = [case for design in batch.designs for case in _cases(design, documents[design.id], batch)]
    outcomes = _outcomes(cases, catalogues, batch.solids)
    impacts: list[DesignImpact] = []
    for design in batch.designs:
        pairs = {case.variant: outcomes[n] for n, case in enumerate(cases) if case.design is design}
        impact = impact_of(batch, design, documents[design.id], pairs, catalogues)
        impacts += [impact] if impact else []
    variants = sum(case.variant is not None for case in cases)
    return BatchResult(tuple(impacts), len(batch.designs) - len(impacts), variants)


def _cases(design: DesignAt, document: Document, batch: Batch) -> Iterator[Case]:
    """Yield a case for the design itself, then one for each of its variants."""
    after = upgraded(document, batch.template, batch.version)
    yield Case(design, None, document, after)
    for variant, overrides in document.variants.items():
        yield Case(design, variant, applied(document, overrides), applied(after, overrides))


def _outcomes(cases: Sequence[Case], catalogues: Catalogues, solids: Solids) -> dict[int, Pair]:
    """Return both outcomes of every case, by case number; cases of one form are calculated together."""
    groups: dict[tuple[str, str], list[_Member]] = {}
    for number, case in enumerate(cases):
        forms = form_of(case.before, catalogues), form_of(case.after, catalogues)
        groups.setdefault((forms[0].text, forms[1].text), []).append(_Member(number, case, forms))
    outcomes: dict[int, Pair] = {}
    for members in groups.values():
        report(len(outcomes) / len(cases), f"{len(outcomes)} of {len(cases)} designs and variants")
        outcomes |= _of_group(members, catalogues, solids)
    return outcomes


@dataclass(frozen=True)
class _Member:
    """A case in a group, with its forms before and after the upgrade."""

    number: int
    case: Case
    forms: tuple[Form, Form]


def _of_group(members: Sequence[_Member], catalogues: Catalogues, solids: Solids) -> dict[int, Pair]:
    """Return both outcomes of every case of one form."""
    sides: list[list[Outcome]] = []
    for side in (0, 1):
        documents = [(member.case.before, member.case.after)[side] for member in members]
        quantities = [member.forms[side].quantities for member in members]
        outcomes = _together(documents[0], quantities, catalogues)
        if outcomes is None:
            outcomes = [
                outcome_alone(document, catalogues, solids, member.case.design.assumed())
                for document, member in zip(documents, members, strict=True)
            ]
        sides.append(outcomes)
    pairs = zip(*sides, strict=True)
    return {member.number: (old, new) for member, (old, new) in zip(members, pairs, strict=True)}


def _together(
    document: Document, quantities: Sequence[Quantities], catalogues: Catalogues
) -> list[Outcome] | None:
    """Return the outcomes of documents of one form; None if they must be calculated alone."""
    if len(quantities) < 2:
        return None
    columns = _columns(quantities)
    together = Together.of(document, catalogues, columns.keys())
    return together.outcomes(columns, len(quantities)) if together else None


def _columns(quantities: Sequence[Quantities]) -> Mapping[Reference, Array]:
    """Return the values [SI] of the quantities in which the designs differ."""
    columns = {place: np.array([one[place] for one in quantities]) for place in quantities[0]}
    return {place: column for place, column in columns.items() if (column != column[0]).any()}
