"""Answer a request of `solve`: read it, calculate it in a process, and return the answer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Annotated

import numpy as np
from pydantic import ConfigDict, Field, StringConstraints

from app.calculations.schemas.evaluations import Jump, TracedCurve
from app.catalogue.catalogues import Catalogues
from app.designs.document import Document, Place
from app.designs.engine.calculate import calculate
from app.designs.engine.design_engine import DesignEngine
from app.designs.engine.verdicts import judged
from app.designs.graph import build_graph, starts
from app.designs.network import Cell
from app.designs.overrides import changed
from app.designs.roundings import between, in_words, without
from app.designs.schemas.solution import DesignRoot, DesignSolution, Target
from app.designs.solution_search import DesignRoots, RootQuestion, roots_of_design
from app.designs.tasks import DesignTask
from app.designs.variants.table import applied
from app.presentation.numbers import percent
from app.reference import Reference
from app.schemas.answers import Quantity, Shown, Values, Warning
from app.schemas.bounds import Bounded, at_most
from app.schemas.slopes import slope_in
from app.schemas.values import Between, Given
from templates.core.criteria.judgement import Judgement
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.language.confirmation import Root
from templates.core.language.roots import Jump as FoundJump
from templates.core.language.roots import TracedCurve as FoundCurve
from templates.core.units.quantity import TypedQuantity, read, read_beside

_NAME = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63}){0,2}$"
Named = Annotated[str, StringConstraints(pattern=_NAME)]
MOST_OTHERS = 50  # values of the design that a request may replace
MOST_JUDGED = 8  # roots whose criteria are judged; each needs a calculation of the whole design


class SolveDesignIn(Bounded):
    """Request for the values of one parameter or input that give a requested output."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        allow_inf_nan=False,
        json_schema_extra={
            "examples": [
                {
                    "unknown": "film.diametral_clearance",
                    "between": ["2 um", "0.5 mm"],
                    "target": {"film.minimum_film_thickness": "2.5 um"},
                }
            ]
        },
    )

    unknown: Named = Field(description="a parameter, `step.input` or `model.parameter` that no relation sets")
    between: Between
    target: Annotated[dict[Named, Given], Field(min_length=1, max_length=1), at_most(1)] = Field(
        description="one output and its requested value"
    )
    tolerance: float | None = Field(
        None,
        gt=0,
        lt=1,
        description="relative error to which solutions are confirmed; by default that of the design",
    )
    others: Annotated[dict[Place, Given], Field(max_length=MOST_OTHERS), at_most(MOST_OTHERS)] = Field(
        {},
        alias="with",
        description="values that replace those of the revision, by parameter, `step.input` or model input",
        examples=[{"film.speed": "7000 rpm"}],
    )


def solved(task: DesignTask, revision: int, body: str) -> DesignSolution:
    """Return every solution of the request `body`, in SI units.

    Raises
    ------
    InvalidInputs
        If the request or the design has faults; the error lists them.
    Unreachable
        If no value between the bounds gives the target.
    """
    question = SolveDesignIn.model_validate_json(body)
    document, catalogues = task.read()
    if question.others:
        document = changed(document, catalogues, question.others, question.unknown)
    unknown = Reference.parse(question.unknown)
    [(name, raw)] = question.target.items()
    target = Reference.parse(name)
    engine = DesignEngine.of(document, catalogues, [unknown], wanted=[target], pending=True)
    low, high = (_single(read, end, engine.accepted(unknown), "between") for end in question.between)
    if low >= high:
        detail = "the first bound must be below the second"
        raise InvalidInputs([Fault("between", "not_ascending", detail)])
    value = _single(read_beside, raw, engine.accepted(target), f"target.{name}")
    steps = between(engine.graph, [unknown], [target]).get(unknown, [])
    free = DesignEngine.of(without(document, steps), catalogues, [unknown], wanted=[target], pending=True)
    asked = RootQuestion(unknown, (low, high), target, value, question.tolerance)
    solution = roots_of_design(free if steps else engine, asked)
    return _SolutionText(solution, document, catalogues, engine, steps).answer(revision)


def _single(read_as: Callable[[object, str], TypedQuantity], raw: object, unit: str, name: str) -> float:
    """Return one typed value [SI]."""
    try:
        value = read_as(raw, unit).si
    except FaultyText as error:
        raise InvalidInputs([error.fault(name)]) from None
    if np.ndim(value):
        raise InvalidInputs([Fault(name, "not_a_number", "give a single value here, not an array")])
    return float(value)


