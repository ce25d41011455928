"""The services, bound to the principal and client of a page request.

A page is a route like those of the interface: the same checks admit the same roles, the same services act for
the same principal, and both use the same models. An error is raised as `Refused`, with the problem that the
interface would return.
"""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated, ParamSpec, TypeVar

from fastapi import Depends, Request
from pydantic import JsonValue, TypeAdapter, ValidationError

from app.api.dependencies import expensive_steps, services_of
from app.api.services import Services
from app.calculations.errors import InvalidBody
from app.designs.routes.designs import noted
from app.designs.service import SaveResult
from app.http.access import TheClient
from app.http.problem_kinds import TABLE
from app.http.problems import refusal
from app.http.strict_requests import refuse_forbidden_in
from app.observation.processor_time import in_thread
from app.schemas.problems import Problem
from app.storage.idempotency import Once

Kind = TypeVar("Kind")
Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")

MOMENT = 1.0
"""Time for which a form waits for the job of a change [s]."""
_NUMBER = re.compile(r"[0-9]{1,6}")

ERRORS = tuple(TABLE)
"""Errors that are reported as problems."""


def with_related(detail: str, also: list[str]) -> str:
    """Return the sentence of a fault and the other inputs that it concerns, as `shared/api.js` does."""
    return f"{detail}. See also {', '.join(also)}" if also else detail


class Refused(Exception):
    """A service refused; `problem` is the interface's response in this case."""

    def __init__(self, problem: Problem) -> None:
        self.status, self.problem = problem.status, problem
        super().__init__(f"{problem.status} {problem.detail}")

    @classmethod
    def by(cls, error: Exception) -> Refused:
        """Return the refusal for an error of a service."""
        return cls(Problem.model_validate_json(bytes(refusal(error).body)))

    @classmethod
    def because(cls, status: int, detail: str) -> Refused:
        """Return a refusal that a page itself raises."""
        title = HTTPStatus(status).phrase.capitalize()
        return cls(Problem(type="about:blank", title=title, status=status, detail=detail))

    @property
    def faults(self) -> dict[str, str]:
        """Return the faults by the name of the input, with the other inputs that they concern."""
        return {fault.name: with_related(fault.detail, fault.also) for fault in self.problem.errors}

    @property
    def sentence(self) -> str:
        """Return the reasons as one text."""
        return "; ".join(self.faults.values()) or self.problem.detail


def tag_of(revision: str) -> str:
    """Return the ETag of the revision in a form; for an invalid number, an ETag that matches nothing."""
    return f'"{revision if _NUMBER.fullmatch(revision) else 0}"'


@contextmanager
def refusals() -> Iterator[None]:
    """Turn errors of services into refusals.

    Raises
    ------
    Refused
        For each error that the interface answers with a problem.
    """
    try:
        yield
    except ERRORS as error:
        raise Refused.by(error) from error


@dataclass(frozen=True)
class PageServices(Services):
    """The services for one request of a page, and the client that sent it."""

    request: Request
    client: str

    @property
    def once(self) -> Once:
        """Return the record of a change; every form is a new change, because it has no idempotency key."""
        return Once(None, "", "", self.client)

    async def run(
        self,
        function: Callable[Arguments, Result],
        *arguments: Arguments.args,
        **options: Arguments.kwargs,
    ) -> Result:
        """Run a function in a thread, and return its result.

        Raises
        ------
        Refused
            If a service refuses.
        """
        with refusals():
            return await in_thread(function, *arguments, **options)

    async def ask(self, answer: Awaitable[Result]) -> Result:
        """Return the answer of a service that runs in the event loop.

        Raises
        ------
        Refused
            If the service refuses.
        """
        with refusals():
            return await answer

    async def save(
        self,
        change: Callable[Arguments, SaveResult],
        *arguments: Arguments.args,
        **options: Arguments.kwargs,
    ) -> SaveResult:
        """Wait a short time for the job of a save, and return the saved state; the page shows the progress.

        Raises
        ------
        Refused
            If nothing was saved.
        """
        saved = await self.calculate(MOMENT, change, *arguments, **options)
        if saved.job and not saved.is_deferred:
            await self.jobs.wait(saved.job, MOMENT)
        return saved

    async def change(
        self, id: str, revision: str, patch: Mapping[str, JsonValue], note: str = ""
    ) -> SaveResult:
        """Save a merge patch of a design, based on the revision whose number the form contains.

        Raises
        ------
        Refused
            If nothing was saved.
        """
        with refusals():
            refuse_forbidden_in({**patch, "note": note})
            change, noted_as = noted({**patch, **({"note": note} if note.strip() else {})})
        return await self.save(self.designs.change, id, change, noted_as, tag_of(revision), self.once)

    async def cancel(self, job: str) -> None:
        """Cancel a job; one that has already ended stays unchanged.

        Raises
        ------
        Refused
            If there is no such job, or it belongs to another principal.
        """
        try:
            await self.run(self.jobs.cancel, job, self.client)
        except Refused as refused:
            if refused.status != HTTPStatus.CONFLICT:
                raise

    async def find(
        self,
        function: Callable[Arguments, Result],
        *arguments: Arguments.args,
        **options: Arguments.kwargs,
    ) -> Result | None:
        """Return the result of a function, or None if the function finds nothing."""
        try:
            return await self.run(function, *arguments, **options)
        except Refused as refused:
            if refused.status != HTTPStatus.NOT_FOUND:
                raise
            return None

    async def calculate(
        self,
        seconds: float | None,
        function: Callable[Arguments, Result],
        *arguments: Arguments.args,
        **options: Arguments.kwargs,
    ) -> Result:
        """Return the result of a function that evaluates steps, deferring steps that take longer [s].

        If no time is given, no step is deferred.

        Raises
        ------
        Refused
            If a service refuses.
        """
        await expensive_steps(self.request, self.client)
        with refusals():
            if seconds is None:
                return await self.threads.run_for(self.request, function, *arguments, **options)
            return await self.threads.run_within(seconds, self.request, function, *arguments, **options)

    def read(self, kind: type[Kind], body: object) -> Kind:
        """Return a form as the model of a request body, validated as strictly as a client's body.

        Raises
        ------
        Refused
            If there are faults; the error lists all of them.
        """
        with refusals():
            refuse_forbidden_in(body)
            try:
                return TypeAdapter(kind).validate_python(body)
            except ValidationError as error:
                raise InvalidBody.of(error) from None


async def get_services(request: Request, client: TheClient) -> PageServices:
    """Return the services for this request.

    If files of a team's catalogue have changed, they are read first.
    """
    services = services_of(request)
    await services.catalogues.refresh()
    return PageServices(**vars(services), request=request, client=client)


ThePageServices = Annotated[PageServices, Depends(get_services)]
