"""Cost of one criterion of single values: processor time of reading its values and judging it.

    python -m benchmarks.criterion_cost      a few seconds; prints microseconds, medians of 21 runs

The bearing is the example of `oil_film` 2, evaluated once. Each of its criteria is judged many times.
"""

from collections.abc import Callable
from functools import partial
from statistics import median
from time import process_time

from templates.core.judging.criterion import Criterion
from templates.core.judging.judgement import Judgement
from templates.core.judging.judging import judge
from templates.core.language.criteria import Evaluated, estimates_of
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy
from templates.oil_film.oil_film_v2 import OilFilm

RUNS, TIMES = 21, 500


def judged(evaluated: Evaluated, criterion: Criterion) -> Judgement:
    """One criterion, with its values read again."""
    return judge(criterion, *estimates_of(evaluated, criterion))


def microseconds(work: Callable[[], object]) -> float:
    """The median of some runs."""
    took = []
    for _ in range(RUNS):
        start = process_time()
        for _ in range(TIMES):
            work()
        took.append((process_time() - start) / TIMES)
    return 1e6 * median(took)


def main() -> None:
    """Print the time of each criterion that has both sides, and the median over them."""
    result = evaluate(OilFilm, OilFilm.example)
    table = accuracy(OilFilm)
    evaluated = Evaluated(result.template, result.outputs, result.error, table, level=result.level)
    criteria = [one for one in OilFilm.declared_criteria if not estimates_of(evaluated, one)[1]]
    times = {one.name: microseconds(partial(judged, evaluated, one)) for one in criteria}
    for name, time in times.items():
        print(f"{name:20} {time:6.1f} us")
    print(f"{'median':20} {median(times.values()):6.1f} us")


if __name__ == "__main__":
    main()
