"""Measure bearings of `oil_film` 2 that are not plain: meshes, start line, and grooves under load.

    python -m benchmarks.shapes mesh        ten minutes: 310 bearings, benchmarks/results/shapes_mesh.json
    python -m benchmarks.shapes held_out    320 others by which nothing was chosen: shapes_held_out.json
    python -m benchmarks.shapes fresh       320 further ones that only check: shapes_fresh.json
    python -m benchmarks.shapes start_line  K_xx and the whirl limit with both start lines
    python -m benchmarks.shapes groove      what a film with a groove in the load line bears

The errors of a plain, aligned bearing without grooves are measured by `benchmarks.accuracy`. `mesh` compares
the film and the error that it states with a film extrapolated from meshes twice as fine each way. It keeps
what it has and goes on there.
"""

import json
import sys
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities import shaped_balance
from templates.physics.cavities.fed_film import Feed
from templates.physics.cavities.shaped_balance import Balance, BearingCase, balance
from templates.physics.cavities.shaped_film import shaped_film
from templates.physics.cavities.shaped_network import shaped_nodes
from templates.physics.films.film_map import mapped_load
from templates.physics.films.film_shape import Bore, Lie
from templates.physics.journals.shaped_journal import START_LINES, Shape, journal_film_at, linear_of
from templates.physics.journals.shaped_journal import measured as measured_film

SEED, HELD_OUT, ONLY_CHECKED = 36, 3607, 90636
RESULTS = {
    SEED: Path("benchmarks/results/shapes_mesh.json"),
    3605: Path("benchmarks/results/shapes_second.json"),
    3606: Path("benchmarks/results/shapes_third.json"),
    HELD_OUT: Path("benchmarks/results/shapes_held_out.json"),
    ONLY_CHECKED: Path("benchmarks/results/shapes_fresh.json"),
}
"""Where the bearings of each seed are kept; the factors were chosen on the first, after the next two."""
COUNTS = {SEED: 310, 3605: 310, 3606: 226, HELD_OUT: 320, ONLY_CHECKED: 320}
STATED = {
    "gap": "mesh_error",
    "place": "place_error",
    "pressure": "pressure_error",
    "side_flow": "flow_error",
}
"""Compared outputs, each with the stated error that must bound its error."""
PLAIN = Shape("plain", 2, *(np.array(v) for v in (0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0)))


def drawn(number: int, seed: int = SEED) -> BearingCase:
    """Return a random bearing, lobed, grooved or both, at So 1e-3 to 10 and B/D 0.2 to 1.6."""
    rng = np.random.default_rng([seed, number])
    lobes = int(rng.choice([1, 2, 3, 4]))
    bore = Bore(
        lobes, 0.0 if lobes == 1 else rng.uniform(0.1, 0.75), rng.uniform(-np.pi, np.pi),
        1.0 if lobes == 2 and rng.random() < 0.4 else 0.5,
    )  # fmt: skip
    kind = int(rng.integers(3)) if lobes > 1 else 1 + int(rng.integers(2))
    width = np.radians(rng.uniform(8, 30))
    if kind == 2:
        places = bore.joints().tolist() if lobes > 1 else [rng.uniform(np.pi / 2, 3 * np.pi / 2)]
    else:
        places = [np.pi / 2, -np.pi / 2] * kind
    ratio, So = 10 ** rng.uniform(-0.7, 0.2), 10 ** rng.uniform(-3, 1)
    feed = Feed(0.0, tuple((place, width) for place in places))
    return BearingCase(So, ratio, bore, np.zeros(2), feed, bool(rng.random() < 0.6))


def stated(loaded: BearingCase) -> tuple[Balance, dict[str, Any]]:
    """Return the equilibrium, and the fields of `StaticFilm` that `shaped_journal` states."""
    balanced = balance(loaded)
    return balanced, measured_film(balanced, loaded.bore, loaded.tilt, 1.0)


def values_of(film: dict[str, Any]) -> dict[str, Array]:
    """Return the values to compare; the journal position as a vector."""
    place = film["eps"] * np.array([np.cos(film["attitude"]), np.sin(film["attitude"])])
    return {"gap": np.array(film["least"]), "place": place, "pressure": np.array(film["P_max"]),
            "side_flow": np.array(film["side_flow"])}  # fmt: skip


def truth_of(loaded: BearingCase, balanced: Balance) -> dict[str, Array]:
    """Return the film extrapolated from a mesh twice as fine each way as the finest of the result."""
    mesh = {128: (256, 32), 256: (512, 64)}[around(balanced)]
    fine = balanced.fine
    finest = shaped_balance.stable_film(loaded, fine.lie.e, mesh, fine.film)
    settled = shaped_balance.SETTLED
    try:
        shaped_balance.SETTLED = np.inf  # steps of any size may be extrapolated to the true value
        return values_of(measured_film(Balance(balanced.coarse, fine, finest), loaded.bore, loaded.tilt, 1.0))
    finally:
        shaped_balance.SETTLED = settled


def around(balanced: Balance) -> int:
    """Return the number of intervals around the bearing of the finest mesh."""
    return int(balanced.fine.film.nodes.shape[0])


