"""Random bearing housings and rods with the compliance of their bores, for `benchmarks.elastic_ensemble`."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np

from cad.analysis.bore import BoreFineness, bore_mesh, compliance_on, read_bored
from cad.analysis.bore_tables import LEVELS
from cad.header import Header
from cad.models.bearing_housing_v1 import BearingHousing
from cad.models.connecting_rod_v1 import ConnectingRod
from cad.shaft import BorePlace
from cad.shells.bore_place import bore_place
from cad.step import write_step
from templates.core.arrays import Array

FINER, ORDER = BoreFineness(bore=0.3, body=0.8), 4
"""Elements for more modes than those of the analysis."""
_MM_PER_MPA = 1e-9  # in m/Pa


def random_solid(rng: np.random.Generator, kind: str) -> tuple[Any, float, float]:
    """A housing or rod, and the diameter and width [mm] of its bearing, whose shells take a tenth."""
    bore = 10 ** rng.uniform(1.5, 2.4)
    width, breadth = bore * rng.uniform(0.3, 0.7), bore * rng.uniform(1.55, 2.6)
    bolt = min(0.2 * bore, 0.45 * (0.98 * breadth - 1.01 * bore), 0.5 * width)
    spacing = (1.01 * bore + 0.98 * breadth) / 2
    common = {"bolt_hole_diameter": bolt, "bolt_spacing": spacing}
    if kind == "rod":
        values = common | {
            "big_end_bore": bore, "big_end_width": width, "big_end_breadth": breadth,
            "shoulder_height": bore * rng.uniform(0.62, 0.85), "cap_height": bore * rng.uniform(0.6, 0.9),
        }  # fmt: skip
        cls: Any = ConnectingRod
    else:
        values = common | {
            "housing_bore": bore, "housing_width": width, "housing_breadth": breadth,
            "block_height": bore * rng.uniform(0.8, 1.5), "cap_height": bore * rng.uniform(0.6, 1.1),
        }  # fmt: skip
        cls = BearingHousing
    solid = cls.from_quantities({name: f"{value} mm" for name, value in values.items()})
    return solid, bore / 1.1, width * rng.uniform(0.8, 1.0)


def matrices(solid: Any, highest: int, along: int) -> tuple[Array, Array, BorePlace]:
    """The matrix of level default, one of more modes on a finer mesh [m/Pa], and the bore."""
    place = bore_place(solid)
    assert place is not None
    bored = read_bored(write_step(list(solid.build()), Header(solid.id, 1, {}, "0" * 64)), place)
    fineness, order = LEVELS["default"]
    own, _ = compliance_on(bore_mesh(bored, fineness), order, place)
    functions = more_modes(place, highest, along)
    more, _ = compliance_on(bore_mesh(bored, FINER), ORDER, place, functions=functions)
    symmetric = [_MM_PER_MPA * (matrix + matrix.T) / 2 for matrix in (own, more)]
    return symmetric[0], symmetric[1], place


def more_modes(place: BorePlace, highest: int, along: int) -> list[Any]:
    """Harmonics 0 … highest around, times so many even polynomials of Legendre along, mean square 1."""
    angle, zeta = ng.atan2(-ng.x, ng.y), ng.z / place.half_width
    around = [ng.CF(1.0)]
    for n in range(1, highest + 1):
        around += [2**0.5 * part(n * angle) for part in (ng.cos, ng.sin)]
    functions = []
    for k in range(along):
        powers = np.polynomial.legendre.leg2poly([0.0] * (2 * k) + [1.0])
        along_bore = sum(float(factor) * zeta**power for power, factor in enumerate(powers) if factor)
        functions += [(4 * k + 1) ** 0.5 * along_bore * part for part in around]
    return functions
