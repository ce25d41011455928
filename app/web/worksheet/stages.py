"""The states of a worksheet on its page: the completed steps, the next step and its missing conditions."""

from __future__ import annotations

from dataclasses import dataclass

from app.worksheets.schemas.worksheets import Sheet, SheetVersion

ORDER = ("draft", "tested", "reviewed", "released")
FINISHED = ("released", "withdrawn", "broken")


@dataclass(frozen=True)
class Stage:
    """One step of the life cycle; `action` is its name in the interface."""

    action: str
    title: str
    explained: str
    is_done: bool
    missing: str

    @property
    def is_next(self) -> bool:
        """Return whether the step can be taken now."""
        return not self.is_done and not self.missing


def stages(sheet: Sheet) -> list[Stage]:
    """Return the steps test, review and release for the newest version."""
    reached = len(ORDER) if sheet.state in FINISHED else ORDER.index(sheet.state)
    by = f" by {sheet.reviewer}" if sheet.reviewer else ""
    return [
        Stage(
            "test",
            "Test",
            "The service runs the tests of the text and calculates its example.",
            reached >= 1,
            _faults(sheet),
        ),
        Stage(
            "review",
            f"Review{by}",
            "Somebody else reads the text. The name is not verified: reports state ‘review not verified’.",
            reached >= 2,
            "" if reached >= 1 else "Test it first.",
        ),
        Stage(
            "release",
            f"Release version {sheet.version}",
            "A released version never changes. Designs use it as they use every template.",
            reached >= 3,
            "" if reached >= 2 else "Have it reviewed first.",
        ),
    ]


def _faults(sheet: Sheet) -> str:
    """Return a sentence about the faults that prevent a test."""
    count = len(sheet.faults)
    if not count:
        return ""
    return f"Correct {'the fault' if count == 1 else f'the {count} faults'} in the text first."


def newest_released(sheet: Sheet) -> SheetVersion | None:
    """Return the newest version that designs can use."""
    usable = (item for item in sheet.versions if item.state == "released")
    return max(usable, key=lambda item: item.version, default=None)


def begins_next(sheet: Sheet) -> bool:
    """Return whether an edit starts the next version, because this one is released."""
    return sheet.state in FINISHED
