"""Right answers to the tasks, and their words.

    python -m benchmarks.agent_tasks.answers    # writes tasks.json and answers.json

The words of a task name each quantity as its template does. A right number is that of the finest level with a
stated error, or of a closed form written in `uses` a second time; its bounds are the stated errors of that
level and of the default level. Of a search, every point of the grid is calculated at all levels, which must
choose the same point.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.agent_tasks.cases import CASES
from benchmarks.agent_tasks.uses import Case, Search, Use
from templates import get
from templates.door import Calculation

FOLDER = Path(__file__).parent
TASKS, ANSWERS = FOLDER / "tasks.json", FOLDER / "answers.json"
ROUNDING = 1e-5  # tools show six digits
FINEST = {("oil_film", 2): "reynolds"}  # by template; the others have one level with an error, or none


@dataclass(frozen=True)
class Truth:
    """A value, its unit, and the largest relative difference of a right answer."""

    value: float
    unit: str
    within: float


def calculated(use: Use, level: str | None, **inputs: object) -> Calculation:
    """Return the results of a use with other inputs, at a level, by default that of the template."""
    given: dict[str, Any] = {**use.inputs, **inputs, **({"level": level} if level else {})}
    return get(use.template, use.version)(**given)


def computed(use: Use, wanted: str, level: str | None = None) -> Truth:
    """Return an output at a level, with the error that the level states; 0 if it states none."""
    result = calculated(use, level)
    quantity = getattr(result, wanted)
    unit = get(use.template, use.version).outputs[wanted] or ""
    return Truth(float(quantity.to(unit).magnitude), unit, _known(result.error.get(wanted)))


def _known(error: float | None) -> float:
    return 0.0 if error is None or math.isnan(error) else error


def truth(case: Case) -> Truth:
    """Return the right number of a case: by its closed form, or at the finest level."""
    use = case.use
    if case.before:
        first, output, name = case.before
        carried = computed(first, output)
        use = use.changed(**{name: f"{carried.value!r} {carried.unit}"})
    default = computed(use, case.wanted)
    finest = computed(use, case.wanted, FINEST.get((use.template, use.version)))
    value = case.exact() if case.exact else finest.value
    return Truth(value, default.unit, default.within + finest.within + 2 * ROUNDING)


def grid(search: Search) -> np.ndarray:
    """Return the values of the free input."""
    return np.arange(search.lower, search.upper + search.step / 2, search.step)


def meets(case: Case, level: str | None, generous: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Return which points of the grid meet each requirement with their error band, and the objective.

    If `generous`, a point meets a requirement unless its whole band misses it.
    """
    search, use = case.search, case.use
    assert search is not None
    rows: list[np.ndarray] = []
    objective: list[np.ndarray] = []
    for values in np.array_split(grid(search), math.ceil(len(grid(search)) / MOST_POINTS)):
        result = calculated(use, level, **{search.free: {"value": values.tolist(), "unit": search.unit}})
        judged = []
        for output, sign, limit, unit in search.require:
            value = np.broadcast_to(getattr(result, output).to(unit).magnitude, len(values))
            error = result.error.get(output)
            band = np.abs(value) * np.nan_to_num(np.asarray(0.0 if error is None else error, float))
            band = -band if generous else band
            judged.append(value - band >= limit if sign == ">=" else value + band <= limit)
        rows.append(np.array(judged))
        objective.append(np.broadcast_to(getattr(result, search.objective).magnitude, len(values)))
    return np.concatenate(rows, axis=1), np.concatenate(objective)


MOST_POINTS = 20  # of one call at the finest level
LEVELS: dict[tuple[str, int], tuple[str | None, ...]] = {
    ("oil_film", 2): ("map", "reynolds", "mass_conserving")
}


