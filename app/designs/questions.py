"""A question about designs is answered at once if that is cheap, else by a job.

`Questions` does this for previews, decisions, solutions, analyses of tolerances, single variants and the
impact of versions. What was begun for a client who waits no longer goes on: the job takes it over and keeps
the answer as an artifact, and the client comes back for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from pydantic import TypeAdapter
from pydantic_core import from_json, to_json
from sqlalchemy.orm import Session

from app.calculations.jobs import place_of_answer
from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.errors import DesignError
from app.designs.tasks import DesignTask
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.plain import JsonObject
from app.pool.errors import StepDeferred
from app.pool.steps import Steps, begun_steps, calling, in_the_pool
from app.presentation.units import System
from app.schemas.answers import Answer
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import NotFound
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from templates.core.errors import TemplateError

FAILURES = (TemplateError, DesignError, NotFound, DeadlineExceeded, MemoryExceeded)
"""What the question itself brings about."""

Q = TypeVar("Q")
A = TypeVar("A", bound=Answer)


@dataclass(frozen=True)
class Reply(Generic[Q, A]):
    """An answer as far as it goes, and the question that a job has to answer; None if the answer is whole."""

    answer: A | None
    rest: Q | None = None


Calculate = Callable[[Q, Database, Catalogues], Reply[Q, A]]
"""Answers a question for the caller of the present context, as far as that caller waits."""
Check = Callable[[Q, Database, Catalogues], None]


class Questions(Generic[Q, A]):
    """Answers questions of one kind, makes jobs where that takes long, and is the handler of such jobs.

    Parameters
    ----------
    kind
        Of the jobs.
    asked
        The type of the questions: a dataclass of what JSON holds.
    calculate
        Answers a question.
    check
        Raises what refuses a question, as far as shows without calculating.
    """

    def __init__(
        self,
        kind: str,
        asked: type[Q],
        calculate: Calculate[Q, A],
        database: Database,
        catalogues: Catalogues,
        store: Artifacts,
        jobs: Jobs,
        steps: Steps,
        check: Check[Q] = lambda *asked: None,
    ) -> None:
        self.kind, self._calculate, self._check = kind, calculate, check
        self._asked: TypeAdapter[Q] = TypeAdapter(asked)
        self.database, self.catalogues, self.store = database, catalogues, store
        self.jobs, self.steps = jobs, steps

    def answer(self, question: Q, client: str) -> tuple[A | None, str | None]:
        """Return the answer as far as its caller waits for it, and the job that completes it, if any.

        Raises
        ------
        InvalidInputs, NotFound
            With everything that is wrong with the question or the design, as far as it is known.
        QueueFull, TooManyCalculations
            Too many jobs, or calculations, are waiting.
        """
        reply = self._reply(question)
        return reply.answer, None if reply.rest is None else self.queued(reply.rest, client)

    def in_parts(self, question: Q, client: str) -> tuple[A, str | None]:
        """As `answer`, of a kind whose answer is never empty.

        Raises
        ------
        InvalidInputs, NotFound, QueueFull, TooManyCalculations
            As `answer`.
        """
        answer, job = self.answer(question, client)
        assert answer is not None, "its kind has answers in parts"
        return answer, job

    def requested(self, question: Q, client: str) -> str:
        """Return the job that answers a question, for a kind that always takes long.

        Raises
        ------
        Exception
            What the check of this kind raises.
        QueueFull
            Too many jobs are waiting.
        """
        self._check(question, self.database, self.catalogues)
        return self.queued(question, client)

    def at_once(self, question: Q) -> A:
        """Return the answer as far as it is known while its caller waits; no job is made for the rest."""
        answer = self._reply(question).answer
        assert answer is not None, "a job waits for the whole answer, and a page asks for what has parts"
        return answer

    def _reply(self, question: Q) -> Reply[Q, A]:
        return self._calculate(question, self.database, self.catalogues)

    def queued(self, question: Q, client: str) -> str:
        """Return the id of a new job; it takes over the steps that this request has begun."""
        payload = {"body": self.store.put(to_json(question))}
        begun = begun_steps()

        def unit_of_work(session: Session) -> str:
            id = self.jobs.enqueue(session, self.kind, payload, client=client)
            if begun is not None:
                begun.leave_to(id)
            return id

        job = self.database.write(unit_of_work)
        self.jobs.wake()
        return job

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Calculate the whole answer, and keep it.

        Raises
        ------
        JobFailed
            With the problem, for anything that the question itself brings about.
        """
        question = self._asked.validate_python(from_json(self.store.read(job.payload["body"])))
        try:
            with calling(self.steps, job, context, f"job:{job.id}", "jobs"):
                answer = self.at_once(question)
        except FAILURES as error:
            raise JobFailed(error) from error
        content = answer.model_dump_json(by_alias=True, exclude_unset=True).encode()
        place = place_of_answer(job.id, self.store.put(content))
        return lambda session: place

    def failed(self, session: Session, job: Job, problem: JsonObject) -> None:
        """End what was left to a job that was cancelled before it began."""
        self.steps.drop(job.id)


@dataclass(frozen=True)
class Asked:
    """A question about a design: the body of its request as JSON text, and the units of its answer.

    `revision` is the newest, if it is None.
    """

    design: str
    body: str
    revision: int | None = None
    units: System = "si"


def in_a_process(kind: str, answered: Callable[[DesignTask, int, str], A]) -> Calculate[Asked, A]:
    """Return the way to answer questions that are calculated in the pool as a whole.

    `answered` answers a body [JSON text] about a revision of a design, by its number and in SI units.
    """

    def calculate(asked: Asked, database: Database, catalogues: Catalogues) -> Reply[Asked, A]:
        with database.read() as session:
            number = asked.revision or repository.head(session, asked.design).number
            document = repository.document(session, asked.design, number)
        task = DesignTask.of(document, catalogues)
        try:
            answer = in_the_pool((kind, number, task, asked.body), answered, task, number, asked.body)
        except StepDeferred:
            return Reply(None, replace(asked, revision=number))
        return Reply(answer.in_units(asked.units))

    return calculate
