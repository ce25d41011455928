"""Calculate the example of `cycle_heat_balance` with and without shear thinning at two levels, with cost.

python -m benchmarks.cycle_heat             half a minute

The levels are mobility_grooved and supplied; at supplied, the side flow is all the oil that leaves at the
ends.
"""

from time import process_time

from templates.core.language.evaluate import evaluate
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance

NAMES = ("effective_viscosity", "film_temperature", "temperature_rise", "minimum_film_thickness",
         "power_loss", "side_flow", "feed_flow")  # fmt: skip
LEVELS = ("mobility_grooved", "supplied")


def main() -> None:
    """Print a row for each."""
    print("| level | case | " + " | ".join(NAMES) + " | processor s |")
    for level in LEVELS:
        for words, left_out in (("heat alone", {"hths_viscosity"}), ("heat and shear", set())):
            raw = {name: value for name, value in CycleHeatBalance.example.items() if name not in left_out}
            start = process_time()
            found = evaluate(CycleHeatBalance, raw, level=level, outputs=NAMES).outputs
            seconds = process_time() - start
            values = [found[n].value for n in NAMES]
            row = " | ".join("" if value is None else f"{value:.4g}" for value in values)
            print(f"| {level} | {words} | {row} | {seconds:.2g} |")


if __name__ == "__main__":
    main()
