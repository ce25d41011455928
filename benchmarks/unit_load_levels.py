"""What the levels of the analysis `unit_loads` cost, and how far their greatest stresses differ.

    python -m benchmarks.unit_load_levels    # docs/finite_elements.md

The throw of benchmarks.crank_life; each level in a process of its own.
"""

import resource
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from benchmarks.crank_life import SIZES
from cad.analysis.kinds import LEVELS, Level
from cad.analysis.throw_tables import unit_load_tables
from cad.models.crank_throw_v1 import CrankThrow
from cad.regenerate import regenerate


def of_level(level: Level) -> tuple[int, float, float, dict[str, float]]:
    """Return elements, seconds, memory [MB] and the greatest von Mises stress at the fillets by load."""
    metres = {name: value / 1000 for name, value in SIZES.items()}
    throw = CrankThrow.from_si(metres)
    sizes = throw.throw_sizes()
    assert sizes is not None
    step = regenerate("crank_throw", 1, metres).step
    begin = time.perf_counter()
    outputs = unit_load_tables(step, throw.shaft(), sizes, level, lambda done, what: None)
    seconds = time.perf_counter() - begin
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    greatest = {n: _greatest(one["value"]) for n, one in outputs.items() if n != "points"}
    return outputs["points"]["mesh"]["elements"], seconds, memory, greatest


def _greatest(rows: list[list[float]]) -> float:
    """Return the greatest von Mises stress of tensors xx, yy, zz, xy, yz, xz."""
    xx, yy, zz, xy, yz, xz = np.array(rows).T
    apart = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return float(np.sqrt(apart / 2 + 3 * (xy**2 + yz**2 + xz**2)).max())


def main() -> None:
    """Print a row for each level; differences are from the finest."""
    results = {}
    for level in LEVELS:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            results[level] = pool.submit(of_level, level).result()
    finest = results[LEVELS[-1]][3]
    for level, (elements, seconds, memory, greatest) in results.items():
        apart = ", ".join(f"{n} {value / finest[n] - 1:+.1%}" for n, value in greatest.items())
        print(f"{level}: {elements} elements, {seconds:.1f} s, {memory:.0f} MB; {apart}")


if __name__ == "__main__":
    main()
