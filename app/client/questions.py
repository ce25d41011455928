"""The client's calls to solve a design for an input, analyse tolerances, and show the impact of a version."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.answers.schemas import DesignAnswer
from app.client.design_operations import change
from app.client.exchange import Exchange, Progress, calculated, post
from app.designs.schemas.designs import Design
from app.designs.schemas.solution import DesignSolution
from app.impact.schemas import Impact
from app.presentation.units import System
from app.tolerances.schemas import ToleranceAnalysis


def solve_design(
    id: str,
    unknown: str,
    between: Sequence[object],
    target: Mapping[str, object],
    *,
    tolerance: float | None = None,
    others: Mapping[str, object] | None = None,
    on_progress: Progress | None = None,
) -> Exchange[DesignSolution]:
    """Return every value of a parameter or input between two bounds that gives a wanted output.

    `others` replaces values of the design for this calculation only: `{"film.speed": "7000 rpm"}`.
    """
    body: dict[str, object] = {"unknown": unknown, "between": list(between), "target": dict(target)}
    body |= {} if tolerance is None else {"tolerance": tolerance}
    body |= {"with": dict(others)} if others else {}
    return calculated(DesignSolution, post(f"/designs/{id}/solve", body), on_progress)


def answer(
    design: str | Mapping[str, object],
    free: Mapping[str, Mapping[str, object]],
    *,
    require: Sequence[str] | None = None,
    minimise: str | None = None,
    maximise: str | None = None,
    options: Mapping[str, object] | None = None,
    revision: int | None = None,
    key: str | None = None,
    on_progress: Progress | None = None,
) -> Exchange[DesignAnswer]:
    """Return the values of free places that meet requirements, or the requirements that conflict.

    `design` is the id of a design, a name of the gallery, or a document. `options` are the other members of
    the body, such as `targets`, `with`, `set_aside`, `tolerance`, `files` and `save`; to save into a design,
    give the `revision` that was read.
    """
    goals = {"require": require, "minimise": minimise, "maximise": maximise}
    body: dict[str, object] = {"design": design, "free": free, **(options or {})}
    body |= {name: goal for name, goal in goals.items() if goal is not None}
    headers = {} if revision is None else {"If-Match": f'"{revision}"'}
    headers |= {} if key is None else {"Idempotency-Key": key}
    return calculated(DesignAnswer, post("/answer", body, headers), on_progress)


def tolerance(
    id: str,
    outputs: list[str] | None = None,
    criteria: list[str] | None = None,
    *,
    points: int | None = None,
    seed: int = 1,
    levels: Mapping[str, str] | None = None,
    on_progress: Progress | None = None,
) -> Exchange[ToleranceAnalysis]:
    """Return worst case, scatter, contributions and yields of outputs, by default those with criteria."""
    sampling = {"points": points, "seed": seed, "levels": dict(levels or {})}
    body = {"outputs": outputs, "criteria": criteria, **sampling}
    return calculated(ToleranceAnalysis, post(f"/designs/{id}/tolerance", body), on_progress)


def impact(
    template: str,
    version: int,
    designs: Sequence[str] | None = None,
    *,
    name: str | None = None,
    tags: Sequence[str] = (),
    limit: int = 100,
    units: System = "si",
    on_progress: Progress | None = None,
) -> Exchange[Impact]:
    """Return how this version would change the designs that use another version, worst first; saves nothing.

    It covers all designs that are not archived, unless ids, a part of the name or tags select some.
    """
    chosen = {"designs": None if designs is None else [*designs], "name": name}
    body = {**chosen, "tags": [*tags], "limit": limit}
    path = f"/templates/{template}/versions/{version}/impact?units={units}"
    return calculated(Impact, post(path, body), on_progress)


def upgrade(
    design: Design,
    template: str,
    version: int,
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[Design]:
    """Create a new revision that uses this version in every step of the template.

    The design must have been read before.
    """
    steps = {name: {"version": version} for name, step in design.steps.items() if step.template == template}
    patch = {"steps": steps, "note": f"{template} version {version}"}
    return change(design, patch, on_progress=on_progress, key=key)
