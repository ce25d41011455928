"""Measure the cost of the torsional stiffness of the reference throw at each level.

    python -m benchmarks.torsion

Each run has its own process with one thread; loading the libraries is not timed. The results are in
benchmarks/results/torsion.json.
"""

import json
import os
import resource
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any

from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.levels import NAMES
from cad.shaft import Shaft

RESULTS = Path("benchmarks/results/torsion.json")
TRUE = 456_600.0  # N·m/rad, shared/references: converged third-order elements
SHAFT = Shaft(-54.0, 54.0)
THROW = {
    "journal_diameter": 0.055, "journal_length": 0.040, "pin_diameter": 0.048, "pin_length": 0.032,
    "web_thickness": 0.018, "web_width": 0.080, "throw": 0.042, "fillet": 0.003,
}  # fmt: skip
TOLERANCE = 5e-3


def throw() -> dict[str, Any]:
    """Return the STEP file of the reference throw, built in a separate process that loads CadQuery."""
    from cad.regenerate import regenerate

    return {"step": regenerate("crank_throw", 1, THROW).step}


def ours(step: bytes, asked: AnalysisRequest) -> dict[str, Any]:
    """Return the stiffness [N·m/rad], and its cost."""
    stiffness = analyse(step, SHAFT, asked, ["stiffness"], lambda done, what: None).outputs["stiffness"]
    return {
        "stiffness": stiffness["value"],
        "estimated error": stiffness["error"],
        "level": stiffness["level"],
        **stiffness["mesh"],
    }


def greatest_stress(step: bytes) -> dict[str, Any]:
    """Return the greatest stress [MPa] under 1 N·m, and its cost."""
    outputs = ["maximum_stress"]
    stress = analyse(step, SHAFT, AnalysisRequest(), outputs, lambda done, what: None).outputs[
        "maximum_stress"
    ]
    return {"stress": stress["value"], "estimated error": stress["error"], **stress["mesh"]}


def alone(action: Callable[..., dict[str, Any]], *inputs: Any, times: int = 3) -> dict[str, Any]:
    """Run a function in new processes several times and return the fastest measurement."""
    runs = []
    for _ in range(times):
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            runs.append(pool.submit(timed, action, *inputs).result())
    return min(runs, key=lambda run: float(run["seconds"]))


def timed(action: Callable[..., dict[str, Any]], *inputs: Any) -> dict[str, Any]:
    """Run a function here; add seconds, error, and memory [MB], in total and above the libraries'."""
    loaded = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    start = perf_counter()
    result = action(*inputs)
    seconds = perf_counter() - start
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    memory = max(resource.getrusage(one).ru_maxrss for one in who) / 1024
    error = {"error": result["stiffness"] / TRUE - 1} if "stiffness" in result else {}
    return {
        **result,
        **error,
        "seconds": seconds,
        "megabytes": memory,
        "megabytes above the libraries": memory - loaded,
    }


def main() -> None:
    """Measure, print and store the results."""
    os.environ["OMP_NUM_THREADS"] = "1"
    step = alone(throw, times=1)["step"]
    own = alone(ours, step, AnalysisRequest(tolerance=TOLERANCE))
    levels = {level: alone(ours, step, AnalysisRequest(level=level)) for level in NAMES}
    stress = alone(greatest_stress, step, times=1)
    table = {
        "ours at 0.5 %": own,
        "levels": levels,
        "greatest stress": stress,
    }
    RESULTS.write_text(json.dumps(table, indent=1) + "\n")
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
