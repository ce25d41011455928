"""Operations on studies: begin, show, choose a row, cancel, delete."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs import repository as designs
from app.designs.analyses import is_measured, is_table
from app.designs.bodies import LONGEST_NOTE
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.graph import build_graph
from app.designs.service import Designs, SaveResult
from app.designs.variant_sheets.reader import Units
from app.designs.variant_sheets.units import units_of
from app.identity.audit import record
from app.identity.usage import note_bytes
from app.jobs.errors import JobFinished, JobNotFound
from app.jobs.schemas import State
from app.jobs.service import Jobs
from app.plain import JsonObject
from app.reference import Reference
from app.solids.analyses import ANALYSIS
from app.solids.models import BUILD
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.storage.idempotency import Once
from app.storage.tables import StudyRow
from app.studies import repository
from app.studies.archive import packed
from app.studies.bodies import StudyIn
from app.studies.plan import Plan
from app.studies.relations import relations_at, words
from app.studies.row_columns import PLACE, StoredRows
from app.studies.row_table import Rows, columns_named
from app.studies.run import STUDY
from app.studies.task import Task
from app.studies.variant import document_of, within
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.units.units import unit

Lost = Callable[[str], Exception]
"""Returns the error to raise if the rows of a study, given by its id, cannot be read."""
ENDED: tuple[State, ...] = ("done", "failed", "cancelled")


@dataclass(frozen=True)
class Draft:
    """A request for a study, before its plan is made."""

    design: str
    revision: int
    body: JsonObject
    rows: Rows | None
    task: Task
    solid_seconds: float  # recent time of jobs that build a solid [s]


class Studies:
    """Operations on studies."""

    def __init__(
        self,
        database: Database,
        store: Artifacts,
        jobs: Jobs,
        catalogues: Catalogues,
        designs: Designs,
        lost: Lost,
    ) -> None:
        self.database, self.store, self.jobs = database, store, jobs
        self.catalogues, self.designs = catalogues, designs
        self._lost = lost

    def begun_before(self, once: Once) -> str | None:
        """Return the study that the same request began before, or None."""
        if not once.key:
            return None
        with self.database.read() as session:
            before = once.find(session)
        return _study(before) if before else None

    def draft(self, body: StudyIn) -> Draft:
        """Return a study of a revision in the form that a process needs to plan it.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        InvalidInputs
            If the rows of a table do not fit together, or there is no such variant.
        """
        number, document = self._revision(body.design, body.revision)
        document = document_of(document, body.variant)
        plain = body.model_dump(mode="json", exclude_unset=True, exclude={"rows"})
        varied = columns_named(body.rows) if body.method == "table" else list(body.vary)
        measured = measured_in(self.designs, document)
        task = Task.of(document, plain, varied, measured, self.catalogues)
        seconds = self.jobs.usual_seconds(BUILD)
        if any(model.get("analyses") for model in document.get("models", {}).values()):
            seconds += self.jobs.usual_seconds(ANALYSIS)
        return Draft(body.design, number, plain, body.rows, task, seconds)

    def places(self, design: str, revision: int | None) -> Units:
        """Return every place that the rows of a study may set, with its unit.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        """
        _, document = self._revision(design, revision)
        graph, _ = build_graph(Document.model_validate(document), self.catalogues)
        return units_of(graph)

    def _revision(self, design: str, revision: int | None) -> tuple[int, JsonObject]:
        """Return the number and the document of a revision, by default the newest.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        """
        with self.database.read() as session:
            number = designs.design(session, design).head if revision is None else revision
            return number, designs.document(session, design, number)

    def begin(self, draft: Draft, plan: Plan, given: Array | None, once: Once) -> str:
        """Store a study, queue its job, and return its id.

        Raises
        ------
        QueueFull
            If too many jobs are waiting.
        """
        content = () if given is None else packed({"rows": given})
        table = self.store.put(*content) if content else None
        seed = int(draft.body.get("seed", 1))
        new = repository.New(
            draft.design, draft.revision, draft.body["method"], draft.body, plan.plain(), seed,
            plan.chunk, plan.rows, table, once.client,
        )  # fmt: skip

        def unit_of_work(session: Session) -> str:
            if before := once.begin(session):
                return _study(before)
            row = repository.add(session, new)
            row.job = self.jobs.enqueue(session, STUDY, {"study": row.id}, client=once.client)
            note_bytes(session, sum(map(len, content)))
            record(session, "study.begin", f"studies/{row.id}")
            once.keep(session, 202, {"study": row.id})
            return row.id

        return self.jobs.commit(unit_of_work, STUDY)

    def choose(self, id: str, row: int, note: str | None, expected: str | None, once: Once) -> SaveResult:
        """Create a revision of the design with the values of a row, and return it.

        The revision's note lists the relations that these values replace.

        Raises
        ------
        InvalidInputs
            If the row has not been calculated, or the newest revision lacks the studied variant.
        StaleRevision
            If `expected` (an If-Match) is not the newest revision.
        """
        with self.database.read() as session:
            study = repository.get(session, id)
            document = designs.document(session, study.design_id, study.revision)
            newest = designs.document(session, study.design_id, designs.design(session, study.design_id).head)
        variant: str | None = study.body.get("variant")
        newest = document_of(newest, variant)
        patch = within(patch_of(document, Plan.of(study.plan).units, self.values(study, row)), variant)
        said = note or f"row {row} of study {id}, revision {study.revision}"
        if replaced := relations_at(Document.model_validate(newest), Plan.of(study.plan).places):
            said = f"{said}; replaces the relation of {words(replaced)}"[:LONGEST_NOTE]
        return self.designs.change(study.design_id, patch, said, expected, once)

    def values(self, study: StudyRow, number: int) -> dict[str, float]:
        """Return the values [SI] of the places in a calculated row.

        Raises
        ------
        InvalidInputs
            If the row has not been calculated.
        """
        with self.database.read() as session:
            stored = StoredRows(self.store, repository.chunks(session, study.id))
        part = next((p for p in stored.parts if p.first <= number < p.first + p.count), None)
        if part is None:
            detail = f"the study has calculated {stored.count} rows so far, numbered from 0"
            raise InvalidInputs([Fault("row", "unknown_row", detail)])
        places = Plan.of(study.plan).places
        with self.reading(study.id), stored.archive(part) as archive:
            return {name: float(archive[f"{PLACE}{name}"][number - part.first]) for name in places}

    @contextmanager
    def reading(self, id: str) -> Iterator[None]:
        """Guard a block that reads a study's rows.

        Raises
        ------
        RowsLost
            If rows are missing or damaged, and are being recalculated.
        CannotRebuild
            If they cannot be restored.
        """
        try:
            yield
        except (ArtifactMissing, ArtifactDamaged) as error:
            raise self._lost(id) from error

    def end(self, id: str, client: str | None = None) -> StudyRow | None:
        """Cancel a study that waits or runs, and return it; delete an ended one, and return None.

        A client may cancel only its own studies, an administrator any. Every client may delete ended studies.

        Raises
        ------
        NotFound
            If there is no such study.
        NotOwn
            If it waits or runs for another principal.
        """
        with self.database.read() as session:
            row = repository.get(session, id)
        if row.state in ENDED:
            self.database.write(lambda session: _remove(session, id))
            return None
        try:
            self.jobs.cancel(row.job or "", client)
        except (JobFinished, JobNotFound):  # the study has just ended, or its job was deleted
            problem = {"type": "/problems/cancelled", "title": "The work was cancelled", "status": 409,
                       "detail": "The study was cancelled."}  # fmt: skip
            self.database.write(lambda session: repository.end(session, id, "cancelled", None, problem))
        with self.database.read() as session:
            return repository.get(session, id)


def _remove(session: Session, id: str) -> None:
    repository.remove(session, id)
    record(session, "study.delete", f"studies/{id}")


def patch_of(document: JsonObject, units: Mapping[str, str], values: Mapping[str, float]) -> JsonObject:
    """Return a merge patch that sets places of a document to these values [SI], in these units."""
    patch: JsonObject = {}
    for name, value in values.items():
        quantity = {"value": float(unit(units[name]).from_si(value)), "unit": units[name]}
        reference = Reference.parse(name)
        block, member = reference.block, reference.member
        if not member:
            patch.setdefault("parameters", {})[name] = quantity
            continue
        group, part = ("models", "parameters") if block in document.get("models", {}) else ("steps", "inputs")
        patch.setdefault(group, {}).setdefault(block, {part: {}})[part][member] = quantity
    return patch


def _study(location: JsonObject) -> str:
    return str(location["study"])


def measured_in(designs: Designs, document: JsonObject) -> dict[str, float]:
    """Return the known measurements [SI] that relations of a document use."""
    if not document.get("models"):
        return {}
    calculation = designs.prepare(document)[1]
    values = {str(reference): _value(calculation, reference) for reference in _used(calculation)}
    return {name: value for name, value in values.items() if value is not None}


def _used(calculation: Calculation) -> set[Reference]:
    """Return the measurements and analysis outputs that relations name, without tables."""
    blocks = calculation.graph.blocks
    used = {reference for cell in calculation.graph.cells() for reference in cell.uses.values()}
    models = {
        reference for reference in used if reference.block in blocks and blocks[reference.block].is_model
    }
    measured = {r for r in models if is_measured(r, blocks[r.block].analyses, blocks[r.block].cls)}
    return {reference for reference in measured if not is_table(reference)}


def _value(calculation: Calculation, reference: Reference) -> float | None:
    try:
        return float(calculation.measure(reference))
    except (FaultyText, KeyError):  # the solid is not built or not analysed
        return None
