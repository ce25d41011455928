"""Measure the error of every level of `oil_film` against the converged solution, and the cost of a point.

python -m benchmarks.accuracy measure    about 12 minutes: writes templates/oil_film/*.accuracy.json
python -m benchmarks.accuracy errors     about 4 minutes: only the errors of `oil_film` 2
python -m benchmarks.accuracy held_out   how often those of stiffness are right at points that are left out
python -m benchmarks.accuracy costs      the costs alone
python -m benchmarks.accuracy expected   the time to expect of an evaluation; after `measure`
python -m benchmarks.accuracy own        the errors that other bearings state, from `benchmarks.shapes`
python -m benchmarks.accuracy_picture  docs/pictures/oil_film_accuracy.png from those files

The converged films are solutions at 2100 random points, which `benchmarks.film_map` stores: extrapolated from
256 × 32 and 512 × 64 intervals, stiffness and damping on 1024 × 64. Levels map, reynolds and mass_conserving
are compared with these solutions; the closed forms are compared with the map on a dense grid, and the error
of the map is added. The error of a cell is the largest error found in it. The bearings are plain and aligned,
without grooves; `benchmarks.shapes` compares meshes for other bearings, and
`benchmarks.heat_balance_accuracy` measures the error that a heat balance adds, which is in the same accuracy
file. Errors are relative: of an angle to 90°, of a stiffness or damping to the largest of its four
coefficients.
"""

import itertools
import json
import sys
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from time import process_time
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import shapes
from benchmarks.film_map import LIGHT, POINTS
from benchmarks.heat_balance_accuracy import heat_balance
from benchmarks.truths import (
    COEFFICIENTS,
    FILM,
    FULL_SHEAR,
    OIL_SHEAR,
    RELATIVE_TO,
    converged,
    meanings,
    truth_of,
)
from templates.core.arrays import Array
from templates.core.criteria.bands import CONVENTION, relative_error
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template
from templates.oil_film.oil_film_v1 import OilFilm as Paper
from templates.oil_film.oil_film_v2 import MESH_ERRORS, OilFilm
from templates.physics.films.film_fit import load_ISO_7902
from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.journals.journal_coefficients import coefficients_at
from templates.physics.journals.static_journal import WIDTHS, JournalFilm, static_film_at
from templates.physics.journals.whirl import threshold_mass
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT
from templates.physics.numerics.power_fit import exponent_k2, factor_k1

FOLDER = Path("templates/oil_film")

EPS = [0, 0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98, 0.99, 0.995, 0.998,
       0.999, 0.9995, 0.9999, 1 - 1e-5, 1 - 1e-6, 1]  # fmt: skip
WIDTH = [0.01, 0.02, 0.035, 0.05, 0.07, 0.1, 0.125, 0.18, 0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 3, 5, 10, 30, 100]
PAPER_WIDTH = sorted([*WIDTH, 0.372, 0.381])
LOADS = [0.01, 0.03, 0.1, 0.2, 0.5, 1, 1.5, 2, 3, 4, 5, 7, 10, 14, 20, 30, 40, 60, 80, 100, 120, 150, 200,
         300, 500, 800, 1360]  # fmt: skip
FINER = 7
MARGIN = 1.02
ROWS = np.linspace(0, np.arctanh(ECCENTRICITY_LIMIT), 9)
"""Edges of the coarse cells over atanh(eps) [-]."""
LIGHT_ROWS = np.concatenate([[0, 0.03, 0.1, 0.3], ROWS[1:]])
"""The same for stiffness and damping, which converge slowly at light load [-]."""
COLUMNS = 8
"""Number of coarse cells over ln(B/D)."""
NEARBY = 1.5
SOLVED = ("reynolds", "mass_conserving")
"""Levels that also solve bearings that are not plain."""
FEWER_POINTS = {"reynolds": 800, "mass_conserving": 400}
"""Number of points for the errors of the film at slow levels."""
FEWER_COEFFICIENTS = {"reynolds": 800}
"""The same for stiffness and damping, besides those at light load; their errors scatter more."""

