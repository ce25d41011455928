"""Cost of `bearing_load` 1 and `engine` 1, the nine-cylinder case of DYREMI, and a polar load diagram.

    python -m benchmarks.engine_load

A few seconds. Writes benchmarks/results/engine.json and docs/pictures/engine_loads.png, and prints the tables
of docs/engine_loads.md. Times are the least of many runs on a machine that does other work; only ratios of
one run are quoted.
"""

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.bearing_load.engine_v1 import Engine
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template

RESULTS = Path("benchmarks/results/engine.json")
PICTURE = Path("docs/pictures/engine_loads.png")
CASE = json.loads(Path("tests/references/nine_cylinder_set.json").read_text(encoding="utf-8"))
CASES, REPEATS = 1000, 40
SHOWN_AT = "6000 rpm"  # of the picture: fast enough for inertia to be seen beside the gas
GREATEST = ["crankpin_load_max", "main_load_max", "wristpin_load_max", "wall_force_max", "mean_torque"]
FIRED = {"bore": "0.25 m", "gas_cycle": "four_stroke", "suction_pressure": "1 bar", "compression_ratio": 12,
         "combustion_pressure": "80 bar", "cutoff": 1.3, "crankcase_pressure": "1 bar"}  # fmt: skip


def least(work: Callable[[], Any], repeats: int = REPEATS) -> float:
    """The least time of many runs [s]."""
    times = []
    work()
    for _ in range(repeats):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return min(times)


def bare(cls: type[Template], values: dict[str, Any]) -> None:
    """Every output from SI values, without the answer's units and reasons."""
    with np.errstate(all="ignore"):
        template = cls.from_si(values)
        template = template.at(template.starting_level())
        for formula in cls.formulas.values():
            getattr(template, formula.attribute)


def si(cls: type[Template], raw: dict[str, Any]) -> dict[str, Any]:
    """The inputs that were given, in SI."""
    template = cls.from_quantities(raw)
    return {name: getattr(template, cls.inputs[name].attribute) for name in raw}


def costs() -> dict[str, dict[str, float]]:
    """Seconds for one case and for each of a thousand speeds at once."""
    cylinder = {**BearingLoad.example, "crank_angle_step": "1 deg"}
    engine = {**CASE["inputs"], **FIRED}
    speeds = {"value": np.linspace(500, 3000, CASES).tolist(), "unit": "rpm"}
    listed = {}
    for name, cls, raw, outputs in (
        ("one cylinder, all outputs", BearingLoad, cylinder, None),
        ("one cylinder, greatest loads and mean torque", BearingLoad, cylinder, GREATEST),
        ("nine cylinders, all outputs", Engine, engine, None),
    ):
        many = {**raw, "speed": speeds}
        one = least(lambda c=cls, r=raw, o=outputs: evaluate(c, r, outputs=o))
        each = least(lambda c=cls, r=many, o=outputs: evaluate(c, r, outputs=o), 8) / CASES
        listed[name] = {"one": one, "each_of_many": each, "times_cheaper": one / each}
        if outputs is None:
            values = si(cls, raw)
            listed[name]["from_si"] = least(lambda c=cls, v=values: bare(c, v))
    return listed


def nine_cylinders() -> dict[str, dict[str, Any]]:
    """The generator set: printed and reproduced."""
    outputs = evaluate(Engine, CASE["inputs"]).outputs
    names = [*CASE["printed"], "rotating_force", "primary_force", "secondary_force", "primary_couple",
             "secondary_couple"]  # fmt: skip
    printed = {name: row["value"] for name, row in CASE["printed"].items()}
    return {
        name: {"printed": printed.get(name), "reproduced": outputs[name].value, "unit": outputs[name].unit}
        for name in names
    }


def draw() -> None:
    """Polar diagrams of one cylinder, and the torque of one and of four."""
    mpl.use("Agg")
    raw = {**BearingLoad.example, "speed": SHOWN_AT, "crank_angle_step": "1 deg"}
    out = {name: answer.value for name, answer in evaluate(BearingLoad, raw).outputs.items()}
    figure, (polar, torque) = plt.subplots(
        1, 2, figsize=(9, 4.6), layout="constrained", width_ratios=(1, 1.4)
    )
    for name, colour in (("crankpin", "tab:blue"), ("main", "tab:orange"), ("wristpin", "tab:green")):
        x, y = out[f"{name}_load_x"] / 1e3, out[f"{name}_load_y"] / 1e3
        polar.plot([*y, y[0]], [*x, x[0]], color=colour, lw=1, label=name)
    polar.set(xlabel="y [kN]", ylabel="x, to the head [kN]", title=f"loads at {SHOWN_AT}", aspect="equal")
    polar.axhline(0, color="0.8", lw=0.6, zorder=0)
    polar.axvline(0, color="0.8", lw=0.6, zorder=0)
    polar.legend(loc="center left", bbox_to_anchor=(1, 0.8), frameon=False)
    shared = {name: value for name, value in raw.items() if name in Engine.inputs}
    four = {"cylinders": 4, "firing_order": [1, 3, 4, 2],
            "cylinder_positions": {"value": [0, 0.1, 0.2, 0.3], "unit": "m"}}  # fmt: skip
    total = evaluate(Engine, {**shared, **four}, outputs=["torque", "mean_torque"]).outputs
    torque.plot(out["crank_angle"], out["torque"], lw=1, label="one cylinder")
    torque.plot(out["crank_angle"], total["torque"].value, lw=1, label="four, 1-3-4-2")
    torque.axhline(total["mean_torque"].value, color="0.5", lw=0.8, ls="--", label="mean of four")
    torque.set(xlabel="crank angle [°]", ylabel="torque [N m]", title="torque", xticks=range(0, 721, 180))
    torque.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False)
    figure.savefig(PICTURE, dpi=110)


def main() -> None:
    """Measure, write, print."""
    cost, case = costs(), nine_cylinders()
    RESULTS.write_text(json.dumps({"cost": cost, "nine_cylinders": case}, indent=1) + "\n", encoding="utf-8")
    draw()
    base = cost["one cylinder, all outputs"]["one"]
    print("| | cost | of it without the answer's units and reasons | each of 1000 speeds: times cheaper |")
    print("|---|---|---|---|")
    for name, row in cost.items():
        share = f"{row['from_si'] / row['one']:.2f}" if "from_si" in row else ""
        print(f"| {name} | {row['one'] / base:.2f} | {share} | {row['times_cheaper']:.0f} |")
    print("\n| | printed | reproduced |\n|---|---|---|")
    for name, row in case.items():
        shown = "" if row["printed"] is None else row["printed"]
        print(f"| {name} [{row['unit']}] | {shown} | {row['reproduced']:.7g} |")
    print({name: f"{row['one'] * 1e3:.2f} ms" for name, row in cost.items()})


if __name__ == "__main__":
    main()
