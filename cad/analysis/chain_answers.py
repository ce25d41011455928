"""Compute the outputs of the analysis `chain`, each with its error, from the chain of a shaft's throws.

Each solid is meshed once and solved with elements of two orders. The error of an output has two parts: the
mesh error, from the two orders as for every other analysis (`cad.analysis.levels`), and the difference
between the chain and finite elements of the whole shaft. The second part is `OF_THE_CHAIN`, which exceeds the
largest differences found for three shafts, free and guided (`python -m benchmarks.crank_chain`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cad.analysis.chain import Chain
from cad.analysis.kinds import CHAIN, KINDS, Boundary
from cad.analysis.levels import Level, ladder
from cad.analysis.mesh import make_grid
from cad.analysis.solid import read_solid
from cad.analysis.throw_matrix import ThrowMatrix, matrix_on
from cad.shaft import PlacedThrow, ThrowsApart

Report = Callable[[float, str], None]

OF_THE_CHAIN = {"stiffness": 0.003, "throw_stiffnesses": 0.005, "torsional_frequency": 0.01}
"""Relative error of the chain model."""

WORST = 0.25
"""Relative error from which no value is returned."""


@dataclass(frozen=True)
class SolvedThrows:
    """The solutions of throws with elements of two orders, the lower order first."""

    low: Sequence[ThrowMatrix]
    high: Sequence[ThrowMatrix]
    elements: int  # of all solids together
    degrees_of_freedom: int
    is_sharp: bool  # any of the solids
    is_resolved: bool  # all of them


def chain_answers(
    apart: ThrowsApart, boundary: Boundary, level: str | None, tolerance: float | None, report: Report
) -> dict[str, dict[str, Any]]:
    """Return all outputs of the kind `chain`, which one calculation provides together.

    With a tolerance, refine level by level.
    """
    answers: dict[str, dict[str, Any]] = {}
    rungs = ladder(level, tolerance)
    for number, rung in enumerate(rungs):

        def on_this_rung(done: float, what: str, number: int = number) -> None:
            report((number + done) / len(rungs), what)

        started = time.perf_counter()
        solved = solve(apart, rung, on_this_rung)
        answers = judged(solved, apart.places, boundary, rung, time.perf_counter() - started)
        if tolerance is None or max(answer["error"] for answer in answers.values()) <= tolerance:
            break
    report(1.0, "done")
    return answers


def solve(apart: ThrowsApart, level: Level, report: Report) -> SolvedThrows:
    """Return the matrices of each solid, computed on its mesh at one level."""
    orders = (level.order - 1, level.order)
    matrices: tuple[list[ThrowMatrix], list[ThrowMatrix]] = ([], [])
    elements, freedoms, is_sharp, is_resolved = 0, 0, False, True
    for number, one in enumerate(apart.solids):
        which = f"level {level.name}, throw {number + 1} of {len(apart.solids)}"
        report(number / len(apart.solids), f"{which}: meshing")
        grid = make_grid(read_solid(one.step, one.shaft, mirrors=()), level.fineness)
        elements += grid.mesh.ne
        is_sharp, is_resolved = is_sharp or grid.is_sharp, is_resolved and grid.is_resolved
        for place, order in enumerate(orders):
            done = (number + 0.1 + 0.4 * place) / len(apart.solids)
            report(done, f"{which}: solving {grid.mesh.ne} elements of order {order}")
            matrix = matrix_on(grid, order, one.shaft, one.pin)
            matrices[place].append(matrix)
        freedoms += matrices[1][-1].degrees_of_freedom
    return SolvedThrows(*matrices, elements, freedoms, is_sharp, is_resolved)


def judged(
    solved: SolvedThrows, places: Sequence[PlacedThrow], boundary: Boundary, level: Level, seconds: float
) -> dict[str, dict[str, Any]]:
    """Return the outputs of the higher order with their errors; no value if the orders differ too much."""
    guided = boundary == "guided_end"
    low, high = (values_of(chain_of(each, places), guided=guided) for each in (solved.low, solved.high))
    common = {
        "level": level.name,
        "mesh": {
            "elements": solved.elements,
            "degrees_of_freedom": solved.degrees_of_freedom,
            "order": level.order,
            "mirror_plane": None,
        },
        "seconds": seconds,
    }
    answers: dict[str, dict[str, Any]] = {}
    for name, unit in KINDS[CHAIN].items():
        pairs = list(zip(np.atleast_1d(low[name]), np.atleast_1d(high[name]), strict=True))
        error, value = WORST, None
        if all(0 < number < np.inf for pair in pairs for number in pair):
            about = {"is_sharp": solved.is_sharp, "is_resolved": solved.is_resolved}
            of_the_mesh = max(level.error(*pair, **about) for pair in pairs)
            error, value = float(of_the_mesh) + OF_THE_CHAIN[name], high[name]
        answer: dict[str, Any] = {"value": value, "unit": unit, "error": error, **common}
        if error >= WORST:
            reason = f"the elements of level {level.name} are too large for this shaft: ask for a finer one"
            answer |= {"value": None, "error": WORST, "reason": reason}
        answers[name] = answer
    return answers


def chain_of(matrices: Sequence[ThrowMatrix], places: Sequence[PlacedThrow]) -> Chain:
    """Return the throws of a shaft at their positions."""
    return Chain([matrices[place.solid] for place in places], [place.angle for place in places])


def values_of(chain: Chain, *, guided: bool) -> dict[str, float | list[float]]:
    """Return the outputs of a chain in their declared units."""
    return {
        "stiffness": chain.stiffness(guided=guided),
        "throw_stiffnesses": chain.throw_stiffnesses(guided=guided).tolist(),
        "torsional_frequency": chain.frequency(guided=guided),
    }
