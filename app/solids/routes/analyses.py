"""`POST /models/{id}/versions/{n}/analyses/{kind}`, the results of an analysis, and its surface field."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from fastapi import APIRouter, Header, Path, Query, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheAnalyses, TheCatalogues, TheHealing, TheJobs, TheStore, Units
from app.api.file_answers import UNAVAILABLE, UNCHANGED, StoredFile, lost
from app.api.responses import accepted, finished, later, written
from app.catalogue.routes.templates import Number
from app.http import problems
from app.http.access import TheClient
from app.http.strict_requests import StrictRoute
from app.presentation.units import System
from app.schemas.problems import refusals
from app.solids.bodies import AnalysisIn
from app.solids.questions import (
    ON_REQUEST,
    faults,
    in_order,
    load_faults,
    load_of,
    not_offered,
    offered,
    question,
)
from app.solids.routes.models import FOR_EVER
from app.solids.schemas.analyses import Analysis, AnalysisList, Surface
from app.storage.errors import NotFound
from cad.analysis.kinds import KINDS
from cad.model import CadModel
from templates.core.errors import Fault, InvalidInputs

router = APIRouter(prefix="/api/v1", tags=["models"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64, examples=["crank_throw"])]
Kind = Annotated[
    str,
    Path(
        max_length=64,
        examples=["torsion"],
        description="`torsion`, `bending`, `unit_loads`, `chain` or `bore_compliance`",
    ),
]


@router.post(
    "/models/{id}/versions/{number}/analyses/{kind}",
    response_model=Analysis,
    responses={**later(Analysis), **refusals(404, 429)},
)
async def analyse_model(
    id: Id,
    number: Number,
    kind: Kind,
    body: AnalysisIn,
    catalogues: TheCatalogues,
    analyses: TheAnalyses,
    jobs: TheJobs,
    client: TheClient,
    prefer: Annotated[str | None, Header()] = None,
    units: Units = "si",
) -> Response:
    """Build a model, then compute stiffness, frequency or stress of its solid; equal requests run once.

    The shaft is held at one end; the other end is loaded by a torque about z (`torsion`), or a moment about
    y in the plane of the throw (`bending`). Stress is the largest von Mises stress under `load`, by default
    1 N·m. For one throw, `unit_loads` returns tables: the stress tensors at points of its fillets under 1 kN
    on the pin along and across the throw, and under torque and bending moments of 1 kN·m. `chain` analyses a
    shaft of several throws, from its first main journal to its last: its stiffness, that of each throw, and
    its frequency. `bore_compliance` analyses a bearing housing or a connecting rod: how far its bore deforms
    under the pressure modes of an oil film.
    """
    if kind not in KINDS:
        raise NotFound(f"there is no analysis {kind[:60]!r}; there are {', '.join(KINDS)}")
    cls = catalogues.models.get(id, number)
    outputs = _checked(cls, kind, body)
    shape, asked = cls.from_quantities(body.parameters), question(kind, body)
    job = await run_in_threadpool(analyses.request, shape, asked, outputs, client)
    if not await finished(jobs, job, prefer):
        return accepted(job, await run_in_threadpool(analyses.show, shape, asked, ()))
    if failed := await run_in_threadpool(jobs.problem, job):
        return problems.answer(failed)
    analysis = await run_in_threadpool(analyses.show, shape, asked, outputs)
    return written(analysis.in_units(units))


@router.get("/analyses/{key}", responses=refusals(404))
def show_analysis(
    key: str,
    analyses: TheAnalyses,
    load: Annotated[str, Query(max_length=60, description="the load of the stress")] = "1 N*m",
    units: Units = "si",
) -> Analysis:
    """Return all outputs of one analysis of one solid, scaled to a load.

    The outputs were computed once for all loads.
    """
    wrong = load_faults(load)
    analysis = analyses.show_all(key, 1.0 if wrong else load_of(load))  # 404 comes first
    if wrong:
        raise InvalidInputs(wrong)
    return analysis.in_units(units)


@router.get("/builds/{key}/analyses", responses=refusals(404))
def list_analyses_of_build(key: str, analyses: TheAnalyses, units: Units = "si") -> AnalysisList:
    """Return all analyses of one solid, with their answers under 1 N·m."""
    return AnalysisList(items=analyses.of_build(key)).in_units(units)


@router.get(
    "/analyses/{key}/surface",
    response_model=Surface,
    responses={
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404),
    },
)
async def show_surface(
    key: str,
    analyses: TheAnalyses,
    store: TheStore,
    healing: TheHealing,
    jobs: TheJobs,
    units: Units = "si",
    if_none_match: Annotated[str | None, Header(description="the ETag of a surface that is at hand")] = None,
    prefer: Annotated[str | None, Header()] = None,
) -> Response:
    """Return the solid's surface under a load of 1 N·m: the displacement, twist and stress of every point.

    It is meant for a picture and has the corners of plane triangles, with a value at each. It never changes.
    It exists once an analysis was requested with `"outputs": ["surface"]`, whose answer links to it.
    """
    file = await run_in_threadpool(analyses.surface, key)
    shown = "" if units == "si" else f"-{units}"
    headers = {"ETag": f'"{file.sha256}{shown}"', "Cache-Control": FOR_EVER}
    if if_none_match and headers["ETag"] in if_none_match:
        return Response(status_code=304, headers=headers)
    if answer := await lost(file.sha256, healing, jobs, prefer):
        return answer
    file = await run_in_threadpool(analyses.surface, key)
    headers["ETag"] = f'"{file.sha256}{shown}"'
    if shown:
        return await run_in_threadpool(_converted, store.read, file.sha256, units, headers)
    return StoredFile(store, file.sha256, "application/json", headers)


def _converted(read: Callable[[str], bytes], sha256: str, units: System, headers: dict[str, str]) -> Response:
    surface = Surface.model_validate_json(read(sha256)).in_units(units)
    return written(surface, headers=headers)


def _checked(cls: type[CadModel], kind: str, body: AnalysisIn) -> tuple[str, ...]:
    """Return the requested outputs, if the body has no faults besides those of its parameters."""
    asked = [name for name in KINDS[kind] if name not in ON_REQUEST] if body.outputs is None else body.outputs
    names = ", ".join(offered(kind))
    wrong = faults(kind, body)
    wrong += [
        Fault("outputs", "unknown_name", f"{name[:40]!r} is not one of {names}")
        for name in asked
        if name not in offered(kind)
    ]
    if not asked:
        wrong.append(Fault("outputs", "empty", f"name at least one of {names}"))
    if refused := not_offered(cls, kind):
        wrong.append(refused)
    if wrong:
        raise InvalidInputs(wrong)
    return in_order(kind, asked)
