"""`/designs/{id}/report` (HTML, PDF) and `/designs/{id}/worksheet` (JSON, CSV, XLSX), for any revision."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Query, Request, Response
from markupsafe import Markup
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import ExpensiveSteps, TheJobs, ThePress, TheReports, TheThreads, Units
from app.api.responses import Threads, accepted_weights, finished, patience, written
from app.designs.routes.designs import Id, Number, Prefer, Within
from app.designs.schemas.designs import RevisionWorksheet
from app.http.access import TheClient
from app.http.attachments import named
from app.http.guard import PAGE_POLICY
from app.http.strict_requests import StrictRoute
from app.jobs.service import Jobs
from app.presentation.environment import environment
from app.presentation.spreadsheets import XLSX
from app.reports import tables
from app.reports.content import Report
from app.reports.paper import Press
from app.reports.service import Reports, tag
from app.schemas.problems import Responses, RouteOptions, refusals
from app.storage.errors import NotFound

router = APIRouter(
    prefix="/api/v1/designs", tags=["reports"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)

REPORTS = {"html": "text/html", "pdf": "application/pdf"}
TABLES = {
    "json": "application/json",
    "csv": "text/csv",
    "xlsx": XLSX,
}
PATIENCE = 15.0  # default wait of a report for its pictures [s]


def _described(kinds: Mapping[str, str], *, later: bool = False) -> RouteOptions:
    content: dict[str, object] = {media: {} for media in kinds.values()}
    going_on = "the report without the pictures that are still being made; Location names their job"
    more: Responses = {202: {"description": going_on, "content": content}} if later else {}
    unchanged: Responses = {304: {"description": "as it was when the ETag of If-None-Match was sent"}}
    model = {"model": RevisionWorksheet} if "json" in kinds else {}
    responses: Responses = {200: {"content": content, **model}, **unchanged, **more, **refusals(404, 429)}
    return {"response_class": Response, "responses": responses}


Accept = Annotated[str | None, Header(description="the kind wanted; the first if none is known")]
Appendix = Annotated[bool, Query(description="whether the report of all variants has its appendix")]
IfNoneMatch = Annotated[str | None, Header(description="the ETag of a report that is at hand")]


Pictures = Callable[[str, int, str], list[str]]
"""Requests the pictures of a design's revision for a client; returns the jobs that draw them."""


@dataclass(frozen=True)
class ReportRequest:
    """A request for a report, with the services that it needs."""

    request: Request
    reports: Reports
    press: Press
    jobs: Jobs
    threads: Threads
    client: str
    units: Units
    accept: str | None
    prefer: str | None
    if_none_match: str | None

    async def answer(
        self,
        gather: Callable[..., Report],
        pictures: Sequence[Pictures],
        id: str,
        number: int | None,
        kind: str | None,
    ) -> Response:
        """Return the report of a revision, by default the newest, as a page or a PDF.

        Raises
        ------
        NotFound
            If there is no such format, design or revision.
        """
        wanted = _wanted("report", kind, self.accept, REPORTS)
        revision = await run_in_threadpool(self.reports.number, id, number)
        job = await self._waited(pictures, id, revision)
        report = await self.threads.run_for(
            self.request, gather, id, revision, self.units, pending=job is not None
        )
        return await self._printed(report, wanted, job)

    async def _waited(self, pictures: Sequence[Pictures], id: str, number: int) -> str | None:
        """Wait for the pictures of this revision; return the job that still draws them afterwards, if any."""
        lists = [await run_in_threadpool(each, id, number, self.client) for each in pictures]
        ends = time.monotonic() + patience(self.prefer, PATIENCE)
        for job in chain.from_iterable(lists):
            left = max(ends - time.monotonic(), 0.0)
            if not await finished(self.jobs, job, f"wait={left:.0f}"):
                return job
        return None

    async def _printed(self, report: Report, kind: str, job: str | None) -> Response:
        """Return a report as a page or a PDF, or a 304 response if it has not changed."""
        headers = _headers(report, kind, job)
        if job is None and self.if_none_match and headers["ETag"] in self.if_none_match:
            return Response(status_code=304, headers=headers)
        if kind == "html":
            body: str | bytes = await run_in_threadpool(page, report)
        else:
            pictures = await run_in_threadpool(self.reports.pictures, report)
            body = await run_in_threadpool(self.press.print, report, pictures)
            await run_in_threadpool(self.reports.record, report, body)
        return Response(body, 202 if job else 200, headers, media_type=REPORTS[kind])


async def report_request(
    request: Request,
    reports: TheReports,
    press: ThePress,
    jobs: TheJobs,
    threads: TheThreads,
    client: TheClient,
    units: Units = "si",
    accept: Accept = None,
    prefer: Prefer = None,
    if_none_match: IfNoneMatch = None,
) -> ReportRequest:
    """Return the parts of a request that all routes of reports share."""
    return ReportRequest(request, reports, press, jobs, threads, client, units, accept, prefer, if_none_match)


