"""Tables of stress tensors under unit loads: outputs of an analysis, which relations use."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import pi
from typing import Any

from cad.analysis.kinds import KINDS, TABLES, UNIT_LOADS, Level
from cad.analysis.mesh import Fineness
from cad.analysis.unit_loads import LOADS, LoadedThrow, UnitStresses, fillet_stresses
from cad.errors import AnalysisError
from cad.fillets import Crank
from cad.shaft import Shaft
from templates.core.arrays import Array

LEVELS: dict[Level, tuple[Fineness, int]] = {
    "coarse": (Fineness(size=0.9, curvature=0.5, turn=pi / 3), 2),
    "default": (Fineness(size=0.7, curvature=0.8, turn=pi / 4), 3),
    "fine": (Fineness(size=0.6, curvature=1.1, turn=pi / 5), 3),
}
"""Mesh and order of the elements at each level."""

NO_ERROR = "how far these tensors depend on the mesh is not estimated: compare two levels"

_PER_UNIT = {"force": 1e3, "moment": 1e6}  # N per kN, N·mm per kN·m


def unit_load_tables(
    step: bytes, shaft: Shaft, crank: Crank, level: Level, report: Callable[[float, str], None]
) -> dict[str, dict[str, Any]]:
    """Return all outputs of the kind `unit_loads`, which one set of solutions provides together.

    If the throw has no fillets, or its pin has no plain cylinder, the values are None, and the reason is
    stated.
    """
    started = time.perf_counter()
    report(0.0, "reading and meshing the solid")
    fineness, order = LEVELS[level]
    throw = LoadedThrow(step, shaft, crank, fineness, order)
    elements = throw.system.grid.mesh.ne

    def before(load: str) -> None:
        report(0.1 + 0.17 * LOADS.index(load), f"solving {elements} elements under a unit of {load}")

    values: dict[str, list[list[float]]] = {}
    reason = ""
    try:
        values = as_tables(fillet_stresses(throw, before))
    except AnalysisError as error:
        reason = error.detail
    common = {
        "error": None,
        "level": level,
        "mesh": {
            "elements": elements,
            "degrees_of_freedom": throw.system.space.ndof,
            "order": order,
            "mirror_plane": None,
        },
        "seconds": time.perf_counter() - started,
    }
    report(1.0, "done")
    return {
        name: {
            "value": values.get(name),
            "unit": unit,
            "columns": [*TABLES[name]],
            **common,
            **({"reason": reason} if reason else {"error_reason": NO_ERROR}),
        }
        for name, unit in KINDS[UNIT_LOADS].items()
    }


def as_tables(stresses: UnitStresses) -> dict[str, list[list[float]]]:
    """Convert the tensors under 1 N or 1 N·mm, and their points, to the units of the outputs."""
    tables: dict[str, Array] = {"points": stresses.points}
    for load, tensors in stresses.tensors.items():
        tables[f"stress_of_{load}"] = _PER_UNIT[load.split("_")[0]] * tensors
    return {name: table.tolist() for name, table in tables.items()}
