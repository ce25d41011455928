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
"""Time that a page waits for an answer [s]; then it shows the progress."""
WRONG = 422
"""Status of a faulty question, which the page shows next to the form."""
Kind = TypeVar("Kind")


@dataclass(frozen=True)
class ShownRoot:
    """A root as a list on the page shows it."""

    text: str  # as it is typed
    shown: str
    crossing: str
    slope: str
    level: str
    error: str

    @classmethod
    def of(cls, root: Root) -> ShownRoot:
        """Return a crossing of the target, or an extremum that touches it."""
        return cls(
            text=f"{root.value!r} {root.unit}" if root.unit != "1" else repr(root.value),
            shown=numbers.in_line(root),
            crossing=root.crossing,
            slope=_slope(root),
            level=in_words(root.level) + ("" if root.confirmed else " (not confirmed)"),
            error="not stated" if root.error is None else f"± {numbers.percent(root.error)}",
        )


def _slope(root: Root) -> str:
    """Return the slope at a root, or the reason why there is none."""
    slope = root.slope
    if slope is None:
        return f"– ({root.reason})"
    return numbers.in_line({"value": float(f"{slope.value:.3g}"), "unit": slope.unit})


@dataclass(frozen=True)
class Drawing:
    """The curves between two bounds, the wanted value in their unit, and the solutions."""

    unknown: str
    target: str
    wanted: float
    curve: TracedCurve
    finer: Sequence[TracedCurve]
    roots: Sequence[Root]  # including extrema that touch the target
    jumps: Sequence[Jump]
    level: str  # of the curve that was searched, in words; empty without levels
    finer_levels: Sequence[str]

    def is_sparse(self, finer: TracedCurve) -> bool:
        """Return whether the finer curve has fewer points than the searched one."""
        return len(finer.x.value) < len(self.curve.x.value)

    def caption(self) -> str:
        """Return the caption of the drawing."""
        wanted = "the dashed line is the value wanted"
        at = f", at level {self.level}" if self.level else ""
        if not self.finer:
            return f"{self.target} over {self.unknown}{at}; {wanted}."
        confirmed = (
            f"{'points' if self.is_sparse(curve) else 'the curve'} at level {level}"
            for level, curve in zip(self.finer_levels, self.finer, strict=True)
        )
        return (
            f"{self.target} over {self.unknown}: the curve at level {self.level} was searched, and "
            f"{', '.join(confirmed)} confirmed the solutions; {wanted}."
        )

    def svg(self) -> str:
        """Return the drawing as SVG."""
        words = Reference.parse(self.target).own_name.replace("_", " ")
        across = [root.value for root in self.roots]
        ends = [self.curve.x.value[0], self.curve.x.value[-1]]
        series = [
            _series(f"level {self.level}" if self.finer else words, self.curve),
            *(
                _series(f"level {level}", curve, is_sparse=self.is_sparse(curve))
                for level, curve in zip(self.finer_levels, self.finer, strict=True)
            ),
            Series("wanted", ends, [self.wanted, self.wanted], dashed=True),
            Series("solutions", across, [self.wanted] * len(across), marked=True, joined=False),
        ]
        x, y = self.curve.x, self.curve.y
        axis = f"{self.unknown} [{numbers.unit(x.unit)}]", f"{words} [{numbers.unit(y.unit)}]"
        return svg(Chart(*axis, [*series, *_jumps(self.jumps)]))


def in_words(level: str | None) -> str:
    """Return the text by which a page shows a level."""
    return (level or "").replace("_", " ")


def _series(name: str, curve: TracedCurve, *, is_sparse: bool = False) -> Series:
    """Return a curve as a line, or as points if it has only a few."""
    x = [float(value) for value in curve.x.value]
    y = [None if value is None else float(value) for value in _list(curve.y.value)]
    return Series(name, x, y, marked=is_sparse, joined=not is_sparse)


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
    """The reply to a request: an answer, a job that computes it, or faults."""

    answer: Kind | None = None
    job: str = ""  # the job that is still computing the answer
    refusal: Refused | None = None

    @property
    def is_out_of_reach(self) -> bool:
        """Return whether no value between the bounds gives the target."""
        return self.refusal is not None and (self.refusal.problem.type or "").endswith("/unreachable")


async def replied(answer: Awaitable[AnswerOrJob[Kind]]) -> Reply[Kind]:
    """Return the reply to a request.

    Raises
    ------
    Refused
        For any error except faults of the request itself.
    """
    try:
        answered = await answer
    except Refused as refused:
        if refused.status != WRONG:
            raise
        return Reply(refusal=refused)
    return Reply(answered.answer, answered.job)
