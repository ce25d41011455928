"""Measure the cost of `oil_film_cycle`, and compare its levels without supply for one published big end.

    python -m benchmarks.film_cycle

The script takes two minutes. It writes benchmarks/results/film_cycle.json and
docs/pictures/oil_film_cycle.png, and prints the table of docs/oil_film_cycle.md. The bearing has the size of
a big end that is often used in publications (Ruston & Hornsby 6VEB-X Mk III): bore 0.2032 m, width 0.127 m
(Mechanics & Industry 19, 2018, 607, table 3), here without its groove. Its load diagram was not available:
the load is that of an idealised diesel cylinder, and masses, clearance, viscosity and speed are our own
choice.
"""

import json
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from templates.core.arrays import Array
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.supplied.fed_cycle import fed_orbit

RESULTS = Path("benchmarks/results/film_cycle.json")
PICTURE = Path("docs/pictures/oil_film_cycle.png")
SHOWN = ["minimum_film_thickness", "minimum_film_angle", "maximum_pressure", "power_loss", "side_flow",
         "numerical_error"]  # fmt: skip
UNITS = {"minimum_film_thickness": "µm", "minimum_film_angle": "°", "maximum_pressure": "MPa",
         "power_loss": "W", "side_flow": "l/min"}  # fmt: skip
CURVES = ("eccentricity_x", "eccentricity_y", "film_thickness")
BORE, STROKE, SPEED = 0.318, 0.368, 600 * np.pi / 30
RECIPROCATING, TURNING, PEAK = 120.0, 60.0, 7.5e6
CASES = 1000
ROD_RATIO = 4.0
LEVELS = ("mobility_short", "mobility", "flooded")
"""Levels for a bearing without a stated supply."""


def firing(angle: Array, at: float, width: float, period: float) -> Array:
    """Return a pressure curve over a cycle that rises fast and falls slowly, with a maximum of 1."""
    late = (angle - at + period / 2) % period - period / 2
    return np.asarray(np.exp(-((late / np.where(late < 0, width / 3, width)) ** 2)))


def quantity(value: Any, unit: str) -> dict[str, Any]:
    """Return the value as a user types it."""
    return {"value": np.asarray(value, float).tolist(), "unit": unit}


def big_end(step: float = 1.0, sizes: Array | None = None) -> dict[str, Any]:
    """Return the inputs of the big end.

    The load is that of the rod on the crankpin, in the axes of the engine; the rod is a swinging sleeve.
    """
    angle = np.radians(np.arange(0, 720, step))
    tilt = np.arcsin(np.sin(angle) / ROD_RATIO)
    area, throw = np.pi / 4 * BORE**2, STROKE / 2
    along = RECIPROCATING * SPEED**2 * throw * (np.cos(angle) + np.cos(2 * angle) / ROD_RATIO)
    along -= PEAK * area * firing(angle, 2 * np.pi + 0.2, 0.6, 4 * np.pi)
    turning = TURNING * SPEED**2 * throw
    x, y = along + turning * np.cos(angle), -along * np.tan(tilt) + turning * np.sin(angle)
    sleeve = -SPEED * np.cos(angle) / np.sqrt(ROD_RATIO**2 - np.sin(angle) ** 2)
    size = np.ones(()) if sizes is None else sizes[:, None]
    return {
        "crank_angle": quantity(np.degrees(angle), "deg"),
        "load_x": quantity(size * x, "N"),
        "load_y": quantity(size * y, "N"),
        "speed": quantity(SPEED, "rad/s"),
        "sleeve_speed": quantity(sleeve, "rad/s"),
        "bearing_diameter": quantity(0.2032, "m"),
        "bearing_width": quantity(0.127, "m"),
        "diametral_clearance": quantity(165.0, "um"),
        "dynamic_viscosity": quantity(15.0, "mPa*s"),
        "oil_supply": "flooded_ends",
    }


