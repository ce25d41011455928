"""Errors of requests about worksheets, besides wrong inputs.

WorksheetError
    IdTaken             a file, or another worksheet, has the id
    OutOfOrder          the state of the worksheet does not allow the step
        OtherText       a review is of another text than the stored one
        UnresolvedRegions   regions of its import are neither verified nor resolved
        TestsFailed     the worksheet has faults, or its tests fail
    OwnReview           an author reviews their own worksheet
    StaleWorksheet      the worksheet has changed since the client read it
"""

from __future__ import annotations

from collections.abc import Sequence


class WorksheetError(Exception):
    """Base class of the errors of worksheets, apart from wrong inputs."""


class IdTaken(WorksheetError):
    """Raised if a file or another worksheet has the id."""

    def __init__(self, id: str, by: str) -> None:
        super().__init__(f"the id {id!r} belongs to {by} already; choose another, such as {id[:60]}_2")


class OutOfOrder(WorksheetError):
    """Raised if the state of the worksheet does not allow the step."""


class OtherText(OutOfOrder):
    """Raised if a review is of another text than the stored one."""

    def __init__(self, named: str, digest: str | None) -> None:
        super().__init__(
            f"the review names digest {named[:12]}…, the worksheet has {(digest or 'none')[:12]}…: "
            "read it again, then review that text"
        )


class TestsFailed(OutOfOrder):
    """Raised if the worksheet has faults, or its tests fail; `reasons` lists them."""

    __test__ = False  # prevents pytest from collecting it as a test

    def __init__(self, reasons: Sequence[str]) -> None:
        self.reasons = tuple(reasons)
        count = len(self.reasons)
        super().__init__(f"{count} {'fault' if count == 1 else 'faults'}: {'; '.join(self.reasons)}")


class UnresolvedRegions(OutOfOrder):
    """Raised if regions of the import differ, are refused or blocked, and their lines are unchanged."""

    def __init__(self, reasons: Sequence[str]) -> None:
        self.reasons = tuple(reasons)
        count, some = len(self.reasons), "; ".join(self.reasons[:5])
        remedy = "rewrite or remove the lines imported from these regions"
        regions = "region" if count == 1 else "regions"
        super().__init__(f"{count} {regions} of the import unresolved: {some}: {remedy}")


class OwnReview(WorksheetError):
    """Raised if an author reviews their own worksheet."""

    def __init__(self, name: str) -> None:
        super().__init__(f"{name!r} is the author; let another person review the worksheet")


class StaleWorksheet(WorksheetError):
    """Raised if the worksheet has changed since the client read it."""

    def __init__(self, id: str) -> None:
        super().__init__(f"worksheet {id} has changed in the meantime; read it again, then send your change")
