"""Answer a request at once if that is cheap, else by a job.

`Questions` does this for evaluations, solutions and worksheets of templates, and for previews, decisions,
solutions, answers to requirements, explanations with sensitivities, analyses of tolerances, single variants
and the impact of versions. If a client stops waiting, a job takes over the running calculation and stores the
answer as an artifact, which the client fetches later. A job is stored under the key of its request, so an
equal request finds the job or its answer.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import TypeAdapter
from pydantic_core import from_json, to_json
from sqlalchemy.orm import Session

import templates
from app.catalogue.catalogues import Catalogues
from app.jobs import repository
from app.jobs.schemas import State
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.plain import JsonObject
from app.pool.steps import Steps, begun_steps, calling
from app.schemas.answers import Answer
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactDamaged, ArtifactMissing, CannotRebuild, NotFound
from app.storage.tables import canonical_json
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from app.workers.pieces import Pieces
from templates.core.errors import TemplateError

CALCULATION, PREVIEW, DECISION = "calculation", "preview", "decision"
TOLERANCE, SOLUTION, IMPACT, VARIANT = "tolerance", "solution", "impact", "variant"
EXPLANATION, ANSWER = "explanation", "answer"
ANSWERS = (CALCULATION, PREVIEW, DECISION, TOLERANCE, SOLUTION, IMPACT, VARIANT, EXPLANATION, ANSWER)
"""Kinds of jobs whose result is an answer to a request that did not wait for it."""
AGAIN = "again"  # payload key: the job whose lost answer is calculated again
FAILURES = (TemplateError, NotFound, CannotRebuild, DeadlineExceeded, MemoryExceeded)
"""Errors that a question of any kind, or the loss of its answer, may cause."""

_PACKAGES = (
    "templates", "cad", "app/answers", "app/calculations", "app/designs", "app/studies", "app/tolerances",
)  # fmt: skip
"""Folders of the code on which answers depend."""

Q = TypeVar("Q")
A = TypeVar("A", bound=Answer | Pieces)
M = TypeVar("M", bound=Answer)


@dataclass(frozen=True)
class Reply(Generic[Q, A]):
    """The answer as far as it is known, and the request that a job must complete, if any."""

    answer: A | None
    rest: Q | None = None


@dataclass(frozen=True)
class Form(Generic[Q]):
    """How requests of a kind are stored: fields in the row of the job, and a body in the file store."""

    write: Callable[[Q], tuple[JsonObject, Pieces]]
    read: Callable[[JsonObject, Pieces], Q]


def json_form(asked: type[Q]) -> Form[Q]:
    """Return the form for requests whose dataclasses hold only JSON values, all stored in the body."""
    adapter: TypeAdapter[Q] = TypeAdapter(asked)

    def read(fields: JsonObject, body: Pieces) -> Q:
        return adapter.validate_python(from_json(body.joined()))

    return Form(lambda question: ({}, Pieces.of(to_json(question))), read)


def json_answer(model: type[M]) -> Callable[[Pieces], M]:
    """Return a function that parses a stored answer as a model."""
    return lambda kept: model.model_validate_json(kept.joined())


@dataclass(frozen=True)
class Kind(Generic[Q, A]):
    """A kind of requests.

    Parameters
    ----------
    name
        Kind of the jobs that answer them.
    form
        How the requests are stored.
    read
        Function that reads a stored answer.
    calculate
        Function that answers a request for the caller of the present context, as far as that caller waits.
    failures
        Errors that a request of this kind may raise, in addition to `FAILURES`.
    settle
        Function that returns a request with the revision that is the newest now, and everything else that
        determines the answer. None if the answer depends on what may change at any time: an equal request
        then joins only a job that has not begun.
    check
        For a kind that always takes long: function that raises an error for an invalid request, as far as
        that shows without calculating.
    has_parts
        Whether part of the answer is available while its job continues.
    """

    name: str
    form: Form[Q]
    read: Callable[[Pieces], A]
    calculate: Callable[[Q, Database, Catalogues], Reply[Q, A]]
    failures: tuple[type[Exception], ...] = ()
    settle: Callable[[Q, Database, Catalogues], tuple[Q, Iterable[str]]] | None = None
    check: Callable[[Q, Database, Catalogues], None] | None = None
    has_parts: bool = False

    @property
    def all_failures(self) -> tuple[type[Exception], ...]:
        """Return the errors that a request of this kind may raise."""
        return (*FAILURES, *self.failures)

    @property
    def joined(self) -> frozenset[State]:
        """Return the states in which a job also serves an equal request."""
        return frozenset({"queued", "running", "done"} if self.settle else {"queued"})


class Questions(Generic[Q, A]):
    """Answers requests of one kind, creates jobs for those that take long, and handles these jobs.

    A save does not use this class: its job is committed with a revision and completes it, and stores no
    answer.
    """

    def __init__(
        self,
        kind: Kind[Q, A],
        database: Database,
        catalogues: Catalogues,
        store: Artifacts,
        jobs: Jobs,
        steps: Steps,
    ) -> None:
        self.kind = kind
        self.database, self.catalogues, self.store = database, catalogues, store
        self.jobs, self.steps = jobs, steps

    def answer(self, question: Q, client: str) -> tuple[A | None, str | None]:
        """Return the parts of the answer ready in the caller's time, and the job that completes it, if any.

        Raises
        ------
        InvalidInputs, NotFound
            If the request or the design has faults; the error lists all known ones.
        QueueFull, TooManyCalculations
            If too many jobs or calculations are waiting.
        """
        asked, key = self._settled(question)
        if key and (earlier := self._earlier(key)):
            if not earlier.finished:
                return None, self._queued(asked, key, client)
            with suppress(ArtifactMissing, ArtifactDamaged):
                return self.kind.read(stored_answer(self.store, earlier)), None
        if self.kind.check is not None:
            self.kind.check(asked, self.database, self.catalogues)
            return None, self._queued(asked, key, client)
        reply = self._reply(asked)
        return reply.answer, None if reply.rest is None else self._queued(reply.rest, key, client)

    def in_parts(self, question: Q, client: str) -> tuple[A, str | None]:
        """Return an answer as `answer` does, for a kind whose answer has parts and is never empty.

        Raises
        ------
        InvalidInputs, NotFound, QueueFull, TooManyCalculations
            As raised by `answer`.
        """
        answer, job = self.answer(question, client)
        return self.at_once(question) if answer is None else answer, job

    def at_once(self, question: Q) -> A:
        """Return the parts of the answer that are ready while the caller waits; no job computes the rest."""
        answer = self._reply(question).answer
        assert answer is not None, "a job waits for the whole answer, and a page asks for what has parts"
        return answer

    def _reply(self, question: Q) -> Reply[Q, A]:
        return self.kind.calculate(question, self.database, self.catalogues)

    def _settled(self, question: Q) -> tuple[Q, str]:
        """Return a request with its revision, and its key, which is empty for a kind that does not settle."""
        if self.kind.settle is None:
            return question, ""
        asked, grounds = self.kind.settle(question, self.database, self.catalogues)
        return asked, self._key(asked, grounds)

    def _key(self, question: Q, grounds: Iterable[str] = ()) -> str:
        """Return the hash of all data that determine the answer to a request."""
        fields, body = self.kind.form.write(question)
        about = [self.kind.name, canonical_json(fields), *program(), *grounds]
        digest = hashlib.sha256("\0".join(about).encode())
        for part in body:
            digest.update(part)
        return digest.hexdigest()

    def _earlier(self, key: str) -> Job | None:
        """Return the newest job of an equal request."""
        with self.database.read() as session:
            return repository.asked(session, key, self.kind.joined)

    def _queued(self, question: Q, key: str, client: str) -> str:
        """Return the job of an equal request, or a new job that takes over calculations already begun."""
        fields, body = self.kind.form.write(question)
        key = key or self._key(question)
        payload = {**fields, "body": self.store.put(*body)}
        begun = begun_steps()

        def unit_of_work(session: Session) -> str:
            id, is_new = self.jobs.ask(session, self.kind.name, payload, key, self.kind.joined, client)
            if begun is not None and is_new:
                begun.leave_to(id)
            return id

        return self.jobs.commit(unit_of_work)

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Calculate the complete answer for a job, and store it.

        Raises
        ------
        JobFailed
            If the request itself causes an error; the failure contains the problem.
        """
        try:
            question = question_of(self.kind.form, job, self.store)
            with calling(self.steps, job, context, f"job:{job.id}", "jobs"):
                answer = self.at_once(question)
        except self.kind.all_failures as error:
            raise JobFailed(error) from error
        lost = job.payload.get(AGAIN)  # the job whose answer was lost
        place = place_of_answer(lost or job.id, self.store.put(*as_kept(answer)))

        def unit_of_work(session: Session) -> str:
            if lost:
                repository.set_result(session, lost, place)
            return place

        return unit_of_work

    def request_again(self, job: Job, client: str) -> str:
        """Return a job that recalculates the lost answer of another job of any kind.

        Raises
        ------
        CannotRebuild
            If the request of that job is lost as well.
        QueueFull
            If too many jobs are waiting.
        """
        if not self.store.exists(job.payload["body"]):
            raise _lost(job)
        payload = {**job.payload, AGAIN: job.id}
        return self.jobs.commit(lambda session: self.jobs.request(session, job.kind, payload, client))

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """Cancel the calculations that were left to a job that was cancelled before its start."""
        self.steps.drop(job.id)


