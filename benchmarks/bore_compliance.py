"""Measure the compliance of a bore by finite elements: error, cost and difference from the finest level.

python -m benchmarks.bore_compliance       about two minutes of processor time
"""

from time import process_time
from typing import Any

import numpy as np

from cad.analysis.bore_tables import LEVELS, bore_tables, difference
from cad.header import Header
from cad.models.bearing_housing_v1 import BearingHousing
from cad.models.connecting_rod_v1 import ConnectingRod
from cad.shells.bore_place import bore_place
from cad.step import write_step


def main() -> None:
    """Print a table of both example solids at every level."""
    print("| model | level | elements | unknowns | stated error | from fine | processor s |")
    for cls in (BearingHousing, ConnectingRod):
        model = cls.from_quantities(cls.example)
        step, place = write_step(list(model.build()), Header(cls.id, 1, {}, "0" * 64)), bore_place(model)
        assert place is not None
        answers: dict[str, tuple[dict[str, Any], float]] = {}
        for level in LEVELS:
            start = process_time()
            answer = bore_tables(step, place, level, lambda done, what: None)["compliance"]
            answers[level] = answer, process_time() - start
        finest = np.array(answers["fine"][0]["value"])
        for name, (answer, seconds) in answers.items():
            away = difference(np.array(answer["value"]), finest)
            mesh = answer["mesh"]
            print(f"| {cls.id} | {name} | {mesh['elements']} | {mesh['degrees_of_freedom']} "
                  f"| {answer['error']:.2%} | {away:.3%} | {seconds:.1f} |")  # fmt: skip


if __name__ == "__main__":
    main()