TheReportRequest = Annotated[ReportRequest, Depends(report_request)]


@router.get("/{id}/report", **_described(REPORTS, later=True))
@router.get("/{id}/report.{kind}", **_described(REPORTS, later=True))
@router.get("/{id}/revisions/{number}/report", **_described(REPORTS, later=True))
@router.get("/{id}/revisions/{number}/report.{kind}", **_described(REPORTS, later=True))
async def show_report(
    id: Id, asked: TheReportRequest, number: Number | None = None, kind: Id | None = None
) -> Response:
    """Return the calculation report of a revision, by default the newest, as a page or a PDF."""
    reports = asked.reports
    return await asked.answer(reports.gather, [reports.request_pictures], id, number, kind)


@router.get("/{id}/variants/report", **_described(REPORTS, later=True))
@router.get("/{id}/variants/report.{kind}", **_described(REPORTS, later=True))
@router.get("/{id}/revisions/{number}/variants/report", **_described(REPORTS, later=True))
@router.get("/{id}/revisions/{number}/variants/report.{kind}", **_described(REPORTS, later=True))
async def show_variants_report(
    id: Id,
    asked: TheReportRequest,
    number: Number | None = None,
    kind: Id | None = None,
    appendix: Appendix = False,
) -> Response:
    """Return one report of all variants of a revision: the table of results, then the plots of the worst.

    The appendix has the worksheet of the variant that governs, the used share of every limit, and a picture
    of every distinct solid.
    """
    reports = asked.reports
    gather = partial(reports.gather_variants, has_appendix=appendix)
    pictures = [reports.request_pictures, reports.request_variant_pictures] if appendix else []
    return await asked.answer(gather, pictures, id, number, kind)


@router.get("/{id}/worksheet", **_described(TABLES))
@router.get("/{id}/worksheet.{kind}", **_described(TABLES))
@router.get("/{id}/revisions/{number}/worksheet", **_described(TABLES))
@router.get("/{id}/revisions/{number}/worksheet.{kind}", **_described(TABLES))
async def show_worksheet(
    id: Id,
    reports: TheReports,
    threads: TheThreads,
    request: Request,
    number: Number | None = None,
    kind: Id | None = None,
    units: Units = "si",
    within: Within = None,
    accept: Accept = None,
    step: Annotated[str | None, Query(max_length=200, description="this step alone")] = None,
    formulas: Annotated[bool, Query(description="write out the formulas of the steps")] = True,
) -> Response:
    """Return the inputs and outputs of a revision, by default the newest.

    The answer is JSON with every formula of the steps written out (symbol = expression = numbers = result),
    or a table.
    """
    wanted = _wanted("worksheet", kind, accept, TABLES)
    revision = await run_in_threadpool(reports.number, id, number)
    asked = (id, revision, units, step, formulas)
    if within is None:
        worksheet = await threads.run_for(request, reports.worksheet, *asked)
    else:
        worksheet = await threads.run_within(within, request, reports.worksheet, *asked)
    headers = {"Vary": "Accept", "Design-Revision": str(revision)}
    if wanted == "json":
        return written(worksheet, headers=headers)
    write = tables.write_csv if wanted == "csv" else tables.write_xlsx
    headers["Content-Disposition"] = named(worksheet.name, revision, wanted, how="attachment")
    table = await run_in_threadpool(lambda: write(tables.of(worksheet)))
    return Response(table, headers=headers, media_type=TABLES[wanted])


def _headers(report: Report, kind: str, job: str | None) -> dict[str, str]:
    headers = {
        "Design-Revision": str(report.revision),
        "Vary": "Accept",
        "Cache-Control": "no-store" if job else "no-cache",
        "Content-Security-Policy": PAGE_POLICY,
        "X-Content-Type-Options": "nosniff",
        "Content-Disposition": named(report.title, report.revision, kind, how="inline"),
    }
    return {**headers, "Location": f"/api/v1/jobs/{job}"} if job else {**headers, "ETag": tag(report, kind)}


def _wanted(what: str, kind: str | None, accept: str | None, kinds: Mapping[str, str]) -> str:
    """Return the format in the path, else the one that the client prefers, else the first.

    Raises
    ------
    NotFound
        If there is no such format.
    """
    if kind is not None:
        if kind not in kinds:
            raise NotFound(f"there is no {what}.{kind[:20]}; there are {', '.join(kinds)}")
        return kind
    weights = accepted_weights(accept)
    return max(kinds, key=lambda name: weights.get(kinds[name], 0.0))


def display(formula: str) -> Markup:
    """Return a MathML formula of the report, set on its own line."""
    return Markup(formula.replace('display="inline"', 'display="block"', 1))


jinja = environment(Path(__file__).with_name("pages"))
jinja.filters["display"] = display


def page(report: Report) -> str:
    """Return a report as HTML."""
    base = f"/api/v1/designs/{report.design}/revisions/{report.revision}"
    return jinja.get_template("report.html").render(
        report=report, units=report.units, path=f"{base}/report", base=base
    )
