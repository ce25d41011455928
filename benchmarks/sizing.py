"""Size random bearings: minimise the power loss with a minimum film, explore cheaply, then confirm.

    python -m benchmarks.sizing [--count 50] [--seed 0] [--explore map] [--within 1e-3]

Each sizing varies diameter, width and clearance of a plain bearing of its own load, speed, oil and limit. The
limit is a share of 0.5 … 0.9 of the thickest film in the box. Every second bearing has its viscosity given;
the others find their temperature by a heat balance. The film must be above the limit with its whole band.
The cost is processor time of everything asked, at both levels. The full cost is what the scan alone, 4,096
rows, would take at `mass_conserving`: rows × the processor time of a row in a call of 6, measured in the same
run. Results in benchmarks/results/sizing.json; it is written again after every sizing.
"""

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.catalogue.discovery import find_templates
from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine
from app.plain import JsonObject
from app.reference import Reference
from app.studies.methods.answers import Answer, Columns, Held, Objective, Problem
from app.studies.methods.optimise import Optimum, optimise
from app.studies.methods.points import Sobol
from app.studies.methods.search import SCANNED
from app.studies.methods.space import Interval, Space
from cad.catalogue import models
from templates.core.arrays import Array
from tests.references.trade import trade

RESULTS = Path("benchmarks/results/sizing.json")
CATALOGUES = Catalogues(find_templates(()), models())
FINE, MEASURED = "mass_conserving", 6
FILM, LOSS = Reference("film", None, "minimum_film_thickness"), Reference("film", None, "power_loss")
NAMES = ("diameter", "width", "clearance")


@dataclass
class Sizing:
    """One sizing problem with its result; the units are in the names."""

    diameter_mm: float
    width_ratio: float
    clearance_ratio: float
    pressure_MPa: float
    speed_rpm: float
    oil: dict[str, str]
    limit_um: float = 0.0
    state: str = ""
    verdict: str = ""
    is_feasible: bool = False
    film_over_limit: float = 0.0
    loss_W: float = 0.0
    rounds: int = 0
    explored: int = 0
    confirmed: int = 0
    seconds: float = 0.0
    share_of_full_cost: float = 0.0


def sizing(random: np.random.Generator, heat: bool) -> Sizing:
    """Return a random bearing of an engine or a gearbox, with a heat balance or at a given viscosity."""
    temperature, viscosity = random.uniform(60, 110), random.uniform(6, 40)
    oil = (
        {"supply_temperature": f"{temperature} degC"} if heat else {"dynamic_viscosity": f"{viscosity} mPa*s"}
    )
    return Sizing(
        diameter_mm=float(random.uniform(30, 90)),
        width_ratio=float(random.uniform(0.3, 0.55)),
        clearance_ratio=float(10 ** random.uniform(-3.1, -2.7)),
        pressure_MPa=float(random.uniform(5, 35)),
        speed_rpm=float(random.uniform(1500, 7000)),
        oil=oil,
    )


def space(of: Sizing) -> Space:
    """Return the ranges [m]: diameter ± 10 %, width 0.8 to 1.25 times, clearance 0.5 to 1.7 times."""
    diameter = of.diameter_mm / 1e3
    middle = (diameter, diameter * of.width_ratio, diameter * of.clearance_ratio)
    around = ((0.9, 1.1), (0.8, 1.25), (0.5, 1.7))
    each = zip(NAMES, middle, around, strict=True)
    return Space(tuple(Interval(name, low * x, high * x) for name, x, (low, high) in each))


def document(of: Sizing) -> JsonObject:
    """Return the document of the design of a sizing, which has one step."""
    diameter = of.diameter_mm
    width, clearance = diameter * of.width_ratio, diameter * of.clearance_ratio
    inputs = {
        "radial_load": f"{of.pressure_MPa * diameter * width!r} N",
        "bearing_diameter": "= diameter",
        "bearing_width": "= width",
        "diametral_clearance": "= clearance",
        "speed": f"{of.speed_rpm!r} rpm",
        **of.oil,
    }
    return {
        "name": "sizing",
        "parameters": {"diameter": f"{diameter} mm", "width": f"{width} mm", "clearance": f"{clearance} mm"},
        "steps": {"film": {"template": "oil_film", "version": 2, "inputs": inputs}},
    }


def engine(of: Sizing) -> DesignEngine:
    """Return the engine of the design of a sizing."""
    return DesignEngine.of(
        Document.model_validate(document(of)), CATALOGUES, [Reference(name) for name in NAMES]
    )


def level(design: DesignEngine, name: str, limit: float) -> Answer:
    """Return the results of a design at a level; the cost is processor time."""

    def answer(rows: Array) -> Columns:
        start = process_time()
        given = {Reference(n): column for n, column in zip(NAMES, rows.T, strict=True)}
        table = design(given, [FILM, LOSS], levels={"film": name})
        film, loss, error = table.columns[FILM], table.columns[LOSS], table.errors[FILM]
        reasons = {row: refusal.detail for row, refusal in table.refusals.items()}
        least, most = film / (1 + error), film / np.maximum(1 - error, 1e-300)
        parts = {
            "objectives": loss,
            "values": film,
            "limits": np.full_like(film, limit),
            "low": least - limit,
            "high": most - limit,
        }
        seconds = process_time() - start
        columns: dict[str, Any] = {name: part[:, None] for name, part in parts.items()}
        return Columns(**columns, reasons=reasons, seconds=seconds)

    return answer


