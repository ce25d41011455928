"""Compare the cost of a worksheet with the Python file of the same template, `oil_film` 1.

    python -m benchmarks.sheets      half a minute; prints processor times, each the smallest of several runs

Every formula is evaluated from checked SI values: reading inputs, which is the same for both, does not count.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template
from templates.core.sheets import grammar, read
from templates.oil_film.oil_film_v1 import OilFilm

TEXT = Path(__file__).with_name("oil_film.sheet").read_text(encoding="utf-8")
MANY = 100_000
Values = Mapping[str, Any]


def values_of(inputs: Mapping[str, Any]) -> Values:
    """Return the SI values of all inputs by attribute."""
    template = OilFilm.from_quantities(inputs)
    return {declared.attribute: getattr(template, declared.attribute) for declared in OilFilm.inputs.values()}


def every_formula(cls: type[Template], values: Values) -> None:
    """Evaluate all outputs."""
    with np.errstate(all="ignore"):
        template = cls(values)
        for formula in cls.formulas.values():
            getattr(template, formula.attribute)


def least(work: Callable[[], object], runs: int, times: int = 1) -> float:
    """Return the smallest processor time of some runs, each of which repeats the work [s]."""
    took = []
    for _ in range(runs):
        start = process_time()
        for _ in range(times):
            work()
        took.append((process_time() - start) / times)
    return min(took)


def many_points() -> dict[str, Any]:
    """Return the example at many loads and speeds."""
    random = np.random.default_rng(1)
    load, speed = random.uniform(1, 100, MANY), random.uniform(1000, 8000, MANY)
    return {
        **OilFilm.example,
        "radial_load": {"value": load.tolist(), "unit": "kN"},
        "speed": {"value": speed.tolist(), "unit": "rpm"},
    }


def read_first() -> None:
    """Read the worksheet as if none of its statements had been read before."""
    grammar._tree.cache_clear()
    read(TEXT).template("oil_film", 1)


def compare(words: str, film: type[Template], inputs: Mapping[str, Any], runs: int, times: int) -> None:
    """Print the times of both for some inputs."""
    values = values_of(inputs)
    mine = least(lambda: every_formula(film, values), runs, times)
    theirs = least(lambda: every_formula(OilFilm, values), runs, times)
    print(f"{words:24} {1e3 * mine:9.3f} ms {1e3 * theirs:9.3f} ms {mine / theirs:7.2f}")


def main() -> None:
    """Print the table, and the largest difference between both."""
    film = read(TEXT).template("oil_film", 1)
    print(f"{'':24} {'worksheet':>12} {'file':>12} {'ratio':>7}")
    compare("1 point", film, OilFilm.example, 200, 50)
    compare(f"{MANY} points", film, many_points(), 60, 1)
    lines = len(TEXT.splitlines())
    print(f"{f'reading {lines} lines':24} {1e3 * least(read_first, 20):9.1f} ms")
    print(f"{'reading them again':24} {1e3 * least(lambda: read(TEXT), 20):9.1f} ms")
    mine, theirs = (evaluate(cls, many_points()).outputs for cls in (film, OilFilm))
    differ = max(np.nanmax(np.abs(mine[n].value / answer.value - 1)) for n, answer in theirs.items())
    print(f"largest relative difference of any output: {differ:.1e}")


if __name__ == "__main__":
    main()
