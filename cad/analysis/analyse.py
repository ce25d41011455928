"""Compute the requested outputs of an analysis of a STEP file, each with its error, as a pure function."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from cad.analysis.elastic import Response, System, respond
from cad.analysis.kinds import KINDS, SURFACE, Boundary, Kind
from cad.analysis.levels import Level, ladder
from cad.analysis.mesh import Grid, make_grid
from cad.analysis.modes import torsional_mode
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import CONVERGED, SMALL, greatest_stress, searched
from cad.analysis.surface import surface
from cad.errors import AnalysisError
from cad.shaft import Shaft

Report = Callable[[float, str], None]

MODE = "torsional_frequency"
"""The output for which the same system is solved many times."""

WORST = 0.25
"""Relative error from which no value is returned."""


@dataclass(frozen=True)
class AnalysisRequest:
    """A requested analysis: its outputs, and a level or a relative tolerance that determines the level."""

    load: Kind = "torsion"
    boundary: Boundary = "free_end"
    level: str | None = None
    tolerance: float | None = None


@dataclass(frozen=True)
class AnalysisResult:
    """The results of an analysis by output: value in the unit of `KINDS`, or surface, with error and mesh."""

    outputs: dict[str, dict[str, Any]] = field(default_factory=dict)


def analyse(
    step: bytes, shaft: Shaft, request: AnalysisRequest, outputs: Collection[str], report: Report
) -> AnalysisResult:
    """Compute only the requested outputs of an analysis.

    Raises
    ------
    AnalysisError
        If the solid is not a shaft, or cannot be meshed.
    """
    report(0.0, "reading the solid")
    solid = read_solid(step, shaft)
    results: dict[str, dict[str, Any]] = {}
    elastic = [name for name in outputs if name != "maximum_stress"]
    if elastic:
        results |= _elastic_results(solid, shaft, request, elastic, report)
    if "maximum_stress" in outputs:
        results["maximum_stress"] = _stress(solid, shaft, request, report)
    report(1.0, "done")
    return AnalysisResult(results)


def _elastic_results(
    solid: Solid, shaft: Shaft, request: AnalysisRequest, outputs: Collection[str], report: Report
) -> dict[str, dict[str, Any]]:
    """Refine level by level until every output meets the tolerance.

    A surface is refined until its stiffness meets the tolerance.
    """
    results: dict[str, dict[str, Any]] = {}
    measured = [name for name in outputs if name in _ELASTIC]
    if not measured and request.tolerance is not None:
        measured = ["stiffness"]
    rungs = ladder(request.level, request.tolerance)
    for number, level in enumerate(rungs):

        def on_this_rung(done: float, what: str, number: int = number) -> None:
            report(_ELASTIC_SHARE * (number + done) / len(rungs), what)

        results = _at_level(solid, shaft, request, level, {*measured, *outputs}, on_this_rung)
        worst = max((results[name]["error"] or 0.0 for name in measured), default=0.0)
        if request.tolerance is None or worst <= request.tolerance:
            break
    return {name: results[name] for name in outputs}


def _at_level(
    solid: Solid,
    shaft: Shaft,
    request: AnalysisRequest,
    level: Level,
    outputs: Collection[str],
    report: Report,
) -> dict[str, dict[str, Any]]:
    started = time.perf_counter()
    report(0.1, f"level {level.name}: meshing")
    fineness = level.fineness if SURFACE not in outputs else replace(level.fineness, least=0.0)
    grid = make_grid(solid, fineness)
    wanted = {name: compute for name, compute in _ELASTIC.items() if name in outputs}
    values: dict[str, list[float]] = {name: [] for name in wanted}
    reasons: dict[str, str] = {}
    for order in (level.order - 1, level.order) if wanted else (level.order,):
        report(0.2 if order < level.order else 0.5, f"solving {grid.mesh.ne} elements of order {order}")
        system = System(grid, order, shaft.material, request.load, few_forces=MODE not in wanted)
        response = respond(system, request.boundary)
        for name, compute in wanted.items():
            try:
                values[name].append(compute(response))
            except AnalysisError as error:  # only this output is refused
                reasons[name] = error.detail
    shown = surface(response) if SURFACE in outputs else None
    common = {
        "level": level.name,
        "mesh": _mesh(solid, grid.mesh.ne, response.system.space.ndof, level.order),
        "seconds": time.perf_counter() - started,
    }
    results: dict[str, dict[str, Any]] = {}
    for name in wanted:
        about = {"unit": KINDS[request.load][name], **common}
        if name in reasons:
            results[name] = {"value": None, "error": None, **about, "reason": reasons[name]}
        else:
            results[name] = {**_judged(values[name], level, grid), **about}
    if shown:
        results[SURFACE] = {"value": shown, "error": None, **common}
    return results


def _judged(values: Sequence[float], level: Level, grid: Grid) -> dict[str, Any]:
    """Return the value of the higher order with its error.

    Return None if the orders differ so much that some elements must be folded.
    """
    low, high = values
    if min(low, high) > 0:
        likely = level.error(low, high, is_sharp=grid.is_sharp, is_resolved=grid.is_resolved)
        if likely < WORST:
            return {"value": high, "error": likely}
    reason = f"the elements of level {level.name} are too large for this solid: ask for a finer one"
    return {"value": None, "error": WORST, "reason": reason}


def _stress(solid: Solid, shaft: Shaft, request: AnalysisRequest, report: Report) -> dict[str, Any]:
    started = time.perf_counter()
    peaks = greatest_stress(
        solid,
        shaft.material,
        request.load,
        request.boundary,
        lambda n: report(_ELASTIC_SHARE + 0.08 * n, f"stress, mesh {n + 1}"),
    )
    last = peaks.steps[-1]
    common = {
        "unit": "MPa",
        "error": peaks.error,
        "convergence": [
            {"elements": peak.elements, "order": peak.order, "value": _per_newton_metre(peak.value)}
            for peak in peaks.steps
        ],
        "point": {"value": list(last.point), "unit": "mm"},
        "searched": {"value": list(searched(solid)), "unit": "mm"},
        "level": None,
        "mesh": _mesh(solid, last.elements, last.degrees_of_freedom, last.order),
        "seconds": time.perf_counter() - started,
    }
    if peaks.converged:
        return {"value": _per_newton_metre(last.value), **common}
    reason = (
        f"the greatest stress did not settle: the last refinement changed it by {peaks.change_by_mesh:.1%} "
        f"({SMALL:.0%} is permitted), elements of third order by {peaks.change:.1%} ({CONVERGED:.0%}); "
        "at a sharp inner corner it has no limit, give it a fillet"
    )
    return {"value": None, **common, "reason": reason}


def _mesh(solid: Solid, elements: int, degrees_of_freedom: int, order: int) -> dict[str, Any]:
    return {
        "elements": elements,
        "degrees_of_freedom": degrees_of_freedom,
        "order": order,
        "mirror_plane": {"": None, "x": "yz", "y": "xz"}[solid.mirror],
    }


def _per_newton_metre(stress: float) -> float:
    """Convert a stress [MPa] under 1 N·mm to that under 1 N·m."""
    return stress * 1e3


def _stiffness(response: Response) -> float:
    """Return the torque or moment per rotation [N·m/rad]."""
    return 1e-3 / response.compliance


_ELASTIC_SHARE = 0.6  # share of the progress if the analysis also searches for the highest stress
_ELASTIC: dict[str, Callable[[Response], float]] = {
    "stiffness": _stiffness,
    MODE: lambda response: torsional_mode(response).frequency,
}
