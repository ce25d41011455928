"""`/evaluations/{job}`: the answer of a calculation, or of a preview, that went on as a job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from app.api import problems
from app.api.dependencies import TheJobs, TheStore
from app.api.gate.pacing import PiecesResponse
from app.api.waiting import LATER, accepted
from app.calculations.jobs import CALCULATION, PREVIEW
from app.jobs.errors import JobNotFound
from app.schemas.evaluations import AnyCalculation
from app.schemas.problems import refusals
from app.solids.errors import CannotRebuild
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.workers.pieces import Pieces

router = APIRouter(prefix="/api/v1/evaluations", tags=["templates"])


@router.get("/{job}", response_model=AnyCalculation, responses={**LATER, **refusals(404, 410)})
def show_evaluation(
    job: Annotated[str, Path(max_length=64)], jobs: TheJobs, store: TheStore, request: Request
) -> Response:
    """What `evaluate`, `solve`, `worksheet` or `preview` would have answered; 202 while the job goes on."""
    found = jobs.get(job)
    if found.kind not in (CALCULATION, PREVIEW):
        raise JobNotFound(job)
    if not found.finished:
        return accepted(job)
    if found.result is None:
        problem = found.problem or problems.problem(problems.INTERNAL, "the job left no answer")
        return problems.answer(problem)
    sha = found.result.rpartition("sha256=")[2]
    try:
        return PiecesResponse(Pieces.of(store.read(sha)), request.app.state.pace)
    except (ArtifactMissing, ArtifactDamaged) as error:
        detail = f"the answer of job {job} was lost. Send the calculation again, or restore a backup"
        raise CannotRebuild("answer_lost", detail) from error
