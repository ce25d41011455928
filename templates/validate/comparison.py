"""Our numbers beside the published ones: differences, verdicts, and where they are farthest apart."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median

from templates.validate.case import Case, Numbers
from templates.validate.reference import Column


@dataclass(frozen=True)
class Comparison:
    """One column of a case; cells that the source leaves empty are absent from both lists."""

    column: Column
    theirs: list[float]
    ours: list[float]

    @property
    def uncertainties(self) -> list[float]:
        """Return the uncertainty of each published number."""
        assert self.column.uncertainty is not None
        return [self.column.uncertainty.of(value) for value in self.theirs]

    @property
    def shares(self) -> list[float]:
        """Return each difference over the uncertainty: above 1, the two differ."""
        each = zip(self.ours, self.theirs, self.uncertainties, strict=True)
        return [abs(ours - theirs) / allowed for ours, theirs, allowed in each]

    @property
    def worst(self) -> int:
        """Return the place of the largest difference over its uncertainty."""
        return max(range(len(self.shares)), key=self.shares.__getitem__)

    @property
    def missed(self) -> int:
        """Return the number of values that differ by more than their uncertainty."""
        return sum(share > 1 for share in self.shares)

    @property
    def median_ratio(self) -> float | None:
        """Return the median of ours over theirs; None if a published number is 0."""
        if 0 in self.theirs:
            return None
        return median(ours / theirs for ours, theirs in zip(self.ours, self.theirs, strict=True))


def comparisons(case: Case, found: Numbers) -> list[Comparison]:
    """Return one comparison for each column."""
    return [_comparison(case, column, found) for column in case.compared]


def _comparison(case: Case, column: Column, found: Numbers) -> Comparison:
    cells = [row[column.name] for row in case.selected]
    pairs = [(float(cell), x) for cell, x in zip(cells, found[column.name], strict=True) if cell]
    return Comparison(column, [theirs for theirs, _ in pairs], [ours for _, ours in pairs])


def agrees(compared: list[Comparison]) -> bool:
    """Return whether every value is within the uncertainty of the published one."""
    return not any(comparison.missed for comparison in compared)


def farthest(compared: list[Comparison]) -> Comparison:
    """Return the comparison with the largest difference over its uncertainty."""
    return max(compared, key=lambda comparison: max(comparison.shares))


def row(case: Case, found: Numbers) -> str:
    """Return the result of a case in one line: the number that is farthest from the published one."""
    compared = comparisons(case, found)
    shown = farthest(compared)
    n = shown.worst
    verdict = "agrees " if agrees(compared) else "DIFFERS"
    allowed = f"{shown.theirs[n]:.5g} ± {shown.uncertainties[n]:.2g}"
    return f"{case.key:32} {verdict} {shown.column.name:24} ours {shown.ours[n]:.5g}, theirs {allowed}"
