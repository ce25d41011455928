"""The example of `cycle_heat_balance` 1, with and without shear thinning, and what a point costs.

python -m benchmarks.cycle_heat             some seconds
"""

from time import process_time

from templates.core.language.evaluate import evaluate
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance

NAMES = ("effective_viscosity", "film_temperature", "temperature_rise", "minimum_film_thickness",
         "power_loss", "side_flow", "feed_flow")  # fmt: skip


def main() -> None:
    """Print a row for each."""
    print("| case | " + " | ".join(NAMES) + " | processor s |")
    for words, left_out in (("heat alone", {"hths_viscosity"}), ("heat and shear", set())):
        raw = {name: value for name, value in CycleHeatBalance.example.items() if name not in left_out}
        start = process_time()
        found = evaluate(CycleHeatBalance, raw, outputs=NAMES).outputs
        seconds = process_time() - start
        print(f"| {words} | " + " | ".join(f"{found[n].value:.4g}" for n in NAMES) + f" | {seconds:.2g} |")


if __name__ == "__main__":
    main()
