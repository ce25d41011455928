"""The criteria of a calculated design: those of its templates and its own, with errors carried downstream."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from operator import or_

import numpy as np

from app.calculations.size import spanned
from app.designs.calculation import Calculation
from app.designs.network import Block, Demand
from app.designs.shifting import NOTHING, Shifting, Upstream
from app.designs.size import limit_operations, limit_values
from app.designs.subjects import Subject, subjects
from app.reference import Reference
from templates.core.errors import FaultyText, TemplateError, listed
from templates.core.judging.bands import Estimate
from templates.core.judging.criterion import Criterion
from templates.core.judging.judgement import Judgement
from templates.core.judging.judging import Absent, Along, Instead, judge
from templates.core.judging.limits import GivenLimit
from templates.core.judging.summary import worst_first
from templates.core.language.criteria import (
    Evaluated,
    along_of,
    estimate_of,
    estimates_of,
    is_due,
    level_and_truth,
    missing_of,
    notes,
)
from templates.core.language.levels import accuracy


def judged(calculation: Calculation) -> list[Judgement]:
    """Every criterion of a design, worst first; what waits for a solid or a step is not checked."""
    return worst_first(Judging(calculation).all())


@dataclass(frozen=True)
class Judging:
    """A calculated design with its verdicts."""

    calculation: Calculation
    _steps: dict[str, Evaluated | None] = field(default_factory=dict)

    def all(self) -> Iterator[Judgement]:
        """Every criterion, in no order."""
        return self.some(self._subjects)

    def some(self, names: Iterable[str]) -> Iterator[Judgement]:
        """The criteria of these names."""
        for name in names:
            subject = self._subjects[name]
            if subject.block is not None:
                yield from self._of_template(subject.block, subject.criterion, subject.demand)
            elif subject.demand is not None:
                yield self._of_design(subject.criterion, subject.demand)

    def names(self) -> list[str]:
        """The names of all criteria."""
        return list(self._subjects)

    def subject(self, name: str) -> Subject:
        """A criterion by its name, and where it is declared."""
        return self._subjects[name]

    def references(self, name: str) -> Mapping[str, Reference]:
        """The values that a criterion names, without limits."""
        return self._subjects[name].references

    def uncertain(self, name: str) -> frozenset[Reference]:
        """The outputs of steps whose errors, as far as they are stated, make the band of a criterion."""
        subject = self._subjects[name]
        judged = [subject, *(one for _, one in subject.instead)]
        references = (reference for one in judged for reference in one.references.values())
        origins = (self._shifting.behind(reference).uncertain for reference in references)
        return reduce(or_, origins, frozenset())

    @cached_property
    def _subjects(self) -> dict[str, Subject]:
        return subjects(self.calculation.graph)

    def _of_template(self, block: Block, criterion: Criterion, demand: Demand | None) -> Iterator[Judgement]:
        """A criterion of a step's template, unless the step leaves out outputs that it needs."""
        evaluated = self._evaluated(block.name)
        if evaluated is None:
            absent = dict.fromkeys(criterion.names, Absent((), f"{block.name} waits for its calculation"))
            yield _named(judge(criterion, {}, absent), block, demand)
            return
        if not is_due(evaluated, criterion):
            return
        more = notes(evaluated, criterion)
        instead = self._instead(block, evaluated, criterion) if criterion.absent else None
        judgement = self._of_step(Subject(criterion, block, demand), evaluated, more, instead)
        yield _named(judgement, block, demand)

    def _instead(self, block: Block, evaluated: Evaluated, criterion: Criterion) -> Instead | None:
        """The judgement where a side has no value, with the errors from upstream."""
        missing = missing_of(evaluated, criterion)
        if missing is None or missing.instead is None:
            return None
        subject = Subject(missing.instead, block, None)
        return Instead(self._of_step(subject, evaluated, {}, None), missing.reason)

    def _of_step(
        self, subject: Subject, evaluated: Evaluated, more: Mapping[str, str | None], instead: Instead | None
    ) -> Judgement:
        criterion, block = subject.criterion, subject.block
        assert block is not None
        estimates, absent = estimates_of(evaluated, criterion)
        absent |= self._waiting_limits(block, criterion) if block.related else {}
        if absent:
            return judge(criterion, estimates, absent, noted=more, instead=instead)
        references = {n: reference for n, reference in subject.references.items() if n in estimates}
        along = along_of(evaluated.template, criterion.names)
        return self._judged(criterion, references, estimates, {}, along, more, instead)

    def _waiting_limits(self, block: Block, criterion: Criterion) -> dict[str, Absent]:
        """The limits whose relations have no value yet; a row of the library does not stand in for them."""
        related = (block.related[name] for name in criterion.limits_by_name if name in block.related)
        waiting = [cell for cell in related if cell.name not in self.calculation.values]
        return {
            cell.reference.output or "": Absent((), f"{cell.name} has no value yet: {cell.raw}")
            for cell in waiting
        }

    def _of_design(self, criterion: Criterion, demand: Demand) -> Judgement:
        """A criterion that the design writes itself."""
        estimates: dict[str, Estimate] = {}
        absent: dict[str, Absent] = {}
        for name, reference in demand.uses.items():
            one = self._estimate(reference)
            if isinstance(one, Absent):
                absent[name] = one
            else:
                estimates[name] = one
        references = {name: demand.uses[name] for name in estimates}
        more = {"source": criterion.source, "waived": demand.written.waived, **self._stated_by(demand)}
        return self._judged(criterion, references, estimates, absent, self._along(demand), more)

    def _stated_by(self, demand: Demand) -> dict[str, str | None]:
        """Level and truth, where an output of a step is judged alone."""
        subject = demand.criterion.subject if demand.criterion else None
        reference = demand.uses[subject] if subject else None
        evaluated = self._evaluated(reference.block) if reference and reference.output else None
        return level_and_truth(evaluated, reference.output) if reference and evaluated else {}

    def _along(self, demand: Demand) -> Along | None:
        """The places of the first curve that a criterion uses."""
        for reference in demand.uses.values():
            evaluated = self._evaluated(reference.block) if reference.output else None
            along = along_of(evaluated.template, [reference.member]) if evaluated else None
            if along is not None:
                return along
        return None

    def _judged(
        self,
        criterion: Criterion,
        references: Mapping[str, Reference],
        estimates: Mapping[str, Estimate],
        absent: Mapping[str, Absent],
        along: Along | None,
        more: Mapping[str, str | None],
        instead: Instead | None = None,
    ) -> Judgement:
        """A criterion with the errors that reach its values from upstream."""
        if absent:
            return judge(criterion, estimates, absent, along, noted=more)
        upstream = reduce(or_, (self._shifting.beneath(r) for r in references.values()), NOTHING)
        try:
            limit_operations(self.calculation.operations + _operations(criterion, estimates, upstream))
            moved, left_out = self._shifting.shifts(references, upstream)
        except FaultyText as error:
            return judge(
                criterion, estimates, dict.fromkeys(criterion.names, Absent((), str(error))), noted=more
            )
        if upstream == NOTHING:
            return judge(criterion, estimates, absent, along, noted=more, instead=instead)
        constant = {name: estimate.value for name, estimate in estimates.items() if name not in references}
        shifts = [({**low, **constant}, {**high, **constant}) for low, high in moved]
        unstated = upstream.unstated | left_out
        tainted = _tainted(estimates, references, upstream, unstated=bool(unstated))
        result = judge(criterion, tainted, absent, along, shifts=shifts, noted=more, instead=instead)
        return _explained(result, upstream.unknown, unstated)

    @cached_property
    def _shifting(self) -> Shifting:
        return Shifting(self.calculation, self._estimate)

    def _estimate(self, reference: Reference) -> Estimate | Absent:
        """The value of a name with the error of its own step, or why there is none."""
        evaluated = self._evaluated(reference.block) if reference.output and not reference.analysis else None
        if evaluated is not None:
            declared = evaluated.template.inputs.keys() | evaluated.answers.keys()
            waits = Absent((), f"{reference} is not computed; name it in the outputs of the step")
            return estimate_of(evaluated, reference.member) if reference.member in declared else waits
        try:
            return Estimate(self.calculation.value(reference))
        except TemplateError as error:
            return Absent((), str(error))
        except (KeyError, AttributeError):
            return Absent((), f"{reference} waits for a solid or for its calculation")

    def _evaluated(self, step: str) -> Evaluated | None:
        """A step as its criteria see it; None of a model, and while it waits."""
        if step not in self._steps:
            evaluation = self.calculation.evaluations.get(step)
            block = self.calculation.graph.blocks.get(step)
            self._steps[step] = None
            if evaluation is not None and block is not None:
                self._steps[step] = Evaluated(
                    evaluation.template,
                    evaluation.outputs,
                    evaluation.error,
                    accuracy(block.cls),
                    self._limits(block),
                    level=evaluation.level,
                )
        return self._steps[step]

    def _limits(self, block: Block) -> Mapping[str, GivenLimit]:
        """The limits of a step; those by relations as far as they have values, with these as source."""
        values = self.calculation.values
        related = {n: cell for n, cell in block.related.items() if cell.name in values}
        given = {n: GivenLimit(values[cell.name], f"{n} {cell.raw}") for n, cell in related.items()}
        return {**block.limits, **given}


