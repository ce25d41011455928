"""The verdict on the design page: what governs, what is missing, and the summary line of each step."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from app.calculations.schemas.evaluations import Output
from app.designs.schemas.designs import Design, RevisionWorksheet
from app.presentation.criteria import Line, headline_of, line, sides, tone
from app.presentation.numbers import has_value
from app.schemas.criteria import Criterion, Verdict
from app.web.shared.blocks import StepBlock
from app.web.shared.forms import texts

MOST_KEYS = 4  # results in the summary line of a step
_NAMES = re.compile(r"[A-Za-z]\w*(?:\.[A-Za-z]\w*)*")


@dataclass(frozen=True)
class Banner:
    """The verdict at the top of the page; without `lines`, the headline states why there is none."""

    headline: str
    tone: str  # green, bad, open or plain: the class of its colour
    governing: Line | None
    lines: list[Line]
    judged: bool

    @property
    def unchecked(self) -> list[Line]:
        """Return the criteria that were not checked, each with the missing input."""
        return [line for line in self.lines if line.verdict == "not_checked"]

    @property
    def undecided(self) -> bool:
        """Return whether a more accurate calculation might decide a criterion."""
        return any(line.is_open for line in self.lines)

    def worst_by_step(self) -> dict[str, Line]:
        """Return the worst criterion of each step that has criteria."""
        return {line.step: line for line in reversed(self.lines)}


def banner(revision: RevisionWorksheet, *, has_criteria: bool = True) -> Banner:
    """Return the verdict on a revision, or the reason why there is none, such as no declared criteria."""
    verdict = revision.verdict
    if verdict is None or not revision.criteria:
        is_judged = revision.criteria is not None or (revision.state == "current" and not has_criteria)
        return Banner(headline_of(revision.state, is_judged=is_judged), "plain", None, [], judged=is_judged)
    return banner_over(verdict, revision.criteria)


def banner_over(verdict: Verdict, criteria: Iterable[Criterion]) -> Banner:
    """Return the verdict over a list of criteria."""
    lines = [line(criterion) for criterion in criteria]
    governing = next((line for line in lines if line.name == verdict.governing), None)
    return Banner(verdict.headline, tone(verdict), governing, lines, judged=True)


def key_outputs(
    step: str, outputs: Mapping[str, Output], criteria: Iterable[Criterion], driving: Iterable[str]
) -> list[str]:
    """Return the outputs in the summary line of a step: judged ones, those used elsewhere, or the last.

    `driving` are the outputs that relations use. Unchecked outputs come last. Outputs without a value are
    omitted if any output has one.
    """
    single = [name for name, output in outputs.items() if not isinstance(output.value, list)]
    ordered = sorted(criteria, key=lambda criterion: criterion.verdict == "not_checked")
    judged = [name for criterion in ordered for name in _judged(step, criterion)]
    wanted = [name for name in dict.fromkeys([*judged, *driving]) if name in outputs]
    valued = [name for name in wanted if has_value(outputs[name].value)]
    last = [name for name in single if has_value(outputs[name].value)] or single
    return (valued or wanted or last[-3:])[:MOST_KEYS]


def _judged(step: str, criterion: Criterion) -> list[str]:
    """Return the outputs of a step that a criterion judges; its template's own criteria use bare names."""
    own = criterion.name.startswith(f"{step}.")
    names = _NAMES.findall(sides(criterion.require)[0])
    return [n.removeprefix(f"{step}.") for n in names if n.startswith(f"{step}.") or (own and "." not in n)]


def driving_outputs(design: Design) -> dict[str, list[str]]:
    """Return the outputs that relations of a design name, by step."""
    driving: dict[str, list[str]] = {}
    for text in texts(design).values():
        for name in _NAMES.findall(text):
            step, dot, output = name.partition(".")
            if dot:
                driving.setdefault(step, []).append(output)
    return driving


def with_keys(steps: Iterable[StepBlock], revision: RevisionWorksheet, design: Design) -> list[StepBlock]:
    """Return the steps, each with the outputs of its summary line."""
    driving, judged = driving_outputs(design), _by_step(revision.criteria or [])
    return [
        replace(
            step,
            keys=key_outputs(
                step.name, step.result.outputs, judged.get(step.name, []), driving.get(step.name, [])
            ),
        )
        for step in steps
    ]


def _by_step(criteria: Iterable[Criterion]) -> dict[str, list[Criterion]]:
    """Return the criteria that concern each step, either by their name or by the values that they compare."""
    judged: dict[str, list[Criterion]] = {}
    for criterion in criteria:
        names = [criterion.name, *_NAMES.findall(sides(criterion.require)[0])]
        for step in dict.fromkeys(name.split(".", 1)[0] for name in names if "." in name):
            judged.setdefault(step, []).append(criterion)
    return judged


def opened(names: Sequence[str], verdict: Banner) -> str | None:
    """Return the step unfolded at first: that of the governing criterion, otherwise the first step."""
    governing = verdict.governing.step if verdict.governing else ""
    return governing if governing in names else next(iter(names), None)