def measured(number: int, seed: int = SEED) -> dict[str, Any]:
    """Return the true and the stated relative errors of one bearing, and its cost."""
    loaded, begin = drawn(number, seed), process_time()
    about: dict[str, Any] = {"seed": number, "So": loaded.So}
    try:
        balanced, film = stated(loaded)
        about |= {"around": around(balanced), "extrapolated": balanced.is_asymptotic}
        about["seconds"] = process_time() - begin
        truth = truth_of(loaded, balanced)
    except (ArithmeticError, RuntimeError):
        return about | {"refused": True}
    values = values_of(film)
    norm = np.linalg.norm
    errors = {name: float(norm(values[name] - true) / norm(true)) for name, true in truth.items()}
    return about | {"errors": errors, "stated": {name: float(film[own]) for name, own in STATED.items()}}


def measured_films(seed: int = SEED) -> list[dict[str, Any]]:
    """Return the measured bearings of a seed that have a film."""
    return [one for one in json.loads(RESULTS[seed].read_text(encoding="utf-8")) if "errors" in one]


def mesh(seed: int = SEED) -> None:
    """Measure missing bearings, and print the table of docs/oil_film_shapes.md."""
    path = RESULTS[seed]
    kept = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []
    for number in range(len(kept), COUNTS[seed]):
        kept.append(measured(number, seed))
        path.write_text(json.dumps(kept, indent=0) + "\n", encoding="utf-8")
    films = measured_films(seed)
    finer, kept_back = (
        [one for one in films if one[name] in of]
        for name, of in (("around", {256}), ("extrapolated", {False}))
    )
    print(
        f"{len(kept)} bearings, {len(kept) - len(films)} refused, "
        f"{len(finer)} refined, {len(kept_back)} not extrapolated"
    )
    print("| | median | 95 % | largest | stated, median | held |\n|---|---|---|---|---|---|")
    for name in STATED:
        true, own = (np.array([one[kind][name] for one in films]) for kind in ("errors", "stated"))
        shown = " | ".join(f"{100 * v:.2g} %" for v in (*np.percentile(true, [50, 95, 100]), np.median(own)))
        print(f"| {name} | {shown} | {(true <= own).mean():.1%} |")
    for what, some in (("all", films), ("refined", finer)):
        print(
            "processor seconds,",
            what,
            np.percentile([one["seconds"] for one in some], [50, 95, 100]).round(2),
        )


def start_line() -> None:
    """Print K_xx over W/c and the whirl threshold at level map, B/D 1, with both start lines."""
    print("| eps | K_xx fixed | K_xx moving | whirl limit moving over fixed |\n|---|---|---|---|")
    for eps in (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8):
        So, ratio = mapped_load(np.array(eps), np.array(1.0)), np.array(1.0)
        film = journal_film_at("map", So, ratio, np.array(0.0), (), PLAIN, np.array(0.0))
        fixed, moving = (linear_of("map", film, So, ratio, line, np.array(0.0), ()) for line in START_LINES)
        limit = np.sqrt(moving.M_c / fixed.M_c) if np.isfinite(moving.M_c + fixed.M_c) else np.nan
        both = " | ".join(f"{float(one.K_xx / So):.2f}" for one in (fixed, moving))
        print(f"| {eps} | {both} | {'stable' if np.isnan(limit) else f'{limit:.3f}'} |")


def groove() -> None:
    """Print the load along the groove's direction that a film carries without a force across it.

    A plain bearing, B/D 0.5, with a groove of 20° over the whole width. The journal is where the force across
    the load vanishes: there is an equilibrium only if the force along reaches the load.
    """
    print("| groove at | relative supply pressure | eps 0.6 | 0.8 | 0.9 | 0.95 | 0.98 |\n" + "|---" * 7 + "|")
    for angle in (-10, 0, 10, 20):
        for pressure in (0.0, 1.0):
            borne = [_borne(angle, pressure, eps) for eps in (0.6, 0.8, 0.9, 0.95, 0.98)]
            print(f"| {angle}° | {pressure} | " + " | ".join(borne) + " |")


def _borne(angle: float, pressure: float, eps: float) -> str:
    """Return the largest load carried at an eccentricity, over attitudes without a force across it."""
    attitudes = np.radians(np.linspace(-90, 90, 49))
    forces = np.array([_force(angle, pressure, eps, attitude) for attitude in attitudes])
    along, across = forces.T
    turns = np.flatnonzero(np.diff(np.sign(across)) != 0)
    share = across[turns] / (across[turns] - across[turns + 1])
    loads = along[turns] + share * (along[turns + 1] - along[turns])
    return f"{loads.max():.2f}" if loads.size else "none"


def _force(angle: float, pressure: float, eps: float, attitude: float) -> Array:
    lie = Lie(eps * np.array([np.cos(attitude), np.sin(attitude)]), np.zeros(2))
    loaded = BearingCase(
        0.0, 0.5, Bore(), lie.tilt, Feed(pressure, ((np.radians(angle), np.radians(20)),)), False
    )
    pockets = loaded.pockets(0.0)
    nodes = shaped_nodes(loaded.bore, lie, loaded.ratio, pockets, 64, 8)
    return shaped_film(nodes, loaded.bore, lie, pockets, conserving=True).force


if __name__ == "__main__":
    {
        "mesh": mesh,
        "held_out": lambda: mesh(HELD_OUT),
        "fresh": lambda: mesh(ONLY_CHECKED),
        "start_line": start_line,
        "groove": groove,
    }[sys.argv[1]]()
