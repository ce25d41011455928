"""Join the faults of broken rules that have one cause, so that each wrong input gives one fault.

A rule names all inputs that it concerns, but only some of them can have broken it. The rule is evaluated
again with its comparisons recorded, and the false comparisons show which inputs can have broken it. If one
input can have broken several rules, these give one fault, at that input.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from templates.core.errors import Fault
from templates.core.language.calculation import Calculation
from templates.core.language.comparisons import Operand, Outcome, outcome
from templates.core.language.spec import Choice, Requirement

BROKEN = "inconsistent"
"""The code of the fault of a broken rule."""


def suspects(template: Calculation, rule: Requirement) -> tuple[str, ...]:
    """Return the API names of the inputs that may have broken a rule at a single point.

    Given inputs come before derived inputs; otherwise they have the order of the rule.
    """
    with np.errstate(all="ignore"):
        sides = list(_compared(outcome(template, rule)))
    used = set[str]().union(*(_inputs_of(template, side) for side in sides))
    seen = [name for name in rule.names if name in used or isinstance(template.inputs[name], Choice)]
    names = seen if used.intersection(seen) else list(rule.names)  # a choice alone cannot have been compared
    return tuple(sorted(names, key=lambda name: name not in template.ledger.typed))


def _compared(result: Outcome) -> Iterator[Operand]:
    """Yield the operands of the false parts of a rule."""
    if result.comparison is not None:
        yield from (result.comparison.left, result.comparison.right)
    elif result.parts:
        for part in result.parts:
            if not np.all(part.value):  # none of the alternatives holds
                yield from _compared(part)
    else:
        yield from result.equated or (Operand(result.value),)


def _inputs_of(template: Calculation, side: Operand) -> set[str]:
    """Return the inputs on which a side depends; all inputs if the side cannot be written as a formula."""
    if side.node is None:
        return set(template.inputs)
    read = (node.attr for node in ast.walk(side.node) if isinstance(node, ast.Attribute))
    beneath = {name for attribute in read for name in template.depends_on(attribute)}
    return {name for name, declared in template.inputs.items() if declared.attribute in beneath}


def by_cause(faults: Iterable[Fault]) -> list[Fault]:
    """Return the faults of broken rules, joined at the input that explains most of them.

    Other faults are returned unchanged.
    """
    faults = list(faults)
    broken = [fault for fault in faults if fault.code == BROKEN]
    return [fault for fault in faults if fault.code != BROKEN] + list(_joined(broken))


def _joined(broken: Sequence[Fault]) -> Iterator[Fault]:
    while broken:
        cause = _commonest(broken)
        yield _at(cause, [fault for fault in broken if cause in fault.names])
        broken = [fault for fault in broken if cause not in fault.names]


def _commonest(broken: Sequence[Fault]) -> str:
    """Return the input that may have broken most rules; of several such inputs, the one named first."""
    places: dict[str, list[int]] = {}
    for fault in broken:
        for place, name in enumerate(fault.names):
            places.setdefault(name, []).append(place)
    return min(places, key=lambda name: (-len(places[name]), sum(places[name])))


def _at(cause: str, faults: Sequence[Fault]) -> Fault:
    others = dict.fromkeys(name for fault in faults for name in fault.names if name != cause)
    return Fault(cause, BROKEN, ". ".join(fault.detail for fault in faults), tuple(others))
