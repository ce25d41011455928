"""Judge a criterion: compare its sides, and report the worst point and place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from templates.core.arrays import Truth
from templates.core.criteria.bands import Estimate, Shift, relative_width
from templates.core.criteria.comparison import (
    NOT_CHECKED,
    NOT_MET,
    VERDICTS,
    Codes,
    Comparison,
    Verdict,
    compare,
    side_of,
)
from templates.core.criteria.criterion import Criterion
from templates.core.criteria.judgement import Judgement, Place
from templates.core.criteria.worst import Worst, worst_of
from templates.core.errors import FaultyText, listed
from templates.core.units.units import Value

Parts = dict[str, Any]
"""Fields of a judgement by name."""


class Absent(NamedTuple):
    """Why a name has no value: the inputs to give, or the reason."""

    give: tuple[str, ...] = ()
    reason: str | None = None


@dataclass(frozen=True, slots=True)
class Instead:
    """The judged comparison that replaces a criterion without a value, and why the value is missing."""

    judgement: Judgement
    reason: str

    @property
    def rows(self) -> Codes:
        """Return the replacement verdicts; a missing value cannot violate a criterion with certainty."""
        codes = self.judgement.rows
        return np.where(np.equal(codes, NOT_MET), NOT_CHECKED, codes).astype(np.int8)

    def parts(self) -> Parts:
        """Return the fields that replace those of the original criterion in a judgement of single values."""
        if self.judgement.verdict not in ("met", "undecided"):
            return {}
        within = "" if self.judgement.verdict == "met" else "within the error of the calculation: "
        parts: Parts = {"verdict": self.judgement.verdict, "reason": within + self.reason}
        return parts | {"error_known": self.judgement.error_known, "rows": self.judgement.rows}


@dataclass(frozen=True, slots=True)
class Along:
    """The places of a curve: the name of the axis and its values [unit], shared or one row per point."""

    name: str
    values: Value
    unit: str


def judge(
    criterion: Criterion,
    estimates: Mapping[str, Estimate],
    absent: Mapping[str, Absent] | None = None,
    along: Along | None = None,
    unit_name: str | None = None,
    shifts: Sequence[Shift] = (),
    noted: Mapping[str, Any] | None = None,
    instead: Instead | None = None,
    *,
    is_known: Truth = True,
) -> Judgement:
    """Return the judgement of a criterion.

    Parameters
    ----------
    criterion
        The comparison to judge.
    estimates
        The values of its names, as far as they are available.
    absent
        The reasons why the other names have no value.
    along
        The places along the curve, if a curve is judged.
    unit_name
        The unit in which to report, if it is not that of the criterion.
    shifts
        The values of all names after an upstream value was moved to either end of its band.
    noted
        Further fields of the judgement, such as `level` and `truth`.
    instead
        The judged comparison that replaces this one where a side has no value.
    is_known
        Where the errors of all upstream values are known.
    """
    shown = criterion if unit_name is None else replace(criterion, unit=unit_name)
    if not estimates.keys() >= criterion.all_names:
        parts = _missing(shown, estimates, absent or {})
        parts |= instead.parts() if instead else {}
    else:
        try:
            compared = compare(criterion, estimates, shifts, is_known=is_known)
            compared = compared.filled(instead.rows) if instead else compared
            parts = _compared(shown, compared, estimates, along, bool(shifts))
            if instead and parts["verdict"] != "not_checked" and "value" not in parts:
                parts |= instead.parts() | {key: parts[key] for key in ("verdict", "rows")}
        except FaultyText as error:
            parts = {"verdict": "not_checked", "reason": str(error)}
    return Judgement(**{**shown.stated, **(noted or {}), **parts})


def _missing(criterion: Criterion, estimates: Mapping[str, Estimate], absent: Mapping[str, Absent]) -> Parts:
    """Return the fields of a judgement with missing values.

    If the other side is a single value, the fields contain it.
    """
    why = tuple([absent[name] for name in criterion.names if name in absent and name not in estimates])
    known = not _unknown(criterion, estimates)
    parts: Parts = {"verdict": "not_checked", "error_known": known, **_lack(why)}
    for name, side in (("value", criterion.value), ("limit", criterion.limit)):
        if side.names <= estimates.keys():
            si = side_of(side, estimates)
            if (isinstance(si, float) or not np.ndim(si)) and math.isfinite(si):
                parts[name] = float(criterion.scale.from_si(float(si)))
    return parts


def _unknown(criterion: Criterion, estimates: Mapping[str, Estimate]) -> list[str]:
    """Return the names whose own error is unknown at one or more points."""
    return [n for n in criterion.names if n in estimates and not estimates[n].is_known_throughout]


@lru_cache(maxsize=1024)
def _lack(absent: tuple[Absent, ...]) -> Mapping[str, Any]:
    """Return the inputs to give, and the reasons, for names without a value."""
    give = dict.fromkeys(name for one in absent for name in one.give)
    reasons = dict.fromkeys(one.reason for one in absent if one.reason)
    return {"give": tuple(give), "reason": "; ".join(reasons) or None}


def _compared(
    criterion: Criterion,
    compared: Comparison,
    estimates: Mapping[str, Estimate],
    along: Along | None,
    is_shifted: bool,
) -> Parts:
    """Return the fields of a judgement that describe both sides, at the worst place."""
    worst = worst_of(criterion, compared)
    rows = compared.rows()
    used = [estimates[name] for name in criterion.names]
    parts = {
        "verdict": VERDICTS[worst.code],
        "error_known": worst.is_known,
        "where": _where(worst.index, compared.axes, along),
        "rows": rows,
        **_counted(rows),
    }
    if worst.code == NOT_CHECKED:
        return {**parts, "reason": _no_value(used, worst.index[: len(worst.index) - compared.axes])}
    if math.isnan(worst.limit) or math.isnan(worst.value):  # another comparison was judged instead
        return parts
    numbers = _numbers(criterion, parts, worst, estimates)
    if is_shifted and worst.is_known:  # includes more than the error of the judged name
        numbers["relative_error"] = relative_width(worst.value, worst.low, worst.high)
    return {**parts, **numbers}


def _where(index: tuple[int, ...], axes: int, along: Along | None) -> tuple[Place, ...]:
    if not index:
        return ()
    points, places = index[: len(index) - axes], index[len(index) - axes :]
    where = [Place("point", _counted_from_one(points), "1")] if points else []
    if axes == 1 and along is not None:
        values = np.asarray(along.values)
        where.append(Place(along.name, float(values[index[-values.ndim :]]), along.unit))
    elif axes:
        where.append(Place("place", _counted_from_one(places), "1"))
    return tuple(where)


def _counted_from_one(index: tuple[int, ...]) -> int | list[int]:
    numbers = [i + 1 for i in index]
    return numbers[0] if len(numbers) == 1 else numbers


def _counted(rows: Codes) -> Parts:
    """Return the number of points with each verdict; empty for a single point."""
    if isinstance(rows, int):
        return {}
    numbers = np.bincount(rows.ravel(), minlength=len(VERDICTS))
    counts: dict[Verdict, int] = {}
    for verdict, n in zip(VERDICTS, numbers.tolist(), strict=True):
        if n:
            counts[verdict] = counts.get(verdict, 0) + n
    return {"points": int(rows.size), "counts": counts}


def _no_value(used: list[Estimate], point: tuple[int, ...]) -> str:
    """Return the reason why there is no value at a point."""
    for reasons in (estimate.reasons for estimate in used if estimate.reasons is not None):
        if reason := reasons[_own_place(point, reasons.shape)]:
            return str(reason)
    return "there is no value here"


def _own_place(point: tuple[int, ...], shape: tuple[int, ...]) -> tuple[int, ...]:
    """Return the index of a point within an array that was broadcast to all points."""
    return tuple(i % n for i, n in zip(point[len(point) - len(shape) :], shape, strict=True))


def _numbers(criterion: Criterion, parts: Parts, worst: Worst, estimates: Mapping[str, Estimate]) -> Parts:
    """Return the value, limit, band and derived numbers, in the unit of the criterion."""
    scale, is_temperature = criterion.scale, criterion.is_temperature
    subject = estimates[criterion.subject] if criterion.subject else None
    is_open = parts["verdict"] == "undecided" and worst.is_known
    needs = _needs(worst, subject) if is_open else None
    difference = worst.value - worst.limit if criterion.sign == ">=" else worst.limit - worst.value
    return {
        "value": float(scale.from_si(worst.value)),
        "limit": float(scale.from_si(worst.limit)),
        "band": (float(scale.from_si(worst.low)), float(scale.from_si(worst.high)))
        if worst.is_known
        else None,
        "relative_error": _relative_error(subject, worst) if worst.is_known else None,
        "utilisation": None if is_temperature else _utilisation(criterion, worst),
        "margin": difference / (1.0 if is_temperature else scale.factor),
        "margin_unit": "delta_degC" if is_temperature else criterion.unit,
        "needs": needs if needs is None or needs <= 1 else None,
        "reason": _reason(criterion, parts, worst, estimates, needs),
    }


def _relative_error(subject: Estimate | None, worst: Worst) -> float | None:
    """Return the stated error of the judged name; for an expression, the error given by its band."""
    if subject is None:
        return relative_width(worst.value, worst.low, worst.high)
    at = subject.error
    if isinstance(at, np.ndarray):
        points = worst.index[: len(worst.index) - subject.axes]
        at = at[_own_place(points, at.shape)] if len(points) >= at.ndim else at.max()  # one value at all
    return float(at)


def _utilisation(criterion: Criterion, worst: Worst) -> float | None:
    if not (worst.value > 0 and worst.limit > 0):
        return None
    share = worst.limit / worst.value if criterion.sign == ">=" else worst.value / worst.limit
    return share if math.isfinite(share) else None


def _needs(worst: Worst, subject: Estimate | None) -> float:
    """Return the largest relative error with which the limit would lie outside the band.

    If the limit is uncertain too, both are given the same relative error.
    """
    gap = abs(worst.value - worst.limit)
    if subject is not None and (subject.axes or subject.scale is not None):
        size = float(np.nanmax(np.abs(subject.value if subject.scale is None else subject.scale)))
        return gap / (size + gap) if gap else 0.0
    if worst.value * worst.limit <= 0:
        return 1.0 if gap else 0.0
    return gap / abs(worst.limit if worst.is_limit_exact else worst.value + worst.limit)


def _reason(
    criterion: Criterion, parts: Parts, worst: Worst, estimates: Mapping[str, Estimate], needs: float | None
) -> str | None:
    """Return a remark on a verdict, if one is needed."""
    if not worst.is_known:
        return unknown_error(map(in_words, _unknown(criterion, estimates)), parts["verdict"])
    if parts["verdict"] != "undecided":
        return None
    if not needs:
        return "the value equals the limit to within its error"
    within = "the limit lies within the error of the value"
    return f"{within}; a relative error below {needs:.2g} would decide" if needs <= 1 else within


MOST_NAMED = 2  # most values with unknown error that one sentence names


def unknown_error(names: Iterable[str], verdict: Verdict) -> str:
    """Return a sentence that names the values whose errors are unknown."""
    of = sorted(dict.fromkeys(names))
    more = len(of) - MOST_NAMED
    shown = listed(of) if more <= 0 else f"{', '.join(of[:MOST_NAMED])} and {more} more"
    unknown = f"error of {shown} unknown" if of else "error unknown"
    if verdict == "undecided":
        return f"{unknown}; the limit lies within the known part of the error"
    return unknown


def in_words(name: str) -> str:
    """Return the label of a value, after the name of its step."""
    return name.replace(".", ": ").replace("_", " ")
