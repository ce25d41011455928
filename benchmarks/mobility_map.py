"""Build `templates/physics/orbits/mobility_map.npz` from full solutions, and measure its error.

python -m benchmarks.mobility_map build      about 6 minutes on one core; goes on where it was stopped
python -m benchmarks.mobility_map measure    about 4 minutes: fresh, finer solutions at random places
python -m benchmarks.mobility_map report     the errors and the cost per point

Solutions so far are kept in build/mobility_map, one file a gap.
"""

import sys
from pathlib import Path
from time import perf_counter

import numpy as np
from scipy.special import lambertw

from templates.core.arrays import Array
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT
from templates.physics.numerics.uniform_spline import Axis, spline_coefficients
from templates.physics.numerics.volume_spline import Axes, volume
from templates.physics.orbits.film_mobility import Motion, film_mobility
from templates.physics.orbits.mobility_map import (
    LARGEST,
    NARROWEST,
    WIDEST,
    cell_of,
    decode_motion,
    encode,
    mapped_mobility,
    mapped_mobility_along_load,
    mobility_map,
)

DATA = Path("templates/physics/orbits/mobility_map.npz")
CHECKS = Path("benchmarks/mobility_map_checks.npz")
KEPT = Path("build/mobility_map")
NODES = 44, 10, 18
CELLS = 8, 3, 6
POINTS = 800
MARGIN = 2.5
MESH = 96, 12
CENTRE = 0.05
"""Position on a chord, over sqrt(h exp(h)), used for its middle, where a mesh gives no direction."""
WIDE = 1.95
"""Largest gap with nodes; beyond it chords are too short to determine the direction, and the cubic
continues."""


def axes() -> Axes:
    """Return nodes over gap, chord and width."""
    low = ECCENTRICITY_LIMIT - LARGEST
    start, end = np.log(low) + low, np.log(WIDE) + WIDE
    narrow, wide = np.log(NARROWEST), np.log(WIDEST)
    return (
        Axis(start, (end - start) / (NODES[0] - 1), NODES[0]),
        Axis(0.0, 1 / (NODES[1] - 1), NODES[1]),
        Axis(narrow, (wide - narrow) / (NODES[2] - 1), NODES[2]),
    )


def place(x: float, v: float) -> tuple[float, float]:
    """Return the eccentricity along and ahead of the load at the map's coordinates.

    The inverse of `coordinates`.
    """
    h = float(lambertw(np.exp(x)).real)
    xi = ECCENTRICITY_LIMIT - h
    return xi, v * float(np.sqrt(max(h * (ECCENTRICITY_LIMIT + xi), 0.0)))


def encoded(xi: float, eta: float, ratio: float, around: int, across: int) -> Array:
    """Return all values of the map from one solution (4,)."""
    eps, chi = min(float(np.hypot(xi, eta)), ECCENTRICITY_LIMIT), float(np.arctan2(-eta, xi))
    motion = film_mobility(eps, ratio, chi, around, across)
    turn = np.array([[np.cos(chi), np.sin(chi)], [-np.sin(chi), np.cos(chi)]])
    return encode(xi, eta, ratio, Motion(turn @ motion.velocity, motion.P_max, motion.side_flow, motion.film))


def extrapolated(xi: float, eta: float, ratio: float, finer: int = 1) -> Array:
    """Return all values by Richardson's extrapolation."""
    coarse, fine = (encoded(xi, eta, ratio, n * finer * MESH[0], n * finer * MESH[1]) for n in (1, 2))
    return fine + (fine - coarse) / 3


def build() -> None:
    """Solve at the nodes and store the splines."""
    KEPT.mkdir(parents=True, exist_ok=True)
    begin = perf_counter()
    gap, chord, width = axes()
    rows = []
    for i, x in enumerate(gap.places()):
        path = KEPT / f"{i:02d}_{'_'.join(map(str, NODES))}.npy"
        if not path.exists():
            np.save(path, row(float(x), chord, width))
            print(f"gap {i + 1} of {gap.nodes}: {perf_counter() - begin:.0f} s", flush=True)
        rows.append(np.load(path))
    splines = coefficients(np.array(rows)).astype(np.float32)
    table = [[axis.first, axis.step, axis.nodes] for axis in (gap, chord, width)]
    np.savez_compressed(DATA, axes=table, values=splines, error=np.zeros((*CELLS, 4), np.float32))


def row(x: float, chord: Axis, width: Axis) -> Array:
    """Return values at all nodes of one gap, (chord, width, 4)."""
    middle = CENTRE * np.sqrt(np.exp(min(x, 0.0)))
    return np.array([
        [extrapolated(*place(x, max(float(v), middle)), float(np.exp(y))) for y in width.places()]
        for v in chord.places()
    ])  # fmt: skip


