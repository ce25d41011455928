"""Level `elastic` of `elastic_film` 2 on random bearings: cost, and error against a second method.

    python -m benchmarks.elastic_ensemble run      all cases, some 12 minutes of processor time
    python -m benchmarks.elastic_ensemble page     the tables of docs/oil_film_elastic.md from what there is

Each case is one line of benchmarks/results/elastic_ensemble.jsonl, written when it is done; a run goes on
where it was stopped.

`ring`: the housing is a thick ring, whose compliance is known in closed form. Level elastic is given its
38 modes, and a half plane above them; the reference takes all 40 harmonics of the ring, by the second method.

`housing`, `rod`: a random bearing housing or rod big end by finite elements, each under several loads. Level
elastic is given the matrix of level default of `bore_compliance`. Two references: `same`, the second method
with the same 38 modes, shows what solver and mesh of the film cost; `more`, with 93 modes (harmonics 0 to 15
times Legendre's polynomials 0, 2, 4) on a finer mesh of the solid, shows what the level costs in all.

The second method is `benchmarks.elastic_reference`, extrapolated from 64 x 8 and 128 x 16 elements. How far
it is sure is a third of the change between these two. Errors are relative, of angles in degrees.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.elastic_reference import Bore, Film, Lost, balanced, carried, elements, measured, places_for
from templates.core.arrays import Array
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.elastic_film_v2 import ElasticFilm
from templates.physics.elastic.bore_film import BoreFilm, BoreSoftness, bore_balances
from templates.physics.elastic.bore_modes import HIGHEST, half_plane
from templates.physics.elastic.compliance import HARMONICS, ring_compliance
from templates.physics.elastic.elastic_journal import ROELANDS_PRESSURE, ROELANDS_SIZE
from templates.physics.elastic.soft_balance import NoBalance
from templates.physics.journals.static_journal import static_film_at

KEPT = Path("benchmarks/results/elastic_ensemble.jsonl")
SEED = 88
RINGS, SOLIDS, LOADS = 48, 12, 4
"""Rings; housings and rods together; bearings in each of these."""
WIDE, ALONG = 15, 3
"""The highest harmonic of the reference's modes, and how many polynomials along."""
SIZES, SURE = ((96, 8), (192, 16), (384, 32)), 2e-3
"""Elements of the second method around and across, and the change over three at which they suffice."""
NAMES = {
    "least": "minimum_film_thickness", "P_max": "maximum_pressure", "deformation": "largest_deformation",
    "eps": "relative_eccentricity", "attitude": "attitude_angle",
}  # fmt: skip
SOFTNESS = (0.3, 1.0, 3.0)
"""Where groups of bearings end: largest deformation over the smallest film [-]."""
FIGURES = {
    "least": ("smallest film", 100.0, "%"), "P_max": ("largest pressure", 100.0, "%"),
    "deformation": ("largest deformation", 100.0, "%"), "eps": ("eccentricity", 100.0, "%"),
    "attitude": ("attitude", 1.0, "°"),
}  # fmt: skip
Line = dict[str, Any]
Inputs = dict[str, str]


def bearing(rng: np.random.Generator, D: float, W: float) -> Inputs:
    """A random bearing of so many mm, from light loads to those of engines."""
    return {
        "bearing_diameter": f"{D} mm", "bearing_width": f"{W} mm",
        "diametral_clearance": f"{D * 10 ** rng.uniform(-3.2, -2.7)} mm",
        "radial_load": f"{D * W * 10 ** rng.uniform(-0.3, 1.3)} N",
        "speed": f"{10 ** rng.uniform(2.5, 3.5) * 100 / D} rpm",
        "oil_temperature": f"{rng.uniform(60, 110)} degC",
        "liner_thickness": f"{D * rng.choice([0.0, 0.006])} mm",
        "pressure_viscosity": f"{rng.choice([0.0, 1.0]) * rng.uniform(5, 20)} 1/GPa",
        "load_angle": f"{rng.uniform(0, 360)} deg", "housing_outer_diameter": f"{3 * D} mm",
    }  # fmt: skip


