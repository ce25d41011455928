"""Evaluate a template: from a user's inputs to named answers, computing only what is asked for."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.declare import Choice, Formula
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_name
from templates.core.intake import Input
from templates.core.ledger import Notice
from templates.core.quantity import Typed, Unit, require_same_kind
from templates.core.template import Template


@dataclass(frozen=True, slots=True)
class Answer:
    """One result in its unit; NaN in an array, or None, where there is none, with its reason."""

    value: Any
    unit: str | None
    reason: str | None = None
    reasons: NDArray[np.object_] | None = None


@dataclass(frozen=True, slots=True)
class Echo:
    """One input as it was used: as typed, or its default."""

    value: Any
    unit: str | None
    source: str  # "given" or "default"
    extra: Mapping[str, Any]


@dataclass(frozen=True)
class Evaluation:
    """What `evaluate` returns; `template` is the evaluated instance with every SI value it computed."""

    template: Template
    inputs: dict[str, Echo]
    outputs: dict[str, Answer]
    warnings: list[Notice]
    seconds: float


def evaluate(
    cls: type[Template],
    raw: Mapping[str, Any],
    *,
    outputs: Iterable[str] | None = None,
    units: Mapping[str, str] | None = None,
    level: str | None = None,
    tolerance: float | None = None,
) -> Evaluation:
    """Evaluate the outputs named (all, if None) for inputs as a user types them.

    `units` asks for outputs in other units. Arrays of inputs give arrays of outputs.

    Raises
    ------
    InvalidInputs
        Naming everything that is wrong with the request at once, or the result that is out of its domain.
    """
    start = time.perf_counter()
    names = list(cls.formulas) if outputs is None else list(outputs)
    faults = [unknown_name(name, cls.formulas, "output") for name in names if name not in cls.formulas]
    shown_in = _units(cls, units or {}, faults)
    if level is not None:
        faults.append(
            Fault("level", "unknown_name", f"{cls.id} {cls.version} has one level only; leave it out")
        )
    try:
        template = cls.from_quantities(raw)
    except InvalidInputs as error:
        raise InvalidInputs([*faults, *error.faults]) from None
    if faults:
        raise InvalidInputs(faults)
    with np.errstate(all="ignore"):
        answers = {name: _answer(template, cls.formulas[name], shown_in.get(name)) for name in names}
        echoes = {name: _echo(template, declared) for name, declared in cls.inputs.items()}
    notices = [*_standing(cls, tolerance), *template.ledger.warnings]
    return Evaluation(template, echoes, answers, notices, time.perf_counter() - start)


def _units(cls: type[Template], units: Mapping[str, str], faults: list[Fault]) -> dict[str, Unit]:
    shown: dict[str, Unit] = {}
    for name, text in units.items():
        if name not in cls.formulas:
            faults.append(unknown_name(name, cls.formulas, "output").within("units"))
            continue
        try:
            shown[name] = require_same_kind(text, cls.formulas[name].meaning.unit)
        except FaultyText as error:
            faults.append(error.fault(f"units.{name}"))
    return shown


def _answer(template: Template, formula: Formula[Any], shown_in: Unit | None) -> Answer:
    si = getattr(template, formula.attribute)
    scale = shown_in or formula.meaning.scale
    if not isinstance(si, np.ndarray):
        return Answer(float(scale.from_si(si)), scale.text)
    value, reasons = _with_reasons(template, formula.attribute, si)
    return Answer(scale.from_si(value), scale.text, reasons=reasons)


def _with_reasons(
    template: Template, attribute: str, si: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.object_] | None]:
    """The values with NaN where a mask of anything beneath covers them, and the reason for each NaN."""
    beneath = template.ancestors(attribute)
    masks = [mask for mask in template.ledger.masks if not beneath.isdisjoint(mask.names)]
    if not masks and not np.isnan(si).any():
        return si, None
    shape = reduce(np.broadcast_shapes, (mask.where.shape for mask in masks), si.shape)
    covered = reduce(np.logical_or, (mask.where for mask in masks), np.zeros(shape, dtype=bool))
    value = np.where(covered, np.nan, si)
    reasons = np.full(shape, None, dtype=object)
    reasons[np.isnan(value)] = "the formula has no finite value here"
    for mask in reversed(masks):
        reasons[np.broadcast_to(mask.where, shape)] = mask.reason
    return value, reasons


def _echo(template: Template, declared: Input) -> Echo:
    typed = template.ledger.typed.get(declared.name)
    if isinstance(typed, Typed):
        return Echo(typed.value, typed.unit, "given", typed.extra)
    value = getattr(template, declared.attribute)
    source = "default" if typed is None else "given"
    if isinstance(declared, Choice):
        return Echo(value, None, source, {})
    shown = declared.meaning.scale.from_si(value)
    return Echo(
        shown.tolist() if isinstance(shown, np.ndarray) else float(shown), declared.meaning.unit, source, {}
    )


def _standing(cls: type[Template], tolerance: float | None) -> list[Notice]:
    """The warnings that hold for every answer of this version."""
    notices = []
    if cls.withdrawn:
        notices.append(
            Notice("withdrawn", cls.id, f"{cls.id} version {cls.version} is withdrawn: {cls.withdrawn}")
        )
    if tolerance is not None:
        detail = f"the error of {cls.id} version {cls.version} is not measured; no level is known to meet it"
        notices.append(Notice("tolerance_unmet", "tolerance", detail))
    return notices
