"""Calculate random engine bearings of every supply at level `supplied`, and a share on a finer mesh.

    nice python -m benchmarks.film_cycle_engines SEED [duties] [finer]     calculates what is not stored yet
    python -m benchmarks.film_cycle_engines                                prints the tables

The duties are the engines of `supplied_duties`: big ends and main bearings of idealised two- and four-stroke
cylinders; load number 0.3 … 105, B/D 0.15 … 1.2, supply pressure 0.02 … 4 (relative). The kinds of supply
alternate: half groove, full groove, hole in the pin, hole in the sleeve, slot, a groove of any extent, and a
groove with a hole in the pin; holes may be anywhere, also under the load. Each duty is one line of
benchmarks/results/film_cycle_engines.jsonl, with the errors of the cheap levels. `finer` also calculates this
many duties on a mesh that is 1.5 times as fine in space and time. The bounds of the mobility levels are
derived from the duties of seeds 101 and 202 and from those of `film_cycle_duties`. They are tested on the
duties of seed 303, of which only those that may have a bound are calculated (`film_cycle_ensemble`).
"""

import json
import sys
from dataclasses import astuple, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.film_cycle_duties import (
    CLEAR,
    GROOVED,
    PRESSURES,
    course,
    digits,
    errors_of,
    fed,
    keep,
    under_load,
    values,
)
from benchmarks.supplied_duties import RandomDuty, random_duty
from templates.physics.orbits.cyclic_film import weights
from templates.physics.supplied.fed_cycle import UNREPEATED, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.supplied_orbit import (
    COARSE,
    FINE,
    LEAST,
    LEAST_OF_HOLES,
    MORE_ROWS,
    NEAR_HOLES,
    STAYS,
    THIN,
    SuppliedOrbit,
    Totals,
    supplied_orbit,
)
from templates.physics.supplied.supply import Pocket, Supply
from templates.physics.supplied.supply_geometry import HALF

KEPT = Path("benchmarks/results/film_cycle_engines.jsonl")
SUPPLIES = ("half_groove", "full_groove", "pin_hole", "sleeve_hole", "slot", "part_groove", "several")
FINER = 1.5
FITTED, TRIED, JUDGED = (101, 202), 303, (404, 505)
"""Seeds from which the bounds are derived; a seed that may withdraw bounds; seeds that only judge them."""
LOWEST, HIGHEST = 0.02, 4.0
"""Relative supply pressures [-]."""
Line = dict[str, Any]


def engine_duty(seed: int, number: int) -> RandomDuty:
    """Return the bearing of an engine; the kinds of supply alternate."""
    fed_by = SUPPLIES[number % len(SUPPLIES)]
    known = {"part_groove": "half_groove", "several": "full_groove"}.get(fed_by, fed_by)
    duty = random_duty(seed, 2 * number, known)
    rng = np.random.default_rng([seed, number, 7])
    (pocket,) = duty.supply.pockets
    pockets: tuple[Pocket, ...] = (pocket,)
    if fed_by == "half_groove":
        pockets = (replace(pocket, half_angle=float(rng.uniform(np.pi / 3, 2 * np.pi / 3))),)
    elif fed_by == "part_groove":
        pockets = (replace(pocket, half_angle=float(rng.uniform(np.pi / 12, np.pi))),)
    elif fed_by == "several":
        hole = float(np.radians(rng.uniform(3, 10)))
        turned = float(rng.uniform(-np.pi, np.pi))
        pockets = (pocket, Pocket(turned, hole, pocket.half_length, on_journal=True))
    pressure = float(np.exp(rng.uniform(np.log(LOWEST), np.log(HIGHEST))))
    return replace(duty, supply=Supply(pockets, pressure), fed_by=fed_by)


