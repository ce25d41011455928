"""Questions about a design: which value gives a wanted output, and what its tolerances do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.client.exchange import Exchange, Progress, calculated, post
from app.schemas.solve import DesignSolution
from app.schemas.tolerances import ToleranceAnalysis


def solve_design(
    id: str,
    unknown: str,
    between: Sequence[object],
    target: Mapping[str, object],
    *,
    tolerance: float | None = None,
    on_progress: Progress | None = None,
) -> Exchange[DesignSolution]:
    """Every value of a parameter or input between two bounds that gives a wanted output."""
    body: dict[str, object] = {"unknown": unknown, "between": list(between), "target": dict(target)}
    body |= {} if tolerance is None else {"tolerance": tolerance}
    return calculated(DesignSolution, post(f"/designs/{id}/solve", body), on_progress)


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
    """Worst case, scatter, shares and yields of outputs, those that criteria judge if none are named."""
    sampling = {"points": points, "seed": seed, "levels": dict(levels or {})}
    body = {"outputs": outputs, "criteria": criteria, **sampling}
    return calculated(ToleranceAnalysis, post(f"/designs/{id}/tolerance", body), on_progress)
