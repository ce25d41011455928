"""Write the sentence for a broken rule from the values in the rule's comparisons.

The docstring of a rule states the requirement. For a broken rule it would state the opposite of the facts, so
this module does not use it.
"""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Truth
from templates.core.criteria.judgement import DIGITS, Side, compared, related
from templates.core.language.calculation import Calculation
from templates.core.language.comparisons import OPPOSITE, Comparison, Operand, Outcome, outcome
from templates.core.language.spec import Declaration, Requirement, Shared
from templates.core.units.units import Unit, unit, unit_symbol

UNUSED = "unused_input"
"""The code of a warning about an input that has no effect."""
_ATTRIBUTE = re.compile(r"\bself\.(\w+)")


def violation(template: Calculation, rule: Requirement, name: str) -> str:
    """Return a sentence about a broken rule, for a warning about one of its names."""
    if stated := stated_case(template, rule):
        return stated
    if rule.warning == UNUSED:
        level = str(getattr(template, "level", ""))
        at = f" at level {level.replace('_', ' ')}" if "level" in rule.function.__code__.co_names else ""
        return f"{_given(template, name)} is not used{at}"
    return "; ".join(_given(template, one) for one in rule.names)


def required(rule: Requirement) -> str:
    """Return the requirement of a rule, in the form that a refusal appends to the actual case."""
    return f"required: {rule.sentence}; {rule.remedy}"


def stated_case(template: Calculation, rule: Requirement) -> str:
    """Return the false comparisons in words with their numbers; empty if one cannot be put into words."""
    with np.errstate(all="ignore"):
        written = [_written(template, one) for one in _broken(outcome(template, rule))]
    return "; ".join(written) if all(written) else ""


def relations(template: Calculation, rule: Requirement) -> list[tuple[NDArray[np.bool_], str]]:
    """Return each false comparison in words with its points; empty if one cannot be put into words."""
    with np.errstate(all="ignore"):
        broken = list(_broken(outcome(template, rule)))
    written = [(np.asarray(one.where), _related(template, one)) for one in broken]
    return written if all(text for _, text in written) else []


def _related(template: Calculation, comparison: Comparison) -> str:
    """Return a false comparison in words, with no numbers except those in the rule; empty if impossible."""
    sides = comparison.left, comparison.right
    scale = _common_scale(template, comparison)
    words = [
        _words(template, side).removesuffix(" =")
        if side.constant is None
        else _constant(side.constant, scale)
        for side in sides
    ]
    return related(words[0], OPPOSITE[comparison.sign], words[1]) if scale and all(words) else ""


def _constant(si: float, scale: Unit | None) -> str:
    return f"{float(scale.from_si(si)):.{DIGITS}g} {unit_symbol(scale.text)}".strip() if scale else ""


def _common_scale(template: Calculation, comparison: Comparison) -> Unit | None:
    left, right = comparison.left, comparison.right
    return _scale(template, left) or _scale(template, right) or _number_of(left, right)


def _broken(result: Outcome, where: Truth = True) -> Iterator[Comparison]:
    """Yield the false comparisons.

    Comparisons joined as alternatives are yielded only at points where all of them are false.
    """
    fails = np.asarray(where, dtype=bool) & ~np.asarray(result.value, dtype=bool)
    if not fails.any():
        return
    if result.comparison is not None:
        yield replace(result.comparison, where=fails)
    for part in result.parts:
        yield from _broken(part, where if result.needs_all else fails)


def _written(template: Calculation, comparison: Comparison) -> str:
    """Return a false comparison at its worst point; empty if it cannot be put into words."""
    left, right = comparison.left, comparison.right
    scale = _common_scale(template, comparison)
    if scale is None:
        return ""
    words = _words(template, left), _words(template, right)
    if not all(text or side.constant is not None for text, side in zip(words, (left, right), strict=True)):
        return ""
    low, high, broken = np.broadcast_arrays(
        np.asarray(left.value, dtype=float),
        np.asarray(right.value, dtype=float),
        ~np.asarray(comparison.holds, dtype=bool) & np.asarray(comparison.where, dtype=bool),
    )
    broken = broken & ~np.isnan(low - high)  # without a value nothing is compared
    if not broken.any():
        return ""
    beyond = np.where(broken, np.abs(low - high), -2.0)
    worst = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    values = (float(scale.from_si(float(si[worst]))) for si in (low, high))
    sides = [Side(*side) for side in zip(words, values, strict=True)]
    if any(np.isnan(side.magnitude) for side in sides):
        return ""
    count = f" (worst of {int(broken.sum())} among {broken.size} values)" if broken.size > 1 else ""
    return compared(sides[0], OPPOSITE[comparison.sign], sides[1], scale.text) + count


def _scale(template: Calculation, side: Operand) -> Unit | None:
    """Return the unit of a side that is an input or output."""
    declared = template.declarations.get(side.attribute or "")
    between = getattr(type(template), side.attribute or "", None)
    if isinstance(between, Shared) and between.unit:
        return unit(between.unit)
    return declared.meaning.scale if declared else None


def _number_of(left: Operand, right: Operand) -> Unit | None:
    """Return the unit 1 if one side is a constant so large that it needs no unit, otherwise None."""
    constants = [side.constant for side in (left, right) if side.constant is not None]
    return unit("1") if any(abs(one) >= 1e-2 for one in constants) else None


def _words(template: Calculation, side: Operand) -> str:
    """Return the words of a side; empty for a constant or an expression that cannot be printed."""
    if side.node is None or side.constant is not None:
        return ""
    if side.attribute is not None:
        return _called(template, side.attribute)
    text = _ATTRIBUTE.sub(lambda name: _called(template, name[1]), ast.unparse(side.node))
    return f"{text.replace('*', '·')} ="


def _called(template: Calculation, attribute: str) -> str:
    """Return the label of an input, an output, or an intermediate result."""
    declared = template.declarations.get(attribute)
    if declared is not None:
        return declared.meaning.words
    shared = getattr(type(template), attribute, None)
    text = (inspect.getdoc(shared.function) or "").split(".")[0] if isinstance(shared, Shared) else ""
    return text.removeprefix("Return ") or attribute


def _given(template: Calculation, name: str) -> str:
    """Return an input as text, with its value if that is a single one."""
    declared: Declaration = template.inputs[name]
    value = getattr(template, declared.attribute)
    if isinstance(value, str):
        return f"{name.replace('_', ' ')} {value.replace('_', ' ')}"
    if isinstance(value, (float, int)) and not np.isnan(value):
        scale = declared.meaning.scale
        number = f"{float(scale.from_si(value)):.{DIGITS}g} {unit_symbol(scale.text)}"
        return f"{declared.meaning.words} {number}".rstrip()
    return declared.meaning.words
