"""The answer to a request, in SI units: chosen values, verdicts, what binds or conflicts, and the proof."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from app.answers.columns import LevelTally
from app.answers.places import FreePlace
from app.answers.request import Request
from app.answers.schemas import (
    AnswerObjective,
    AnswerState,
    BindingRequirement,
    ChosenValue,
    DesignAnswer,
    LevelUse,
    ReachableValue,
    Relaxation,
    RequirementConflict,
    RequirementVerdict,
)
from app.answers.search import BindingLimit, Conflict
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.graph import build_graph, raise_if, starts
from app.designs.network import Subject, subjects
from app.designs.schemas.designs import Sensitivity
from app.designs.sensitivities import SensitivityQuestion, sensitivities
from app.designs.variants.table import applied
from app.plain import Raw
from app.reference import Reference
from app.schemas.answers import Quantity, Shown, Warning
from app.studies.methods.optimise import Optimum
from app.studies.methods.space import Interval
from templates.core.arrays import Array
from templates.core.criteria.comparison import MET, VERDICTS
from templates.core.criteria.criterion import Criterion
from templates.core.criteria.judgement import verdict_sentence
from templates.core.units.quantity import read_any
from templates.core.units.units import difference_of, unit

SLACK = 1e-3
"""Share of a relaxed limit that is added, so that a search finds the few points that meet it."""
DIGITS = 3
"""Significant digits of a relaxed limit, which is rounded to the side that is easier to meet."""
MOST_SLOPES = 10
AT_BOUND = 1e-6


@dataclass(frozen=True)
class AnswerText:
    """Writes the answer of one request whose optimum is known."""

    request: Request
    optimum: Optimum
    explored: LevelTally
    confirmed: LevelTally
    revision: int | None

    def feasible(self, bindings: Sequence[BindingLimit]) -> DesignAnswer:
        """Return the answer with values that meet all requirements."""
        binding = self._binding(bindings[0]) if bindings else None
        at, calculation = self.optimum.best.at, self._calculation
        names = [str(goal)] if (goal := self.request.objective) else []
        names += [binding.name] if binding else []
        state: AnswerState = "confirmed" if self.optimum.best.is_known else "unconfirmed"
        return self._answer(
            state,
            _headline(state, len(self._verdicts), self._objective(at), binding),
            others=[
                one.name
                for one in judged(calculation)
                if one.verdict == "not_met" and one.name not in self.request.required
            ],
            **({"binding": binding} if binding else {}),
            sensitivities={name: self._sensitivities(name) for name in names},
        )

    def infeasible(self, conflict: Conflict | None) -> DesignAnswer:
        """Return the answer of a search that found no values that meet all requirements."""
        if conflict is not None:
            shown = self._conflict(conflict)
            return self._answer("infeasible", shown.sentence, conflict=shown)
        if self.optimum.state == "undecided":
            near = [one.name for one in self._verdicts if one.verdict == "undecided"]
            detail = f"{', '.join(near)}: the limit lies within the error of the finest level; no answer"
            return self._answer("undecided", detail)
        reason = self.optimum.rounds[-1].reason
        detail = (
            f"the finest level refuses the best place: {reason}" if reason else "the levels still disagree"
        )
        return self._answer("not_settled", f"{detail}; narrow the bounds, or give a `tolerance`")

    def _answer(self, state: AnswerState, sentence: str, **more: object) -> DesignAnswer:
        at = self.optimum.best.at
        objective = self._objective(at)
        return DesignAnswer.model_validate(
            {
                **({} if self.revision is None else {"revision": self.revision}),
                "state": state,
                "feasible": state in ("confirmed", "unconfirmed"),
                "sentence": sentence,
                "values": self._values(at),
                **({"objective": objective} if objective else {}),
                "requirements": self._verdicts,
                "explored": _use(self.explored),
                "confirmed_at": _use(self.confirmed),
                "optimum": "not proven",
                "patch": self._patch(at),
                "warnings": list(self._warnings()),
                **more,
            }
        )

    @cached_property
    def _verdicts(self) -> list[RequirementVerdict]:
        best, columns = self.optimum.best, self.request.columns
        fine = columns.at(self.confirmed)(best.at[None])
        codes = fine.codes(columns.problem)
        numbers = zip(self.request.required, codes, fine.values[0], fine.limits[0], best.worst, strict=True)
        return [self._verdict(name, code, *map(float, sides)) for name, code, *sides in numbers]

    def _verdict(self, name: str, code: int, value: float, limit: float, worst: float) -> RequirementVerdict:
        criterion = self._subject(name).criterion
        scale, sign = unit(criterion.unit), 1.0 if criterion.sign == ">=" else -1.0
        margin = sign * (value - limit)
        is_certain = code == MET or (code != MET - 1 and margin != worst)
        error = (margin - worst) / abs(value) if value and math.isfinite(worst) and is_certain else None
        share = limit / value if criterion.sign == ">=" else value / limit if limit else math.nan
        is_share = value > 0 and limit > 0 and math.isfinite(share) and not criterion.is_temperature
        numbers = float(scale.from_si(value)), float(scale.from_si(limit)), criterion.unit
        is_there = math.isfinite(value) and math.isfinite(limit)
        sentence = verdict_sentence(
            criterion.require,
            VERDICTS[code],
            numbers if is_there else None,
            misses=margin < 0,
            error_known=is_certain,
            truth=None,
        )
        shown: dict[str, object] = {
            "name": name,
            "require": criterion.require,
            "verdict": VERDICTS[code],
            "confirmed": code == MET,
            "sentence": sentence,
            "error": error,
        }
        if is_there:
            shown["value"], shown["limit"] = (Quantity(value=n, unit=numbers[2]) for n in numbers[:2])
            shown["margin"] = _difference(margin, criterion)
        if is_share:
            shown["utilisation"] = share
        return RequirementVerdict.model_validate(shown)

    def _subject(self, name: str) -> Subject:
        return self._subjects[name]

    @cached_property
    def _subjects(self) -> dict[str, Subject]:
        return subjects(self.request.graph)

    def _values(self, at: Array) -> dict[str, ChosenValue]:
        return {
            place.name: self._chosen(place, float(value), self.request.columns.sizes(at[None], n))
            for n, (place, value) in enumerate(zip(self.request.free, at.tolist(), strict=True))
        }

    def _chosen(self, place: FreePlace, value: float, sizes: Array) -> ChosenValue:
        raw = place.typed(value, float(sizes[0]))
        if place.options:
            return ChosenValue(value=Shown(value=raw))
        typed = read_any(raw)
        chosen: dict[str, object] = {"value": Shown(value=typed.value, unit=typed.unit)}
        if place.has_ends:
            scale = unit(typed.unit)
            ends = place.ends(np.array([value]), sizes)[0]
            low, high = (Quantity(value=float(scale.from_si(end)), unit=typed.unit) for end in ends.tolist())
            fit = place.fits[int(value)].name if place.fits else str(place.zone)
            chosen |= {"fit": fit, "least": low, "greatest": high}
        if bound := _bound(place, value):
            chosen["at_bound"] = bound
        return ChosenValue.model_validate(chosen)

    def _typed(self, at: Array) -> dict[str, Raw]:
        """Return the chosen values as the design stores them, by place."""
        columns = self.request.columns
        sizes = [float(columns.sizes(at[None], n)[0]) for n in range(len(at))]
        each = zip(self.request.free, at.tolist(), sizes, strict=True)
        return {place.name: place.typed(value, size) for place, value, size in each}

    def _patch(self, at: Array) -> dict[str, object]:
        """Return the merge patch of the design: chosen and replaced values, added requirements, levels."""
        request, parameters = self.request, dict[str, Raw]()
        steps, models = (dict[str, dict[str, dict[str, Raw]]]() for _ in range(2))
        levels = dict(self._levels_to_set())
        for name, raw in {**request.body.others, **self._typed(at)}.items():
            place = Reference.parse(name)
            if place.output is None:
                parameters[name] = raw
            elif place.block in request.document.steps:
                steps.setdefault(place.block, {}).setdefault("inputs", {})[place.member] = raw
            else:
                models.setdefault(place.block, {}).setdefault("parameters", {})[place.member] = raw
        leveled = {name: {**steps.get(name, {}), "level": level} for name, level in levels.items()}
        criteria = {name: request.document.criteria[name].model_dump() for name in request.asked.added}
        patch = {
            "parameters": parameters,
            "steps": {**steps, **leveled},
            "models": models,
            "criteria": criteria,
        }
        return {name: part for name, part in patch.items() if part}

    def _levels_to_set(self) -> Iterator[tuple[str, str]]:
        """Yield the steps that the design calculates at another level than the verdicts, with that level."""
        for step, level in self.confirmed.levels.items():
            block = self.request.graph.blocks[step]
            if level and level not in (block.level, block.cls.default_level) and block.tolerance is None:
                yield step, level

    @property
    def _document(self) -> Document:
        return applied(self.request.document, self._typed(self.optimum.best.at))

    @cached_property
    def _calculation(self) -> Calculation:
        graph, faults = build_graph(self._document, self.request.catalogues)
        raise_if(faults)
        return calculate(graph, lambda _: None, lambda *_: None, starts(self._document))

    def _sensitivities(self, name: str) -> list[Sensitivity]:
        asked = SensitivityQuestion(name, self._subjects.get(name))
        slopes = sensitivities(self._document, self._calculation, self.request.catalogues, asked)
        return list(slopes.items)[:MOST_SLOPES]

    def _objective(self, at: Array) -> AnswerObjective | None:
        goal = self.request.objective
        value = float(self.optimum.best.confirmed[0])
        if goal is None or not math.isfinite(value):
            return None
        name = self._unit_of_goal
        error = self.request.columns.error_at(at, self.confirmed)
        shown = Quantity(value=float(unit(name).from_si(value)), unit=name)
        return AnswerObjective(name=str(goal), sense=self.request.sense, value=shown, error=error)

    @cached_property
    def _unit_of_goal(self) -> str:
        columns = self.request.columns
        assert self.request.objective is not None
        return columns.engine_of(columns.first).unit(self.request.objective)

    def _binding(self, one: BindingLimit) -> BindingRequirement:
        name = self.request.required[one.number]
        criterion, best = self._subject(name).criterion, self.optimum.best
        limit = float(best.confirmed[1 + len(self.request.required) + one.number])
        sign = 1.0 if criterion.sign == ">=" else -1.0
        relaxed = _shown(limit - sign * one.by * (abs(limit) or 1.0), criterion)
        if self.request.objective is None:
            return BindingRequirement(name=name, limit=relaxed, by=one.by)
        scale = unit(self._unit_of_goal)
        gain = Quantity(value=one.gain / scale.factor, unit=self._unit_of_goal)
        return BindingRequirement(name=name, limit=relaxed, by=one.by, gain=gain)

    def _conflict(self, clash: Conflict) -> RequirementConflict:
        names = [self.request.required[n] for n in clash.numbers]
        options = list(self._relaxations(clash))
        return RequirementConflict(
            requirements=names,
            sentence=_conflicting([self._subject(name).criterion for name in names]),
            reachable=[
                ReachableValue(
                    name=self.request.required[one.number],
                    limit=_shown(self._limit(one.number), self._of(one.number)),
                    best=_shown(one.value, self._of(one.number)),
                )
                for one in clash.reaches
            ],
            relaxation=options[0] if options else None,
            alternatives=options[1:],
        )

    def _relaxations(self, clash: Conflict) -> Iterator[Relaxation]:
        """Yield relaxations of one requirement, smallest first, then that of all violated ones together."""
        for one in clash.reaches:
            yield self._relaxation({one.number: one.limit}, one.at)
        if len(clash.joint) > 1 or not clash.reaches:
            yield self._relaxation(clash.joint, clash.joint_at)

    def _relaxation(self, limits: dict[int, float], at: Array) -> Relaxation:
        shown = {self.request.required[n]: _eased(limit, self._of(n)) for n, limit in limits.items()}
        by = max(
            self._by(n, float(unit(self._of(n).unit).to_si(shown[self.request.required[n]].value)))
            for n in limits
        )
        return Relaxation(limits=shown, by=by, at=self._values(at))

    def _by(self, number: int, limit: float) -> float:
        old = self._limit(number)
        return abs(limit - old) / (abs(old) or 1.0)

    def _limit(self, number: int) -> float:
        return float(self.optimum.best.confirmed[1 + len(self.request.required) + number])

    def _of(self, number: int) -> Criterion:
        return self._subject(self.request.required[number]).criterion

    def _warnings(self) -> Iterator[Warning]:
        for name, level in self.confirmed.levels.items():
            finest = self.request.graph.blocks[name].cls.levels
            if self.request.body.tolerance is None and finest and level != finest[-1]:
                detail = f"verdicts are those of level {level}, which the design sets or which time allows"
                yield Warning(code="not_the_finest_level", name=name, detail=detail)


def _use(use: LevelTally) -> LevelUse:
    return LevelUse(levels=dict(use.levels), rows=use.rows, seconds=round(use.seconds, 4))


def _bound(place: FreePlace, value: float) -> Literal["lower", "upper"] | None:
    if not isinstance(place.variable, Interval):
        return None
    at = float(place.variable.place(np.array(value)))
    return "lower" if at <= AT_BOUND else "upper" if at >= 1 - AT_BOUND else None


def _shown(si: float, criterion: Criterion) -> Quantity:
    return Quantity(value=float(unit(criterion.unit).from_si(si)), unit=criterion.unit)


def _difference(si: float, criterion: Criterion) -> Quantity:
    name = difference_of(criterion.unit)
    return Quantity(value=si / unit(name).factor, unit=name)


def _eased(si: float, criterion: Criterion) -> Quantity:
    """Return a limit with few digits, rounded to the side that is easier to meet."""
    side = -1.0 if criterion.sign == ">=" else 1.0
    value = float(unit(criterion.unit).from_si(si + side * SLACK * abs(si)))
    if not value:
        return Quantity(value=0.0, unit=criterion.unit)
    step = 10.0 ** (math.floor(math.log10(abs(value))) - DIGITS + 1)
    rounded = (math.floor if criterion.sign == ">=" else math.ceil)(value / step) * step
    return Quantity(value=float(f"{rounded:.{DIGITS}g}"), unit=criterion.unit)


def _headline(
    state: str, count: int, objective: AnswerObjective | None, binding: BindingRequirement | None
) -> str:
    doubt = "" if state == "confirmed" else ", but an error is unknown"
    parts = [f"{'All ' if count > 1 else ''}{count} requirement{'s' * (count > 1)} met{doubt}"]
    if objective:
        parts.append(f"{objective.name} {objective.value.value:.4g} {objective.value.unit}")
    if binding and binding.gain and binding.gain.value > 0:
        parts.append(
            f"{binding.name} binds: a limit of {binding.limit.value:.4g} {binding.limit.unit} gains "
            f"{binding.gain.value:.3g} {binding.gain.unit}"
        )
    return "; ".join(parts)


def _conflicting(criteria: Sequence[Criterion]) -> str:
    listed = " and ".join(f"`{one.require}`" for one in criteria)
    if len(criteria) == 1:
        return f"{listed} cannot be met within the bounds"
    return f"{listed} cannot all be met within the bounds"