def coefficients(values: Array) -> Array:
    """Return B-spline coefficients along all three axes, of (gap, chord, width, functions)."""
    for _ in range(3):
        values = np.moveaxis(spline_coefficients(values), 0, 2)
    return values


def check_points() -> Array:
    """Return random points over the whole map in its coordinates, (3, POINTS)."""
    low = np.array([axis.first for axis in axes()])
    high = np.array([axis.first + axis.step * (axis.nodes - 1) for axis in axes()])
    high[0] = np.log(2 * LARGEST) + 2 * LARGEST
    draw = np.random.default_rng(7).random((5 * POINTS, 3))
    places = low + draw * (high - low)
    inside = [np.hypot(*place(x, v)) <= LARGEST for x, v, _ in places]
    return np.asarray(places[inside][:POINTS].T)


def measure_error() -> None:
    """Compare with solutions on a mesh twice as fine, and store the largest error of each cell."""
    places = check_points()
    truth = []
    for k, (x, v, y) in enumerate(places.T):
        truth.append(extrapolated(*place(x, v), float(np.exp(y)), 2))
        if k % 50 == 49:
            print(f"point {k + 1} of {POINTS}", flush=True)
    np.savez_compressed(CHECKS, places=places, truth=np.array(truth).T)
    keep_error()


def errors() -> tuple[Array, Array]:
    """Return places (3, POINTS) and absolute errors of the map, (4, POINTS): see `mobility_error`."""
    with np.load(CHECKS) as checks:
        places, truth = checks["places"], checks["truth"]
    data = mobility_map()
    interpolated = volume(np.concatenate([data.motion, data.film], axis=-1), data.axes, places)
    xi, eta = np.array([place(x, v) for x, v, _ in places.T]).T
    ratio = np.exp(places[2])
    M, M_true = (decode_motion(xi, eta, ratio, values) for values in (interpolated, truth))
    difference = np.abs(interpolated - truth)
    difference[3] = np.abs(interpolated[3] / truth[3] - 1)
    difference[1] = np.hypot(*(M - M_true)) / np.hypot(*M_true)
    return places, difference


def keep_error() -> None:
    """Store the largest error of each cell and its neighbours, with a margin."""
    places, errors_there = errors()
    index = cell_of(axes(), places.T, np.array(CELLS))
    table = np.zeros((*CELLS, 4))
    for cell in np.ndindex(*CELLS):
        near = np.all(np.abs(index - cell) <= 1, axis=1)
        table[cell] = MARGIN * errors_there[:, near].max(axis=1)
    with np.load(DATA) as data:
        kept = {name: data[name] for name in data.files if name != "error"}
    np.savez_compressed(DATA, **kept, error=table.astype(np.float32))


def report() -> None:
    """Print the errors inside and over the whole range, and the cost per point."""
    places, errors_there = errors()
    xi, eta = np.array([place(x, v) for x, v, _ in places.T]).T
    eps, ratio = np.hypot(xi, eta), np.exp(places[2])
    inside = (eps <= 0.999) & (ratio >= 0.1) & (ratio <= 4)
    for name, part in (("eps to 0.999, B/D 0.1…4", inside), ("everywhere", np.ones_like(inside))):
        print(f"{name}: {part.sum()} points; errors of ln M_xi, |M|, ln P_max, side flow")
        print("  largest", " ".join(f"{value:.1e}" for value in errors_there[:, part].max(axis=1)))
        print("  median ", " ".join(f"{value:.1e}" for value in np.median(errors_there[:, part], axis=1)))
    rng = np.random.default_rng(1)
    eps, chi = 0.999 * rng.random(200_000), rng.uniform(-np.pi, np.pi, 200_000)
    xi, eta, ratio, half = eps * np.cos(chi), -eps * np.sin(chi), 0.1 + 2 * eps, np.array(0.5)
    costs = (
        ("mapped_mobility, one width", lambda: mapped_mobility(eps, half, chi)),
        ("mapped_mobility_along_load, one width", lambda: mapped_mobility_along_load(xi, eta, half)),
        ("mapped_mobility_along_load, a width a point", lambda: mapped_mobility_along_load(xi, eta, ratio)),
    )
    for name, call in costs:
        print(f"{name}: {1e9 * min(_seconds(call) for _ in range(5)) / eps.size:.0f} ns a point")
    print(f"data {DATA.stat().st_size / 1e3:.0f} kB")


def _seconds(call: object) -> float:
    """Return the wall time of one call."""
    assert callable(call)
    begin = perf_counter()
    call()
    return perf_counter() - begin


if __name__ == "__main__":
    {"build": build, "measure": measure_error, "report": report}[sys.argv[1]]()
