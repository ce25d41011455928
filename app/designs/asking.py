"""Questions about a revision: answered when the pool has calculated them, or by a job if that takes long."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from app.calculations.errors import StepDeferred
from app.calculations.steps import Steps, in_the_pool
from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.long_answers import LongAnswers
from app.designs.tasks import DesignTask
from app.jobs.service import Jobs
from app.plain import Json, JsonObject
from app.presentation.units import System
from app.schemas.answers import Answer
from app.storage.artifacts import Artifacts
from app.storage.database import Database

A = TypeVar("A", bound=Answer)


@dataclass(frozen=True)
class Asked:
    """A question about a design: the body of its request as JSON text, and the units of its answer.

    `revision` is the newest, if it is None.
    """

    design: str
    body: str
    revision: int | None = None
    units: System = "si"


class Asking(LongAnswers, Generic[A]):
    """Answers questions of one kind, makes jobs where that takes long, and is the handler of such jobs.

    `answered` answers a body [JSON text] about a revision of a design, by its number and in SI units; it runs
    in a calculation process.
    """

    def __init__(
        self,
        kind: str,
        answered: Callable[[DesignTask, int, str], A],
        database: Database,
        catalogues: Catalogues,
        store: Artifacts,
        jobs: Jobs,
        steps: Steps,
    ) -> None:
        super().__init__(database, catalogues, store, jobs, steps)
        self.kind, self.answered = kind, answered

    def answer(self, asked: Asked, client: str) -> tuple[A | None, str | None]:
        """Return the answer, or the job that makes it where its caller does not wait so long.

        Raises
        ------
        InvalidInputs
            With everything that is wrong with the question or the design.
        QueueFull, TooManyCalculations
            Too many jobs, or calculations, are waiting.
        """
        number, task = self._task(asked)
        try:
            return self._calculated(number, task, asked), None
        except StepDeferred:
            payload = {"design": asked.design, "revision": number, "units": asked.units}
            return None, self.queued(payload, asked.body, client)

    def calculated(self, payload: JsonObject, body: Json) -> A:
        """Return the whole answer to what a job holds."""
        asked = Asked(body=str(body), **payload)
        return self._calculated(*self._task(asked), asked)

    def _task(self, asked: Asked) -> tuple[int, DesignTask]:
        """Return the revision in question, and its design."""
        with self.database.read() as session:
            number = asked.revision or repository.head(session, asked.design).number
            document = repository.document(session, asked.design, number)
        return number, DesignTask.of(document, self.catalogues)

    def _calculated(self, number: int, task: DesignTask, asked: Asked) -> A:
        """Return the answer, calculated in the pool for the present caller."""
        key = self.kind, number, task, asked.body
        return in_the_pool(key, self.answered, task, number, asked.body).in_units(asked.units)
