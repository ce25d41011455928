"""Level `supplied` on random duties: how marches end, what they cost, and what a finer mesh changes.

    nice python -m benchmarks.supplied_orbits ensemble [duties]     marches, 300 unless given
    nice python -m benchmarks.supplied_orbits finer [duties]        every fifth of them twice as fine
    python -m benchmarks.supplied_orbits                            prints the tables

Every duty is written to benchmarks/results/supplied_orbits.json as soon as it is marched, and is not marched
again. Processor seconds are those of one process on the machine named in the results, without compiling.
"""

import json
import platform
import sys
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.supplied_duties import GROOVES, SUPPLIES, RandomDuty, random_duty
from templates.physics.supplied.supplied_orbit import COARSE, FINE, Meshing, SuppliedOrbit, supplied_orbit

RESULTS = Path("benchmarks/results/supplied_orbits.json")
SEED, DUTIES, EVERY = 17, 300, 5
Row = dict[str, Any]


def marched(duty: RandomDuty, meshes: tuple[Meshing, ...] = (COARSE, FINE)) -> tuple[SuppliedOrbit, float]:
    """The orbit of a duty and its processor time [s]."""
    begin = process_time()
    orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, meshes)
    return orbit, process_time() - begin


def row(duty: RandomDuty) -> Row:
    """What is kept of a duty."""
    orbit, seconds = marched(duty)
    return {
        "kind": duty.kind,
        "fed_by": duty.fed_by,
        "S": float(np.hypot(*duty.load.S[:, 0]).max()),
        "ratio": duty.ratio,
        "pressure": duty.supply.pressure,
        "verdict": orbit.verdict.value,
        "under_load": orbit.under_load,
        "least_gap": orbit.least_gap,
        "P_max": float(orbit.P_max.max()),
        "repeat_error": orbit.repeat_error,
        "drift": orbit.drift,
        "cycles": list(orbit.cycles),
        "around": orbit.around,
        "halvings": orbit.halvings,
        "mass_balance": orbit.mass_balance,
        "seconds": seconds,
    }


def finer(duty: RandomDuty, kept: Row) -> Row:
    """The least gap with twice the cells around and across, and half the step."""
    base = replace(FINE, around=kept["around"])
    twice = Meshing(2 * base.around, 2 * base.across, base.step / 2, base.most)
    orbit, seconds = marched(duty, (COARSE, base, twice))
    return {"least_gap": orbit.least_gap, "verdict": orbit.verdict.value, "seconds": seconds}


def results() -> dict[str, Any]:
    """What is kept; empty at first."""
    if RESULTS.exists():
        kept: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
        return kept
    return {"seed": SEED, "machine": platform.processor() or platform.machine(), "duties": {}}


def run(what: str, duties: int) -> None:
    """March what is not kept yet."""
    kept = results()
    marched(random_duty(SEED, 1))  # compiles
    for number in range(duties):
        rows, duty = kept["duties"], random_duty(SEED, number)
        if what == "ensemble" and str(number) not in rows:
            rows[str(number)] = row(duty)
        elif what == "finer" and number % EVERY == 0 and "finer" not in rows.get(str(number), {"finer": 0}):
            if rows[str(number)]["verdict"] == "starved":
                continue
            rows[str(number)]["finer"] = finer(duty, rows[str(number)])
        else:
            continue
        RESULTS.write_text(json.dumps(kept, indent=1, default=str) + "\n", encoding="utf-8")


def tables(rows: list[Row]) -> None:
    """Endings for each supply, cost, and the change by a finer mesh."""
    print(f"{len(rows)} duties")
    verdicts = ("repeating", "wandering", "starved", "unsettled")
    print("supply       " + "".join(f"{verdict:>11}" for verdict in verdicts))
    for fed_by in SUPPLIES:
        ends = [r["verdict"] for r in rows if r["fed_by"] == fed_by]
        print(f"{fed_by:13}" + "".join(f"{ends.count(verdict):11d}" for verdict in verdicts))
    seconds = np.array([r["seconds"] for r in rows])
    print(
        f"CPU s: median {np.median(seconds):.2f}, 95 % {np.quantile(seconds, 0.95):.2f}, {seconds.max():.1f}"
    )
    wandering = [r["repeat_error"] for r in rows if r["verdict"] == "wandering"]
    grooved = [r["repeat_error"] for r in rows if r["fed_by"] in GROOVES]
    print(f"largest repeat error: wandering {max(wandering, default=0):.1e}, grooves {max(grooved):.1e}")
    starved = [r["under_load"] for r in rows if r["verdict"] == "starved"]
    print("hole under the load, starved duties: " + " ".join(f"{share:.2f}" for share in sorted(starved)))
    change = np.array([abs(r["least_gap"] / r["finer"]["least_gap"] - 1) for r in rows if "finer" in r])
    if change.size:
        within = [float((change <= limit).mean()) for limit in (0.02, 0.05)]
        print(f"least gap against twice as fine, {change.size} duties: median {np.median(change):.4f}, "
              f"2 % {within[0]:.3f}, 5 % {within[1]:.3f}, largest {change.max():.4f}")  # fmt: skip


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else DUTIES)
    tables(list(results()["duties"].values()))