def thickest(of: Sizing, design: DesignEngine, explore: str) -> float:
    """Return the thickest film [m] in the ranges of a sizing, at the exploring level."""
    return float(np.nanmax(level(design, explore, 0.0)(Sobol(space(of), 1024, 0).rows(0, 1024)).values))


def problem(of: Sizing) -> Problem:
    """Return the optimisation problem: least loss with a film of at least the limit."""
    return Problem(space(of), (Objective("loss"),), (Held("film", ">="),))


def run(of: Sizing, design: DesignEngine, explore: str, seed: int, within: float) -> None:
    """Optimise one sizing and record the result."""
    limit = of.limit_um / 1e6
    answers = level(design, explore, limit), level(design, FINE, limit)
    optimum = optimise(problem(of), *answers, seed=seed, within=within)
    best = optimum.best
    of.state, of.verdict = optimum.state, best.verdicts[0]
    of.is_feasible = bool((best.worst >= 0).all())
    of.film_over_limit, of.loss_W = float(best.confirmed[1]) / limit, float(best.confirmed[0])
    of.rounds, of.explored, of.confirmed = len(optimum.rounds), optimum.explored, optimum.confirmations
    of.seconds = optimum.seconds


def full_seconds(of: Sizing, design: DesignEngine) -> float:
    """Return the time of a complete scan at the confirming level [s]."""
    answer = level(design, FINE, of.limit_um / 1e6)
    return answer(Sobol(space(of), MEASURED, 0).rows(0, MEASURED)).seconds / MEASURED * SCANNED


def started(random: np.random.Generator, number: int, explore: str) -> tuple[Sizing, DesignEngine]:
    """Return a sizing with its limit, and its design."""
    one = sizing(random, heat=bool(number % 2))
    design, share = engine(one), random.uniform(0.5, 0.9)
    one.limit_um = float(share * thickest(one, design, explore) * 1e6)
    return one, design


def all_sizings(options: argparse.Namespace) -> list[Sizing]:
    """Run the requested number of sizings; print each, and write the results."""
    random, done = np.random.default_rng(options.seed), []
    for number in range(options.count):
        one, design = started(random, number, options.explore)
        run(one, design, options.explore, number, options.within)
        one.share_of_full_cost = one.seconds / full_seconds(one, design)
        done.append(one)
        write(options.explore, done, {})
        line = f"{number:3} {one.state:11} {one.verdict:9} film/limit {one.film_over_limit:.6f}"
        print(f"{line} {one.rounds} rounds, {one.share_of_full_cost:.2%} of full", flush=True)
    return done


def levels_of_one(options: argparse.Namespace) -> dict[str, Any]:
    """Return the choice of each level for the first sizing."""
    one, design = started(np.random.default_rng(options.seed), 0, options.explore)
    limit = one.limit_um / 1e6
    levels = {name: level(design, name, limit) for name in ("short_bearing", "fit", "map")}
    table = trade(problem(one), levels, level(design, FINE, limit), seed=0)
    return {name: entry(optimum, limit) for name, optimum in table.items()}


def entry(optimum: Optimum, limit: float) -> dict[str, Any]:
    """Return one row of the trade-off table."""
    best = optimum.best
    return {
        "promised loss [W]": float(best.promise[0]),
        "confirmed loss [W]": float(best.confirmed[0]),
        "promised film / limit": float(best.promise[1]) / limit,
        "confirmed film / limit": float(best.confirmed[1]) / limit,
        "verdict": best.verdicts[0],
        "rows": optimum.explored + optimum.confirmations,
        "seconds": round(optimum.seconds, 3),
    }


def summary(explore: str, done: list[Sizing]) -> dict[str, Any]:
    """Return how many are feasible, and the cost."""
    shares = [one.share_of_full_cost for one in done]
    return {
        "explored at": explore,
        "sizings": len(done),
        "feasible at mass_conserving": sum(one.is_feasible for one in done),
        "with a heat balance": sum("supply_temperature" in one.oil for one in done),
        "met with the whole band": sum(one.verdict == "met" for one in done),
        "undecided": sum(one.verdict == "undecided" for one in done),
        "rows confirmed, most": max(one.confirmed for one in done),
        "share of full cost, median": float(np.median(shares)),
        "share of full cost, most": max(shares),
        "aim": "all feasible, at most 0.01 of the full cost",
    }


def write(explore: str, done: list[Sizing], levels: dict[str, Any]) -> None:
    """Write the results."""
    table = {"summary": summary(explore, done), "levels": levels, "each": [asdict(one) for one in done]}
    RESULTS.write_text(json.dumps(table, indent=1) + "\n")


def main() -> None:
    """Run the sizings, summarise and write them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--explore", default="map")
    parser.add_argument("--within", type=float, default=1e-3)
    options = parser.parse_args()
    done = all_sizings(options)
    print(json.dumps(summary(options.explore, done), indent=1))
    write(options.explore, done, levels_of_one(options))


if __name__ == "__main__":
    main()
