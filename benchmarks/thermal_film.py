"""Error of one temperature, and time that a temperature at every place takes: `thermal_film` 1.

python -m benchmarks.thermal_film           100 random bearings: refusals, times, ratios; two minutes
python -m benchmarks.thermal_film report    the same from the kept results
python -m benchmarks.thermal_film mesh      the first 15 of them at level fine_field too; a minute
python -m benchmarks.thermal_film picture   docs/pictures/thermal_film.svg; some seconds

The first writes `benchmarks/results/thermal_film.json`.
"""

import json
import sys
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from matplotlib import pyplot as plt

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.thermal_film_v1 import ThermalFilm

RESULTS = Path("benchmarks/results/thermal_film.json")
PICTURE = Path("docs/pictures/thermal_film.svg")
COUNT, MESHED, SEED = 100, 15, 64
NAMES = ("relative_eccentricity", "film_ratio", "loss_ratio", "unseen_rise", "effective_temperature",
         "greatest_film_temperature", "journal_temperature", "heat_residual", "mesh_error", "mesh_change",
         "minimum_film_thickness", "power_loss")  # fmt: skip
GRADES = ("iso_vg_32", "iso_vg_46", "iso_vg_68", "iso_vg_100", "sae_15w_40", "sae_0w_20")


def bearing(rng: np.random.Generator) -> dict[str, Any]:
    """A random plain bearing of ordinary machines, engines to turbines."""
    D = 10 ** rng.uniform(1.5, 2.6)  # mm
    b = rng.uniform(0.3, 1.1)
    slide = 10 ** rng.uniform(0, 1.7)  # m/s
    raw = {
        "bearing_diameter": f"{D} mm", "bearing_width": f"{b * D} mm",
        "diametral_clearance": f"{D * 10 ** rng.uniform(-3.2, -2.5)} mm",
        "speed": f"{slide / (D / 2000) * 30 / np.pi} rpm",
        "radial_load": f"{b * D**2 * 10 ** rng.uniform(-0.7, 0.9)} N",  # 0.2 … 8 MPa
        "oil_grade": str(rng.choice(GRADES)), "supply_temperature": f"{rng.uniform(30, 70)} degC",
        "supply_pressure": f"{rng.uniform(0, 3)} bar", "groove_angle": f"{rng.uniform(110, 250)} deg",
        "groove_width": f"{rng.uniform(10, 30)} deg",
    }  # fmt: skip
    wall = rng.choice(["adiabatic", "cooled", "held"])
    if wall == "cooled":
        raw |= {"heat_transfer_coefficient": f"{10 ** rng.uniform(1.3, 3)} W/(m**2*K)",
                "ambient_temperature": "30 degC"}  # fmt: skip
    if wall == "held":
        raw |= {"held_bush_temperature": f"{rng.uniform(40, 90)} degC"}
    return raw


def wall(raw: dict[str, Any]) -> str:
    """The condition of the bush: held, cooled or adiabatic."""
    return (
        "held"
        if "held_bush_temperature" in raw
        else "cooled"
        if "ambient_temperature" in raw
        else "adiabatic"
    )


def solved(raw: dict[str, Any], level: str) -> dict[str, float]:
    """The outputs and the processor seconds of one bearing; no outputs where it is refused by name."""
    start = process_time()
    try:
        answer = evaluate(ThermalFilm, raw, outputs=NAMES, level=level).outputs
        found = {name: float(answer[name].value) for name in NAMES}
    except InvalidInputs as refusal:
        if {fault.name for fault in refusal.faults} != {"relative_eccentricity"}:
            raise
        found = {}
    return {**found, "seconds": process_time() - start}


def quantiles(rows: list[dict[str, float]], name: str) -> str:
    """5 %, median, 95 % and the extremes."""
    values = np.array([row[name] for row in rows])
    low, five, half, most, high = np.quantile(values, [0, 0.05, 0.5, 0.95, 1])
    return f"{name}: median {half:.3g}, 5 % {five:.3g}, 95 % {most:.3g}, from {low:.3g} to {high:.3g}"


