"""Error of taking a thrust pad for a rectangle, and convergence of the sectors of `thrust_bearing` 1.

python -m benchmarks.thrust_bearing            about half a minute

Rectangle: load, torque and inlet flow of the rectangle of mean length over those of the sector, for the same
film, less 1; and at a given load and viscosity its smallest film over the sector's, less 1. Mesh: the sector
at 16 × 4 and 32 × 8 intervals, extrapolated, against 64 × 16 and 128 × 32.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.pads.sector_equations import solved_sectors
from templates.physics.pads.thrust_collar import RECTANGLE, SECTOR, CollarFilm, collar_film

RATIOS = (1.2, 1.5, 2.0, 3.0, 5.0)
ANGLES = (15.0, 30.0, 45.0, 60.0)
REACHES = (1.2, 1.5, 2.0, 3.0)


def film_at_load(level: str, a: Array, angle: Array, reach: Array, needed: Array) -> Array:
    """Outlet film over the taper that bears `needed`, the load over its scale with the taper for h_o."""
    films = np.geomspace(0.02, 20, 400)
    pads = collar_film(level, 1 + 1 / films, np.full(400, angle[0]), np.full(400, reach[0]))
    return np.interp(-needed, -pads.load / films**2, films)


def rectangle() -> None:
    """Print the differences of the rectangle, the range over film ratios and pad angles for each reach."""
    print("rectangle over sector, less 1, in per cent: smallest and largest")
    for reach in REACHES:
        rows = []
        for angle in np.radians(ANGLES):
            a, wide = np.array(RATIOS), np.full(len(RATIOS), reach)
            pads = [collar_film(level, a, np.full(len(a), angle), wide) for level in (RECTANGLE, SECTOR)]
            needed = pads[1].load * (a - 1) ** 2
            thick = [film_at_load(level, a, np.full(1, angle), wide, needed) for level in (RECTANGLE, SECTOR)]
            torque = [pad.friction * pad.load for pad in pads]
            rows.append(
                [pads[0].load / pads[1].load - 1, torque[0] / torque[1] - 1,
                 pads[0].inlet / pads[1].inlet - 1, thick[0] / thick[1] - 1]
            )  # fmt: skip
        percent = 100 * np.array(rows)
        names = ("load", "torque", "inlet flow", "film at a load")
        spans = (
            f"{name} {percent[:, i].min():.1f} {percent[:, i].max():.1f}" for i, name in enumerate(names)
        )
        print(f"reach {reach}:", "; ".join(spans))


def mesh() -> None:
    """Print the largest errors of load and flows, by film ratio, width ratio and reach."""
    print("mesh: largest relative error of load, inlet flow, side flow (of the inlet flow)")
    for reach in (1.05, 1.2, 2.0, 3.0, 5.0):
        for width in (0.1, 0.3, 1.0, 3.0, 10.0):
            angle = 2 * (reach - 1) / ((reach + 1) * width)
            if angle > 2 * np.pi:
                continue
            a = np.array([1 + 1e-6, 1.5, 2.0, 5.0, 10.0, 30.0, 100.0])
            size = np.full(a.size, angle), np.full(a.size, reach)
            coarse, fine = (solved_sectors(a, *size, *one) for one in ((64, 16), (128, 32)))
            load, inlet, side = (fine + (fine - coarse) / 3).T
            film: CollarFilm = collar_film(SECTOR, a, *size)
            worst = abs(film.load / load - 1), abs(film.inlet / inlet - 1), abs(film.side - side) / inlet
            usual = [f"{one[:4].max():.1e}" for one in worst]
            print(
                f"reach {reach}, b/l {width}: a ≤ 5", *usual, "; a ≤ 100", *(f"{w.max():.1e}" for w in worst)
            )


def main() -> None:
    """Both."""
    rectangle()
    mesh()


if __name__ == "__main__":
    main()
