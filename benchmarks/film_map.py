"""Build `templates/physics/films/film_map.npz` from full solutions, and measure its error.

python -m benchmarks.film_map build      about 10 minutes on one core
python -m benchmarks.film_map measure    about 15 minutes: fresh, finer solutions at random places
python -m benchmarks.film_map report     the errors and the cost per point
"""

import sys
from pathlib import Path
from time import perf_counter

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_dynamics import linear_forces
from templates.physics.films.film_map import (
    NARROWEST,
    WIDEST,
    encode,
    encode_linear,
    film_map,
    mapped_film,
    mapped_load,
)
from templates.physics.films.film_measures import measure
from templates.physics.films.reynolds import static_field
from templates.physics.films.short_bearing import attitude_Ocvirk_1952
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT
from templates.physics.numerics.uniform_spline import Axis, surface, surface_coefficients

DATA = Path("templates/physics/films/film_map.npz")
CHECKS = Path("benchmarks/film_map_checks.npz")
NODES = 86, 94
CELLS = 12, 12
POINTS, LIGHT = 1500, 600
"""Random points over the whole map, and further ones at light load, where atanh(eps) gives only few."""
LIGHTEST, NOT_LIGHT = 0.005, 0.76
"""Eccentricities of the further points; below the lower one the film is proportional to it [-]."""
LINEAR_MESH = 1024, 64
"""Intervals for the true stiffness and damping. Both converge with first order where a narrow film ruptures,
so their truth must be several times finer than the 256 × 32 intervals of levels map and reynolds.
"""
CENTRED = 1e-6
MARGIN = 1.5


def axes() -> tuple[Axis, Axis]:
    """Return nodes over atanh(eps) and ln(B/D)."""
    top, low, high = np.arctanh(ECCENTRICITY_LIMIT), np.log(NARROWEST), np.log(WIDEST)
    return Axis(0.0, top / (NODES[0] - 1), NODES[0]), Axis(low, (high - low) / (NODES[1] - 1), NODES[1])


def encoded(eps: float, ratio: float, around: int, across: int) -> Array:
    """Return all values of the map from one solution (16,)."""
    field = static_field(eps, ratio, around, across)
    forces = linear_forces(eps, ratio, field.mesh, field.rupture)
    return np.concatenate([encode(eps, ratio, measure(field)), encode_linear(eps, forces)])


def extrapolated(eps: float, ratio: float, around: int = 128, across: int = 16) -> Array:
    """Return all values with the film extrapolated (Richardson).

    Stiffness and damping are too noisy for it.
    """
    eps = min(max(eps, CENTRED), ECCENTRICITY_LIMIT)
    coarse, fine = encoded(eps, ratio, around, across), encoded(eps, ratio, 2 * around, 2 * across)
    return fine + (fine - coarse) / 3 * (np.arange(16) < 8)


def reference(eps: float, ratio: float) -> Array:
    """Return the true values: the film extrapolated, stiffness and damping on `LINEAR_MESH`."""
    eps = min(max(eps, CENTRED), ECCENTRICITY_LIMIT)
    values = extrapolated(eps, ratio, 256, 32)
    values[8:] = encoded(eps, ratio, *LINEAR_MESH)[8:]
    return values


def build() -> None:
    """Solve at the nodes and store the splines."""
    eccentricity, width = axes()
    values = np.array([
        [extrapolated(float(np.tanh(x)), float(np.exp(y))) for y in width.places()]
        for x in eccentricity.places()
    ])  # fmt: skip
    splines = surface_coefficients(values).astype(np.float32)
    table = [[axis.first, axis.step, axis.nodes] for axis in (eccentricity, width)]
    np.savez_compressed(
        DATA,
        axes=table,
        static=splines[..., :8],
        linear=splines[..., 8:],
        error=np.zeros((*CELLS, 8), np.float32),
    )


