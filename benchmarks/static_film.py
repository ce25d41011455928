"""Check the stated errors of `oil_film` 2 at every level on 1 000 new plain bearings.

    python -m benchmarks.static_film           ten minutes: benchmarks/results/static_film.json
    python -m benchmarks.static_film 90701     points of another seed: static_film_90701.json
    python -m benchmarks.static_film 90701 400 fewer of them

The random points are uniform over atanh(eps) from 0.02 to 6 and over ln(B/D) from 0.02 to 20; no table was
derived from them. The reference is extrapolated from 256 × 32 and 512 × 64 intervals; stiffness and damping
are those on 1024 × 64. Points that a level refuses are counted separately.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy import TRUTH, coefficient_errors, film_errors
from benchmarks.film_map import reference
from benchmarks.truths import OIL_SHEAR, decoded, truth_of
from templates.core.arrays import Array
from templates.core.language.evaluate import evaluate
from templates.core.units.quantity import TypedQuantity
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.journals.journal_coefficients import coefficients_at
from templates.physics.journals.static_journal import static_film_at

RESULTS = Path("benchmarks/results/static_film.json")
COUNT, SEED = 1000, 3608
D, PSI, ETA, OMEGA = 0.1, 1e-3, 0.02, 100.0


def places(seed: int, count: int) -> tuple[Array, Array]:
    """Return random eccentricities and width ratios."""
    rng = np.random.default_rng(seed)
    return np.tanh(rng.uniform(0.02, 6, count)), np.exp(rng.uniform(np.log(0.02), np.log(20), count))


def stated(level: str, So: Array, b: Array) -> dict[str, Array]:
    """Return the error that a level states for each output at the points."""
    given: dict[str, tuple[Any, str]] = {
        "radial_load": (So * b * D**2 * ETA * OMEGA / PSI**2, "N"), "bearing_width": (b * D, "m"),
        "bearing_diameter": (D, "m"), "diametral_clearance": (PSI * D, "m"),
        "dynamic_viscosity": (ETA, "Pa*s"), "speed": (OMEGA, "rad/s"),
    }  # fmt: skip
    raw = {name: TypedQuantity(None, unit, value, {}) for name, (value, unit) in given.items()}
    parts = []
    for some in np.array_split(np.arange(So.size), -(-So.size // OilFilm.most_points.get(level, So.size))):
        part = {
            n: q if np.ndim(q.si) == 0 else TypedQuantity(None, q.unit, np.asarray(q.si)[some], {})
            for n, q in raw.items()
        }
        error = evaluate(OilFilm, part, level=level, judge=False).error
        parts.append({n: np.broadcast_to(np.asarray(e, float), some.size) for n, e in error.items()})
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def held(level: str, eps: Array, b: Array, solutions: Array) -> dict[str, Any]:
    """Return, for each output, the number of points with a stated error, and with a right one."""
    truth, matrices = decoded(eps, b, solutions, streamers=truth_of(level, "power_loss") == OIL_SHEAR)
    film = static_film_at(level, truth.So, b)
    own = np.where(np.isfinite(film.eps), film.eps, np.nan)
    errors = {
        **film_errors(film.admitted(own), truth),
        **coefficient_errors(coefficients_at(level, own, b), matrices),
    }
    said, table = stated(level, truth.So, b), {}
    for name, error in errors.items():
        known = np.isfinite(said[name]) & np.isfinite(error)
        if known.any():
            table[name] = {"count": int(known.sum()), "held": int((said[name] >= error)[known].sum())}
    return table


def main(seed: int = SEED, count: int = COUNT) -> None:
    """Measure all levels at the points of a seed, and print the shares of right errors."""
    eps, b = places(seed, count)
    solutions = np.array([reference(float(at), float(width)) for at, width in zip(eps, b, strict=True)])
    found = {level: held(level, eps, b, solutions) for level in OilFilm.levels}
    about = {"seed": seed, "count": count, "truth": TRUTH}
    path = RESULTS if seed == SEED else RESULTS.with_name(f"static_film_{seed}.json")
    path.write_text(json.dumps({**about, "levels": found}, indent=1) + "\n", encoding="utf-8")
    for level, table in found.items():
        for name, one in table.items():
            print(
                f"{level:16} {name:24} {one['held']:5} of {one['count']:5}  {one['held'] / one['count']:.1%}"
            )


if __name__ == "__main__":
    main(*(int(one) for one in sys.argv[1:]))
