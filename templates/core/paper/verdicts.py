"""The checks of a calculation report: every bound and rule of a template, compared with its values.

Each check gives the requirement, the value, and the ratio of value to limit. Nothing is refused here: a
template instance has passed the rules that refuse, so only rules that warn may be broken.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from templates.core.language.comparisons import Comparison, Operand, outcome, worst_share
from templates.core.language.meaning import Bounds, Meaning
from templates.core.language.spec import Declaration, Requirement
from templates.core.language.template import Template
from templates.core.language.violations import violation
from templates.core.paper.mathml import Writer, amount, symbol, symbols
from templates.core.paper.report import shown
from templates.core.units.units import Unit

Kind = Literal["domain", "published", "rule", "warning"]

_SIGNS = {"<": "<", "<=": r"\le ", ">": ">", ">=": r"\ge "}
_SMALL = 1e-2  # numbers in a rule below this may be SI values


@dataclass(frozen=True)
class Check:
    """One bound or rule; `demand` and `numbers` are LaTeX, empty without a formula or a single value.

    `used` is the ratio of the value to its limit at the worst point; None if it has no meaning.
    """

    name: str
    words: str
    kind: Kind
    demand: str
    numbers: str
    used: float | None
    holds: bool
    broken: int = 0  # points at which it does not hold
    points: int = 1
    source: str | None = None
    violation: str = ""  # of a broken rule: the actual relation in words


def checks(template: Template) -> Iterator[Check]:
    """Yield a check for each rule and for each bound that is more than a sign, if its values exist."""
    for declared in template.declarations.values():
        value = vars(template).get(declared.attribute)
        if isinstance(value, (float, np.ndarray)) and _has_number(value):
            yield from _of_bounds(template, declared, declared.meaning.at(template.level), value)
    for rule in template.requirements:
        if template.ledger.missing.isdisjoint(rule.uses) or rule.missing:
            check = _of_rule(template, rule)
            if check is not None:
                yield check


def _has_number(value: float | NDArray[np.generic]) -> bool:
    """Return whether a value contains a finite number; an array of texts has no bounds."""
    numbers = np.asarray(value)
    return numbers.dtype.kind in "fiu" and bool(np.isfinite(numbers).any())


def _of_bounds(template: Template, declared: Declaration, meaning: Meaning, value: Any) -> Iterator[Check]:
    kinds: tuple[tuple[Kind, Bounds, Bounds | None], ...] = (
        ("domain", meaning.domain, meaning.domain_si),
        ("published", meaning.published, meaning.published_si),
    )
    for kind, bounds, si in kinds:
        if si is None or not any((bounds.gt, bounds.ge, bounds.lt is not None, bounds.le is not None)):
            continue
        present = np.asarray(value)[np.isfinite(value)]
        inside = np.asarray(si.admits(present))
        numbers = shown(template, declared.attribute, {}, absolute=True) if np.ndim(value) == 0 else ""
        yield Check(
            name=declared.name,
            words=meaning.words,
            kind=kind,
            demand=_demanded(symbol(declared), bounds, meaning.unit),
            numbers=numbers and f"{symbol(declared)}={numbers}",
            used=None if meaning.scale.absolute else _share_of(si, present),
            holds=bool(inside.all()),
            broken=int((~inside).sum()),
            points=present.size,
            source=meaning.source,
        )


def _demanded(letter: str, bounds: Bounds, unit: str) -> str:
    low = bounds.gt if bounds.ge is None else bounds.ge
    high = bounds.lt if bounds.le is None else bounds.le
    before = "" if low is None else amount(low, unit) + ("<" if bounds.ge is None else r"\le ")
    after = "" if high is None else ("<" if bounds.le is None else r"\le ") + amount(high, unit)
    if before and not after and low is not None:
        return letter + (">" if bounds.ge is None else r"\ge ") + amount(low, unit)
    return f"{before}{letter}{after}"


def _share_of(bounds: Bounds, value: Any) -> float | None:
    """Return the larger of two ratios: value over upper limit, and lower limit over value."""
    highs = [worst_share(value, limit) for limit in (bounds.lt, bounds.le) if limit is not None]
    lows = [worst_share(limit, value) for limit in (bounds.gt, bounds.ge) if limit]
    return max((share for share in (*highs, *lows) if share is not None), default=None)


def _of_rule(template: Template, rule: Requirement) -> Check | None:
    """Return the check of a rule; None if it compared nothing because a limit is missing."""
    with np.errstate(all="ignore"):
        result = outcome(template, rule)
        decisive = list(result.decisive())
    truth = np.asarray(result.value, dtype=bool)
    if truth.all() and not decisive and _lacks_an_input(template, rule):
        return None
    shares = [comparison.share for comparison in decisive]
    written = [_written(template, comparison) for comparison in decisive]
    return Check(
        name=", ".join(rule.names),
        words=rule.sentence,
        kind="warning" if rule.warning else "rule",
        demand=r",\quad ".join(demand for demand, _ in written if demand),
        numbers=r",\quad ".join(numbers for _, numbers in written if numbers),
        used=max((share for share in shares if share is not None), default=None),
        holds=bool(truth.all()),
        broken=int((~truth).sum()),
        points=truth.size,
        violation="" if truth.all() else violation(template, rule, rule.names[0]),
    )


def _lacks_an_input(template: Template, rule: Requirement) -> bool:
    """Return whether an input that the rule names is neither given nor derived."""
    inputs = (template.inputs[name] for name in rule.names if name in template.inputs)
    values = (vars(template).get(declared.attribute) for declared in inputs)
    return any(isinstance(value, (float, np.ndarray)) and bool(np.isnan(value).all()) for value in values)


def _written(template: Template, comparison: Comparison) -> tuple[str, str]:
    """Return a comparison with symbols, and with numbers if all its values are single ones.

    Both are empty if a side cannot be printed; the sentence of the rule then states the requirement.
    """
    left, right = comparison.left, comparison.right
    if left.node is None or right.node is None or _misleads(template, left, right):
        return "", ""
    names = symbols(type(template))
    nodes = (node for side in (left.node, right.node) for node in ast.walk(side))
    used = {node.attr for node in nodes if isinstance(node, ast.Attribute)} & names.keys()
    values = {attribute: shown(template, attribute, {}) for attribute in used}
    demand = _joined(template, comparison, names, r"\,")
    return demand, _joined(template, comparison, values, r"\cdot ", is_filled=True) if all(
        values.values()
    ) else ""


def _joined(
    template: Template,
    comparison: Comparison,
    texts: Mapping[str, str],
    times: str,
    *,
    is_filled: bool = False,
) -> str:
    """Return both sides with the sign between them.

    The sign is the required one, or the true one if numbers are filled in.
    """
    attributes = {name: (text, 1 if r"\," in text else 3) for name, text in texts.items()}
    writer = Writer({}, attributes, {}, times)
    left, right = comparison.left, comparison.right
    written = _side(template, writer, left, right), _side(template, writer, right, left)
    return _SIGNS[comparison.actual if is_filled else comparison.sign].join(written)


def _side(template: Template, writer: Writer, side: Operand, other: Operand) -> str:
    """Return one side; a number is given in the unit of the input or output to which it is compared."""
    scale = _scale(template, other)
    if not side.constant or scale is None or scale.text == "1":
        assert side.node is not None
        return writer.write(side.node)[0]
    if scale.absolute:
        return amount(side.constant, "K")
    return amount(float(scale.from_si(side.constant)), scale.text)


def _scale(template: Template, side: Operand) -> Unit | None:
    """Return the declared unit of a side that is a value of the template, else None."""
    declared = template.declarations.get(side.attribute or "")
    return declared.meaning.scale if declared else None


def _misleads(template: Template, left: Operand, right: Operand) -> bool:
    """Return whether a side is a small SI number of unknown unit, such as a length in metres.

    Such a number would mislead a reader.
    """
    pairs = ((left, right), (right, left))
    return any(_is_small(one.constant) and _scale(template, other) is None for one, other in pairs)


def _is_small(constant: float | None) -> bool:
    return isinstance(constant, float) and 0 < constant < _SMALL
