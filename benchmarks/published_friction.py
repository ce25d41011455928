"""Compare friction over speed of a published test rig with `mixed_friction` 1.

    python -m benchmarks.published_friction

A big end runs between two supports that carry half of its load each.
tests/references/sander_2016_friction_torque.csv names the source of the torques. The summit slenderness is
chosen so that the paper's contact factor, K = 16 sqrt(2) pi/15 (product)**2 sqrt(slenderness), is 0.001 at a
roughness product of 0.05.
"""

import csv
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.core.language.evaluate import evaluate
from templates.oil_film.mixed_friction_v1 import MixedFriction

PUBLISHED = Path("tests/references/sander_2016_friction_torque.csv")
BIG_END, SUPPORT = (47.8, 17.2), (54.0, 25.0)
"""Diameter and width [mm]."""
LOAD = 800.0
"""Load of the big end for each MPa of specific load [N]."""
PRODUCT, FACTOR = 0.05, 0.001


def rows(path: Path) -> list[list[float]]:
    """Return a reference table without its comments and its heading."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return [[float(value) for value in row] for row in list(csv.reader(lines))[1:]]


def torque(size: tuple[float, float], load: float, rpm: Array) -> Array:
    """Return the friction torque of one bearing under a load [N] at some speeds [N m]."""
    diameter, width = size
    slenderness = (FACTOR / (16 * np.sqrt(2) * np.pi / 15 * PRODUCT**2)) ** 2
    raw = {
        "radial_load": f"{load} N", "bearing_diameter": f"{diameter} mm", "bearing_width": f"{width} mm",
        "diametral_clearance": f"{1e-3 * diameter} mm", "dynamic_viscosity": "6.8 mPa*s",
        "speed": {"value": rpm.tolist(), "unit": "rpm"}, "journal_roughness": "0.13 um",
        "bearing_roughness": "0.28 um", "roughness_product": PRODUCT, "summit_slenderness": slenderness,
        "composite_modulus": "53.3 GPa", "contact_friction": 0.02,
    }  # fmt: skip
    found = evaluate(MixedFriction, raw, outputs=["friction_torque"]).outputs["friction_torque"].value
    return np.asarray(found, dtype=float)


def curves(path: Path = PUBLISHED) -> Iterator[tuple[float, Array, Array, Array]]:
    """Yield the specific load [MPa], speeds [rpm], and torques of the rig, published and calculated [N m]."""
    for pressure, group in groupby(rows(path), lambda row: row[0]):
        rpm, published = np.array([row[1:] for row in group]).T
        load = LOAD * pressure
        yield pressure, rpm, published, torque(BIG_END, load, rpm) + 2 * torque(SUPPORT, load / 2, rpm)


def main() -> None:
    """Print the table of docs/oil_film_sources.md."""
    print("| MPa | rpm | published [N m] | ours [N m] | ours over it |")
    print("|---|---|---|---|---|")
    for pressure, rpm, published, found in curves():
        for speed, theirs, ours in zip(rpm, published, found, strict=True):
            print(f"| {pressure:g} | {speed:g} | {theirs:g} | {ours:.2f} | {ours / theirs:.2f} |")


if __name__ == "__main__":
    main()