def least(function: Callable[[], object], repeats: int) -> float:
    """Return the least processor time of several calls [s]."""
    times = []
    for _ in range(repeats):
        begin = process_time()
        function()
        times.append(process_time() - begin)
    return min(times)


def orbit_seconds(level: str) -> float:
    """Return the processor time of the big end's orbit [s]."""
    fed = OilFilmCycle.from_quantities(big_end()).at(level).fed
    return least(lambda: fed_orbit(level, fed), 1 if level == "flooded" else 20)


def levels() -> dict[str, Any]:
    """Return the results of every level for the big end at 1°, with its cost."""
    by_level: dict[str, Any] = {}
    for level in LEVELS:
        answers = evaluate(OilFilmCycle, big_end(), level=level).outputs
        by_level[level] = {name: answers[name].value for name in SHOWN} | {
            "orbit_seconds": orbit_seconds(level)
        }
        by_level[level]["curves"] = {name: answers[name].value for name in CURVES}
    return by_level


def costs() -> dict[str, float]:
    """Return the cost of one periodic cycle of 720 points at level mobility, alone and among a thousand."""
    one = OilFilmCycle.from_quantities(big_end()).at("mobility").fed
    sizes = np.linspace(0.5, 1.5, CASES)
    many = OilFilmCycle.from_quantities(big_end(sizes=sizes)).at("mobility").fed
    single, whole = (
        least(lambda: fed_orbit("mobility", one), 20),
        least(lambda: fed_orbit("mobility", many), 1),
    )
    asked = big_end()
    through = least(lambda: evaluate(OilFilmCycle, asked, outputs=["minimum_film_thickness"]), 10)
    return {
        "one": single,
        "each_of_1000": whole / CASES,
        "ratio": single / (whole / CASES),
        "evaluate": through,
    }


def draw(by_level: dict[str, Any]) -> None:
    """Draw the orbits, and the films over the cycle."""
    mpl.use("Agg")
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(10, 4.6), width_ratios=(1, 1.35), layout="constrained"
    )
    turn = np.linspace(0, 2 * np.pi, 200)
    left.plot(np.cos(turn), np.sin(turn), color="0.6", lw=1)
    styles = {"mobility_short": ":", "mobility": "-", "flooded": "--"}
    for level, answers in by_level.items():
        curves = answers["curves"]
        x, y = (np.append(curves[name], curves[name][0]) for name in CURVES[:2])
        left.plot(x, y, styles[level], lw=1.4, label=level)
        right.semilogy(np.arange(720), curves["film_thickness"], styles[level], lw=1.4, label=level)
    left.set(
        aspect="equal",
        xlabel="eccentricity x [-]",
        ylabel="eccentricity y [-]",
        title="orbit of the crankpin",
    )
    right.set(
        xlabel="crank angle [°]", ylabel="film thickness [µm]", xlim=(0, 720), xticks=np.arange(0, 721, 90)
    )
    right.grid(alpha=0.3, which="both")
    right.legend(frameon=False)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=110)


def main() -> None:
    """Measure, write and print the results."""
    by_level, cost = levels(), costs()
    draw(by_level)
    summary = {
        level: {n: v for n, v in answers.items() if n != "curves"} for level, answers in by_level.items()
    }
    RESULTS.write_text(json.dumps({"levels": summary, "mobility": cost}, indent=1) + "\n", encoding="utf-8")
    base = summary["mobility"]["orbit_seconds"]
    print("| level |", " | ".join(f"{n} [{UNITS[n]}]" if n in UNITS else n for n in SHOWN), "| cost |")
    for level, answers in summary.items():
        row = ("none" if answers[n] is None else f"{answers[n]:.4g}" for n in SHOWN)
        print(f"| `{level}` |", " | ".join(row), f"| {answers['orbit_seconds'] / base:.3g} |")
    print({name: round(value, 5) for name, value in cost.items()})


if __name__ == "__main__":
    main()
