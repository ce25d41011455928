"""The example of `cycle_heat_balance`, with and without shear thinning, at three levels; what a point costs.

python -m benchmarks.cycle_heat             half a minute

Version 1 at level mobility_grooved, then version 2 there and at level supplied, whose side flow is all
the oil that leaves by the ends.
"""

from time import process_time

from templates.core.language.evaluate import evaluate
from templates.oil_film import cycle_heat_balance_v1, cycle_heat_balance_v2

NAMES = ("effective_viscosity", "film_temperature", "temperature_rise", "minimum_film_thickness",
         "power_loss", "side_flow", "feed_flow")  # fmt: skip
FIRST, SECOND = cycle_heat_balance_v1.CycleHeatBalance, cycle_heat_balance_v2.CycleHeatBalance
LEVELS = ((FIRST, "mobility_grooved"), (SECOND, "mobility_grooved"), (SECOND, "supplied"))


def main() -> None:
    """Print a row for each."""
    print("| version, level | case | " + " | ".join(NAMES) + " | processor s |")
    for cls, level in LEVELS:
        for words, left_out in (("heat alone", {"hths_viscosity"}), ("heat and shear", set())):
            raw = {name: value for name, value in cls.example.items() if name not in left_out}
            start = process_time()
            found = evaluate(cls, raw, level=level, outputs=NAMES).outputs
            seconds = process_time() - start
            values = [found[n].value for n in NAMES]
            row = " | ".join("" if value is None else f"{value:.4g}" for value in values)
            print(f"| {cls.version}, {level} | {words} | {row} | {seconds:.2g} |")


if __name__ == "__main__":
    main()
