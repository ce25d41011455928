"""Parts that the solve pages of a design and of a template share: the answer, its curve and its roots."""

from __future__ import annotations

from collections.abc import Awaitable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from app.calculations.schemas.evaluations import Jump, Root, TracedCurve
from app.presentation import numbers
from app.reference import Reference
from app.reports.charts import Chart, Series, svg
from app.web.shared.answers import AnswerOrJob
from app.web.shared.services import Refused

PATIENCE = 5.0
"""Time that a page waits for an answer [s]; it shows how a longer calculation goes on."""
WRONG = 422
"""Status of a question that is wrong, which its page shows beside the form."""
Kind = TypeVar("Kind")


@dataclass(frozen=True)
class ShownRoot:
    """A root as a page lists it."""

    text: str  # as it is typed
    shown: str
    rises: str
    level: str
    error: str

    @classmethod
    def of(cls, root: Root) -> ShownRoot:
        """Return a crossing of the target, or an extremum that touches it."""
        return cls(
            text=f"{root.value!r} {root.unit}" if root.unit != "1" else repr(root.value),
            shown=numbers.in_line(root),
            rises={1: "rises", -1: "falls", 0: "touches"}[root.slope],
            level=(root.level or "").replace("_", " ") + ("" if root.confirmed else " (not confirmed)"),
            error="not stated" if root.error is None else f"± {numbers.percent(root.error)}",
        )


@dataclass(frozen=True)
class Drawing:
    """A curve between two bounds, the value that is wanted, in the unit of the curve, and what gives it."""

    unknown: str
    target: str
    wanted: float
    curve: TracedCurve
    roots: Sequence[Root]  # and extrema that touch
    jumps: Sequence[Jump]

    @property
    def level(self) -> str:
        """Return the level of all points, in words."""
        return (self.curve.level or "").replace("_", " ")

    @property
    def other_levels(self) -> str:
        """Return the levels of the solutions in words; empty where all are that of the curve."""
        levels = sorted({root.level for root in self.roots if root.level and root.confirmed})
        return "" if levels in ([], [self.curve.level]) else ", ".join(levels).replace("_", " ")

    def svg(self) -> str:
        """Return the drawing as SVG."""
        curve = self.curve
        x = [float(value) for value in curve.x.value]
        y = [None if value is None else float(value) for value in _list(curve.y.value)]
        words = Reference.parse(self.target).own_name.replace("_", " ")
        across = [root.value for root in self.roots]
        at, of_roots = (
            f", level {level}" if self.other_levels else "" for level in (self.level, self.other_levels)
        )
        series = [
            Series(f"{words}{at}", x, y),
            Series("wanted", [x[0], x[-1]], [self.wanted, self.wanted], dashed=True),
            Series(f"solutions{of_roots}", across, [self.wanted] * len(across), marked=True, joined=False),
        ]
        axis = f"{self.unknown} [{numbers.unit(curve.x.unit)}]", f"{words} [{numbers.unit(curve.y.unit)}]"
        return svg(Chart(*axis, [*series, *_jumps(self.jumps)]))


def _jumps(jumps: Sequence[Jump]) -> list[Series]:
    """Return the places where the output jumps across the target, as dashed lines."""
    if not jumps:
        return []
    across: list[float | None] = []
    upright: list[float | None] = []
    for jump in jumps:
        across += [jump.value, jump.value, None]
        upright += [jump.before.value, jump.after.value, None]
    return [Series("jumps", across, upright, dashed=True)]


def _list(value: object) -> list[float | None]:
    assert isinstance(value, list)
    return value


@dataclass(frozen=True)
class Reply(Generic[Kind]):
    """The reply to a question: an answer, a job that makes it, or faults."""

    answer: Kind | None = None
    job: str = ""  # that still makes the answer
    refusal: Refused | None = None

    @property
    def is_out_of_reach(self) -> bool:
        """Return whether no value between the bounds gives the target."""
        return self.refusal is not None and (self.refusal.problem.type or "").endswith("/unreachable")


async def replied(answer: Awaitable[AnswerOrJob[Kind]]) -> Reply[Kind]:
    """Return the reply to a question.

    Raises
    ------
    Refused
        For anything but a question that is wrong.
    """
    try:
        answered = await answer
    except Refused as refused:
        if refused.status != WRONG:
            raise
        return Reply(refusal=refused)
    return Reply(answered.answer, answered.job)