TRUTH = (
    "Swift-Stieber film, extrapolated from 256 × 32 and 512 × 64 intervals; stiffness and damping on "
    "1024 × 64"
)

Errors = dict[str, Array]


def film_errors(film: JournalFilm, truth: JournalFilm) -> Errors:
    """Return the relative errors of every output that is calculated from the film, at equal load."""
    couple, true_couple = (f.eps * f.So * np.sin(f.attitude) / 2 for f in (film, truth))
    torque = relative_error(film.shear + couple, truth.shear + true_couple)
    thickness = relative_error(1 - film.eps, 1 - truth.eps)
    peak = np.abs(film.attitude + film.peak - truth.attitude - truth.peak)
    return {
        "relative_eccentricity": relative_error(film.eps, truth.eps),
        "minimum_film_thickness": thickness,
        "film_parameter": thickness,
        "attitude_angle": np.abs(film.attitude - truth.attitude) / (np.pi / 2),
        "maximum_pressure": relative_error(film.P_max, truth.P_max),
        "maximum_pressure_angle": peak / (np.pi / 2),
        "shear_torque": relative_error(film.shear, truth.shear),
        "load_couple": relative_error(couple, true_couple),
        "friction_torque": torque,
        "friction_coefficient": torque,
        "power_loss": torque,
        "side_flow": relative_error(film.side_flow, truth.side_flow),
    }


def coefficient_errors(values: tuple[Array, Array], truth: tuple[Array, Array]) -> Errors:
    """Return the errors of stiffness and damping over the largest coefficient, and of the whirl threshold."""
    parts = []
    for matrix, true in zip(values, truth, strict=True):
        size = np.abs(true).max(axis=(-1, -2), keepdims=True)
        parts.append((np.abs(matrix - true) / size).reshape(-1, 4))
    errors = dict(zip(COEFFICIENTS, np.concatenate(parts, axis=1).T, strict=True))
    mass, true_mass = (_threshold(*pair) for pair in (values, truth))
    with np.errstate(all="ignore"):
        speed = np.abs(np.sqrt(mass / true_mass) - 1)
    both = np.isinf(mass) & np.isinf(true_mass)
    return {
        **errors,
        "whirl_threshold_speed": np.where(both, 0.0, np.where(np.isfinite(speed), speed, np.nan)),
    }


def _threshold(K: Array, B: Array) -> Array:
    is_finite = np.asarray(np.isfinite(K).all(axis=(-1, -2)))
    unit = np.broadcast_to(np.eye(2), K.shape)
    mass = threshold_mass(*(np.where(is_finite[:, None, None], matrix, unit) for matrix in (K, B)))
    return np.where(is_finite, mass, np.nan)


def dense(first: list[float], second: list[float]) -> tuple[Array, Array]:
    """Return FINER × FINER points in every cell, edges included, (cells, cells, FINER²)."""
    share = np.linspace(0, 1, FINER)
    one = np.array([a + (b - a) * share for a, b in itertools.pairwise(first)])
    two = np.array([a * (b / a) ** share for a, b in itertools.pairwise(second)])
    x = np.broadcast_to(one[:, None, :, None], (len(one), len(two), FINER, FINER))
    y = np.broadcast_to(two[None, :, None, :], x.shape)
    return x.reshape(len(one), len(two), -1), y.reshape(len(one), len(two), -1)


def closed_form(level: str, load: Callable[..., Array], own: dict[str, Array]) -> dict[str, Array]:
    """Return the largest error of a closed form in each cell of its own eps, against the map."""
    eps, ratio = dense(EPS, WIDTH)
    eps = np.clip(eps, 1e-9, 1 - 1.001e-7)
    low, high = WIDTHS[level]
    allowed = (ratio >= low * (1 - 1e-12)) & (ratio <= high * (1 + 1e-12))
    safe = np.clip(ratio, low, high)
    So = np.where(allowed, load(eps, safe), np.nan).ravel()
    film, truth = (static_film_at(name, So, safe.ravel()) for name in (level, "map"))
    film = film.admitted(np.where(np.isfinite(film.eps), film.eps, np.nan))
    true_eps = np.where(np.isfinite(truth.eps), truth.eps, np.nan)
    values = coefficients_at(level, eps.ravel(), safe.ravel())
    errors = {
        **film_errors(film, truth.admitted(true_eps)),
        **coefficient_errors(values, coefficients_at("map", true_eps, safe.ravel())),
    }
    cells = {name: error.reshape(eps.shape).max(axis=-1) for name, error in errors.items()}
    return {name: MARGIN * cell + own[name] for name, cell in cells.items()}


