"""The greatest stress of random stepped shafts on their solids, against solutions in the half plane.

    python -m benchmarks.random_shoulders [COUNT] [SEED]

Draws stepped shafts: the narrow end 30 to 60 mm, the wide one 1.1 to 2 times that, the fillet 0.04 to 0.2 of
the narrow diameter. Every other one is twisted, every other one bent. The stress on the solid is computed as
for the output `maximum_stress`. Its stated error is compared with the difference from
`benchmarks.first_harmonic`. A shaft takes about 10 s of processor time. Results in
benchmarks/results/random_shoulders.json.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from math import pi, sqrt
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.first_harmonic import HalfPlane, bending, torsion
from benchmarks.shoulder_fillet import shoulder
from cad.analysis.kinds import Kind
from cad.analysis.solid import read_solid
from cad.analysis.stress import first_principal, greatest_stress, von_mises
from cad.shaft import STEEL_MATERIAL, Shaft

RESULTS = Path("benchmarks/results/random_shoulders.json")
COUNT, SEED = 24, 11
MEASURES = {"torsion": von_mises, "bending": first_principal}
LOADS: tuple[Kind, ...] = ("torsion", "bending")


def drawn(seed: int, number: int) -> HalfPlane:
    """A random stepped shaft [mm]; either end is as long as 1.5 times its diameter."""
    rng = np.random.default_rng([seed, number])
    narrow = float(rng.uniform(30, 60))
    wide = narrow * float(rng.uniform(1.1, 2.0))
    fillet = min(narrow * float(np.exp(rng.uniform(np.log(0.04), np.log(0.2)))), 0.45 * (wide - narrow))
    sizes = (round(one, 2) for one in (wide / 2, narrow / 2, 1.5 * wide, fillet, 1.5 * (wide + narrow)))
    return HalfPlane(*sizes)


def compared(half: HalfPlane, load: Kind) -> dict[str, Any]:
    """One shaft under one load, both ways."""
    plane = torsion(half) if load == "torsion" else bending(half, "free_end")
    step = shoulder(half.fillet, half.end, 2 * half.wide, 2 * half.narrow, half.shoulder)
    solid, begin = read_solid(step, Shaft(0.0, half.end)), process_time()
    peaks = greatest_stress(solid, STEEL_MATERIAL, load, "free_end", lambda step: None, MEASURES[load])
    nominal = sqrt(3) * 2 / pi / half.narrow**3 if load == "torsion" else 4 / pi / half.narrow**3
    return {
        "load": load,
        "shaft": asdict(half),
        "factor": plane.stress / nominal,
        "difference": peaks.steps[-1].value / plane.stress - 1,
        "stated error": peaks.error,
        "has converged": peaks.converged,
        "seconds": round(process_time() - begin, 2),
    }


def main() -> None:
    """Compare, print and keep."""
    count, seed = (int(one) for one in (*sys.argv[1:], *map(str, (COUNT, SEED)[len(sys.argv) - 1 :])))
    rows = []
    for number in range(count):
        rows.append(compared(drawn(seed, number), LOADS[number % 2]))
        print(json.dumps(rows[-1]), flush=True)
    held = sum(abs(row["difference"]) <= row["stated error"] for row in rows)
    worst = max(abs(row["difference"]) for row in rows)
    print(
        f"seed {seed}: the stated error holds for {held} of {count}; the greatest difference is {worst:.2%}"
    )
    RESULTS.write_text(
        json.dumps({"seed": seed, "holds": held, "of": count, "shafts": rows}, indent=1) + "\n"
    )


if __name__ == "__main__":
    main()
