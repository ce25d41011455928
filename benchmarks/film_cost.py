"""Cost and error of the full film solution, and the error of Petrov's friction.

    python -m benchmarks.film_cost [prototype.py]

With the path of a prototype that has `solve(eps, ratio, around, across)`, such as reynolds_active_set.py,
its cost at an error no larger than that of ours is measured in the same run.
"""

import sys
from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_file_location
from time import perf_counter

from templates.physics.films.reynolds import extrapolated_film, static_film
from templates.physics.journals.petrov import friction_number_Petrov_1883

MESHES = [(48, 8), (64, 8), (128, 16), (256, 32)]
POINTS = [(0.1, 1.0), (0.5, 0.5), (0.8, 1.0), (0.95, 0.25), (0.99, 1.0), (0.999, 1.0)]
REPEATS = 20


def seconds(function: Callable[[], object], repeats: int = REPEATS) -> float:
    """Least wall time of several calls."""
    times = []
    for _ in range(repeats):
        begin = perf_counter()
        function()
        times.append(perf_counter() - begin)
    return min(times)


def cost() -> None:
    """Print error and time over meshes."""
    print("eps    B/D   mesh      error of So   time")
    for eps, ratio in POINTS:
        truth = extrapolated_film(eps, ratio, 512, 64)[0].So
        for n, m in MESHES:
            error = static_film(eps, ratio, n, m).So / truth - 1
            time = seconds(lambda e=eps, b=ratio, n=n, m=m: static_film(e, b, n, m))  # type: ignore[misc]
            print(f"{eps:<6} {ratio:<5} {n:3d} × {m:<3d} {100 * error:9.4f} %  {1e3 * time:8.2f} ms")


def against(path: str, eps: float = 0.8, ratio: float = 1.0) -> None:
    """Print the time of the prototype over ours, both at 0.1 % or better."""
    spec = spec_from_file_location("prototype", path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    truth = extrapolated_film(eps, ratio, 512, 64)[0].So
    ours = seconds(lambda: static_film(eps, ratio, 64, 8))
    print(f"ours 64 × 8: error {100 * (static_film(eps, ratio, 64, 8).So / truth - 1):.3f} %")
    for n, m in ((60, 8), (120, 12), (180, 18), (240, 24), (360, 40), (480, 48)):
        error = module.solve(eps, ratio, n, m)["So"] / truth - 1
        theirs = seconds(lambda n=n, m=m: module.solve(eps, ratio, n, m), 3)  # type: ignore[misc]
        print(f"prototype {n} × {m}: error {100 * error:.3f} %, {theirs / ours:.1f} times our time")


def petrov() -> None:
    """Print Petrov's friction over that of the film."""
    print("eps   " + "".join(f"  B/D {ratio:<5}" for ratio in (0.25, 0.5, 1.0)))
    for eps in (0.01, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.965, 0.99):
        frictions = [extrapolated_film(eps, ratio)[0].friction for ratio in (0.25, 0.5, 1.0)]
        print(
            f"{eps:<6}"
            + "".join(f"{100 * (friction_number_Petrov_1883() / f - 1):9.2f} %" for f in frictions)
        )


if __name__ == "__main__":
    cost()
    petrov()
    if len(sys.argv) > 1:
        against(sys.argv[1])
