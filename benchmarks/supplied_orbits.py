"""Run level `supplied` on random duties: verdicts, cost, and the change on a finer mesh.

    nice python -m benchmarks.supplied_orbits ensemble [duties]     marches, 300 unless given
    nice python -m benchmarks.supplied_orbits finer [duties]        a fifth of them twice as fine
    nice python -m benchmarks.supplied_orbits why                   those that miss: cycles, mesh or step
    nice python -m benchmarks.supplied_orbits near [duties]         holes under the load: meshes of version 3
    python -m benchmarks.supplied_orbits                            prints the tables

`finer` takes two of ten, engines and Fourier loads of every kind of supply alike. `why` marches each duty
whose least gap changes by more than 2 % three times more, from its result: further cycles of the same march,
twice the cells with the same step, half the step with the same cells. `near` marches those whose holes stay
under the load on the meshes that `oil_film_cycle` 1 adds, and on a finest one: three times the cells around,
10 rows and half the step; some 40 s a duty, those that miss first.

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
from templates.physics.supplied.supplied_orbit import (
    COARSE,
    FINE,
    MORE_ROWS,
    NEAR_HOLES,
    STAYS,
    THIN,
    MeshSettings,
    SuppliedOrbit,
    Verdict,
    supplied_orbit,
)

RESULTS = Path("benchmarks/results/supplied_orbits.json")
SEED, DUTIES = 17, 300
MISS = 0.02
"""Change of the smallest gap on a finer mesh above which the cause is investigated [-]."""
FINEST = MeshSettings(384, 10, FINE.step / 2, FINE.most, near_edges=True, cells=3.0)
"""The mesh with which the meshes near holes are compared."""
FILMS = (Verdict.REPEATING.value, Verdict.WANDERING.value)
"""Verdicts that report a film."""
Row = dict[str, Any]


def marched(
    duty: RandomDuty,
    meshes: tuple[MeshSettings, ...] = (COARSE, FINE),
    near_holes: tuple[MeshSettings, ...] = (),
) -> tuple[SuppliedOrbit, float]:
    """Return the orbit of a duty and its processor time [s]."""
    begin = process_time()
    orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, meshes, near_holes=near_holes)
    return orbit, process_time() - begin


def row(duty: RandomDuty) -> Row:
    """Return the stored row of a duty."""
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


def sampled(number: int) -> bool:
    """Return whether a duty is one of two in ten.

    Fifty duties contain each supply with each kind of load once.
    """
    return number // 10 % 5 == number % 5


def continued(duty: RandomDuty, kept: Row, cells: int = 1, steps: int = 1) -> Row:
    """Return a stored duty continued for more cycles, then with more cells and steps."""
    base = replace(FINE, around=kept["around"])
    across = cells * base.across
    if kept["least_gap"] < THIN:  # the orbit adds as many rows to each mesh
        across += (cells - 1) * MORE_ROWS
    orbit, seconds = marched(
        duty, (COARSE, base, MeshSettings(cells * base.around, across, base.step / steps, base.most))
    )
    return {
        "least_gap": orbit.least_gap,
        "P_max": float(orbit.P_max.max()),
        "verdict": orbit.verdict.value,
        "cycles": list(orbit.cycles),
        "seconds": seconds,
    }


def why(duty: RandomDuty, kept: Row) -> dict[str, Row]:
    """Return the separate effects of more cycles, of more cells and of smaller steps."""
    return {
        "cycles": continued(duty, kept),
        "cells": continued(duty, kept, cells=2),
        "steps": continued(duty, kept, steps=2),
    }


def near(duty: RandomDuty) -> Row:
    """Return the minimum gap near holes on the added meshes, its stated error, and the finest result."""
    orbit, seconds = marched(duty, near_holes=NEAR_HOLES)
    finest, _ = marched(duty, near_holes=(*NEAR_HOLES, FINEST))
    return {
        "least_gap": orbit.least_gap,
        "mesh_error": orbit.error.gap,
        "verdict": orbit.verdict.value,
        "cycles": list(orbit.cycles),
        "seconds": seconds,
        "finest": {"least_gap": finest.least_gap, "verdict": finest.verdict.value},
    }


def change(kept: Row, other: Row) -> float:
    """Return the relative error of the minimum gap [-]."""
    return float(kept["least_gap"] / other["least_gap"] - 1)


def results() -> dict[str, Any]:
    """Return the stored results; empty at first."""
    if RESULTS.exists():
        kept: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
        return kept
    return {"seed": SEED, "machine": platform.processor() or platform.machine(), "duties": {}}


def run(what: str, duties: int) -> None:
    """Calculate the duties that are not stored yet."""
    kept = results()
    rows = kept["duties"]
    marched(random_duty(SEED, 1))  # compiles the kernels
    for number in sorted(range(duties), key=lambda n: not missed(rows.get(str(n), {}))):
        duty, own = random_duty(SEED, number), rows.get(str(number))
        if what == "ensemble" and own is None:
            rows[str(number)] = row(duty)
        elif what == "finer" and own and sampled(number) and own["verdict"] in FILMS and "finer" not in own:
            own["finer"] = continued(duty, own, cells=2, steps=2)
        elif what == "why" and own and missed(own) and "why" not in own:
            own["why"] = why(duty, own)
        elif what == "near" and own and stays(own) and "near" not in own:
            own["near"] = near(duty)
        else:
            continue
        RESULTS.write_text(json.dumps(kept, indent=1, default=str) + "\n", encoding="utf-8")


def stays(kept: Row) -> bool:
    """Return whether every hole stays under the load, and there is a film."""
    return bool(kept["under_load"] > STAYS and kept["verdict"] in FILMS)


def missed(kept: Row) -> bool:
    """Return whether a finer mesh changes the minimum gap by more than `MISS`."""
    return "finer" in kept and abs(change(kept, kept["finer"])) > MISS


def tables(rows: list[Row]) -> None:
    """Print the verdicts for each supply, the cost, and the change on a finer mesh."""
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
    finer_tables(rows)


def finer_tables(rows: list[Row]) -> None:
    """Print the change on a finer mesh for each supply and in total, and what causes the largest ones."""
    for name in (*SUPPLIES, "all"):
        changes = np.array([
            abs(change(r, r["finer"])) for r in rows if "finer" in r and name in ("all", r["fed_by"])
        ])  # fmt: skip
        if changes.size:
            within = [int((changes <= limit).sum()) for limit in (0.02, 0.05)]
            print(f"least gap against twice as fine, {name}: {changes.size} duties, median "
                  f"{np.median(changes):.4f}, {within[0]} within 2 %, {within[1]} within 5 %, "
                  f"largest {changes.max():.4f}")  # fmt: skip
    for number, kept in results()["duties"].items():
        if missed(kept):
            alone = {cause: f"{change(kept, other):+.4f}" for cause, other in kept.get("why", {}).items()}
            print(f"duty {number}: {kept['kind']}, {kept['fed_by']}, S {kept['S']:.3g}, B/D "
                  f"{kept['ratio']:.2f}, gap {kept['least_gap']:.4f}, hole under the load "
                  f"{kept['under_load']:.2f}, cycles {kept['cycles']}, change "
                  f"{change(kept, kept['finer']):+.4f}, alone {alone}")  # fmt: skip

    near_table()


def near_table() -> None:
    """Print the errors near holes under the load relative to the finest mesh, and the stated errors."""
    for number, kept in results()["duties"].items():
        if (own := kept.get("near")) and own["finest"]["verdict"] in FILMS:
            print(f"duty {number}: under the load {kept['under_load']:.2f}, version 2 "
                  f"{change(kept, own['finest']):+.4f}, 3 {change(own, own['finest']):+.4f}, stated "
                  f"{own['mesh_error']:.4f}, cycles {own['cycles']}, {own['seconds']:.1f} s")  # fmt: skip


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else DUTIES)
    tables(list(results()["duties"].values()))
