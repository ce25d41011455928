"""Compute the life of a throw's fillets from an engine's loads and the STEP file.

    python -m benchmarks.crank_life    # docs/fatigue.md

Finite elements once, then any cycle. An in-line four of 86 mm stroke (`benchmarks/in_line_four.py`); the
load of pin 1 on its throw, with the torque of its own cylinder.
"""

import time
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.in_line_four import IN_LINE_FOUR
from cad.analysis.unit_loads import Crank, LoadedThrow, UnitStresses, fillet_stresses
from cad.models.crank_throw_v1 import CrankThrow
from cad.regenerate import regenerate
from templates.core.language.evaluate import evaluate
from templates.door import built_in

SIZES = {"journal_diameter": 55.0, "journal_length": 26.0, "pin_diameter": 48.0, "pin_length": 32.0,
         "web_thickness": 18.0, "web_width": 80.0, "throw": 43.0, "fillet": 3.0}  # mm  # fmt: skip
STEEL = {
    "ultimate_strength": "850 MPa",
    "yield_strength": "600 MPa",
    "surface": "ground",
    "diameter": "48 mm",
    "reliability": 0.99,
}
UNITS = {"force": ("MPa/kN", 1e3), "moment": ("MPa/(kN*m)", 1e6)}


def stresses_of(sizes: dict[str, float]) -> UnitStresses:
    """Return the tensors of unit loads at the fillets of a throw."""
    metres = {name: value / 1000 for name, value in sizes.items()}
    crank = Crank(
        sizes["throw"], sizes["pin_diameter"] / 2, sizes["pin_length"], sizes["journal_diameter"] / 2,
        sizes["web_thickness"], sizes["fillet"],
    )  # fmt: skip
    step = regenerate("crank_throw", 1, metres).step
    return fillet_stresses(LoadedThrow(step, CrankThrow.from_si(metres).shaft(), crank))


def as_inputs(found: UnitStresses) -> dict[str, Any]:
    """Return the tensors as inputs of `fatigue_life` 1."""
    tables = {}
    for load, tensors in found.tensors.items():
        unit, factor = UNITS[load.split("_")[0]]
        tables[f"stress_of_{load}"] = {"value": (factor * tensors).tolist(), "unit": unit}
    return tables


def pin_forces() -> NDArray[np.complex128]:
    """Return the load of pin 1 over the cycle, along the throw (real) and across it (imaginary) [N]."""
    engine = built_in().get("engine", 1)
    names = ["crankpin_load_x", "crankpin_load_y", "crank_angle", "crankpin_angles"]
    raw = {**IN_LINE_FOUR, "crank_angle_step": "5 deg"}
    x, y, angle, pins = (evaluate(engine, raw, outputs=names).outputs[name].value for name in names)
    turned = np.exp(-1j * pi / 180 * (np.asarray(angle) + pins[0]))
    return np.asarray((x[0] + 1j * y[0]) * turned)


def main() -> None:
    """Print the time of each part, and the life."""
    begin = time.perf_counter()
    found = stresses_of(SIZES)
    print(f"finite elements: {len(found.points)} points, {found.elements} elements, "
          f"{time.perf_counter() - begin:.1f} s")  # fmt: skip
    force = pin_forces()
    tables = as_inputs(found)
    forces = {"force_1": force.real, "force_2": force.imag}
    raw = {**STEEL, **{name: {"value": values.tolist(), "unit": "N"} for name, values in forces.items()},
           **{f"stress_of_{name}": tables[f"stress_of_{name}"] for name in forces}}  # fmt: skip
    for level in ("extremes", "rainflow"):
        begin = time.perf_counter()
        answers = evaluate(built_in().get("fatigue_life", 1), raw, level=level).outputs
        point = int(answers["governing_point"].value)
        print(
            f"{level}, {time.perf_counter() - begin:.2f} s: {answers['life'].value},",
            f"safety factor {answers['safety_factor'].value:.2f},",
            f"endurance limit {answers['endurance_limit'].value:.0f} MPa,",
            f"equivalent amplitude {answers['equivalent_amplitude'].value.max():.0f} MPa,",
            f"von Mises {answers['greatest_von_mises'].value.max():.0f} MPa,",
            f"leading tensor {answers['leading_tensor_share'].value[point - 1]:.2f},",
            f"at {np.round(found.points[point - 1], 1)} mm",
        )


if __name__ == "__main__":
    main()
