"""Evaluations and criteria as the REST interface shows them: plain JSON values, never NaN or infinity."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np
from numpy.typing import NDArray

from app.plain import JsonObject
from app.schemas.slopes import slope_in
from templates.core.catalogue.digests import digest
from templates.core.criteria.judgement import Judgement, Place, sentence
from templates.core.criteria.summary import summarised
from templates.core.language.answer import Answer, UsedInput
from templates.core.language.evaluate import Evaluation, assumed
from templates.core.language.ledger import Notice
from templates.core.language.template import Template

if TYPE_CHECKING:
    from templates.core.language.solve import Jump, Root, Solution, TracedCurve


def rendered(ordered: Sequence[Judgement]) -> JsonObject:
    """Return `criteria`, worst first, and the overall `verdict`; empty if there are no criteria."""
    if not ordered:
        return {}
    return {"criteria": [criterion(judgement) for judgement in ordered], "verdict": verdict(ordered)}


def verdict(ordered: Sequence[Judgement]) -> dict[str, object]:
    """Return the verdict over all criteria, which must be in order."""
    summary = summarised(ordered)
    return {
        "verdict": summary.verdict,
        "counts": dict(summary.counts),
        "error_unknown": summary.error_unknown,
        **({"governing": summary.governing} if summary.governing else {}),
        "headline": summary.headline,
        "green": summary.green,
    }


def criterion(judgement: Judgement) -> JsonObject:
    """Return one criterion as JSON, without members that do not apply."""
    shown: JsonObject = {
        "name": judgement.name,
        "words": judgement.words,
        "require": judgement.require,
        "verdict": judgement.verdict,
        "sentence": sentence(judgement),
        "error_stated": judgement.error_known,
        "error_known": judgement.error_known,
    }
    _show_numbers(judgement, shown)
    if judgement.give:
        shown["give"] = list(judgement.give)
    if judgement.where:
        shown["where"] = _where(judgement.where)
    if judgement.points is not None:
        shown["points"] = judgement.points
    if judgement.counts:
        shown["counts"] = dict(judgement.counts)
    _show_remarks(judgement, shown)
    return shown


def _show_numbers(judgement: Judgement, shown: JsonObject) -> None:
    """Add the numbers of a criterion to its JSON object."""
    unit, margin = judgement.unit, judgement.margin
    if judgement.value is not None and math.isfinite(judgement.value):
        shown["value"] = {"value": judgement.value, "unit": unit}
    if judgement.limit is not None and math.isfinite(judgement.limit):
        shown["limit"] = {"value": judgement.limit, "unit": unit}
    if margin is not None and math.isfinite(margin):
        shown["margin"] = {"value": margin, "unit": judgement.margin_unit}
    if judgement.band is not None:
        shown["band"] = _band(judgement.band, unit)
    if judgement.relative_error is not None:
        shown["relative_error"] = judgement.relative_error
    if judgement.utilisation is not None:
        shown["utilisation"] = judgement.utilisation
    if judgement.needs is not None:
        shown["needs"] = judgement.needs


def _show_remarks(judgement: Judgement, shown: JsonObject) -> None:
    """Add the remarks on a criterion to its JSON object."""
    if judgement.reason is not None:
        shown["reason"] = judgement.reason
    if judgement.level is not None:
        shown["level"] = judgement.level
    if judgement.truth is not None:
        shown["truth"] = judgement.truth
    if judgement.source is not None:
        shown["source"] = judgement.source
    if judgement.unverified is not None:
        shown["unverified"] = judgement.unverified
    if judgement.waived is not None:
        shown["waived"] = judgement.waived


def _band(band: tuple[float, float], unit: str) -> dict[str, object]:
    return {"value": [end if math.isfinite(end) else None for end in band], "unit": unit}


def _where(places: Sequence[Place]) -> dict[str, object]:
    """Return the places by name; a place without a unit is a text, such as the name of a variant."""
    return {
        place.name: {"value": place.value, "unit": place.unit} if place.unit else place.value
        for place in places
    }


class Identity(TypedDict):
    """A version of a template, with the digest of its code."""

    id: str
    version: int
    digest: str


_identities: dict[type[Template], Identity] = {}


def identity(cls: type[Template]) -> Identity:
    """Return the version of the calculation: id, version and the digest of its code."""
    if cls not in _identities:
        identified: Identity = {"id": cls.id, "version": cls.version, "digest": digest(cls)}
        if cls.sheet:
            return identified  # a worksheet may be gone, but it states its digest
        _identities[cls] = identified
    return {**_identities[cls]}


def quantity(value: object, unit: str | None) -> dict[str, object]:
    """Return a value with its unit; a text has no unit."""
    return {"value": value} if unit is None else {"value": value, "unit": unit}


def outputs(answers: Mapping[str, Answer]) -> JsonObject:
    """Return the outputs; a missing value is null and has a reason."""
    shown: dict[str, object] = {}
    for name, output in answers.items():
        if isinstance(output.value, np.ndarray):
            shown[name] = _array(output)
        else:
            unit = {} if output.unit is None else {"unit": output.unit}
            reason = {} if output.reason is None else {"reason": output.reason}
            shown[name] = {"value": None if reason else output.value, **unit, **reason}
    return shown


def _array(output: Answer) -> dict[str, object]:
    """Return an output of several points or places; each missing value is null and has a reason."""
    if output.reasons is None:
        return quantity(output.value.tolist(), output.unit)
    holes = _with_holes(output.value, output.reasons)
    return {**quantity(holes.tolist(), output.unit), "reasons": output.reasons.tolist()}


def _with_holes(value: NDArray[np.float64], reasons: NDArray[np.object_]) -> NDArray[np.object_]:
    """Return the values as an object array, with None where a value is missing.

    A missing profile is a single None, because it has a single reason.
    """
    if value.ndim == reasons.ndim:
        holes = value.astype(object)
        holes[reasons != None] = None  # noqa: E711
        return holes
    rows = np.empty(reasons.shape, dtype=object)
    for point in np.ndindex(reasons.shape):
        rows[point] = None if reasons[point] else value[point].tolist()
    return rows


def _plain(value: object) -> object:
    """Return a single value or an array as JSON; unmeasured values are null."""
    if not isinstance(value, np.ndarray):
        return None if value != value else value  # NaN
    if value.ndim == 1:
        return [None if item != item else item for item in value.tolist()]
    return [_plain(row) for row in value]


def errors(errors: Mapping[str, object]) -> dict[str, object]:
    """Return the estimated error of each output."""
    return {
        name: _plain(error) if isinstance(error, np.ndarray) else None if error != error else error
        for name, error in errors.items()
    }


def inputs(echoes: Mapping[str, UsedInput]) -> dict[str, object]:
    """Return the inputs as the calculation used them."""
    shown: dict[str, object] = {}
    for name, used in echoes.items():
        part: dict[str, object] = {"value": used.value, "unit": used.unit, "from": used.source}
        if used.unit is None:
            del part["unit"]
        if used.extra:
            part |= used.extra
        shown[name] = part
    return shown


def evaluation(result: Evaluation) -> JsonObject:
    """Return the complete answer of `evaluate`."""
    return {
        "template": identity(type(result.template)),
        "inputs": inputs(result.inputs),
        "outputs": outputs(result.outputs),
        "level": _plain(result.level),
        "error": errors(result.error),
        "warnings": warnings(result.warnings),
        "assumed": assumptions(result, result.criteria),
        **rendered(result.criteria),
        "seconds": result.seconds,
    }


def assumptions(result: Evaluation, criteria: Sequence[Judgement]) -> list[dict[str, str]]:
    """Return the assumptions that an evaluation and its criteria make."""
    return [vars(one) for one in assumed(result.template, result.outputs, criteria)]


def warnings(notices: Iterable[Notice]) -> list[dict[str, object]]:
    """Return the warnings."""
    return [{"code": w.code, "name": w.name, "detail": w.detail} for w in notices]


def solution(result: Solution) -> JsonObject:
    """Return the complete answer of `solve`."""
    return {
        "unknown": quantity(result.unknown, result.unit),
        "warnings": warnings(result.warnings),
        "roots": [_root(root, result) for root in result.roots],
        "touching": [_root(root, result) for root in result.touching],
        "jumps": [_jump(jump, result) for jump in result.jumps],
        "curve": _curve(result.curve, result),
        "finer": [_curve(curve, result) for curve in result.finer],
        "evaluation": evaluation(result.evaluation),
    }


def _root(root: Root, result: Solution) -> dict[str, object]:
    about = {"level": root.level, "error": root.error, "confirmed": root.confirmed}
    slope = None if root.slope is None else slope_in(result.target_unit, result.unit, root.slope)
    change = {"crossing": root.crossing, "slope": slope and slope.plain()}
    reason = {} if root.no_slope is None else {"reason": root.no_slope}
    return {**quantity(root.value, result.unit), **change, **reason, **about}


def _jump(jump: Jump, result: Solution) -> dict[str, object]:
    sides = {
        "before": quantity(jump.before, result.target_unit),
        "after": quantity(jump.after, result.target_unit),
    }
    return {**quantity(jump.value, result.unit), **sides}


def _curve(curve: TracedCurve, result: Solution) -> dict[str, object]:
    return {
        "x": quantity(curve.x.tolist(), result.unit),
        "y": quantity(_plain(curve.y), result.target_unit),
        "reasons": curve.reasons.tolist(),
        "level": curve.level,
    }
