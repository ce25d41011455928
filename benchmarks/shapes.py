"""Bearings of `oil_film` 2 that are not plain: meshes, start line, and grooves under load.

    python -m benchmarks.shapes mesh        ten minutes: 60 bearings, benchmarks/results/shapes_mesh.json
    python -m benchmarks.shapes start_line  K_xx and the whirl limit with both start lines
    python -m benchmarks.shapes groove      what a film with a groove in the load line bears

The errors of a plain, aligned bearing without grooves are measured by `benchmarks.accuracy`. `mesh` compares
the film that it states with one extrapolated from 128 × 16 and 256 × 32 intervals. It keeps what it
has and goes on there.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities import shaped_balance
from templates.physics.cavities.fed_film import Feed
from templates.physics.cavities.shaped_balance import Loaded, NoBalance, balance
from templates.physics.cavities.shaped_film import shaped_film
from templates.physics.cavities.shaped_network import shaped_nodes
from templates.physics.films.film_map import mapped_load
from templates.physics.films.film_shape import Bore, Lie, narrowest
from templates.physics.journals.shaped_journal import START_LINES, Shape, journal_film_at, linear_of

RESULTS = Path("benchmarks/results/shapes_mesh.json")
FINER = (*shaped_balance.MESHES, (256, 32))
COUNT = 60
PLAIN = Shape("plain", 2, *(np.array(v) for v in (0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0)))


def drawn(seed: int) -> Loaded:
    """Return a random bearing of usual size: lobed or not, tilted or not, grooved or not."""
    rng = np.random.default_rng([20261122, seed])
    lobes = int(rng.choice([1, 2, 3, 4]))
    bore = Bore(
        lobes, 0.0 if lobes == 1 else rng.uniform(0.1, 0.7), rng.uniform(-np.pi, np.pi),
        1.0 if lobes == 2 and rng.random() < 0.5 else 0.5,
    )  # fmt: skip
    if rng.random() < 0.3:
        bore = replace(bore, mouth=rng.uniform(0.05, 0.5), mouth_length=rng.uniform(0.1, 0.4))
    tilt = rng.uniform(-0.2, 0.2, 2) if rng.random() < 0.5 else np.zeros(2)
    grooves = tuple((side * np.pi / 2, np.radians(20)) for side in (1, -1)) if rng.random() < 0.5 else ()
    ratio = 10 ** rng.uniform(-0.9, 0.3)
    So = float(mapped_load(np.array(rng.uniform(0.2, 0.9)), np.array(ratio)))
    return Loaded(So, ratio, bore, tilt, Feed(0.0, grooves), bool(rng.random() < 0.5))


def stated(loaded: Loaded) -> tuple[dict[str, float], float]:
    """Gap, largest pressure, side flow and stiffness as `shaped_journal` states them, and the mesh error."""
    balanced = balance(loaded)
    coarse, fine = balanced.coarse, balanced.fine
    gaps = [narrowest(loaded.bore, lie)[0] for lie in (balanced.at_coarse, balanced.at_fine)]
    lie = Lie(balanced.at_fine.e + (balanced.at_fine.e - balanced.at_coarse.e) / 3, loaded.tilt)
    values = {
        "gap": narrowest(loaded.bore, lie)[0],
        "pressure": fine.peak[0] + (fine.peak[0] - coarse.peak[0]) / 3,
        "side_flow": 2 * fine.side_flow - coarse.side_flow,
        "stiffness": float(fine.linear[0][0, 0]),
    }
    return values, abs(gaps[1] - gaps[0]) / gaps[1]


def measured(seed: int) -> dict[str, Any]:
    """Return the errors of one bearing, relative, and what it cost."""
    loaded, begin = drawn(seed), process_time()
    about: dict[str, Any] = {"seed": seed, "conserving": loaded.conserving, "tilted": bool(loaded.tilt.any())}
    try:
        values, mesh_error = stated(loaded)
    except NoBalance:
        return about | {"refused": True, "seconds": process_time() - begin}
    seconds, usual = process_time() - begin, shaped_balance.MESHES
    try:
        shaped_balance.MESHES = FINER
        truth, _ = stated(loaded)
    finally:
        shaped_balance.MESHES = usual
    errors = {name: abs(values[name] / truth[name] - 1) for name in truth}
    return about | {"errors": errors, "mesh_error": mesh_error, "seconds": seconds}


def mesh() -> None:
    """Measure what is not yet, and print the table of docs/oil_film_shapes.md."""
    kept = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else []
    for seed in range(len(kept), COUNT):
        kept.append(measured(seed))
        RESULTS.write_text(json.dumps(kept, indent=0) + "\n", encoding="utf-8")
    films = [one for one in kept if "errors" in one]
    print(f"{len(kept)} bearings, {len(kept) - len(films)} refused")
    print("| | median | 95 % | largest |\n|---|---|---|---|")
    for name in ("gap", "pressure", "side_flow", "stiffness"):
        print(_row(f"error of {name}", [one["errors"][name] for one in films]))
    print(_row("stated mesh error", [one["mesh_error"] for one in films]))
    held = np.mean([one["errors"]["gap"] <= one["mesh_error"] for one in films])
    print(f"the stated mesh error bounds that of the gap in {held:.0%}")
    for tilted in (False, True):
        seconds = [one["seconds"] for one in films if one["tilted"] == tilted]
        print(
            "processor seconds,",
            "tilted" if tilted else "aligned",
            np.percentile(seconds, [50, 95, 100]).round(2),
        )


def _row(name: str, values: list[float]) -> str:
    return (
        f"| {name} | " + " | ".join(f"{100 * v:.2g} %" for v in np.percentile(values, [50, 95, 100])) + " |"
    )


def start_line() -> None:
    """Print K_xx over W/c and the whirl limit at level map, B/D 1, with both start lines."""
    print("| eps | K_xx fixed | K_xx moving | whirl limit moving over fixed |\n|---|---|---|---|")
    for eps in (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8):
        So, ratio = mapped_load(np.array(eps), np.array(1.0)), np.array(1.0)
        film = journal_film_at("map", So, ratio, np.array(0.0), (), PLAIN, np.array(0.0))
        fixed, moving = (linear_of("map", film, So, ratio, line, np.array(0.0), ()) for line in START_LINES)
        limit = np.sqrt(moving.M_c / fixed.M_c) if np.isfinite(moving.M_c + fixed.M_c) else np.nan
        both = " | ".join(f"{float(one.K_xx / So):.2f}" for one in (fixed, moving))
        print(f"| {eps} | {both} | {'stable' if np.isnan(limit) else f'{limit:.3f}'} |")


def groove() -> None:
    """Print the load along the groove's direction that a film bears where none stands across it.

    A plain bearing, B/D 0.5, with a groove of 20° over the whole width. The journal is where the force across
    the load vanishes: there is an equilibrium only if the force along reaches the load.
    """
    print("| groove at | relative supply pressure | eps 0.6 | 0.8 | 0.9 | 0.95 | 0.98 |\n" + "|---" * 7 + "|")
    for angle in (-10, 0, 10, 20):
        for pressure in (0.0, 1.0):
            borne = [_borne(angle, pressure, eps) for eps in (0.6, 0.8, 0.9, 0.95, 0.98)]
            print(f"| {angle}° | {pressure} | " + " | ".join(borne) + " |")


def _borne(angle: float, pressure: float, eps: float) -> str:
    """The largest load that is borne at an eccentricity, over the attitudes at which none stands across."""
    attitudes = np.radians(np.linspace(-90, 90, 49))
    forces = np.array([_force(angle, pressure, eps, attitude) for attitude in attitudes])
    along, across = forces.T
    turns = np.flatnonzero(np.diff(np.sign(across)) != 0)
    share = across[turns] / (across[turns] - across[turns + 1])
    loads = along[turns] + share * (along[turns + 1] - along[turns])
    return f"{loads.max():.2f}" if loads.size else "none"


def _force(angle: float, pressure: float, eps: float, attitude: float) -> Array:
    lie = Lie(eps * np.array([np.cos(attitude), np.sin(attitude)]), np.zeros(2))
    loaded = Loaded(0.0, 0.5, Bore(), lie.tilt, Feed(pressure, ((np.radians(angle), np.radians(20)),)), False)
    pockets = loaded.pockets(0.0)
    nodes = shaped_nodes(loaded.bore, lie, loaded.ratio, pockets, 64, 8)
    return shaped_film(nodes, loaded.bore, lie, pockets, conserving=True).force


if __name__ == "__main__":
    {"mesh": mesh, "start_line": start_line, "groove": groove}[sys.argv[1]]()
