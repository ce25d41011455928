"""Answer requests about designs of any origin, make their files, and save the answers if asked to.

The values come from a calculation process. Saving and building solids happen afterwards, in the request or in
the job that completes it, so both end with the same state.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from uuid import uuid4

from pydantic_core import from_json

from app.answers.bodies import AnswerIn, FileKind
from app.answers.request import body_faults
from app.answers.schemas import DesignAnswer, SavedAnswer
from app.answers.tasks import answer_request
from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.document import merge
from app.designs.errors import DesignError, StaleRevision
from app.designs.gallery.gallery import GALLERY
from app.designs.graph import raise_if, read_document, resolved
from app.designs.questions import settled
from app.designs.service import Designs, SaveResult, matches
from app.designs.tasks import DesignTask
from app.jobs.service import Jobs
from app.plain import Raw
from app.pool.errors import StepDeferred
from app.pool.questions import ANSWER, Kind, Reply, json_answer, json_form
from app.pool.steps import in_the_pool, present_caller
from app.presentation.units import System
from app.solids.models import Models
from app.storage.database import Database
from app.storage.errors import KeyReused
from app.storage.idempotency import Once
from app.storage.tables import canonical_json
from app.workers.errors import JobCancelled
from cad.model import CadModel
from cad.regenerate import build_key
from templates.core.errors import Fault, InvalidInputs

Stored = dict[str, Raw]
"""A document as a revision stores it."""
POLL = 0.02  # time between two looks at a job that builds a solid [s]
KINDS: dict[FileKind, tuple[str, ...]] = {"step": ("step",), "drawing": ("step", "drawing.pdf")}
"""The files of a solid that each kind of a request needs."""


@dataclass(frozen=True)
class SaveOrder:
    """How to save an answer: If-Match, the parts of its idempotency key, and a number of its own."""

    expected: str | None
    key: str | None
    scope: str
    fingerprint: str
    client: str
    number: str

    @property
    def once(self) -> Once:
        """Return the service that recognises a repeated request."""
        return Once(self.key, self.scope, self.fingerprint, self.client)


@dataclass(frozen=True)
class AnswerQuestion:
    """A request for an answer: a saved design by its id, or a document as JSON text; the rest of the body."""

    design: str
    document: str
    body: str
    client: str
    revision: int | None = None
    units: System = "si"
    save: SaveOrder | None = None


def question_of(
    body: AnswerIn, units: System, client: str, once: Once, expected: str | None, catalogues: Catalogues
) -> AnswerQuestion:
    """Return the question of a request.

    Raises
    ------
    InvalidInputs
        If the body has faults that show without its design, or the design is neither an id, nor a name of the
        gallery, nor a document.
    """
    raise_if(list(body_faults(body)))
    design, document = _origin(body.design, catalogues)
    rest = body.model_copy(update={"design": ""}).model_dump_json(exclude_unset=True, by_alias=True)
    order = None
    if body.save:
        number = "" if once.key else uuid4().hex
        order = SaveOrder(expected, once.key, once.scope, once.fingerprint, once.client, number)
    return AnswerQuestion(design, document, rest, client, body.revision, units, order)


def _origin(design: Raw, catalogues: Catalogues) -> tuple[str, str]:
    """Return the id of a saved design, or the document of another one as JSON text."""
    if isinstance(design, str) and design not in GALLERY:
        return design, ""
    raw = GALLERY[design].document if isinstance(design, str) else design
    if not isinstance(raw, dict):
        detail = f"give the id of a design, a name of the gallery ({', '.join(GALLERY)}), or a document"
        raise InvalidInputs([Fault("design", "design", detail)])
    try:
        document = resolved(read_document(raw), catalogues)
    except InvalidInputs as error:
        raise InvalidInputs(fault.within("design") for fault in error.faults) from None
    return "", canonical_json(document.model_dump(mode="json"))


@dataclass(frozen=True)
class AnswerService:
    """Completes the answers of the calculation processes: files and saving."""

    designs: Designs
    models: Models
    jobs: Jobs

    @property
    def kind(self) -> Kind[AnswerQuestion, DesignAnswer]:
        """Return the kind of these requests."""
        return Kind(
            ANSWER,
            json_form(AnswerQuestion),
            json_answer(DesignAnswer),
            self.reply,
            failures=(DesignError, KeyReused),
            settle=_settled,
        )

    def reply(
        self, asked: AnswerQuestion, database: Database, catalogues: Catalogues
    ) -> Reply[AnswerQuestion, DesignAnswer]:
        """Return the answer, or the request to continue with if its client does not wait any longer.

        Raises
        ------
        InvalidInputs
            If the request or the design has faults, or a requested file cannot be made.
        """
        body = AnswerIn.model_validate_json(asked.body)
        asked, document = _base(asked, database)
        _check_files(body, asked, document)
        task, number = DesignTask.of(document, catalogues), None if asked.document else asked.revision
        try:
            key = (ANSWER, number, task, asked.body)
            answer = in_the_pool(key, answer_request, task, number, asked.body)
            if answer.feasible:
                answer = self._completed(answer, asked, body, document)
        except StepDeferred:
            return Reply(None, asked)
        return Reply(answer.in_units(asked.units))

    def _completed(
        self, answer: DesignAnswer, asked: AnswerQuestion, body: AnswerIn, document: Stored
    ) -> DesignAnswer:
        """Return the answer with its files, saved if asked to; the files come first, since they may fail."""
        changed, about = merge(document, answer.patch), dict[str, object]()
        if asked.design:
            about["design"] = asked.design
        if body.files:
            shapes = self._shapes(changed)
            about["links"] = dict(self._links_of_builds(shapes, body.files, asked.client))
        if asked.save is not None:
            saved = self._saved(asked, asked.save, body, answer, changed)
            state = self.designs.show(saved.design, saved.revision).state
            about["design"] = saved.design
            about["saved"] = SavedAnswer(design=saved.design, revision=saved.revision, state=state)
            if body.files:
                about["links"] = dict(_links_of_revision(saved, list(shapes), body.files))
        return answer.model_copy(update=about)

    def _shapes(self, document: Stored) -> dict[str, CadModel]:
        """Return the models of a document, by name.

        Raises
        ------
        InvalidInputs
            If a model has no solid yet; the error says why.
        """
        _, calculation = self.designs.prepare(document)
        if calculation.faults:
            raise InvalidInputs(calculation.faults)
        names = [name for name, block in calculation.graph.blocks.items() if block.is_model]
        for name in names:
            if name not in calculation.shapes:
                unset = ", ".join(calculation.missing.get(name, ())) or "it waits for another solid"
                detail = f"the model {name} has no solid ({unset}); set its parameters, or omit `files`"
                raise InvalidInputs([Fault("files", "no_solid", detail)])
        return {name: calculation.shapes[name] for name in names}

    def _links_of_builds(
        self, shapes: dict[str, CadModel], files: Iterable[FileKind], client: str
    ) -> Iterator[tuple[str, str]]:
        """Build the solids, and yield the name and path of each file.

        Raises
        ------
        InvalidInputs
            If a solid cannot be built; the error says why.
        """
        for name, shape in shapes.items():
            for kind in files:
                if kind == "report":
                    continue
                self._wait(self.models.request(shape, KINDS[kind], client), name)
                suffix = KINDS[kind][-1]
                yield _link_name(kind, name, len(shapes)), f"/api/v1/builds/{build_key(shape)}/model.{suffix}"

    def _wait(self, job: str | None, model: str) -> None:
        """Wait for the job that builds a solid, as long as the client waits."""
        caller = present_caller()
        while job is not None and not self.jobs.get(job).finished:
            if caller is not None and caller.left.is_set():
                raise JobCancelled
            if caller is not None and time.monotonic() >= caller.until:
                raise StepDeferred
            time.sleep(POLL)
        if problem := self.jobs.problem(job):
            detail = f"the solid of {model} fails at the chosen values: {problem['detail']}"
            remedy = "narrow the bounds, add a requirement that excludes them, or omit `files`"
            raise InvalidInputs([Fault("files", "solid_failed", f"{detail}; {remedy}")])

    def _saved(
        self,
        asked: AnswerQuestion,
        order: SaveOrder,
        body: AnswerIn,
        answer: DesignAnswer,
        changed: Stored,
    ) -> SaveResult:
        note = body.note or answer.sentence[:1000]
        if asked.design:
            expected = f'"{asked.revision}"'
            return self.designs.change(asked.design, answer.patch, note, expected, order.once)
        return self.designs.create(changed, note, order.once)


def _base(asked: AnswerQuestion, database: Database) -> tuple[AnswerQuestion, Stored]:
    """Return a request with its revision, and the document that it starts from.

    A repeated request starts from the revision before the one that it saved.
    """
    if asked.document:
        return asked, from_json(asked.document)
    order = asked.save
    with database.read() as session:
        before = order.once.find(session) if order else None
        head = repository.head(session, asked.design).number
        number = int(before["revision"]) - 1 if before else asked.revision or head
        document = repository.document(session, asked.design, number)
    if order is not None and before is None:
        if order.expected is not None and not matches(order.expected, head):
            raise StaleRevision(order.expected, head)
        if number != head:
            detail = f"a saved answer follows the newest revision, {head}; omit `revision`"
            raise InvalidInputs([Fault("revision", "not_newest", detail)])
    return replace(asked, revision=number), document


def _check_files(body: AnswerIn, asked: AnswerQuestion, document: Stored) -> None:
    """Refuse files that this request cannot have."""
    if "report" in body.files and asked.save is None:
        detail = "a report belongs to a revision: set `save` to true, or omit the report"
        raise InvalidInputs([Fault("files.report", "not_saved", detail)])
    if {*body.files} - {"report"} and not document.get("models"):
        detail = "the design has no model, so there is no STEP file and no drawing; omit them"
        raise InvalidInputs([Fault("files", "no_model", detail)])


def _settled(
    asked: AnswerQuestion, database: Database, catalogues: Catalogues
) -> tuple[AnswerQuestion, Iterable[str]]:
    """Return a request with its revision, and the data that determine the answer."""
    return (asked, ()) if asked.document else settled(asked, database, catalogues)


def _link_name(kind: str, model: str, count: int) -> str:
    return kind if count == 1 else f"{kind} {model}"


def _links_of_revision(
    saved: SaveResult, models: list[str], files: Iterable[FileKind]
) -> Iterator[tuple[str, str]]:
    """Yield the name and path of each file of a revision."""
    root = f"/api/v1/designs/{saved.design}/revisions/{saved.revision}"
    for kind in files:
        if kind == "report":
            yield kind, f"{root}/report.pdf"
            continue
        for name in models:
            yield _link_name(kind, name, len(models)), f"{root}/models/{name}/model.{KINDS[kind][-1]}"
