"""Measure finite elements of the reference throw: stiffness at 0.5 %, greatest stress, and memory."""

from __future__ import annotations

import time

from benchmarks.speed.figures import Figure, most_memory
from benchmarks.torsion import THROW, TOLERANCE, alone, throw
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.shaft import Shaft

SHAFT = Shaft(-54.0, 54.0)
ASKED = {"stiffness": AnalysisRequest(tolerance=TOLERANCE), "maximum_stress": AnalysisRequest()}


def figures() -> list[Figure]:
    """Return the cost of both outputs, each in its own process that has already loaded the libraries."""
    step = alone(throw, times=1)["step"]
    stiffness = alone(analysed, step, "stiffness", times=3)
    stress = alone(analysed, step, "maximum_stress", times=1)
    of = f"throw {1e3 * THROW['throw']:g} mm, estimated error"
    return [
        Figure(
            "K of the reference throw at 0.5 %",
            stiffness["spent"],
            "s",
            0.5,
            detail=f"{of} {100 * stiffness['error']:.2g} %",
        ),
        Figure(
            "greatest stress of the reference throw",
            stress["spent"],
            "s",
            10.0,
            detail=f"{of} {100 * stress['error']:.2g} %",
        ),
        Figure("its peak memory", stress["most memory"], "MB", 800.0, detail="the whole process"),
    ]


def analysed(step: bytes, output: str) -> dict[str, float]:
    """Return the processor time [s], estimated error and peak memory [MB] of one output."""
    begin = time.process_time()
    answer = analyse(step, SHAFT, ASKED[output], [output], lambda done, what: None).outputs[output]
    spent = time.process_time() - begin
    return {"spent": spent, "error": float(answer["error"] or 0.0), "most memory": most_memory()}