class _SolutionText:
    """The solutions of a design as a response."""

    def __init__(
        self,
        solution: DesignRoots,
        document: Document,
        catalogues: Catalogues,
        engine: DesignEngine,
        steps: Sequence[Cell],
    ) -> None:
        self.solution, self.document, self.catalogues = solution, document, catalogues
        self.engine, self.steps = engine, steps
        self.curve = solution.scanned
        self.x, self.y = self.curve.x.unit, self.curve.y.unit

    def answer(self, revision: int) -> DesignSolution:
        roots = self.solution.roots
        left = MOST_JUDGED - len(roots.roots)
        return DesignSolution(
            revision=revision,
            unknown=self.curve.x.name,
            target=self._target(),
            roots=[self._root(root, n < MOST_JUDGED) for n, root in enumerate(roots.roots)],
            touching=[self._root(root, n < left) for n, root in enumerate(roots.touching)],
            jumps=[self._jump(jump) for jump in roots.jumps],
            curve=self._curve(roots.curve),
            finer=[self._curve(curve) for curve in roots.finer],
            warnings=[
                *(
                    Warning(code=w.code, name=w.name, detail=w.detail)
                    for w in roots.warnings
                    if w.code != "several_solutions"  # `roots` lists them all
                ),
                *self._missed_tolerance(),
                *self._roundings(),
            ],
            levels=dict(self.curve.levels),
            finer_levels=dict(self.solution.requested.levels) if roots.finer else {},
        )

    def _curve(self, curve: FoundCurve) -> TracedCurve:
        return TracedCurve(
            x=Values(value=curve.x.tolist(), unit=self.x),
            y=Shown(value=[None if np.isnan(y) else y for y in curve.y.tolist()], unit=self.y),
            reasons=curve.reasons.tolist(),
            level=curve.level,
        )

    def _missed_tolerance(self) -> Iterator[Warning]:
        """Yield a warning if the error of a solution exceeds the requested tolerance."""
        tolerance, worst = self.solution.tolerance, 0.0
        for root in (*self.solution.roots.roots, *self.solution.roots.touching):
            worst = max(worst, math.inf if root.error is None else root.error) if root.confirmed else worst
        if tolerance is None or worst <= tolerance:
            return
        error = "is not stated" if math.isinf(worst) else f"is up to {percent(worst)}"
        detail = (
            f"the error of the solutions {error}, which is not within the tolerance of {percent(tolerance)}"
        )
        yield Warning(code="tolerance_unmet", name=self.curve.y.name, detail=f"{detail}{self._kept_level()}")

    def _roundings(self) -> Iterator[Warning]:
        """Yield a warning if values between the unknown and the target are rounded."""
        if self.steps:
            detail = (
                f"solved with the calculated values of {in_words(self.steps)}; `rounded` of each solution is "
                f"{self.curve.y.name} with the chosen values"
            )
            yield Warning(code="rounded", name=self.curve.y.name, detail=detail)

    def _rounded(self, value: float) -> dict[str, Shown]:
        """Return the target with the chosen values as the member `rounded`; empty if nothing is rounded."""
        if not self.steps:
            return {}
        rows = {self.solution.scanned.unknown: np.array([self.curve.x.scale.to_si(value)])}
        target = self.solution.scanned.target
        table = self.engine(rows, [target], levels=self.solution.requested.levels)
        chosen = float(self.curve.y.scale.from_si(table.columns[target][0]))
        return {"rounded": Shown(value=chosen if math.isfinite(chosen) else None, unit=self.y)}

    def _kept_level(self) -> str:
        """Return a remark that the design fixes the level of the target's step; empty if it does not."""
        step = self.document.steps.get(self.solution.scanned.target.block)
        level = step.level if step else None
        return f": the design fixes level {level} for {self.solution.scanned.target.block}" if level else ""

    def _target(self) -> Target:
        value = float(np.asarray(self.curve.y.scale.from_si(self.curve.wanted)))
        return Target(name=self.curve.y.name, value=value, unit=self.y)

    def _root(self, root: Root, is_judged: bool) -> DesignRoot:
        judgements = self._judgements(root.value) if is_judged else []
        return DesignRoot(
            value=root.value,
            unit=self.x,
            crossing=root.crossing,
            slope=None if root.slope is None else slope_in(self.y, self.x, root.slope),
            **({} if root.no_slope is None else {"reason": root.no_slope}),
            level=root.level,
            error=root.error,
            confirmed=root.confirmed,
            **self._rounded(root.value),
            verdicts={one.name: one.verdict for one in judgements},
            error_unknown=[one.name for one in judgements if one.is_open and one.verdict != "undecided"],
        )

    def _judgements(self, value: float) -> list[Judgement]:
        """Return the judgement of every criterion for one value of the unknown.

        Criteria that need a solid are not checked.
        """
        own = applied(self.document, {self.curve.x.name: {"value": value, "unit": self.x}})
        graph, faults = build_graph(own, self.catalogues)
        if faults:
            return []
        return judged(calculate(graph, lambda _: None, lambda *_: None, starts(own)))

    def _jump(self, jump: FoundJump) -> Jump:
        before, after = (Quantity(value=side, unit=self.y) for side in (jump.before, jump.after))
        return Jump(value=jump.value, unit=self.x, before=before, after=after)