def check_points() -> tuple[Array, Array]:
    """Return random points over the whole map, and then those at light load, in its coordinates."""
    _, width = axes()
    draw, light = np.random.default_rng(7).random((2, POINTS)), np.random.default_rng(8).random((2, LIGHT))
    x = draw[0] * np.arctanh(ECCENTRICITY_LIMIT)
    x_light = np.arctanh(LIGHTEST * (NOT_LIGHT / LIGHTEST) ** light[0])
    share = np.concatenate([draw[1], light[1]])
    return np.concatenate([x, x_light]), width.first + share * width.step * (width.nodes - 1)


def measure_error() -> None:
    """Compare with solutions on finer meshes, and store the largest error of each cell."""
    x, y = check_points()
    truth = np.array([reference(float(np.tanh(a)), float(np.exp(b))) for a, b in zip(x, y, strict=True)])
    np.savez_compressed(CHECKS, x=x, y=y, truth=truth)
    keep_error()


def errors() -> tuple[Array, Array, Array]:
    """Return points and absolute errors of the map in its own values, (points, 16)."""
    with np.load(CHECKS) as checks:
        x, y, truth = checks["x"], checks["y"], checks["truth"]
    data = film_map()
    coefficients = np.concatenate([data.static, data.linear], axis=-1)
    return x, y, np.abs(surface(coefficients, data.eccentricity, data.width, x, y).T - truth)


def keep_error() -> None:
    """Store the largest error of each cell and its neighbours, with a margin, at the uniform points."""
    x, y, errors_there = (values[:POINTS] for values in errors())
    eccentricity, width = axes()
    row = np.clip((x / (eccentricity.step * (NODES[0] - 1)) * CELLS[0]).astype(int), 0, CELLS[0] - 1)
    column = ((y - width.first) / (width.step * (NODES[1] - 1)) * CELLS[1]).astype(int)
    table = np.zeros((*CELLS, 8))
    for i, j in np.ndindex(*CELLS):
        near = (np.abs(row - i) <= 1) & (np.abs(column - j) <= 1)
        table[i, j] = MARGIN * errors_there[near, :8].max(axis=0)
    with np.load(DATA) as data:
        kept = {name: data[name] for name in data.files if name != "error"}
    np.savez_compressed(DATA, **kept, error=table.astype(np.float32))


def report() -> None:
    """Print the errors inside and over the whole range, and the cost per point."""
    x, y, errors_there = errors()
    eps, ratio = np.tanh(x), np.exp(y)
    with np.load(CHECKS) as checks:
        half = np.arctan(np.exp(checks["truth"][:, 1]) * np.tan(attitude_Ocvirk_1952(eps) / 2))
    degrees = np.degrees(errors_there[:, 1] * np.sin(2 * half))
    inside = (eps >= 0.01) & (eps <= 0.999) & (ratio >= 0.1) & (ratio <= 4)
    for name, part in (("eps 0.01…0.999, B/D 0.1…4", inside), ("everywhere", np.ones_like(inside))):
        print(f"{name}: {part.sum()} points")
        print(f"  So {100 * errors_there[part, 0].max():.4f} %, attitude {degrees[part].max():.4f}°")
        print("  largest of all values", " ".join(f"{value:.1e}" for value in errors_there[part].max(axis=0)))
    rng = np.random.default_rng(1)
    many, widths = rng.random(200_000), rng.uniform(0.1, 2, 200_000)
    for function in (mapped_film, mapped_load):
        best = min(_seconds(function, many, widths) for _ in range(5))
        print(f"{function.__name__}: {1e9 * best / many.size:.0f} ns a point")
    print(f"data {DATA.stat().st_size / 1e3:.0f} kB")


def _seconds(function: object, *arguments: Array) -> float:
    """Return the wall time of one call."""
    assert callable(function)
    begin = perf_counter()
    function(*arguments)
    return perf_counter() - begin


if __name__ == "__main__":
    {"build": build, "measure": measure_error, "report": report}[sys.argv[1]]()