def in_ring(rng: np.random.Generator) -> tuple[Inputs, Array]:
    """A random bearing in a random ring of steel, and the ring's compliance of harmonics 0 to 40 [m/Pa]."""
    D = 10 ** rng.uniform(1.5, 2.5)
    inputs = bearing(rng, D, D * rng.uniform(0.25, 1.0))
    inner = D / 2 + float(inputs["liner_thickness"].split()[0])
    ring = ring_compliance(inner * 1e-3, rng.uniform(1.2, 2.5) * inner * 1e-3, 210e9, 0.3)
    return inputs, np.asarray(ring)


def in_solid(rng: np.random.Generator, number: int) -> tuple[str, dict[str, float], Array, Array]:
    """A random housing, every third a rod: its sizes, and its matrices of 38 and 93 modes [m/Pa]."""
    from benchmarks.elastic_solids import matrices, random_solid  # NGSolve

    kind = "rod" if number % 3 == 2 else "housing"
    solid, D, W = random_solid(rng, kind)
    own, more, place = matrices(solid, WIDE, ALONG)
    sizes = {
        "D": D, "W": W, "bore_width": 2 * place.half_width, "modulus": place.material.young * 1e-9,
        "poisson": place.material.poisson,
    }  # fmt: skip
    return kind, sizes, own, more


def of_harmonics(ring: Array, highest: int, along: int = 1) -> Array:
    """A ring's harmonics as a matrix of modes; along the bore it feels the mean alone."""
    orders = np.repeat(np.arange(highest + 1), [1] + [2] * highest)
    return np.diag(np.concatenate([ring[orders], np.zeros((along - 1) * orders.size)]))


def given(matrix: Array) -> dict[str, Any]:
    """A matrix [m/Pa] as an input."""
    return {"compliance": {"value": (1e15 * matrix).tolist(), "unit": "um/GPa"}}


def asked(inputs: Inputs, matrix: Array) -> tuple[dict[str, float] | None, float]:
    """The dimensionless answer of level elastic, or None if it refuses, and its processor seconds."""
    raw, names = {**ElasticFilm.example, **inputs, **given(matrix)}, [*NAMES.values(), "mesh_error"]
    begin = process_time()
    try:
        outputs = evaluate(ElasticFilm, raw, outputs=names, level="elastic").outputs
    except InvalidInputs:
        return None, process_time() - begin
    seconds = process_time() - begin
    values = {key: float(np.asarray(outputs[name].value)) for key, name in NAMES.items()}
    values["mesh_error"] = float(np.asarray(outputs["mesh_error"].value))
    film = ElasticFilm.from_quantities(raw)
    clearance = float(film.elasticity.clearance) * 1e6
    values["least"] /= clearance
    values["deformation"] /= clearance
    values["P_max"] /= float(film.p_0) * 1e-6
    return values, seconds


def softness_of(inputs: Inputs, matrix: Array) -> tuple[float, float, BoreSoftness, float]:
    """Sommerfeld number, B/D, what gives way, and the angle to the load, as the template has them."""
    film = ElasticFilm.from_quantities({**ElasticFilm.example, **inputs, **given(matrix)})
    one = film.elasticity
    per_gap = float(one.pressure / one.clearance)
    softness = BoreSoftness(
        per_gap * float(one.liner), per_gap * half_plane(one.inner, one.modulus, one.poisson),
        float(np.log(one.eta)) + ROELANDS_SIZE, ROELANDS_PRESSURE * float(one.pressure), float(one.exponent),
        per_gap * matrix, float(film.bore.share),
    )  # fmt: skip
    return float(film.S_0), float(film.b), softness, float(film.theta_F)


