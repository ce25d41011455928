"""Effect of an elastic bearing on its film, by `elastic_film` 1: levels, cost, mesh.

python -m benchmarks.elastic_film           about a minute
python -m benchmarks.elastic_film random    60 random bearings at level housing: refusals, times, mesh_error
"""

import sys
from time import process_time
from typing import Any

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.oil_film.elastic_film_v1 import ElasticFilm

NAMES = ("minimum_film_thickness", "maximum_pressure", "largest_deformation", "neglected_deformation",
         "relative_eccentricity", "power_loss", "side_flow", "largest_thickening", "mesh_error")  # fmt: skip
BIG_END = {**ElasticFilm.example, "radial_load": "25 kN"}


def row(level: str, changes: dict[str, Any]) -> tuple[list[float], float]:
    """The outputs and the processor seconds of one point."""
    start = process_time()
    found = evaluate(ElasticFilm, {**BIG_END, **changes}, outputs=NAMES, level=level).outputs
    values = [np.nan if found[name].value is None else float(found[name].value) for name in NAMES]
    return values, process_time() - start


def levels() -> None:
    """One bearing at all levels, with and without oil that thickens, and with housings of several walls."""
    cases: list[tuple[str, str, dict[str, Any]]] = [("rigid", "rigid", {})]
    for alpha in ("0 1/GPa", "15 1/GPa"):
        cases.append((f"liner, alpha {alpha}", "liner", {"pressure_viscosity": alpha}))
        cases += [
            (f"housing {outer}, alpha {alpha}", "housing",
             {"pressure_viscosity": alpha, "housing_outer_diameter": outer})
            for outer in ("64 mm", "76 mm", "96 mm", "200 mm")
        ]  # fmt: skip
    print("| case | " + " | ".join(NAMES) + " | processor s |")
    for words, level, changes in cases:
        row(level, changes)
        values, seconds = row(level, changes)
        print(f"| {words} | " + " | ".join(f"{v:.4g}" for v in values) + f" | {seconds:.2g} |")


def random() -> None:
    """Random bearings: how many are refused, how long they take, how far the two meshes are apart."""
    rng = np.random.default_rng(58)
    errors, times, refused = [], [], 0
    for _ in range(60):
        D = 10 ** rng.uniform(1.3, 2.5)
        changes = {
            "bearing_diameter": f"{D} mm", "bearing_width": f"{D * rng.uniform(0.25, 1)} mm",
            "diametral_clearance": f"{D * 10 ** rng.uniform(-3.2, -2.7)} mm",
            "radial_load": f"{D**2 * 10 ** rng.uniform(-0.5, 1)} N",
            "speed": f"{10 ** rng.uniform(2.5, 3.8)} rpm", "liner_thickness": f"{D * 0.006} mm",
            "housing_outer_diameter": f"{D * rng.uniform(1.3, 2.5)} mm",
            "pressure_viscosity": f"{rng.uniform(0, 20)} 1/GPa",
        }  # fmt: skip
        start = process_time()
        found = evaluate(
            ElasticFilm, {**BIG_END, **{n: {"value": [float(v.split()[0])], "unit": v.split()[1]}
                                        for n, v in changes.items()}},
            outputs=["mesh_error"], level="housing",
        ).outputs["mesh_error"]  # fmt: skip
        times.append(process_time() - start)
        value = float(np.ravel(np.asarray(found.value, float))[0])
        refused += np.isnan(value)
        errors.append(value)
    print("refused", refused, "of", len(times))
    print("mesh_error: median, 95 %, largest", np.nanquantile(errors, [0.5, 0.95, 1]))
    print("processor s: median, 95 %, largest", np.quantile(times, [0.5, 0.95, 1]))


if __name__ == "__main__":
    random() if sys.argv[1:] == ["random"] else levels()
