"""Compute the compliance of a split bore as outputs, which relations pass to `elastic_film` 1."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from cad.analysis.bore import RIGID, BoreFineness, bore_mesh, compliance_on, read_bored
from cad.analysis.kinds import BORE_COMPLIANCE, KINDS, TABLES, Level
from cad.shaft import BorePlace
from templates.core.arrays import Array

LEVELS: dict[Level, tuple[BoreFineness, int]] = {
    "coarse": (BoreFineness(bore=0.4, body=0.8), 3),
    "default": (BoreFineness(bore=0.4, body=0.8), 4),
    "fine": (BoreFineness(bore=0.25, body=0.5), 4),
}
"""Mesh and order of the elements at each level."""

WORST = 0.25
"""Relative error from which no value is returned."""

_PER_GPA = 1e6  # mm/MPa in um/GPa


def bore_tables(
    step: bytes, place: BorePlace, level: Level, report: Callable[[float, str], None]
) -> dict[str, dict[str, Any]]:
    """Return all outputs of the kind `bore_compliance`.

    The error is the change from elements of the next lower order.
    """
    started = time.perf_counter()
    report(0.0, "reading and meshing the solid")
    fineness, order = LEVELS[level]
    mesh = bore_mesh(read_bored(step, place), fineness)
    matrices: list[Array] = []
    freedoms = 0
    for begin, one in ((0.1, order - 1), (0.4, order)):
        words = f"solving {mesh.ne} elements of order {one}"
        length = begin + 0.2

        def on_this_order(
            done: float, begin: float = begin, length: float = length, words: str = words
        ) -> None:
            report(begin + length * done, words)

        matrix, freedoms = compliance_on(mesh, one, place, report=on_this_order)
        matrices.append(matrix)
    error = difference(*matrices)
    symmetric = (matrices[-1] + matrices[-1].T) / 2
    values: dict[str, Any] = {
        "compliance": (_PER_GPA * symmetric).tolist(),
        "modulus": place.material.young * 1e-9,
        "poisson_ratio": place.material.poisson,
        "bore_width": 2 * place.half_width,
    }
    answers: dict[str, dict[str, Any]] = {}
    for name, unit in KINDS[BORE_COMPLIANCE].items():
        answers[name] = {
            "value": values[name],
            "unit": unit,
            "error": error if name in TABLES else 0.0,
            "level": level,
            "mesh": {
                "elements": mesh.ne,
                "degrees_of_freedom": freedoms,
                "order": order,
                "mirror_plane": "xy",
            },
            "seconds": time.perf_counter() - started,
        }
        if name in TABLES:
            answers[name]["columns"] = [*TABLES[name]]
    if not error < WORST:
        reason = f"the elements of level {level} are too large for this solid: ask for a finer one"
        answers["compliance"] |= {"value": None, "error": WORST, "reason": reason}
    report(1.0, "done")
    return answers


def difference(low: Array, high: Array) -> float:
    """Return the relative difference of two matrices in the spectral norm, without rigid motion."""
    kept = np.ix_(~RIGID, ~RIGID)
    return float(np.linalg.norm(low[kept] - high[kept], 2) / np.linalg.norm(high[kept], 2))
