"""The order of affected designs, and of the verdict changes of one design, worst first."""

from __future__ import annotations

from collections.abc import Iterable

from app.impact.schemas import CriterionChange, DesignImpact

NO_LONGER_MET, NOT_MET, REFUSED, OPEN, MOVED, UNKNOWN = range(6)


def severity(moved: CriterionChange) -> int:
    """Return the rank of a change of verdict; the worst change has the lowest rank."""
    if moved.new == "not_met":
        return NO_LONGER_MET if moved.old == "met" else NOT_MET
    if moved.old == "met":
        return OPEN
    return MOVED


def worst_first(moved: Iterable[CriterionChange]) -> list[CriterionChange]:
    """Return changes of verdicts, sorted worst first."""
    return sorted(moved, key=lambda one: (severity(one), one.name, one.variant or ""))


def rank(impact: DesignImpact) -> tuple[int, float, float, str]:
    """Return the key by which designs are sorted."""
    worst = min((severity(one) for one in impact.verdicts), default=MOVED)
    if impact.effect == "refused":
        worst = REFUSED
    elif impact.effect == "needs_solids":
        worst = UNKNOWN
    lost = impact.margin.relative if impact.margin else None
    changed = impact.output.change if impact.output else None
    return worst, -(lost or 0.0), -abs(changed or 0.0), impact.design