def points_of(level: str) -> NDArray[np.intp]:
    """Return the indices of the converged solutions that a level is compared with."""
    last = POINTS + LIGHT
    return np.asarray(np.r_[: FEWER_COEFFICIENTS.get(level, POINTS), POINTS:last], np.intp)


def solved_errors(level: str) -> tuple[Array, Array, Errors, Errors]:
    """Return points x and y, and there the errors of the film and those of stiffness and damping."""
    x, y, truth, matrices = converged(streamers=level == "mass_conserving")
    used = points_of(level)
    x, y, matrices = x[used], y[used], (matrices[0][used], matrices[1][used])
    truth, ratio = JournalFilm(*(getattr(truth, field.name)[used] for field in fields(truth))), np.exp(y)
    film = static_film_at(level, truth.So, ratio)
    eps = np.where(np.isfinite(film.eps), film.eps, np.nan)
    linear = coefficient_errors(coefficients_at(level, eps, ratio), matrices)
    return x, y, film_errors(film.admitted(eps), truth), linear


def solved(level: str) -> dict[str, Array]:
    """Return the largest error of a level near each cell, against the converged solutions, with a margin."""
    x, y, of_film, linear = solved_errors(level)
    some = np.r_[: FEWER_POINTS.get(level, POINTS), x.size - LIGHT : x.size]
    return {
        **{name: spread(x[some], y[some], error[some], ROWS) for name, error in of_film.items()},
        **{name: spread(x, y, error, LIGHT_ROWS) for name, error in linear.items()},
    }


def held_out(level: str = "mass_conserving") -> None:
    """Print how often stiffness and damping of each fifth are within the table of the other four fifths."""
    x, y, _, linear = solved_errors(level)
    fifth = np.random.default_rng(5).integers(0, 5, x.size)
    row = np.clip(np.searchsorted(np.arctanh(np.minimum(EPS, ECCENTRICITY_LIMIT)), x) - 1, 0, len(EPS) - 2)
    column = np.clip(np.searchsorted(np.log(WIDTH), y) - 1, 0, len(WIDTH) - 2)
    for name, error in linear.items():
        stated = np.full(x.size, np.nan)
        for k in range(5):
            others = fifth != k
            table = spread(x[others], y[others], error[others], LIGHT_ROWS)
            stated[~others] = table[row, column][~others]
        known = np.isfinite(stated) & np.isfinite(error)
        print(f"{name:24} {(stated >= error)[known].sum()} of {known.sum()}")


def spread(x: Array, y: Array, error: Array, rows_at: Array) -> Array:
    """Return errors at scattered points as a table of cells.

    Each cell gets the largest error of the coarse cells that it touches and of their neighbours.
    """
    edges = rows_at, np.linspace(np.log(WIDTH[0]), np.log(WIDTH[-1]), COLUMNS + 1)

    def cell(values: Array, axis: int) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(edges[axis], values, side="right") - 1, 0, edges[axis].size - 2)

    row, column = cell(x, 0), cell(y, 1)
    coarse = np.full((rows_at.size - 1, COLUMNS), np.nan)
    for i, j in np.ndindex(*coarse.shape):
        near = error[(np.abs(row - i) <= 1) & (np.abs(column - j) <= 1)]
        coarse[i, j] = NEARBY * near.max()
    rows, columns = cell(np.arctanh(np.minimum(EPS, ECCENTRICITY_LIMIT)), 0), cell(np.log(WIDTH), 1)
    return np.array([
        [coarse[a : b + 1, c : d + 1].max() for c, d in itertools.pairwise(columns)]
        for a, b in itertools.pairwise(rows)
    ])  # fmt: skip


