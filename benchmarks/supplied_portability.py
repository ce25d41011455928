"""How far level `supplied` of `oil_film_cycle` 2 differs between processors and compilers, on its example.

    nice python -m benchmarks.supplied_portability

A march picks its steps by the gap, so a last digit may move a step, an iteration or a cycle. Each row marches
the example's golden case in a process of its own, as another processor or compiler would, or with every input
off by a few of the last digits; and prints the largest relative difference of each group of outputs from the
plain run. The tolerances of the golden record rest on it (`level_precision` of the template).
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from templates.core.catalogue.golden import results
from templates.oil_film.oil_film_cycle_v2 import OilFilmCycle

LEVEL = "supplied"
GOLDEN = Path("tests/golden/oil_film_cycle_v2.json")
ELSEWHERE: dict[str, dict[str, str]] = {
    "this processor": {},
    "no AVX (NUMBA_CPU_NAME=generic)": {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""},
    "Haswell code": {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx2,+fma"},
    "compiler level 0": {"NUMBA_OPT": "0"},
    "compiler level 1": {"NUMBA_OPT": "1"},
    "BLAS for Haswell": {"OPENBLAS_CORETYPE": "Haswell"},
    "BLAS for Prescott": {"OPENBLAS_CORETYPE": "Prescott"},
    "BLAS for SkylakeX": {"OPENBLAS_CORETYPE": "SkylakeX"},
    "NumPy without AVX": {"NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3 AVX512F AVX512CD AVX512_SKX"},
    "all of the oldest": {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "OPENBLAS_CORETYPE": "Prescott",
        "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3 AVX512F AVX512CD AVX512_SKX",
    },
}
NUDGES = (1e-15, 1e-14, 1e-13, 1e-12, 1e-10)
SEEDS = 3


def case() -> dict[str, Any]:
    """The golden case of the level."""
    cases = json.loads(GOLDEN.read_text(encoding="utf-8"))["levels"]
    return next(case for case in cases if case["level"] == LEVEL)


def nudged(inputs: dict[str, Any], nudge: float, seed: int) -> dict[str, Any]:
    """Inputs whose loads are off by random shares of the nudge."""
    rng = np.random.default_rng(seed)
    moved = dict(inputs)
    for name in ("load_x", "load_y"):
        load = np.asarray(inputs[name])
        moved[name] = (load * (1 + rng.uniform(-nudge, nudge, load.shape))).tolist()
    return moved


def one(nudge: float, seed: int) -> None:
    """Print the outputs of a run as JSON."""
    print(json.dumps(results(OilFilmCycle, nudged(case()["inputs"], nudge, seed), LEVEL)))


def run(environment: dict[str, str], nudge: float = 0.0, seed: int = 0) -> dict[str, Any]:
    """The outputs of a run in a process of its own, with machine code of its own."""
    with tempfile.TemporaryDirectory() as folder:
        own = {"NUMBA_CACHE_DIR": folder} if environment else {}
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.supplied_portability", "one", str(nudge), str(seed)],
            env=os.environ | own | environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
    if done.returncode:
        raise SystemExit(done.stderr[-2000:])
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def differences(one: dict[str, Any], other: dict[str, Any]) -> dict[str, float]:
    """The largest relative difference of each output that differs; infinite where a text does."""
    largest = {}
    for name, value in one.items():
        if isinstance(value, str) or value is None or other[name] is None:
            largest[name] = 0.0 if value == other[name] else np.inf
        else:
            a, b = np.asarray(value, float), np.asarray(other[name], float)
            largest[name] = float(np.nanmax(np.abs(b - a) / np.maximum(np.abs(a), 1e-300)))
    return {name: off for name, off in largest.items() if off > 0}


def row(words: str, off: dict[str, float]) -> None:
    """Print the outputs that differ most."""
    worst = sorted(off.items(), key=lambda item: -item[1])[:6]
    print(f"{words:34}" + ", ".join(f"{name} {size:.1e}" for name, size in worst), flush=True)


def main() -> None:
    """Print a row for each other processor and each nudge."""
    plain = run({})
    for words, environment in ELSEWHERE.items():
        row(words, differences(plain, run(environment)))
    for nudge in NUDGES:
        for seed in range(SEEDS):
            row(f"load off by {nudge:.0e}, seed {seed}", differences(plain, run({}, nudge, seed)))


if __name__ == "__main__":
    if sys.argv[1:2] == ["one"]:
        one(float(sys.argv[2]), int(sys.argv[3]))
    else:
        main()
