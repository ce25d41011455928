"""Compare a design or variant, calculated with its present versions, with the result under a new version."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from app.impact.outcome import Outcome, is_temperature
from app.impact.schemas import CriterionChange, MarginLost, ModelParameterChange, OutputChange
from app.reference import Reference
from app.schemas.answers import Quantity
from templates.core.arrays import Array
from templates.core.units.conformity import misfit
from templates.core.units.nodes import kind_of
from templates.core.units.units import Value, unit

SAME = 1e-9
"""Relative change below which two values are the same: far above the rounding of array calls, 3e-15."""

INFINITE = float("inf")

UNREMARKABLE = {(None, "met"), (None, "not_checked"), ("not_checked", None)}
"""Changes of criteria between versions that require no action."""


@dataclass(frozen=True)
class Difference:
    """The changes in one design or one variant.

    Attributes
    ----------
    outputs
        Number of outputs that change.
    size
        The relative change of `output`; infinite if one side has no value.
    gone
        Outputs that only the old version has.
    """

    verdicts: tuple[CriterionChange, ...] = ()
    margin: MarginLost | None = None
    output: OutputChange | None = None
    outputs: int = 0
    size: float = 0.0
    gone: tuple[str, ...] = ()
    parameters: tuple[ModelParameterChange, ...] = ()
    waiting: tuple[str, ...] = field(default=())

    @property
    def is_moved(self) -> bool:
        """Return whether any known value changes."""
        return bool(self.verdicts or self.outputs or self.gone or self.parameters)


def difference(before: Outcome, after: Outcome, variant: str | None) -> Difference:
    """Return the changes between two outcomes without faults."""
    moved = sorted(_outputs(before, after), key=lambda one: (-one[1], one[0]))
    output = _shown(before, after, moved[0][0], variant) if moved else None
    names = after.values.keys() | {name for name in before.values if _is_of_waiting(name, after)}
    return Difference(
        verdicts=tuple(_verdicts(before, after, variant)),
        margin=_margin(before, after, variant),
        output=output,
        outputs=len(moved),
        size=moved[0][1] if moved else 0.0,
        gone=tuple(name for name in before.values if name not in names),
        parameters=tuple(_parameters(before, after, variant)),
        waiting=after.waiting,
    )


def _is_of_waiting(name: str, outcome: Outcome) -> bool:
    return Reference.parse(name).block in outcome.waiting


def _named(name: str, variant: str | None) -> dict[str, str]:
    return {"name": name} | ({} if variant is None else {"variant": variant})


def _verdicts(before: Outcome, after: Outcome, variant: str | None) -> Iterator[CriterionChange]:
    for name in dict.fromkeys([*before.judged, *after.judged]):
        old, new = (outcome.judged.get(name) for outcome in (before, after))
        words = [one.verdict if one else None for one in (old, new)]
        if words[0] != words[1] and tuple(words) not in UNREMARKABLE:
            yield CriterionChange.model_validate({**_named(name, variant), "old": words[0], "new": words[1]})


def _margin(before: Outcome, after: Outcome, variant: str | None) -> MarginLost | None:
    """Return the criterion that loses the largest part of its margin; those without a margin rank last."""
    losses: list[tuple[float, MarginLost]] = []
    for name, old in before.judged.items():
        new = after.judged.get(name)
        if new is None or old.margin is None or new.margin is None or old.unit != new.unit:
            continue
        lost = old.margin - new.margin
        if lost <= SAME * max(abs(old.margin), abs(new.margin)):
            continue
        relative = lost / old.margin if old.margin > 0 and np.isfinite(lost / old.margin) else None
        margin = MarginLost.model_validate(
            {
                **_named(name, variant),
                "old": Quantity(value=old.margin, unit=old.unit),
                "new": Quantity(value=new.margin, unit=new.unit),
                "lost": Quantity(value=lost, unit=old.unit),
                "relative": relative,
            }
        )
        losses.append((-1.0 if relative is None else relative, margin))
    return max(losses, key=lambda one: one[0])[1] if losses else None


def _outputs(before: Outcome, after: Outcome) -> Iterator[tuple[str, float]]:
    """Yield the outputs of both versions that change, with the size of the change."""
    for name, old in before.values.items():
        new = after.values.get(name)
        if new is None:
            continue
        size = change_size(old, new) if _is_one_kind(before, after, name) else INFINITE
        if size > SAME:
            yield name, size


def _is_one_kind(before: Outcome, after: Outcome, name: str) -> bool:
    """Return whether a name has the same kind of quantity in both versions, whatever its unit."""
    one, other = before.units[name], after.units[name]
    return one == other or misfit(kind_of(one), unit(other), one) is None


def change_size(old: Value, new: Value) -> float:
    """Return the largest change divided by the largest old value.

    It is infinite if a value appears, vanishes or changes from 0.
    """
    if (
        isinstance(old, float)
        and isinstance(new, float)
        and old
        and math.isfinite(old)
        and math.isfinite(new)
    ):
        return abs(new - old) / abs(old)
    one, other = _together(old, new)
    if one.shape != other.shape or not np.array_equal(np.isnan(one), np.isnan(other)):
        return INFINITE
    if np.array_equal(one, other, equal_nan=True):
        return 0.0
    scale = float(np.nanmax(np.abs(one)))
    step = float(np.nanmax(np.abs(other - one)))
    return step / scale if scale else INFINITE


def _together(old: Value, new: Value) -> tuple[Array, Array]:
    """Return both values as arrays of the same shape, even if one of them is a single value."""
    one, other = np.asarray(old, dtype=float), np.asarray(new, dtype=float)
    if one.ndim and other.ndim:
        return one, other
    shape = np.broadcast_shapes(one.shape, other.shape)
    return np.broadcast_to(one, shape), np.broadcast_to(other, shape)


def _shown(before: Outcome, after: Outcome, name: str, variant: str | None) -> OutputChange:
    """Return a change where it is largest, in the unit that the new version declares."""
    old, new = _together(before.values[name], after.values[name])
    is_alike = old.shape == new.shape and _is_one_kind(before, after, name)
    place = _place(old, new) if is_alike else ()
    units = (after if is_alike else before).units[name], after.units[name]
    ends = [_quantity(values[place], scale) for values, scale in zip((old, new), units, strict=True)]
    change = _signed(old, new, place, after.units[name]) if is_alike else None
    return OutputChange.model_validate(
        {**_named(name, variant), "old": ends[0], "new": ends[1], "change": change}
    )


def _place(one: Array, other: Array) -> tuple[np.intp, ...]:
    """Return the index at which two arrays differ most; a missing value counts as the largest difference."""
    steps = np.where(np.isnan(one) != np.isnan(other), INFINITE, np.abs(other - one))
    return np.unravel_index(int(np.argmax(np.nan_to_num(steps, nan=-1.0, posinf=INFINITE))), one.shape)


def _signed(one: Array, other: Array, place: tuple[np.intp, ...], scale: str) -> float | None:
    """Return the change at an index, divided by the largest old value."""
    largest = float(np.nanmax(np.abs(one))) if not np.isnan(one).all() else 0.0
    step = float(other[place] - one[place])
    if is_temperature(scale) or largest == 0 or not np.isfinite(step / largest):
        return None
    return step / largest


def _quantity(si: Value, scale: str) -> Quantity | None:
    """Return a single value [SI] in a unit; None for an array or a missing value."""
    if np.ndim(si) or not np.isfinite(si):
        return None
    return Quantity(value=float(unit(scale).from_si(float(si))), unit=scale)


def _parameters(before: Outcome, after: Outcome, variant: str | None) -> Iterator[ModelParameterChange]:
    """Yield parameters of models that change, or that become unknown until a solid is built."""
    for name in dict.fromkeys([*before.parameters, *after.parameters]):
        old, new = (outcome.parameters.get(name) for outcome in (before, after))
        if old is None or new is None or change_size(old, new) > SAME:
            scale = (before if name in before.units else after).units[name]
            ends = [None if si is None else _quantity(si, scale) for si in (old, new)]
            yield ModelParameterChange.model_validate(
                {**_named(name, variant), "old": ends[0], "new": ends[1]}
            )
