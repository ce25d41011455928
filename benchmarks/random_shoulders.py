"""Compare the greatest stress of random stepped shafts with solutions in their half planes.

    python -m benchmarks.random_shoulders [COUNT] [SEED]

The narrow end of a shaft has 30 to 60 mm, the wide one 1.1 to 2 times that; the fillet is 0.04 to 0.2 of the
narrow diameter. Half of the shafts are twisted, the others bent. The stress on the solid is computed as for
the output `maximum_stress`; its stated error is compared with the difference from
`tests.references.half_plane`. Every result is stored in benchmarks/results/random_shoulders.json at once, so
an interrupted run continues; a shaft takes about 10 s of processor time.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from math import pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from cad.analysis.kinds import LOADS, Kind
from cad.analysis.solid import read_solid
from cad.analysis.stress import greatest_stress, von_mises
from cad.shaft import STEEL_MATERIAL, Shaft
from tests.references.half_plane import HalfPlane, bending, torsion
from tests.references.shoulder_fillet import first_principal, shoulder

RESULTS = Path("benchmarks/results/random_shoulders.json")
COUNT, SEED = 36, 12
MEASURES = {"torsion": von_mises, "bending": first_principal}


def drawn(seed: int, number: int) -> HalfPlane:
    """Return a random stepped shaft [mm]; each end is as long as 1.5 times its diameter."""
    rng = np.random.default_rng([seed, number])
    narrow = float(rng.uniform(30, 60))
    wide = narrow * float(rng.uniform(1.1, 2.0))
    fillet = min(narrow * float(np.exp(rng.uniform(np.log(0.04), np.log(0.2)))), 0.45 * (wide - narrow))
    sizes = (round(one, 2) for one in (wide / 2, narrow / 2, 1.5 * wide, fillet, 1.5 * (wide + narrow)))
    return HalfPlane(*sizes)


def compared(half: HalfPlane, load: Kind) -> dict[str, Any]:
    """Return the stress of one shaft under one load by both methods."""
    plane = torsion(half) if load == "torsion" else bending(half, "free_end")
    step = shoulder(half.fillet, half.end, 2 * half.wide, 2 * half.narrow, half.shoulder)
    solid = read_solid(step, Shaft(0.0, half.end))
    peaks = greatest_stress(solid, STEEL_MATERIAL, load, "free_end", lambda step: None, MEASURES[load])
    nominal = sqrt(3) * 2 / pi / half.narrow**3 if load == "torsion" else 4 / pi / half.narrow**3
    return {
        "load": load,
        "shaft": asdict(half),
        "factor": plane.stress / nominal,
        "difference": peaks.steps[-1].value / plane.stress - 1,
        "stated error": peaks.error,
        "has converged": peaks.converged,
        "meshes": [[peak.elements, peak.order, peak.value / plane.stress - 1] for peak in peaks.steps],
    }


def main(count: int, seed: int) -> None:
    """Compare the shafts that are not stored yet, print and store them."""
    kept = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    rows: list[dict[str, Any]] = kept["shafts"] if kept.get("seed") == seed else []
    for number in range(len(rows), count):
        rows.append(compared(drawn(seed, number), LOADS[number % 2]))
        print(number, json.dumps(rows[-1]), flush=True)
        RESULTS.write_text(json.dumps(summary(rows, seed), indent=1) + "\n")
    print(json.dumps({**summary(rows, seed), "shafts": len(rows)}))


def summary(rows: list[dict[str, Any]], seed: int) -> dict[str, Any]:
    """Return the rows with the number of shafts whose stated error holds."""
    settled = [row for row in rows if row["has converged"]]
    return {
        "seed": seed,
        "of": len(rows),
        "converged": len(settled),
        "holds": sum(abs(row["difference"]) <= row["stated error"] for row in settled),
        "greatest difference": max(abs(row["difference"]) for row in settled),
        "shafts": rows,
    }


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    main(*given, *(COUNT, SEED)[len(given) :])