def question_of(form: Form[Q], job: Job, store: Artifacts) -> Q:
    """Return the request of a job from the row of the job.

    Raises
    ------
    CannotRebuild
        If its body is lost.
    """
    fields = {name: part for name, part in job.payload.items() if name not in ("body", AGAIN)}
    try:
        return form.read(fields, Pieces.of(store.read(job.payload["body"])))
    except (ArtifactMissing, ArtifactDamaged) as error:
        raise _lost(job) from error


def _lost(job: Job) -> CannotRebuild:
    detail = f"the request of job {job.id} was lost. Send it again, or restore a backup"
    return CannotRebuild("answer_lost", detail)


def as_kept(answer: Answer | Pieces) -> Pieces:
    """Return an answer as JSON, without the fields that it leaves out.

    An answer that is already text is returned unchanged.
    """
    if isinstance(answer, Pieces):
        return answer
    return Pieces.of(answer.model_dump_json(by_alias=True, exclude_unset=True).encode())


def stored_answer(store: Artifacts, job: Job) -> Pieces:
    """Return the answer that a job saved in the store; raises ArtifactMissing, ArtifactDamaged."""
    assert job.result is not None
    return Pieces.of(store.read(job.result.rpartition("sha256=")[2]))


def place_of_answer(job: str, sha: str) -> str:
    """Return the address of a job's answer."""
    return f"/api/v1/evaluations/{job}?sha256={sha}"


@lru_cache(1)
def program() -> tuple[str, ...]:
    """Return the program's version, and the time stamps and sizes of the files that it calculates with."""
    root = Path(templates.__file__).parents[1]
    files = sorted(
        path
        for package in _PACKAGES
        for path in (root / package).rglob("*")
        if path.suffix in (".py", ".json", ".npz", ".csv")
    )
    digest = hashlib.sha256()
    for path in files:
        about = path.stat()
        digest.update(f"{path.relative_to(root)} {about.st_size} {about.st_mtime_ns}\n".encode())
    return version("crankwright"), digest.hexdigest()
