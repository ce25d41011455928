"""Compare one bearing at all five levels of `oil_film` 2 in a Markdown table.

    python -m benchmarks.levels

The bearing is the template's example. The error is the one that the template states for the minimum film
thickness; the cost is the processor time of a point among many without stiffness, as a multiple of the closed
form's.
"""

from benchmarks.accuracy import cost
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm

COLUMNS = {
    "minimum_film_thickness": ("h_min", "um", ".3f"),
    "attitude_angle": ("attitude", "deg", ".2f"),
    "maximum_pressure": ("p_max", "MPa", ".1f"),
    "friction_coefficient": ("friction", "1", ".5f"),
    "stiffness_xx": ("stiffness_xx", "kN/um", ".3f"),
}


def row(level: str) -> list[str]:
    """Return the cells of one level except its cost."""
    units = {name: unit for name, (_, unit, _) in COLUMNS.items()}
    evaluation = evaluate(OilFilm, OilFilm.example, level=level, outputs=list(COLUMNS), units=units)
    values = [evaluation.outputs[name].value for name in COLUMNS]
    cells = [
        "none" if v is None else format(v, how)
        for v, (_, _, how) in zip(values, COLUMNS.values(), strict=True)
    ]
    return [f"`{level}`", *cells, f"{100 * evaluation.error['minimum_film_thickness']:.2g} %"]


def main() -> None:
    """Print the bearing and the table."""
    film = evaluate(OilFilm, OilFilm.example).outputs
    names = ("width_ratio", "sommerfeld_number", "relative_eccentricity")
    print(", ".join(f"{name} {film[name].value:.3g}" for name in names))
    heads = [f"{word} [{unit}]" if unit != "1" else word for word, unit, _ in COLUMNS.values()]
    print("\n| level | " + " | ".join([*heads, "error of h_min", "cost"]) + " |")
    print("|" + "---|" * (len(heads) + 3))
    costs = {level: cost(level)["vectorised"] for level in OilFilm.levels}
    for level in OilFilm.levels:
        multiple = f"{costs[level] / costs['short_bearing']:.1g}"
        print("| " + " | ".join([*row(level), f"{float(multiple):,.0f}".replace(",", " ")]) + " |")


if __name__ == "__main__":
    main()
