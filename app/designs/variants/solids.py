"""Regenerate variants: build one solid for each distinct set of parameters.

If a solid fails, only the variants that use it fail; the revision stays usable.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.errors import NotConverged
from app.designs.results import Outcome
from app.designs.service import DocumentCalculation
from app.designs.variants.outcome import outcome_of
from app.jobs.service import JobContext
from app.plain import JsonObject
from app.solids.builds import Builds, failures_named
from app.storage.errors import CannotRebuild
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded
from cad.errors import AnalysisError, GeometryError
from cad.model import CadModel
from cad.regenerate import build_key
from templates.core.errors import InvalidInputs, TemplateError

FAILURES = (
    NotConverged, TemplateError, GeometryError, AnalysisError, DeadlineExceeded, MemoryExceeded, JobCrashed,
    CannotRebuild,
)  # fmt: skip
"""Errors that are caused by the variant itself."""

MOST_CRASHES = 2  # largest number of crashes of the process that builds one solid

Describe = Callable[[Exception], JsonObject]
"""Turns an error into a problem (RFC 9457)."""

Settle = Callable[[DocumentCalculation, JobContext], Calculation]
"""Completes the calculation of a design: builds, measures, iterates."""


def plain_problem(error: Exception) -> JsonObject:
    """Return an error as a problem."""
    return {"type": "about:blank", "title": "The variant failed", "status": 422, "detail": str(error)}


@dataclass(frozen=True)
class VariantSolids:
    """Builds the solids of variants in one regeneration.

    Attributes
    ----------
    builds, settle, describe
        Build a solid, complete a design, and describe an error.
    context
        The context of the job.
    """

    builds: Builds
    settle: Settle
    describe: Describe
    context: JobContext
    _failed: dict[str, Exception] = field(
        default_factory=dict
    )  # errors by key of build; a failed build is not repeated

    def settled(self, outcomes: Sequence[Outcome]) -> list[Outcome]:
        """Return the variants with all their solids built, or with the reason of a failure."""
        done: list[Outcome] = []
        for number, outcome in enumerate(outcomes):
            self.context.progress(number / len(outcomes), f"variant {outcome.name}")
            done.append(self._settled(outcome))
        return done

    def _settled(self, outcome: Outcome) -> Outcome:
        if outcome.faults:
            return replace(outcome, problem=self.describe(InvalidInputs(outcome.faults)))
        failures = dict(self._failures(outcome.shapes))
        if failures:
            return replace(outcome, failures=failures)
        if outcome.document is None or outcome.calculation is None or not outcome.is_pending:
            return outcome
        return self._completed(outcome, outcome.document, outcome.calculation)

    def _failures(self, shapes: Mapping[str, CadModel]) -> Iterator[tuple[str, JsonObject]]:
        """Build the solids whose parameters are known, and yield the reasons of failures."""
        for name, shape in shapes.items():
            try:
                with failures_named(name):
                    self._make(shape)
            except FAILURES as error:
                self._failed[build_key(shape)] = error
                yield name, self.describe(error)

    def _make(self, shape: CadModel) -> None:
        if failed := self._failed.get(build_key(shape)):
            raise failed
        for attempt in range(MOST_CRASHES):
            try:
                self.builds.make(shape, self.context)
            except JobCrashed:
                if attempt + 1 == MOST_CRASHES:
                    raise
            else:
                return

    def _completed(self, outcome: Outcome, document: Document, calculation: Calculation) -> Outcome:
        """Return a variant completed as a separate design, with all values that depend on its solids."""
        try:
            complete = self.settle(DocumentCalculation(document, calculation), self.context)
        except FAILURES as error:
            return replace(outcome, problem=self.describe(error))
        return outcome_of(outcome.name, outcome.places, document, complete)