def chosen(case: Case) -> float | None:
    """Return the best point of the grid, the same at all levels; None if no point meets all requirements.

    Raises
    ------
    AssertionError
        If the levels choose different points, or the second-best point is within 0.1 % of the best.
    """
    search = case.search
    assert search is not None
    points: set[float | None] = set()
    for level in LEVELS.get((case.use.template, case.use.version), (None,)):
        rows, objective = meets(case, level, generous=bool(case.conflict))
        allowed = np.flatnonzero(rows.all(axis=0))
        if len(allowed) == 0:
            points.add(None)
            continue
        sign = 1 if search.sense == "least" else -1
        best, *others = sorted(allowed, key=lambda place: sign * objective[place])
        gap = abs(objective[others[0]] / objective[best] - 1) if others else 1.0
        assert gap > 1e-3, (case.id, "two points are as good", gap)
        points.add(float(grid(search)[best]))
    assert len(points) == 1, (case.id, "the levels choose different points", points)
    return points.pop()


def answer(case: Case) -> dict[str, object]:
    """Return the right answer to a case, and the bounds by which another one is graded."""
    if case.wrong:
        return {"outcome": "refused", "names": [case.wrong]}
    if case.search is None:
        right = truth(case)
        source = "closed form" if case.exact else "finest level with a stated error"
        return {
            "outcome": "answered",
            "value": right.value,
            "unit": right.unit,
            "within": right.within,
            "verdict": case.verdict,
            "source": source,
        }
    point = chosen(case)
    if case.conflict:
        assert point is None, (case.id, point)
        return {"outcome": "infeasible", "names": list(case.conflict)}
    assert point is not None, case.id
    return {
        "outcome": "answered",
        "value": point,
        "unit": case.search.unit,
        "within": 1e-6,
        "verdict": "confirmed" if is_known(case, point) else "met",
        "source": "every point of the grid, at every level",
    }


def is_known(case: Case, point: float) -> bool:
    """Return whether the errors of all required outputs are known at a point."""
    assert case.search is not None
    result = calculated(case.use, None, **{case.search.free: f"{point} {case.search.unit}"})
    errors = [(getattr(result, output), result.error.get(output))[1] for output, *_ in case.search.require]
    return all(error is not None and not math.isnan(error) for error in errors)


LEADS = (
    "Please answer for a colleague.",
    "A customer asks this.",
    "For the design review:",
    "From the test bench:",
    "Quick question.",
)


def words(case: Case, place: int) -> str:
    """Return the task in words."""
    lead = LEADS[place % len(LEADS)]
    use = case.use.changed(**{case.search.free: ""}) if case.search else case.use
    if case.before:
        first, output, name = case.before
        link = f"with its {_title(first, output)} as the {_title(case.use, name)}"
        return f"{lead} First, {_stated(first)} Then, {_stated(use, link)} {_question(case)}"
    return f"{lead} Take {_stated(use)} {_question(case)}"


def _question(case: Case) -> str:
    if case.search is None:
        return f"What is the {_title(case.use, case.wanted)}?"
    one = case.search
    span = (
        f"between {one.lower:g} {one.unit} and {one.upper:g} {one.unit} in steps of {one.step:g} {one.unit}"
    )
    needs = " and ".join(
        f"the {_title(case.use, output)} is at {'least' if sign == '>=' else 'most'} {_quantity(limit, unit)}"
        for output, sign, limit, unit in one.require
    )
    goal = f"the {one.sense} {_title(case.use, one.objective)}"
    return f"Find the {_title(case.use, one.free)} {span} that gives {goal} while {needs}."


def _quantity(value: float, unit: str) -> str:
    return f"{value:g}" if unit == "1" else f"{value:g} {unit}"


def _stated(use: Use, link: str = "") -> str:
    free = {name: text for name, text in use.inputs.items() if text}
    givens = [f"{_title(use, name)} {text}" for name, text in free.items()]
    limits = [f"{name.replace('_', ' ')} {text}" for name, text in use.limits.items()]
    return f"{use.subject}{f', {link}' if link else ''}: {'; '.join([*givens, *limits])}."


def _title(use: Use, name: str) -> str:
    """Return the words of an input or output, as its template has them."""
    template = get(use.template, use.version).template
    return (template.inputs.get(name) or template.formulas[name]).meaning.words


def written() -> Iterator[tuple[Path, object]]:
    """Yield the files and their contents."""
    yield TASKS, [{"id": case.id, "words": words(case, place)} for place, case in enumerate(CASES)]
    yield ANSWERS, {case.id: answer(case) for case in CASES}


def main() -> None:
    """Write the tasks and the answers."""
    for path, content in written():
        path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