def paper() -> dict[str, Any]:
    """Return the largest error of the fit of `oil_film` 1 in each cell of So and B/D, against the map.

    `signed` is the signed error of the film thickness: above 0 the film is overestimated, which is unsafe.
    """
    So, ratio = dense(LOADS, PAPER_WIDTH)
    eps = factor_k1(So) * So ** exponent_k2(So)
    film = static_film_at("map", So.ravel(), ratio.ravel())
    true = np.where(np.isfinite(film.eps), film.eps, np.nan).reshape(So.shape)
    errors = {"relative_eccentricity": relative_error(eps, true)}
    errors["minimum_film_thickness"] = relative_error(1 - eps, 1 - true)
    over = (1 - eps) / (1 - true) - 1
    worst = np.take_along_axis(over, np.abs(over).argmax(axis=-1)[..., None], axis=-1)[..., 0]
    return {
        "truth": dict.fromkeys(errors, FILM),
        "errors": {name: rounded(MARGIN * error.max(axis=-1)) for name, error in errors.items()},
        "signed": {"minimum_film_thickness": [[float(f"{v:.2g}") for v in row] for row in worst]},
    }


def cost(level: str) -> dict[str, float]:
    """Return the processor time per point [s], alone and among many, at eps 0.8 and B/D 1.

    The figure is also valid on a busy machine.
    """
    So, many = 3.5718, 20 if level in SOLVED else 20_000

    def seconds(count: int) -> float:
        loads: Any = np.full(count, So) if count > 1 else np.float64(So)
        ratio: Any = 1.0
        begin = process_time()
        static_film_at(level, loads, ratio)
        return (process_time() - begin) / count

    seconds(1)
    return {"single": min(seconds(1) for _ in range(20)), "vectorised": min(seconds(many) for _ in range(3))}


def content_of(
    cls: type[Template], truths: dict[str, str], axes: list[dict[str, Any]], levels: dict[str, Any]
) -> dict[str, Any]:
    """Return the content of the accuracy file."""
    return {
        "template": {"id": cls.id, "version": cls.version},
        "made_by": "python -m benchmarks.accuracy measure",
        "truth": TRUTH,
        "truths": truths,
        "convention": CONVENTION,
        "error": "largest found in each cell; relative, of an angle to 90°, of a stiffness or damping to the "
        "largest of its four; of the film at the viscosity used; null: not measured, or refused",
        "relative_to": {name: size for name, size in RELATIVE_TO.items() if name in cls.formulas},
        "cost": "processor seconds a point, of all measures of the film but stiffness and damping",
        "cost_of_all": 3.0,  # with stiffness and damping, which take twice as long as all other outputs
        "axes": axes,
        "levels": levels,
    }


def rounded(table: Array) -> list[list[float | None]]:
    """Return a number rounded up to two digits; None if it is unknown."""
    with np.errstate(all="ignore"):
        unit = 10.0 ** (np.floor(np.log10(np.maximum(table, 1e-12))) - 1)
    up = np.ceil(table / unit) * unit
    return [[None if not np.isfinite(v) else float(f"{v:.2g}") for v in row] for row in up]


