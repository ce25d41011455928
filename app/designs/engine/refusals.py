"""Refusals of rows: made from the faults of array calls, and from the points that templates mask."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from app.designs.engine.columns import Indices
from templates.core.errors import Fault, FaultyText
from templates.core.language.causes import BROKEN
from templates.core.language.ledger import Mask
from templates.core.language.template import Template


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a row has no values: the place, a code for programs, and a sentence."""

    place: str
    code: str
    detail: str


def refusal_of(faults: Sequence[Fault]) -> Refusal:
    """Combine several faults into one refusal, located at the first fault."""
    first, *others = faults
    details = [first.detail, *(f"{fault.name}: {fault.detail}" for fault in others)]
    return Refusal(first.name, first.code, "; ".join(details))


def refusal_of_text(place: str, error: FaultyText) -> Refusal:
    """Return the refusal of a relation."""
    return Refusal(place, error.code, str(error))


def masked(step: str, template: Template, rows: Indices) -> dict[int, Refusal]:
    """Return the rows with masked points, each with the message of its first mask."""
    refusals: dict[int, Refusal] = {}
    for mask in template.ledger.masks:
        if not mask.explains and mask.where.any():
            refused = rows[np.broadcast_to(mask.where, rows.shape)].tolist()
            refusals = dict.fromkeys(refused, _refusal(step, template, mask)) | refusals
    return refusals


def _refusal(step: str, template: Template, mask: Mask) -> Refusal:
    """Return the refusal for a mask, with the code that a single point would have."""
    attribute, *others = mask.names
    name = template.declarations[attribute].name
    code = BROKEN
    if not others and attribute not in template.ledger.handed:
        code = "outside_domain"
    elif not others and mask.reason.startswith(f"{name} must be "):
        code = "out_of_range"
    return Refusal(f"{step}.{name}", code, mask.reason)


def is_of_all_rows(cls: type[Template], faults: Sequence[Fault], varied: Collection[str]) -> bool:
    """Return whether a fault concerns all rows because it depends on no varied input."""
    attributes = {cls.inputs[name].attribute for name in varied}
    for fault in faults:
        beneath = _beneath(cls, fault)
        if fault.code == "missing" or (beneath and beneath.isdisjoint(attributes)):
            return True
    return False


def _beneath(cls: type[Template], fault: Fault) -> frozenset[str]:
    """Return the attributes on which a fault depends; empty if these are unknown."""
    declared = {**cls.formulas, **cls.inputs}
    if not all(name in declared for name in fault.names):
        return frozenset()
    used = {declared[name].attribute for name in fault.names}
    if fault.code == BROKEN:
        rules = (rule for rule in cls.requirements if not set(rule.names).isdisjoint(fault.names))
        used = used.union(*(rule.uses for rule in rules))
    return frozenset().union(*map(cls.dependencies, used))