def ensemble() -> None:
    """The random bearings at level field."""
    rng = np.random.default_rng(SEED)
    rows = [solved(bearing(rng), "field") for _ in range(COUNT)]
    RESULTS.write_text(json.dumps(rows, indent=1) + "\n")
    report(rows)


def report(rows: list[dict[str, float]]) -> None:
    """Refusals, ratios and times, of all and by what is behind the bush."""
    borne = [row for row in rows if "film_ratio" in row]
    print(f"{len(rows)} bearings, {len(rows) - len(borne)} refused")
    rng = np.random.default_rng(SEED)
    kinds = [wall(bearing(rng)) for _ in rows]
    for kind in sorted(set(kinds)):
        own = [row for row, its in zip(rows, kinds, strict=True) if its == kind and row in borne]
        print(kind, len(own))
        for name in ("film_ratio", "loss_ratio", "unseen_rise"):
            print("   ", quantiles(own, name))
    for name in ("film_ratio", "loss_ratio", "unseen_rise", "mesh_error", "mesh_change", "heat_residual"):
        print(quantiles(borne, name))
    print(quantiles(rows, "seconds"))
    unsafe = np.array([row["film_ratio"] for row in borne])
    print(f"film of one temperature thicker by more than 10 %: {np.mean(unsafe > 1.1):.0%}; "
          f"thinner by more than 10 %: {np.mean(unsafe < 0.9):.0%}")  # fmt: skip


def again() -> None:
    """Print the summary of the kept results."""
    report(json.loads(RESULTS.read_text()))


def mesh() -> None:
    """Both levels on the first bearings that have a film."""
    rng = np.random.default_rng(SEED)
    rows = []
    for _ in range(MESHED):
        raw = bearing(rng)
        field, fine = (solved(raw, level) for level in ("field", "fine_field"))
        if "film_ratio" in field and "film_ratio" in fine:
            rows.append({
                "film_change": abs(field["minimum_film_thickness"] / fine["minimum_film_thickness"] - 1),
                "loss_change": abs(field["power_loss"] / fine["power_loss"] - 1),
                "peak_change_K": abs(field["greatest_film_temperature"] - fine["greatest_film_temperature"]),
                "ratio_change": abs(field["film_ratio"] / fine["film_ratio"] - 1),
                "seconds": fine["seconds"],
            })  # fmt: skip
    print(len(rows), "bearings at level field against fine_field")
    for name in rows[0]:
        print(quantiles(rows, name))


def picture() -> None:
    """The bush's temperature around, for three ways of cooling, beside one temperature."""
    plain = {name: value for name, value in ThermalFilm.example.items()
             if name not in ("heat_transfer_coefficient", "ambient_temperature")}  # fmt: skip
    cases = {
        "adiabatic bush": plain,
        "cooled from behind, 1000 W/(m² K) to 40 °C":
            {**plain, "heat_transfer_coefficient": "1000 W/(m**2*K)", "ambient_temperature": "40 degC"},
        "bush held at 50 °C": {**plain, "held_bush_temperature": "50 degC"},
    }  # fmt: skip
    plt.rcParams.update({"svg.hashsalt": "crankwright", "svg.fonttype": "none"})  # the same bytes again
    figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
    for words, raw in cases.items():
        found = evaluate(ThermalFilm, raw, level="fine_field").outputs
        angle, bush = (np.asarray(found[f"bush_{name}"].value) for name in ("angle", "temperature"))
        (line,) = axes.plot(angle, bush, label=words)
        axes.axhline(float(found["journal_temperature"].value), color=line.get_color(), ls=":", lw=1)
        one = float(found["effective_temperature"].value)
        print(words, {n: round(float(found[n].value), 4) for n in NAMES})
    axes.axhline(one, color="black", ls="--", label="one effective temperature (ISO 7902-1)")
    axes.set(xlabel="angle from the load in the sense of rotation [°]", ylabel="bush [°C]", xlim=(0, 355))
    axes.legend(fontsize="small", title="dotted: the journal")
    figure.savefig(PICTURE, metadata={"Date": None})
    plt.close(figure)


if __name__ == "__main__":
    {"mesh": mesh, "picture": picture, "report": again}.get("".join(sys.argv[1:]), ensemble)()
