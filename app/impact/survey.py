"""Calculate all designs that use another version of a template, batch by batch, and rank them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from app.catalogue.catalogues import Catalogues
from app.designs import repository as designs
from app.designs.document import Document
from app.designs.errors import DesignError
from app.designs.filters import DesignFilter
from app.designs.labels import key_of
from app.designs.tasks import CatalogueTask
from app.impact import repository
from app.impact.bodies import ImpactIn
from app.impact.effect import described, unfinished, unusable, used_steps
from app.impact.process import BatchResult, compared
from app.impact.schemas import DesignImpact, Impact
from app.impact.severity import rank
from app.impact.task import Batch, DesignAt, missing, uses
from app.pool.questions import IMPACT, Kind, Reply, json_answer, json_form
from app.pool.steps import present_caller
from app.presentation.units import System
from app.schemas.answers import Version
from app.storage.database import Database
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded

MOST_TOGETHER = 256
"""Number of designs and variants in one batch, which limits the memory."""

LOST = (DeadlineExceeded, MemoryExceeded, JobCrashed)
"""Errors that end the process of a batch; its designs are then calculated in smaller batches."""

At = tuple[DesignAt, Document]


@dataclass(frozen=True)
class ImpactQuestion:
    """A version of a template, the designs to compare with it, and the units of the answer."""

    template: str
    version: int
    body: ImpactIn
    units: System = "si"


def check(asked: ImpactQuestion, database: Database, catalogues: Catalogues) -> None:
    """Check that the requested designs and versions exist.

    Raises
    ------
    UnknownTemplate
        If there is no such version, or it is a draft with faults.
    NotFound
        If a named design does not exist.
    """
    catalogues.to_try(asked.template, asked.version)
    with database.read() as session:
        for id in asked.body.designs or ():
            designs.design(session, id)


def impact(
    asked: ImpactQuestion, database: Database, catalogues: Catalogues
) -> Reply[ImpactQuestion, Impact]:
    """Return the impact of a version; only a job calls this, because it takes long."""
    catalogues.to_try(asked.template, asked.version)
    drafts = catalogues.with_drafts([(asked.template, asked.version)])
    return Reply(Survey(asked, database, drafts).impact().in_units(asked.units))


@dataclass
class _Tally:
    """The intermediate result: the worst designs, and the number of designs of each kind."""

    limit: int
    worst: list[DesignImpact] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    concerned: int = 0
    unchanged: int = 0
    variants: int = 0

    def add(self, batch: BatchResult) -> None:
        """Add the results of a batch, keeping only the worst `limit` designs."""
        for impact in batch.designs:
            self.counts[impact.effect] = self.counts.get(impact.effect, 0) + 1
        self.worst = sorted([*self.worst, *batch.designs], key=rank)[: self.limit]
        self.concerned += len(batch.designs) + batch.unchanged
        self.unchanged += batch.unchanged
        self.variants += batch.variants


@dataclass(frozen=True)
class Survey:
    """One request, with the templates as they were when it arrived."""

    asked: ImpactQuestion
    database: Database
    catalogues: Catalogues

    def impact(self) -> Impact:
        """Return the impact of the version on these designs."""
        asked = self.asked
        chosen = None if asked.body.designs is None else set(asked.body.designs)
        tags = tuple(dict.fromkeys(map(key_of, asked.body.tags)))
        wanted = DesignFilter(name=asked.body.name, tags=tags, template=asked.template)
        with self.database.read() as session:
            ids = repository.ids_of(session, wanted, chosen)
            archived = repository.ids_of(session, replace(wanted, archived="true"), chosen)
        tally, seen = _Tally(asked.body.limit), 0
        for page in _pages(ids):
            for batch in self._of_page(page, seen, len(ids)):
                tally.add(batch)
            seen += len(page)
        return Impact(
            template=Version(id=asked.template, version=asked.version),
            concerned=tally.concerned,
            moved=tally.counts.get("moved", 0),
            refused=tally.counts.get("refused", 0),
            needs_solids=tally.counts.get("needs_solids", 0),
            unchanged=tally.unchanged,
            archived=sum(len(self._concerned(page)) for page in _pages(archived)),
            variants=tally.variants,
            designs=tally.worst,
        )

    def _concerned(self, ids: Sequence[str]) -> list[At]:
        """Return the designs with a step that uses another version."""
        with self.database.read() as session:
            newest = list(repository.newest(session, ids))
        return [
            (design, document)
            for design, document in newest
            if used_steps(document, self.asked.template, self.asked.version)
        ]

    def _of_page(self, ids: Sequence[str], seen: int, total: int) -> Iterator[BatchResult]:
        """Yield the results for one page of designs, batch by batch."""
        concerned = self._concerned(ids)
        usable: list[At] = []
        for design, document in concerned:
            if absent := missing(document, self.catalogues):
                about = described(design, document, self.asked.template, self.asked.version)
                yield BatchResult((unusable(about, absent),), 0, 0)
            else:
                usable.append((design, document))
        for batch in _batches(usable):
            yield from self._of_batch(batch, _Share(seen / total, len(ids) / total, total))

    def _of_batch(self, batch: Sequence[At], share: _Share) -> Iterator[BatchResult]:
        """Yield the result for a batch; if its process dies, split the batch, down to single designs."""
        try:
            yield self._compared(batch, share)
        except LOST as error:
            if len(batch) == 1:
                design, document = batch[0]
                about = described(design, document, self.asked.template, self.asked.version)
                yield BatchResult((unfinished(about, error),), 0, 0)
                return
            half = len(batch) // 2
            yield from self._of_batch(batch[:half], share)
            yield from self._of_batch(batch[half:], share)

    def _compared(self, batch: Sequence[At], share: _Share) -> BatchResult:
        """Return the result for a batch, which the pool calculates on behalf of the job."""
        templates, models = uses(document for _, document in batch)
        parts = CatalogueTask.of(
            {*templates, (self.asked.template, self.asked.version)}, models, self.catalogues
        )
        with self.database.read() as session:
            solids = repository.solids_of(session, batch)
        task = Batch(
            self.asked.template, self.asked.version, tuple(design for design, _ in batch), parts, solids
        )
        if (caller := present_caller()) is None:
            return compared(task)
        report = caller.report
        report_of_share = (
            None if report is None else lambda fraction, _: report(share.at(fraction), share.text(fraction))
        )
        key = IMPACT, self.asked.template, self.asked.version, tuple(design.id for design, _ in batch)
        return replace(caller, report=report_of_share).calculated(key, compared, task)


@dataclass(frozen=True)
class _Share:
    """The part of a job that one page of designs takes: its beginning and its width, as fractions of 1."""

    begin: float
    width: float
    total: int

    def at(self, fraction: float) -> float:
        """Return the progress of the job when this fraction of the page is complete."""
        return self.begin + self.width * fraction

    def text(self, fraction: float) -> str:
        """Return the progress as a text, such as `3 of 10 designs`."""
        return f"{int(self.at(fraction) * self.total)} of {self.total} designs"


def _pages(ids: Sequence[str]) -> Iterator[Sequence[str]]:
    for start in range(0, len(ids), MOST_TOGETHER):
        yield ids[start : start + MOST_TOGETHER]


def _batches(designs: Sequence[At]) -> Iterator[list[At]]:
    """Yield designs in batches of limited numbers of designs and variants; each has at least one design."""
    batch: list[At] = []
    count = 0
    for at in designs:
        rows = 1 + len(at[1].variants)
        if batch and count + rows > MOST_TOGETHER:
            yield batch
            batch, count = [], 0
        batch.append(at)
        count += rows
    if batch:
        yield batch


IMPACTS = Kind(
    IMPACT, json_form(ImpactQuestion), json_answer(Impact), impact, failures=(DesignError,), check=check
)
