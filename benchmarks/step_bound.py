"""Count how often the stated bound of an orbit's minimum gap is right, on random duties.

    python -m benchmarks.step_bound [duties]      two minutes for 400, and as many for grooved ones

The script prints the shares and stores them in benchmarks/results/step_bound.json. Grooved duties are for
level `mobility_grooved` of `oil_film_cycle` 1, with a groove of any position and extent, and up to half as
wide as the bearing.

The truth is the orbit with steps sixteen times as fine. `step_error` is what `oil_film_cycle` 1 answers, the
change at shared nodes; `step_bound` is that of `templates/physics/orbits/step_bound.py`.
"""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.physics.orbits import journal_orbit
from templates.physics.orbits.grooved_mobility import Groove, GroovePassage, grooved_orbit
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw
from templates.physics.orbits.rotation import turning

RESULTS = Path("benchmarks/results/step_bound.json")
SEED, DUTIES, POINTS, FINER = 91, 400, 72, 16
USUAL = (0.3, 105.0)
"""Largest load numbers of usual engine bearings [-]."""


@dataclass(frozen=True)
class Shares:
    """Outcomes of the duties that have an orbit."""

    orbits: int
    bounded_before: float
    """Share of duties bounded by `step_error`, for the smallest gap at the nodes."""
    known: float
    known_usual: float
    """Share of duties with a `step_bound`, of all loads and of usual loads."""
    bounded: float
    """Share of these duties for which the bound is right."""
    worst: float
    """Largest error over its bound."""
    excess: float
    """Median of the bound over the error."""


def random_duties(rng: np.random.Generator, count: int, points: int) -> tuple[CyclicLoad, Array]:
    """Return random loads: harmonics and a firing, six decades, any sign of speed, B/D 0.05 … 5."""
    angle = np.arange(points) * 4 * np.pi / points
    order = np.arange(8)[:, None, None]
    size = rng.random((8, count, 4)) * (rng.random((8, count, 1)) < 0.5) / (1 + order)
    waves = np.stack([np.cos(order * angle / 2), np.sin(order * angle / 2)])
    S = np.einsum("ocf,foan->fcn", size[..., :2] - size[..., 2:] / 2, waves)
    S[0] += 3 * rng.random((count, 1)) * np.exp(8 * (np.cos((angle - 6.3 * rng.random((count, 1))) / 2) - 1))
    S *= 10 ** rng.uniform(-3, 3, (count, 1))
    w = rng.choice([0.5, 0.5, 1.0, -0.5, 0.0, 0.1, 3.0], (count, 1)) * np.ones(points)
    return CyclicLoad(angle, 4 * np.pi, S, w), 10 ** rng.uniform(-1.3, 0.7, count)


@contextmanager
def finer_steps(times: float) -> Iterator[None]:
    """Return orbits with steps this many times finer, without further refinement."""
    kept = journal_orbit.LARGEST_STEP, journal_orbit.ROUGHEST
    journal_orbit.LARGEST_STEP, journal_orbit.ROUGHEST = kept[0] / times, np.inf
    try:
        yield
    finally:
        journal_orbit.LARGEST_STEP, journal_orbit.ROUGHEST = kept


def measured(seed: int, duties: int, finer: float = FINER) -> Shares:
    """Compare both estimates with the true error."""
    load, ratio = random_duties(np.random.default_rng(seed), duties, POINTS)
    law = MapLaw(ratio)
    orbit = periodic_orbit(load, law)
    with finer_steps(finer):
        true = periodic_orbit(load, law).between
    return compared(orbit, true, np.hypot(*load.S).max(axis=-1))


def measured_with_grooves(seed: int, duties: int, finer: float = FINER) -> Shares:
    """Compare both estimates for bearings with a groove in a fixed sleeve."""
    rng = np.random.default_rng(seed)
    load, ratio = random_duties(rng, duties, POINTS)
    ratio = np.maximum(ratio, 0.1)
    rest = turning(load.angle, load.period, np.zeros(load.w.shape))
    place = rng.uniform(-np.pi, np.pi, duties), rng.uniform(0.2, 2 * np.pi, duties)
    passing = GroovePassage(load, rest, Groove(rng.uniform(0.05, 0.5, duties), *place))
    orbit = grooved_orbit(passing, ratio)
    with finer_steps(finer):
        true = grooved_orbit(passing, ratio).between
    return compared(orbit, true, np.hypot(*load.S).max(axis=-1))


def compared(orbit: Orbit, true: Array, load: Array) -> Shares:
    """Return the shares for the orbits that both calculations have."""
    present = np.isfinite(orbit.least_gap) & np.isfinite(true)
    bound, error = orbit.step_bound[present], np.abs(orbit.between / true - 1)[present]
    at_nodes = np.abs(orbit.least_gap / true - 1)[present]
    is_known, usual = np.isfinite(bound), (load[present] > USUAL[0]) & (load[present] < USUAL[1])
    return Shares(
        int(present.sum()),
        float((orbit.step_error[present] >= at_nodes).mean()),
        float(is_known.mean()),
        float(is_known[usual].mean()),
        float((bound[is_known] >= error[is_known]).mean()),
        float((error[is_known] / bound[is_known]).max()),
        float(np.median(bound[is_known] / error[is_known])),
    )


def main() -> None:
    """Measure, store and print the shares."""
    duties = int(sys.argv[1]) if len(sys.argv) > 1 else DUTIES
    shares = {"mobility": measured(SEED, duties), "mobility_grooved": measured_with_grooves(SEED, duties)}
    kept = {"duties": duties, **{level: asdict(share) for level, share in shares.items()}}
    RESULTS.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    for level, share in shares.items():
        print(level, share)


if __name__ == "__main__":
    main()
