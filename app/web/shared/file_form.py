"""A form to upload a file that a job imports: the form, its progress, and the result or refusal."""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from fastapi import Request, Response
from pydantic import BaseModel

from app.storage.idempotency import Once
from app.web.shared.design_answers import job_of
from app.web.shared.multipart import parts_of
from app.web.shared.responses import go, show
from app.web.shared.services import PageServices, Refused

MISSED = (409, 415, 422, 429, 503)
"""Errors that the form explains, because the user can correct them, or send the file again later."""
_JOB = re.compile(r"[A-Za-z0-9-]{1,64}")


class Upload(BaseModel):
    """The id for the imported object, and the name of the file."""

    id: str
    file: str


async def _nothing(services: PageServices) -> dict[str, object]:
    return {}


@dataclass(frozen=True)
class FileForm:
    """The page of an upload form.

    Parameters
    ----------
    path, page
        The address of the page, and its template file.
    choose
        The sentence that asks for a file.
    upload
        The model that validates id and name.
    begin
        The service that starts the import.
    address
        Function that returns the address of the imported object from the result of its job; None for a job of
        another kind.
    context
        Function that returns further data for the form.
    """

    path: str
    page: str
    choose: str
    upload: type[Upload]
    begin: Callable[[PageServices], Callable[[memoryview, str, str, Once], str]]
    address: Callable[[str], str | None]
    context: Callable[[PageServices], Awaitable[dict[str, object]]] = _nothing

    async def show(self, request: Request, services: PageServices, job: str, id: str) -> Response:
        """Return the form for a file, the progress of its job, or the result or refusal."""
        if not _JOB.fullmatch(job):
            return await self._form(request, services, id)
        work = await job_of(services, job)
        if work.problem is not None:
            return await self._form(request, services, id, work.problem.detail, work.problem.status)
        if work.state == "done":
            address = self.address(work.result or "")
            return go(address) if address else await self._form(request, services, id)
        answer = show(request, self.page, notice="", waiting=work)
        answer.headers["Refresh"] = "1"  # so that the page can wait without a script
        return answer

    async def send(self, request: Request, services: PageServices) -> Response:
        """Import the chosen file; return the form with the reason if it is refused at once."""
        parts = await parts_of(request)
        id = parts["id"].text.strip() if "id" in parts else ""
        chosen = parts.get("file")
        if chosen is None or not chosen.content:
            return await self._form(request, services, id, f"choose a file: {self.choose}", 422)
        name = "".join(sign for sign in (chosen.file or "") if sign.isprintable())[-200:].strip()
        try:
            job = await self.begun(services, chosen.content, id, name)
        except Refused as refused:
            if refused.status not in MISSED:
                raise
            return await self._form(request, services, id, refused.sentence, refused.status)
        return go(f"{self.path}?job={job}&id={id}")

    async def begun(self, services: PageServices, content: memoryview, id: str, name: str) -> str:
        """Begin the import of a file, and return its job.

        Raises
        ------
        Refused
            If the file is refused at once.
        """
        given = services.read(self.upload, {"id": id, **({"file": name} if name else {})})
        begin = self.begin(services)
        return await services.ask(services.threads.run(begin, content, given.id, given.file, services.once))

    async def _form(
        self, request: Request, services: PageServices, id: str, notice: str = "", status: int = 200
    ) -> Response:
        context = await self.context(services)
        return show(request, self.page, status, typed_id=id, notice=notice, waiting=None, **context)
