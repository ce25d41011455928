"""The example of `cycle_heat_balance` 1, with and without shear thinning, and what a point costs.

python -m benchmarks.cycle_heat             some seconds
python -m benchmarks.cycle_heat supplied    the same balance with the film of level supplied; a minute

Level supplied of `oil_film_cycle` 3 conserves its oil: its side flow is all that leaves by the ends, what the
journal displaces and what the supply pressure drives, from the ends of the groove too.
"""

import sys
from math import exp, log
from time import process_time
from typing import Any

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance
from templates.oil_film.oil_film_cycle_v3 import OilFilmCycle
from templates.physics.heat.cycle_heat import CycleOil

NAMES = ("effective_viscosity", "film_temperature", "temperature_rise", "minimum_film_thickness",
         "power_loss", "side_flow", "feed_flow")  # fmt: skip
CASES = (("heat alone", {"hths_viscosity"}), ("heat and shear", set[str]()))
SETTLED, MOST = 2e-3, 12
"""Change of ln(viscosity) at which the marched balance ends: a march repeats to 1e-3; rounds at most."""
ZERO = 273.15
FILM = ("minimum_film_thickness", "power_loss", "side_flow", "film_thickness", "verdict")
BEARING = ("crank_angle", "load_x", "load_y", "speed", "bearing_diameter", "bearing_width",
           "diametral_clearance", "groove_width", "groove_start", "groove_extent",
           "supply_pressure")  # fmt: skip


def main() -> None:
    """Print a row for each."""
    print("| case | " + " | ".join(NAMES) + " | processor s |")
    for words, left_out in CASES:
        raw = {name: value for name, value in CycleHeatBalance.example.items() if name not in left_out}
        start = process_time()
        found = evaluate(CycleHeatBalance, raw, outputs=NAMES).outputs
        seconds = process_time() - start
        print(f"| {words} | " + " | ".join(f"{found[n].value:.4g}" for n in NAMES) + f" | {seconds:.2g} |")


def marched() -> None:
    """Print a row for each with the film of level supplied, and in how many marches it is found."""
    names = ("case", "viscosity [mPa s]", "film [degC]", "rise [K]", "smallest film [um]", "loss [W]",
             "flow [l/min]", "marches", "processor s")  # fmt: skip
    print("| " + " | ".join(names) + " |")
    for words, left_out in CASES:
        raw = {name: value for name, value in CycleHeatBalance.example.items() if name not in left_out}
        template = evaluate(CycleHeatBalance, raw, outputs=NAMES).template
        start = process_time()
        x, rounds = log(float(template.eta_e)), []
        while len(rounds) < MOST:
            film = film_at(exp(x), raw)
            T = float(template.T_s) + rise_of(film, template.oil) / 2
            lack = log(float(template.oil.sheared(np.asarray(T), np.asarray(shear_rate(film))))) - x
            rounds.append((x, lack))
            if abs(lack) < SETTLED:
                break
            x = following(rounds)
        seconds = process_time() - start
        numbers = (1e3 * exp(x), T - ZERO, 2 * (T - float(template.T_s)), *(film[name] for name in FILM[:3]))
        print(f"| {words} | " + " | ".join(f"{number:.4g}" for number in numbers)
              + f" | {len(rounds)} | {seconds:.2g} |")  # fmt: skip


def film_at(eta: float, raw: dict[str, Any]) -> dict[str, Any]:
    """The film of level supplied at a viscosity [Pa s]."""
    inputs = {name: raw[name] for name in BEARING} | {"dynamic_viscosity": f"{1e3 * eta:.12g} mPa*s"}
    found = evaluate(OilFilmCycle, inputs, level="supplied", outputs=FILM).outputs
    film = {name: found[name].value for name in FILM}
    assert film["verdict"] == "repeating", film["verdict"]
    return film


def rise_of(film: dict[str, Any], oil: CycleOil) -> float:
    """Temperature rise of the oil that leaves [K]."""
    flow = film["side_flow"] / 60e3
    return float(oil.share * film["power_loss"] / (oil.heat_capacity * flow))


def shear_rate(film: dict[str, Any]) -> float:
    """Sliding speed over the gap, as mean over circle and cycle, of the example [1/s]."""
    clearance, speed = 0.055e-3 / 2, 3000 * np.pi / 30 * 0.048 / 2
    gap = np.asarray(film["film_thickness"]) * 1e-6 / clearance
    return float(speed / clearance * np.mean(1 / np.sqrt(gap * (2 - gap))))


def following(rounds: list[tuple[float, float]]) -> float:
    """The next ln(viscosity), by a secant."""
    x, lack = rounds[-1]
    if len(rounds) == 1:
        return x + lack / 2
    before, lack_before = rounds[-2]
    return x - lack * (x - before) / (lack - lack_before)


if __name__ == "__main__":
    marched() if sys.argv[1:] == ["supplied"] else main()
