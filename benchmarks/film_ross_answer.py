"""ROSS's side of `benchmarks.film_ross`, which runs in ROSS's own environment: nothing of ours is there."""

import json
import warnings
from importlib import import_module
from time import perf_counter

import numpy as np

POINTS = [(0.1, 1.0), (0.5, 0.5), (0.8, 1.0), (0.95, 1.0), (0.99, 1.0)]
"""Eccentricity and width over diameter [-]."""
DIAMETER, CLEARANCE, VISCOSITY, SPEED = 0.1, 1e-4, 0.02, 300.0
"""[m], radial [m], [Pa s], [rad/s]."""
REPEATS = 20


def answer() -> None:
    """Print ROSS's load and time at each point; runs in its environment."""
    warnings.simplefilter("ignore")
    rows = []
    for eps, ratio in POINTS:
        ross_load(eps, ratio)
        rows.append({"So": ross_load(eps, ratio), "time": least_seconds(eps, ratio)})
    print(json.dumps(rows))


def ross_load(eps: float, ratio: float) -> float:
    """Sommerfeld number of ROSS's plain journal bearing, its land beginning at the widest gap."""
    viscosity = {f"liquid_viscosity{k}": VISCOSITY for k in (1, 2)}
    oil = {"liquid_density": 860.0, "liquid_specific_heat": 1950.0, "liquid_thermal_conductivity": 0.13}
    bearing = import_module("ross.bearings.plain_journal").PlainJournal(
        n=0,
        pad_axial_length=ratio * DIAMETER,
        journal_diameter=DIAMETER,
        radial_clearance=CLEARANCE,
        n_pads=1,
        pad_arc=np.radians(359.9999),
        oil_supply_temperature=323.15,
        speed=[SPEED],
        fys_load=-1e4,
        lubricant=viscosity | {"temperature1": 313.15, "temperature2": 373.15} | oil,
        oil_flow_v=1e-2,
        thermal_type=None,
        equilibrium_type="match_eccentricity",
        initial_position=(-eps, 0.0),
    )
    film = bearing._results.outputs[0]
    load = np.hypot(np.squeeze(film["fx_hydro"]), np.squeeze(film["fy_hydro"]))
    return float(load * (2 * CLEARANCE / DIAMETER) ** 2 / (ratio * DIAMETER**2 * VISCOSITY * SPEED))


def least_seconds(eps: float, ratio: float) -> float:
    """The least time of some calls [s]."""
    times = []
    for _ in range(REPEATS):
        begin = perf_counter()
        ross_load(eps, ratio)
        times.append(perf_counter() - begin)
    return min(times)


if __name__ == "__main__":
    answer()
