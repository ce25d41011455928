"""The operations on designs. This module decides; the repository has the SQL, jobs build the geometry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import NamedTuple

from sqlalchemy.orm import Session

from app.calculations.cache import Cache
from app.catalogue.catalogues import Catalogues
from app.designs import repository, results, tolerances, views
from app.designs.automap import proposals
from app.designs.document import Document, StoredDocument, merge
from app.designs.drives import network
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.errors import StaleRevision
from app.designs.graph import Graph, build_graph, raise_if, read_document, resolved, starts
from app.designs.repository import Newest, StoredRevision, note_revision
from app.designs.results import ModelState, Outcome
from app.designs.schemas.designs import Design, Proposal
from app.designs.schemas.network import DesignNetwork
from app.designs.variants.checks import checked
from app.designs.variants.together import Available
from app.jobs.service import Jobs
from app.plain import Json, JsonObject, Raw
from app.pool.steps import PendingCalculations, begun_steps
from app.reference import Reference
from app.solids.analysis_rows import analysed
from app.solids.rows import built, renew
from app.storage.clock import now
from app.storage.database import Database, Unit
from app.storage.idempotency import Once
from app.storage.tables import RevisionRow, canonical_json
from templates.core.errors import Fault

MEGABYTES = 32  # size of the cache of calculations that wait for their job
BYTES = 128
"""Bytes of a calculation for each character of its document; 36 to 104 for the designs of the gallery."""


class DocumentCalculation(NamedTuple):
    """A document as read, and its calculation as far as it is known."""

    document: Document
    calculation: Calculation


class CalculationCache:
    """The latest calculations that wait for a solid, by their documents.

    A cache belongs to one application and depends on its catalogues and database. If a calculation was
    dropped, or was made by another process, it is repeated from the document.
    """

    def __init__(self, cache: Cache | None = None) -> None:
        self._cache = cache or Cache(MEGABYTES)

    def keep(self, plain: Mapping[str, Json], prepared: DocumentCalculation) -> None:
        """Cache the calculation of a document; the document is given as JSON."""
        text = canonical_json(plain).encode()
        self._cache.keep(_digest(text), prepared, BYTES * len(text))

    def find(self, plain: Mapping[str, Json]) -> DocumentCalculation | None:
        """Return the cached calculation of a document, or None."""
        prepared: DocumentCalculation | None = self._cache.get(_digest(canonical_json(plain).encode()))
        return prepared


def _digest(text: bytes) -> bytes:
    return sha256(text).digest()


REGENERATE, REGENERATE_SLOWLY = "regenerate", "regenerate_and_analyse"
CALCULATE = "calculate_and_regenerate"
"""Kinds of jobs: the second is for designs whose relations use finite elements, the third for designs
with steps for which the save did not wait."""


@dataclass(frozen=True)
class SaveResult:
    """The result of a save: a revision, and the job that regenerates it if it needs one."""

    design: str
    revision: int
    job: str | None
    created: bool
    fresh: bool = True  # whether this request saved it, not an earlier one
    is_deferred: bool = False  # whether the job must calculate steps for which the request does not wait
    answer: Design | None = None  # the saved design, if no job will change it and this request saved it

    def keep(self, session: Session, once: Once) -> None:
        """Store the result of the request in the transaction that saves the revision."""
        location = {name: value for name, value in vars(self).items() if name != "answer"}
        once.keep(session, 201 if self.created else 200, location)


@dataclass(frozen=True)
class Draft:
    """A revision to be saved, and the kind of job that completes it if necessary."""

    written: StoredRevision
    kind: str
    is_deferred: bool
    begun: PendingCalculations | None  # running calculations that the job takes over


class Designs:
    """All operations on designs."""

    def __init__(
        self,
        database: Database,
        jobs: Jobs,
        catalogues: Catalogues,
        calculation_cache: CalculationCache | None = None,
    ) -> None:
        self.database, self.jobs, self.catalogues = database, jobs, catalogues
        self.calculation_cache = calculation_cache or CalculationCache()
        self._solids = built(database), analysed(database)

    def show(self, id: str, number: int | None = None) -> Design:
        """Return a design at a revision, by default the newest.

        Raises
        ------
        NotFound
            If there is no such design, or no such revision.
        """
        with self.database.read() as session:
            return views.newest(session, id, number)

    def with_results(self, design: Design) -> Design:
        """Return a design with the results of its revision, if it has any."""
        if design.state != "current":
            return design
        with self.database.read() as session:
            row = repository.lean(session, design.id, design.revision)
            results = views.results(session, row)
        return design.model_copy(update={"results": results}) if results else design

    def network(self, id: str) -> DesignNetwork:
        """Return the dependencies in a design.

        Raises
        ------
        NotFound
            If there is no such design.
        """
        with self.database.read() as session:
            document = repository.newest(session, id).document
        return network(document, self.catalogues)

    def create(
        self,
        raw: Mapping[str, Raw],
        note: str | None,
        once: Once,
        action: str = "design.create",
        saved: StoredDocument | None = None,
    ) -> SaveResult:
        """Create a design, perhaps from a `saved` document, and return its first revision.

        Raises
        ------
        InvalidInputs
            If there are faults; the error lists all of them, and nothing is saved.
        """
        if before := once.find_in(self.database):
            return _saved_before(before)
        draft = self.draft(raw, note, action, saved)

        def unit(session: Session) -> SaveResult:
            if before := once.begin(session):
                return _saved_before(before)
            certain = _with_builds(session, draft)
            name, at = certain.written.document["name"], now()
            design, revision = repository.create(session, name, certain.written, at)
            return self._enqueued(session, design, revision, certain, once, created=at, at=at)

        return self._saved(unit, draft)

    def change(
        self, id: str, patch: Mapping[str, Raw], note: str | None, expected: str | None, once: Once
    ) -> SaveResult:
        """Apply a merge patch and return the new revision; a patch without changes creates none.

        If only the name changes, the new revision keeps all results.

        Raises
        ------
        StaleRevision
            If `expected` (an If-Match) is not the newest revision.
        InvalidInputs
            If there are faults; the error lists all of them, and nothing is saved.
        """
        if patch.keys() == {"name"} and (renamed := self._renamed(id, patch, note, expected, once)):
            return renamed
        with self.database.read() as session:
            if before := once.find(session):
                return _saved_before(before)
            base = repository.newest(session, id)
        _require_match(expected, base.number)
        changed = merge(base.document, patch)
        return self._append(id, base, changed, note, once, "design.change", base.document)

    def restore(self, id: str, number: int, note: str | None, expected: str | None, once: Once) -> SaveResult:
        """Create a revision with the document of an old one, and return it."""
        with self.database.read() as session:
            if before := once.find(session):
                return _saved_before(before)
            base = repository.newest(session, id)
            document = repository.document(session, id, number)
        _require_match(expected, base.number)
        words = note or f"as revision {number}"
        return self._append(id, base, document, words, once, "design.restore", document)

    def copy(self, id: str, name: str | None, once: Once) -> SaveResult:
        """Create a design with the newest document of another one, and return it."""
        with self.database.read() as session:
            number, document, *_ = repository.newest(session, id)
        named = {**document, "name": name or f"{document['name'][:190]} (copy)"}
        return self.create(named, f"copy of {id}, revision {number}", once, "design.copy", document)

    def delete(self, id: str, expected: str | None) -> None:
        """Delete a design from the lists; it can be restored.

        Raises
        ------
        StaleRevision
            If `expected` (an If-Match) is not the newest revision.
        DesignSigned
            If one of its revisions has a signature.
        """

        def unit(session: Session) -> None:
            _require_match(expected, repository.locked(session, id).head)
            repository.delete(session, id)

        self.database.write(unit)

    def undelete(self, id: str) -> Design:
        """Return a deleted design to the lists; return it at its newest revision.

        Raises
        ------
        NotFound
            If there never was such a design.
        """
        self.database.write(lambda session: repository.restore(session, id))
        return self.show(id)

    def proposals(self, id: str) -> list[Proposal]:
        """Return relations that are proposed for unset model parameters."""
        with self.database.read() as session:
            document = repository.head(session, id).document
        return proposals(self._graph(resolved(read_document(document), self.catalogues)))

    def auto_map(
        self, id: str, apply: bool, expected: str | None, once: Once
    ) -> tuple[list[Proposal], SaveResult | None]:
        """Return proposals for unset model parameters, and the new revision if they are applied."""
        before = once.find_in(self.database) if apply else None
        repeated = _saved_before(before) if before else None
        with self.database.read() as session:
            number = repeated.revision - 1 if repeated else repository.head(session, id).number
            document = repository.revision(session, id, number).document
        proposed = proposals(self._graph(resolved(read_document(document), self.catalogues)))
        if repeated or not (apply and proposed):
            return proposed, repeated
        models: JsonObject = {}
        for proposal in proposed:
            target = Reference.parse(proposal.target)
            model = models.setdefault(target.block, {"parameters": {}})
            model["parameters"][target.member] = proposal.relation
        return proposed, self.change(id, {"models": models}, "auto-map", expected or f'"{number}"', once)

    def prepare(self, raw: Mapping[str, Raw]) -> tuple[Document, Calculation]:
        """Return a document as read, and its calculation with the existing solids.

        The calculation keeps faults of values.

        Raises
        ------
        InvalidInputs
            If the document cannot be read, or its network has faults.
        """
        document = resolved(read_document(raw), self.catalogues)
        return document, calculate(self._graph(document), *self._solids, starts(document))

    def _graph(self, document: Document) -> Graph:
        graph, faults = build_graph(document, self.catalogues)
        raise_if(faults)
        return graph

    def _append(
        self,
        id: str,
        base: Newest,
        raw: Mapping[str, Raw],
        note: str | None,
        once: Once,
        action: str,
        saved: StoredDocument,
    ) -> SaveResult:
        """Return the revision after `base` with another document, or `base` if the document is unchanged."""
        draft = self.draft(raw, note, action, saved)
        is_changed = base.document != draft.written.document

        def unit(session: Session) -> SaveResult:
            if before := once.begin(session):
                return _saved_before(before)
            if not is_changed:
                _require_match(f'"{base.number}"', repository.design(session, id).head)
                unchanged = SaveResult(id, base.number, None, created=False, fresh=False)
                unchanged.keep(session, once)
                return unchanged
            certain, at = _with_builds(session, draft), now()
            revision = repository.append(session, id, base.number, certain.written, at)
            return self._enqueued(session, id, revision, certain, once, created=base.created, at=at)

        return self._saved(unit, draft)

    def _renamed(
        self, id: str, patch: Mapping[str, Raw], note: str | None, expected: str | None, once: Once
    ) -> SaveResult | None:
        """Return a revision with another name and the same results; None if a normal save is necessary.

        A normal save is necessary if the design has no current results, the name does not change, or the
        request is a repetition.
        """

        def unit(session: Session) -> SaveResult:
            if once.begin(session):
                raise _UsualWay
            number = repository.locked(session, id).head
            head = repository.revision(session, id, number)
            document = merge(head.document, patch)
            if head.state != "current" or document == head.document:
                raise _UsualWay
            _require_match(expected, number)
            named = {**head.document, "name": read_document(document).name}
            appended = repository.append(session, id, number, _carried(head, named, note))
            saved = SaveResult(id, appended, None, created=False)
            note_revision(session, self.jobs.events, id, appended, head.state)
            saved.keep(session, once)
            return saved

        try:
            return self.database.write(unit)
        except _UsualWay:
            return None

    def draft(
        self, raw: Mapping[str, Raw], note: str | None, action: str, saved: StoredDocument | None = None
    ) -> Draft:
        """Return the revision to save for a document; a job adds its results if a value is pending.

        A tolerance that no file would state is a fault, unless the `saved` document has it already.

        Raises
        ------
        InvalidInputs
            If there are faults; the error lists all of them.
        """
        document, calculation = self.prepare(raw)
        raise_if([*calculation.faults, *tolerances.not_stated_in(calculation, saved)])
        outcomes = self._variants(document, calculation, saved)
        waits = bool(outcomes) and any(outcome.is_pending for outcome in outcomes)
        pending = bool(document.iterations) or bool(calculation.pending) or waits
        stored = None if pending else results.stored(calculation, [], outcomes)
        state = "regenerating" if pending else "current"
        plain = document.model_dump(mode="json")
        is_deferred = bool(calculation.deferred) or (
            bool(outcomes) and any(outcome.is_deferred for outcome in outcomes)
        )
        if pending and not calculation.deferred:
            self.calculation_cache.keep(plain, DocumentCalculation(document, calculation))
        written = StoredRevision(plain, stored, results.models(calculation, outcomes), state, note, action)
        return Draft(written, _kind(calculation.graph, is_deferred), is_deferred, begun_steps())

    def _variants(self, document: Document, base: Calculation, saved: StoredDocument | None) -> list[Outcome]:
        """Return the variants of a document, as far as they can be calculated now.

        Raises
        ------
        InvalidInputs
            If the table has faults; the error lists all of them.
        """
        outcomes, faults = self._checked(document, base, saved)
        raise_if(faults)
        return outcomes

    def _checked(
        self, document: Document, base: Calculation, saved: StoredDocument | None
    ) -> tuple[list[Outcome], list[Fault]]:
        if not document.variants:
            return [], []
        return checked(document, base, Available(self.catalogues, *self._solids), saved)

    def faulty_variants(self, raw: Mapping[str, Raw], saved: StoredDocument) -> list[Fault]:
        """Return all faults of a document's variants that would prevent a save.

        Raises
        ------
        InvalidInputs
            If the document itself has faults.
        """
        document, calculation = self.prepare(raw)
        return self._checked(document, calculation, saved)[1]

    def _enqueued(
        self, session: Session, design: str, revision: int, draft: Draft, once: Once, *, created: str, at: str
    ) -> SaveResult:
        """Create the job of a revision if it needs one, and store the result of the request."""
        job, answer, written = None, None, draft.written
        if written.state == "regenerating":
            job = self.jobs.enqueue(
                session, draft.kind, {}, design=design, revision=revision, client=once.client
            )
            if draft.begun is not None:
                draft.begun.leave_to(job)
        else:
            answer = views.current(design, revision, written.document, created, at)
        saved = SaveResult(design, revision, job, created=revision == 1, answer=answer)
        note_revision(session, self.jobs.events, design, revision, written.state)
        saved.keep(session, once)
        return saved

    def _saved(self, unit: Unit[SaveResult], draft: Draft) -> SaveResult:
        saved = self.database.write(unit)
        if saved.fresh:
            saved = replace(saved, is_deferred=draft.is_deferred)
        if saved.job:
            self.jobs.wake(draft.kind)
        return saved


def _with_builds(session: Session, draft: Draft) -> Draft:
    """Return the draft after marking its builds as recently used.

    If a build was deleted in the meantime, the returned draft builds it again.
    """
    builds = [model.build for model in draft.written.models if model.build]
    if not builds or renew(session, builds):
        return draft
    return replace(draft, written=replace(draft.written, results=None, state="regenerating"))


def _kind(graph: Graph, is_deferred: bool) -> str:
    """Return the kind of job that completes a revision of the design."""
    if analyses_wanted(graph):
        return REGENERATE_SLOWLY
    return CALCULATE if is_deferred else REGENERATE


def _saved_before(location: JsonObject) -> SaveResult:
    return SaveResult(**{**location, "fresh": False})


class _UsualWay(Exception):
    """Raised if a patch of the name alone needs a normal save.

    This is the case if the design must be calculated, nothing changes, or the request is a repetition.
    """


def _carried(head: RevisionRow, document: JsonObject, note: str | None) -> StoredRevision:
    """Return the content of the new revision that a renaming creates."""
    models = [
        ModelState(m.name, m.model, m.model_version, m.parameters, m.relations, (), m.build_key)
        for m in (*head.models, *head.variant_models)
    ]
    words = note or f"renamed from {head.document['name']}"
    return StoredRevision(document, head.results, models, head.state, words, "design.rename")


def _require_match(expected: str | None, head: int) -> None:
    if expected is not None and not matches(expected, head):
        raise StaleRevision(expected, head)


def matches(expected: str, head: int) -> bool:
    """Return whether an If-Match header names the newest revision, or is `*`."""
    return expected.strip() in ("*", f'"{head}"')


def analyses_wanted(graph: Graph) -> bool:
    """Return whether a design uses a finite-element analysis."""
    return any(graph.wanted(block.name, kind) for block in graph.blocks.values() for kind in block.analyses)