def write(cls: type[Template], content: dict[str, Any]) -> None:
    """Write the file with one line per row of cells, so that a diff is readable."""
    path = FOLDER / f"{cls.id}_v{cls.version}.accuracy.json"
    path.write_text(json.dumps(content, ensure_ascii=False, separators=(",", ":")) + "\n", encoding="utf-8")
    print(path, path.stat().st_size // 1000, "kB")


def axis(attribute: str, name: str, values: list[float]) -> dict[str, Any]:
    """Return one axis of the tables: the edges of the cells."""
    return {"attribute": attribute, "name": name, "values": values}


def error_tables() -> dict[str, Any]:
    """Return the references and the errors of every level."""
    own = solved("map")
    tables = {
        "short_bearing": closed_form("short_bearing", load_Ocvirk_1952, own),
        "fit": closed_form("fit", load_ISO_7902, own),
        "map": own,
        "reynolds": solved("reynolds"),
        "mass_conserving": solved("mass_conserving"),
    }
    return {
        level: {
            "truth": {name: truth_of(level, name) for name in table},
            "errors": {name: rounded(t) for name, t in table.items()},
        }
        for level, table in tables.items()
    }


def measure() -> None:
    """Measure errors and costs and write both files."""
    levels = {level: {"cost": cost(level), **table} for level, table in error_tables().items()}
    for level in SOLVED:
        levels[level] |= own_errors()
    width = axis("b", "width_ratio", WIDTH)
    truths = meanings(FILM, FULL_SHEAR, OIL_SHEAR)
    content = content_of(OilFilm, truths, [axis("eps", "relative_eccentricity", EPS), width], levels)
    write(OilFilm, {**content, "conditions": [heat_balance()]})
    axes = [axis("S_0", "sommerfeld_number", LOADS), axis("b", "width_ratio", PAPER_WIDTH)]
    write(Paper, content_of(Paper, meanings(FILM), axes, {"only": {"cost": {}, **paper()}}))


def own_errors() -> dict[str, Any]:
    """Return the errors that shaped bearings state, and how often they are right.

    The expected errors come from the bearings of `benchmarks.shapes mesh`, the shares from those of
    `held_out`.
    """
    films, fresh = (shapes.measured_films(seed) for seed in (shapes.SEED, shapes.HELD_OUT))
    expected, held = {}, {}
    measures = SimpleNamespace(**{own: name for name, own in shapes.STATED.items()})
    for output, field in MESH_ERRORS.items():
        name = field(measures)
        size = np.pi / 2 if output == "attitude_angle" else 1.0
        stated = np.array([film["stated"][name] for film in films])
        expected[output] = float(f"{np.percentile(stated, 95) / size:.2g}")
        within = [film["stated"][name] >= film["errors"][name] for film in fresh]
        held[output] = float(f"{np.mean(within):.4g}")
    about = {
        "made_by": "python -m benchmarks.shapes held_out",
        "seed": shapes.HELD_OUT,
        "count": len(fresh),
        "held": held,
    }
    return {"own": expected, "own_measured": about}


def errors() -> None:
    """Measure and write only the errors of the levels of `oil_film` 2."""
    path = FOLDER / "oil_film_v2.accuracy.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    for level, table in error_tables().items():
        content["levels"][level] |= table
    write(OilFilm, content | {"truth": TRUTH})


def own() -> None:
    """Write only the errors that shaped bearings state."""
    path = FOLDER / "oil_film_v2.accuracy.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    for level in SOLVED:
        content["levels"][level] |= own_errors()
    write(OilFilm, content)


def costs() -> None:
    """Measure and write only the costs."""
    path = FOLDER / "oil_film_v2.accuracy.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    for level, about in content["levels"].items():
        about["cost"] = cost(level)
        print(level, about["cost"])
    write(OilFilm, content)


def expected() -> None:
    """Measure the time of one point in an evaluation [s], at levels that accept few points.

    The result is the geometric mean over some loads of the example, with and without stiffness and damping.
    """
    path = FOLDER / "oil_film_v2.accuracy.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    content["expected_seconds"] = {
        level: {"cases": {"": _evaluating(level)}} for level in OilFilm.most_points
    }
    print(content["expected_seconds"])
    write(OilFilm, content)


def _evaluating(level: str) -> float:
    times = []
    for outputs in (
        ["minimum_film_thickness", "maximum_pressure"],
        ["minimum_film_thickness", "stiffness_xx"],
    ):
        for load in ("5 kN", "25 kN", "25 kN", "100 kN"):
            begin = process_time()
            evaluate(OilFilm, {**OilFilm.example, "radial_load": load}, level=level, outputs=outputs)
            times.append(process_time() - begin)
    return float(f"{np.exp(np.mean(np.log(times))):.2g}")


if __name__ == "__main__":
    {
        "measure": measure,
        "errors": errors,
        "held_out": held_out,
        "costs": costs,
        "own": own,
        "expected": expected,
    }[sys.argv[1]]()