def _tainted(
    estimates: Mapping[str, Estimate],
    references: Mapping[str, Reference],
    upstream: Upstream,
    *,
    unstated: bool,
) -> dict[str, Estimate]:
    """Values whose errors upstream are not known, or not stated, marked as such."""
    tainted = dict(estimates)
    for name in references:
        if upstream.unknown:
            tainted[name] = replace(tainted[name], error=float("nan"), is_stated=False)
        elif unstated:
            tainted[name] = replace(tainted[name], is_stated=False)
    return tainted


def _explained(result: Judgement, unknown: frozenset[Reference], unstated: frozenset[Reference]) -> Judgement:
    """A judgement that names where upstream its error is lost."""
    if unknown and result.verdict == "undecided":
        return replace(result, reason=f"it follows from {_listed(unknown)}, whose error is not known here")
    if unstated and result.verdict in ("met", "not_met"):
        return replace(
            result, reason=f"the error of {_listed(unstated)}, from which it follows, is not stated"
        )
    return result


def _listed(references: frozenset[Reference]) -> str:
    return listed(sorted(map(str, references)))


def _operations(criterion: Criterion, estimates: Mapping[str, Estimate], upstream: Upstream) -> int:
    """Count the operations on single values that a criterion takes, its shifted sides included."""
    points = spanned(np.shape(estimate.value) for estimate in estimates.values())
    limit_values(points)
    times = 1 + 2 * (len(estimates) + len(upstream.uncertain))
    return points * times * (criterion.value.parts + criterion.limit.parts)


def _named(judgement: Judgement, block: Block, demand: Demand | None) -> Judgement:
    """A criterion of a template by its name in the design, with what the design says of it."""
    written = demand.written if demand else None
    return replace(
        judgement,
        name=f"{block.name}.{judgement.name}",
        give=tuple(map(f"{block.name}.".__add__, judgement.give)),
        words=(written and written.words) or judgement.words,
        source=(written and written.source) or judgement.source,
        waived=written.waived if written else None,
    )
