"""Grade the answers of any client to the tasks.

    python -m benchmarks.agent_tasks.grade submission.json

A submission is a JSON object with an entry for each task:

    {"number-01": {"outcome": "answered", "value": 3.87, "unit": "um", "verdict": "confirmed"},
     "conflict-02": {"outcome": "infeasible", "names": ["minimum_film_thickness", "power_loss"]},
     "unit-01": {"outcome": "refused", "names": ["radial_load"]}}

`verdict` is the word of the tool before its brackets. A right number lies within the bounds of
`answers.json`, in any unit of the same kind, with the right verdict. To be right, `infeasible` names all
requirements that conflict, and `refused` the quantity that is wrong; further names do not count. A wrong
number that is called confirmed, or any number called confirmed where there is none, fails the whole run.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NotRequired, TypedDict

import pint

ANSWERS = Path(__file__).with_name("answers.json")
UNITS: pint.UnitRegistry[float] = pint.UnitRegistry()
Grade = Literal["right", "wrong", "fatal"]


class Right(TypedDict):
    """A right answer."""

    outcome: Literal["answered", "infeasible", "refused"]
    value: NotRequired[float]
    unit: NotRequired[str]
    within: NotRequired[float]
    verdict: NotRequired[str]
    names: NotRequired[list[str]]


Given = Mapping[str, object]


@dataclass(frozen=True)
class Report:
    """The grades of a run by task."""

    grades: dict[str, Grade]

    @property
    def has_failed(self) -> bool:
        """Return whether a wrong number was called confirmed."""
        return "fatal" in self.grades.values()

    def lines(self) -> list[str]:
        """Return the result as lines of text."""
        groups = sorted({_group(id) for id in self.grades})
        rows = [f"{group:10} {self._count(group)}" for group in groups]
        fatal = [id for id, grade in self.grades.items() if grade == "fatal"]
        end = f"FAILED: confirmed, but wrong: {', '.join(fatal)}" if fatal else f"all        {self._count()}"
        return [*rows, end]

    def _count(self, group: str = "") -> str:
        counts = Counter(grade for id, grade in self.grades.items() if _group(id).startswith(group))
        return f"{counts['right']:3} right of {counts.total()}"


def grade(submission: Mapping[str, Given], answers: Mapping[str, Right]) -> Report:
    """Return the grades of a submission; a missing answer is wrong."""
    return Report({id: graded(submission.get(id, {}), right) for id, right in answers.items()})


def graded(given: Given, right: Right) -> Grade:
    """Return the grade of one answer."""
    if not isinstance(given, Mapping):
        return "wrong"
    if right["outcome"] == "answered":
        is_near = _is_near(given, right)
        if is_near and given.get("outcome") == "answered" and given.get("verdict") == right["verdict"]:
            return "right"
        return "wrong" if is_near or given.get("verdict") != "confirmed" else "fatal"
    if given.get("verdict") == "confirmed":
        return "fatal"
    names = given.get("names")
    listed = [str(name) for name in names] if isinstance(names, list) else []
    has_all = all(any(wanted in name for name in listed) for wanted in right["names"])
    return "right" if given.get("outcome") == right["outcome"] and has_all else "wrong"


def _is_near(given: Given, right: Right) -> bool:
    value, unit = given.get("value"), given.get("unit")
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return False
    try:
        found = UNITS.Quantity(float(value), str(unit or "")).to(right["unit"]).magnitude
    except (pint.PintError, ValueError, TypeError, AttributeError):
        return False
    return bool(abs(found - right["value"]) <= right["within"] * abs(right["value"]))


def _group(id: str) -> str:
    return id.rpartition("-")[0]


def main() -> None:
    """Grade a file; the exit code is 1 if the run has failed or an answer is wrong."""
    submission = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    report = grade(submission, json.loads(ANSWERS.read_text(encoding="utf-8")))
    print("\n".join(report.lines()))
    sys.exit(report.has_failed or any(one != "right" for one in report.grades.values()))


if __name__ == "__main__":
    main()