def second(So: float, film: Film) -> tuple[dict[str, float], float, Film]:
    """Extrapolated values of the second method, how far its smallest film is sure, and the finest film.

    A third mesh follows where the change between two says so.
    """
    places, solved = places_for(film), []
    unsure = np.inf
    for size in SIZES:
        film = balanced(carried(film, places.mesh(film.ratio, *size)), So)
        solved.append(measured(film))
        if len(solved) > 1:
            unsure = max(abs(solved[-1][name] / solved[-2][name] - 1) / 3 for name in ("least", "P_max"))
            if unsure < SURE:
                break
    coarse, fine = solved[-2:]
    return {name: fine[name] + (fine[name] - coarse[name]) / 3 for name in fine}, unsure, film


def begun(So: float, ratio: float, softness: BoreSoftness, to_load: float) -> Film:
    """The film of level elastic, for the second method to begin at."""
    eps = min(float(static_film_at("map", np.array(So), np.array(ratio)).eps), 1 - 1e-6)
    film = bore_balances(So, ratio, eps, softness, to_load)[-1][1].film
    assert isinstance(film, BoreFilm)
    bore = Bore(
        softness.matrix, HIGHEST, 2, softness.ring * (np.arange(HARMONICS + 1) > HIGHEST), softness.liner,
        softness.share, to_load, softness.size, softness.scale, softness.power,
    )  # fmt: skip
    mesh = elements(film.mesh.phi, film.mesh.zeta)
    return Film(mesh, ratio, bore, film.P.ravel(), film.eps, film.softness.turn)


def errors(values: dict[str, float], truth: dict[str, float]) -> dict[str, float]:
    """Errors of level elastic: relative, of the attitude in degrees."""
    wrong = {name: values[name] / truth[name] - 1 for name in NAMES if name != "attitude"}
    off = values["attitude"] - np.degrees(truth["attitude"])
    wrong["attitude"] = float((off + 180) % 360 - 180)
    return {name: float(f"{value:.3g}") for name, value in wrong.items()}


def compared(inputs: Inputs, matrix: Array, wide: tuple[Array, int, int]) -> Line:
    """One bearing at level elastic and by the second method: with the same modes, then with more."""
    values, seconds = asked(inputs, matrix)
    So, ratio, softness, to_load = softness_of(inputs, matrix)
    line: Line = {"So": four(So), "b": four(ratio), "seconds": round(seconds, 3), "refused": values is None}
    if values is None:
        return line
    line |= {name: four(values[name]) for name in (*NAMES, "mesh_error")}
    line |= {"liner": softness.liner > 0, "thickens": softness.power > 0}
    per_gap = float(np.abs(softness.matrix).max() / np.abs(matrix).max())
    more, highest, along = wide
    try:
        film = begun(So, ratio, softness, to_load)
        truth, unsure, film = second(So, film)
        line |= {"same": errors(values, truth), "unsure": four(unsure)}
        tail = film.bore.tail * (np.arange(HARMONICS + 1) > highest)
        bore = replace(film.bore, matrix=per_gap * more, highest=highest, along=along, tail=tail)
        truth, unsure, _ = second(So, replace(film, bore=bore))
        line |= {"more": errors(values, truth), "unsure": four(max(unsure, line["unsure"]))}
    except (Lost, NoBalance) as lost:
        line["lost"] = str(lost)
    return line


def four(value: float) -> float:
    """Four digits."""
    return float(f"{value:.4g}")


def cases(done: int) -> Iterator[Line]:
    """Lines of the cases from one on, rings and solids in turn."""
    count = 0
    for solid in range(SOLIDS):
        for number in range(solid * RINGS // SOLIDS, (solid + 1) * RINGS // SOLIDS):
            count += 1
            if count > done:
                inputs, ring = in_ring(np.random.default_rng([SEED, 0, number]))
                matrix, full = of_harmonics(ring, HIGHEST, 2), of_harmonics(ring, HARMONICS)
                yield {"kind": "ring", **compared(inputs, matrix, (full, HARMONICS, 1))}
        drawn = None
        for number in range(LOADS):
            count += 1
            if count > done:
                drawn = drawn or in_solid(np.random.default_rng([SEED, 1, solid]), solid)
                kind, of_solid, matrix, more = drawn
                rng = np.random.default_rng([SEED, 2, solid, number])
                inputs = bearing(rng, *(float(of_solid[name]) for name in ("D", "W"))) | {
                    "bore_width": f"{of_solid['bore_width']} mm",
                    "housing_modulus": f"{of_solid['modulus']} GPa",
                    "housing_poisson_ratio": f"{of_solid['poisson']}",
                }
                yield {"kind": kind, "solid": solid, **compared(inputs, matrix, (more, WIDE, ALONG))}


def run() -> None:
    """All cases that are not kept yet."""
    done = len(KEPT.read_text(encoding="utf-8").splitlines()) if KEPT.exists() else 0
    for line in cases(done):
        with KEPT.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line, separators=(",", ":")) + "\n")


