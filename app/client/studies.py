"""Studies in the client: an object that waits for a study, returns its rows and saves one row in the design.

study = client.study(design.id, method="grid", vary={…}, steps=41, outputs=["film.power_loss"])
study.wait(print).result
best = min(study.rows(where="met"), key=lambda row: row.values["film.power_loss"])
design = study.choose(best.row)
"""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from typing import Literal

from app.client.connections import AwaitedConnection, BlockingConnection
from app.client.design_operations import design
from app.client.exchange import (
    BASE,
    Exchange,
    Progress,
    Request,
    answered,
    followed,
    get,
    job_of,
    listed,
    post,
    read,
)
from app.client.files import File
from app.client.problem import Problem, checked
from app.designs.schemas.designs import Design
from app.schemas.criteria import Word
from app.studies.schemas import Study, StudyList, StudyRow, StudyRows

Where = Word | Literal["refused"]
"""A selection of rows: by their worst verdict, or rows without values."""
Kind = Literal["csv", "xlsx", "npz"]
_PAGE = "500"  # rows in one request
_JOB = f"{BASE}/jobs/"


def begin(design: str, body: Mapping[str, object], key: str | None = None) -> Exchange[Study]:
    """Start a study; two requests with the same key start one study."""
    return answered(Study, post("/studies", {"design": design, **body}, _once(key)))


def find(id: str) -> Exchange[Study]:
    """Return the current state of a study."""
    return answered(Study, get(f"/studies/{id}"))


def find_all(design: str | None = None) -> Exchange[list[Study]]:
    """Return studies, newest first; with a design, only its studies."""
    return listed(StudyList, "/studies", [("design", design)] if design else [])


def end_of(id: str, on_progress: Progress | None = None) -> Exchange[Study]:
    """Return a completed study.

    Raises
    ------
    Problem
        If the study failed or was cancelled.
    """
    study = yield from find(id)
    if study.job is not None:
        yield from followed(study.job.removeprefix(_JOB), on_progress)
    study = yield from find(id)
    if study.problem:
        raise Problem(study.problem.status, study.problem.model_dump(exclude_unset=True))
    return study


def rows_of(id: str, query: Sequence[tuple[str, str]]) -> Exchange[list[StudyRow]]:
    """Return rows of a study from all pages."""
    return listed(StudyRows, f"/studies/{id}/rows", [*query, ("limit", _PAGE)])


def file_of(id: str, kind: Kind, query: Sequence[tuple[str, str]]) -> Exchange[File]:
    """Return rows of a study as a file."""
    response = yield get(f"/studies/{id}/rows.{kind}", tuple(query))
    return File.of(checked(response))


def chosen(
    study: Study, row: int, note: str | None, on_progress: Progress | None, key: str | None
) -> Exchange[Design]:
    """Save a row of a study as the design's newest revision, and return the design."""
    newest = yield from design(study.design)
    headers = {"If-Match": f'"{newest.revision}"', **_once(key)}
    body = {"row": row, **({"note": note} if note else {})}
    response = yield post(f"/studies/{study.id}/choose", body, headers)
    answer = read(Design, response)
    if job := job_of(response):
        yield from followed(job, on_progress)
        answer = yield from design(answer.id)
    return answer


def _once(key: str | None) -> dict[str, str]:
    """Return the header with a new Idempotency-Key, which makes a repeated request harmless."""
    return {"Idempotency-Key": key or uuid.uuid4().hex}


def ended(id: str) -> Exchange[Study | None]:
    """Cancel a waiting or running study, and return it; delete an ended study, and return None."""
    response = yield Request("DELETE", f"{BASE}/studies/{id}")
    return None if checked(response).status_code == 204 else read(Study, response)


def filters(columns: Sequence[str] | None, where: Where | None, sort: str | None) -> list[tuple[str, str]]:
    """Return the selection of rows and columns as query parameters."""
    given = {"columns": ",".join(columns) if columns else None, "where": where, "sort": sort}
    return [(name, value) for name, value in given.items() if value is not None]


class ClientStudy:
    """A study of a `Client`; `study` is its state in the last response."""

    def __init__(self, client: BlockingConnection, study: Study) -> None:
        self._client, self.study = client, study

    @property
    def id(self) -> str:
        """Return the id of the study."""
        return self.study.id

    def wait(self, on_progress: Progress | None = None) -> Study:
        """Return the completed study; raises Problem if it failed or was cancelled."""
        self.study = self._client.run(end_of(self.id, on_progress))
        return self.study

    def rows(
        self, columns: Sequence[str] | None = None, *, where: Where | None = None, sort: str | None = None
    ) -> list[StudyRow]:
        """Return the rows, in order or sorted by a column (`-` in front: in descending order)."""
        return self._client.run(rows_of(self.id, filters(columns, where, sort)))

    def file(
        self,
        kind: Kind = "csv",
        columns: Sequence[str] | None = None,
        *,
        where: Where | None = None,
        sort: str | None = None,
    ) -> File:
        """Return the rows as a file: csv, xlsx or npz."""
        return self._client.run(file_of(self.id, kind, filters(columns, where, sort)))

    def choose(
        self,
        row: int,
        note: str | None = None,
        *,
        on_progress: Progress | None = None,
        key: str | None = None,
    ) -> Design:
        """Save the values of a row as a new revision of the design, and return the design."""
        return self._client.run(chosen(self.study, row, note, on_progress, key))

    def end(self) -> Study | None:
        """Cancel the study if it is running; delete it if it has ended."""
        return self._client.run(ended(self.id))


class AsyncClientStudy:
    """A study of an `AsyncClient`, like `ClientStudy`; its methods are awaited."""

    def __init__(self, client: AwaitedConnection, study: Study) -> None:
        self._client, self.study = client, study

    @property
    def id(self) -> str:
        """Return the id of the study."""
        return self.study.id

    async def wait(self, on_progress: Progress | None = None) -> Study:
        """Return the completed study; raises Problem if it failed or was cancelled."""
        self.study = await self._client.run(end_of(self.id, on_progress))
        return self.study

    async def rows(
        self, columns: Sequence[str] | None = None, *, where: Where | None = None, sort: str | None = None
    ) -> list[StudyRow]:
        """Return the rows, in order or sorted by a column (`-` in front: in descending order)."""
        return await self._client.run(rows_of(self.id, filters(columns, where, sort)))

    async def file(
        self,
        kind: Kind = "csv",
        columns: Sequence[str] | None = None,
        *,
        where: Where | None = None,
        sort: str | None = None,
    ) -> File:
        """Return the rows as a file: csv, xlsx or npz."""
        return await self._client.run(file_of(self.id, kind, filters(columns, where, sort)))

    async def choose(
        self,
        row: int,
        note: str | None = None,
        *,
        on_progress: Progress | None = None,
        key: str | None = None,
    ) -> Design:
        """Save the values of a row as a new revision of the design, and return the design."""
        return await self._client.run(chosen(self.study, row, note, on_progress, key))

    async def end(self) -> Study | None:
        """Cancel the study if it is running; delete it if it has ended."""
        return await self._client.run(ended(self.id))