def compared(seed: int, number: int, *, finer: bool) -> Line:
    """Return the results of one duty at every level, as a line of the record."""
    duty = engine_duty(seed, number)
    asked, begin = fed(duty), process_time()
    orbit = fed_orbit("supplied", asked)
    (marched,) = orbit.marches
    assert marched is not None
    seconds = process_time() - begin
    line: Line = {
        "seed": seed, "number": number, "fed_by": duty.fed_by, "load": duty.kind,
        "S": digits(np.hypot(*duty.load.S).max()), "b": digits(duty.ratio), "P": digits(duty.supply.pressure),
        "extent": digits(2 * duty.supply.pockets[0].half_angle), "under_load": digits(marched.under_load),
        "course": course(duty), "verdict": marched.verdict.value, "repeat": digits(marched.repeat_error),
        "cycles": list(marched.cycles), "seconds": round(seconds, 2),
    }  # fmt: skip
    if marched.verdict in UNREPEATED:
        return line
    film = fed_film("supplied", asked, orbit)
    own = [marched.least_gap, film.P_max, film.loss, film.side_flow, marched.mean_feed]
    line["own"] = [digits(value) for value in own]
    line["change"] = [digits(value) for value in astuple(marched.change)]
    line["rate"] = digits(mean_rate(duty, orbit))
    truth = values(orbit, film)
    keep(line, truth)
    line["errors"] = errors_of(duty, truth)
    if finer:
        line["finer"] = finer_march(duty, marched)
    return line


def mean_rate(duty: RandomDuty, orbit: FedOrbit) -> float:
    """Return the mean shear rate over Omega/psi: sliding over gap, around the bearing and the cycle [-]."""
    load, gap = duty.load, orbit.gap
    mean = weights(load.angle, load.period) / load.period
    return float((np.abs(duty.sliding) / np.sqrt(gap * (2 - gap))) @ mean)


def finer_march(duty: RandomDuty, marched: SuppliedOrbit) -> list[float | None] | None:
    """Return the changes on a mesh `FINER` times as fine in space and time; None if there is no film."""
    near = NEAR_HOLES if marched.under_load > STAYS else ()
    last = near[-1] if near else FINE
    thin = MORE_ROWS if marched.least_gap < THIN else 0
    across = round(FINER * (last.across + thin)) - thin  # the orbit adds `thin` rows
    finest = replace(last, around=round(FINER * marched.around), across=across, step=last.step / FINER,
                     cells=FINER * last.cells)  # fmt: skip
    meshes = (COARSE, FINE, *near, finest)
    orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, meshes)
    return None if orbit.verdict in UNREPEATED else [digits(v) for v in astuple(orbit.change)]


def kept() -> list[Line]:
    """Return all lines of the record."""
    if not KEPT.exists():
        return []
    return [json.loads(line) for line in KEPT.read_text(encoding="utf-8").splitlines()]


def is_placed(duty: RandomDuty) -> bool:
    """Return whether a duty may have a bound: by pressure, groove, or how long a hole is under the load."""
    if not PRESSURES[0] <= duty.supply.pressure <= PRESSURES[1]:
        return False
    if duty.fed_by == "part_groove":
        return abs(2 * duty.supply.pockets[0].half_angle - np.pi) <= HALF
    return duty.fed_by in GROOVED[:2] or (duty.fed_by != "several" and under_load(duty) <= CLEAR)


def march(seed: int, duties: int, finer: int) -> None:
    """Calculate what is not stored yet; of the test seed, only duties that may have a bound."""
    done = {(line["seed"], line["number"]) for line in kept()}
    for number in range(duties):
        if (seed, number) not in done and (seed in FITTED or is_placed(engine_duty(seed, number))):
            line = compared(seed, number, finer=number < finer)
            with KEPT.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line, separators=(",", ":")) + "\n")


def held(line: Line, times: float = 1.0) -> list[bool]:
    """Return whether the errors stated at level supplied are right on the finer mesh, in order of `Totals`.

    `times` is the ratio of the stated error to the change on that mesh.
    """
    least = LEAST if any(line["fed_by"] == one for one in GROOVED[:2]) else LEAST_OF_HOLES
    stated = astuple(Totals(*line["change"]).error(line["repeat"], least))
    return [times * change <= error for change, error in zip(line["finer"], stated, strict=True)]


def tables() -> None:
    """Print how many stated errors are right, by seed."""
    for seed in sorted({line["seed"] for line in kept()}):
        own = [line for line in kept() if line["seed"] == seed]
        finer = [line for line in own if line.get("finer")]
        seconds = np.median([line["seconds"] for line in own])
        print(f"seed {seed}: {len(own)} duties, {seconds:.2f} s in the median; {len(finer)} on a finer mesh")
        for times in (1.0, 1.8):
            if finer:
                counts = np.sum([held(line, times) for line in finer], axis=0).tolist()
                print(f"  stated errors over {times} times the change: film, pressure, loss, flow {counts}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        march(*(int(one) for one in sys.argv[1:4]))
    tables()