def by_softness(lines: list[Line]) -> None:
    """Print the largest errors of bores against 93 modes, by deformation over film, and what they bound."""
    for low, high in pairwise((0.0, *SOFTNESS, np.inf)):
        own = [line["more"] for line in lines if low <= line["deformation"] / line["least"] < high]
        film, pressure = (max((abs(one[name]) for one in own), default=0.0) for name in ("least", "P_max"))
        print(f"deformation {low:g} to {high:g} of the film: {len(own)} bearings, "
              f"largest error of film {100 * film:.2g} %, of pressure {100 * pressure:.2g} %")  # fmt: skip
    solids = len({(line["kind"], line["solid"]) for line in lines})
    quantile = 0.05 ** (1 / len(lines))
    print(f"the largest of {len(lines)}, in {solids} solids, bounds the {100 * quantile:.1f} % quantile "
          "with a confidence of 95 %, were they independent")  # fmt: skip


def page() -> None:
    """The tables of the docs."""
    lines = [json.loads(text) for text in KEPT.read_text(encoding="utf-8").splitlines()]
    print("| reference | bearings | " + " | ".join(words for words, _, _ in FIGURES.values()) + " |")
    print("|---" * (2 + len(FIGURES)) + "|")
    for kinds, key, words in (
        (("ring",), "same", "rings, the same modes"),
        (("ring",), "more", "rings, all 40 harmonics"),
        (("housing", "rod"), "same", "housings and rods, the same modes"),
        (("housing", "rod"), "more", "housings and rods, 93 modes"),
    ):
        own = [line for line in lines if line["kind"] in kinds and key in line]
        cells = []
        for name, (_, scale, unit) in FIGURES.items():
            sizes = scale * np.abs([line[key][name] for line in own])
            cells.append(", ".join(f"{v:.2g}" for v in np.quantile(sizes, [0.5, 0.95, 1])) + f" {unit}")
        print(f"| {words} | {len(own)} | " + " | ".join(cells) + " |")
    answered = [line for line in lines if not line["refused"]]
    print(f"{len(lines)} bearings, refused {len(lines) - len(answered)}, "
          f"without a reference {sum('lost' in line for line in lines)}")  # fmt: skip
    seconds = [line["seconds"] for line in answered]
    softness = [line["deformation"] / line["least"] for line in answered]
    sure = [line["unsure"] for line in lines if "unsure" in line]
    print("processor s: median, 95 %, largest", np.quantile(seconds, [0.5, 0.95, 1]).round(2))
    print("deformation over film, the same", np.quantile(softness, [0.5, 0.95, 1]).round(2))
    print("second method sure to, the same", np.quantile(sure, [0.5, 0.95, 1]))
    checked = [line for line in lines if "same" in line]
    held = sum(abs(line["same"]["least"]) <= line["mesh_error"] + line["unsure"] for line in checked)
    print(f"mesh_error bounds the smallest film's error with the same modes in {held} of {len(checked)}")
    by_softness([line for line in lines if line["kind"] != "ring" and "more" in line])
    for line in sorted(lines, key=lambda line: -abs(line.get("more", {}).get("least", 0.0)))[:6]:
        print(json.dumps(line))


if __name__ == "__main__":
    page() if sys.argv[1:] == ["page"] else run()
