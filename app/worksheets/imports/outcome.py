"""The outcome of each region of a sheet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from app.worksheets.imports.quantities import Result
from app.worksheets.imports.regions import Original

State = Literal["verified", "differs", "unverified", "shown", "refused", "blocked"]

UNRESOLVED: frozenset[State] = frozenset({"differs", "refused", "blocked"})
"""States that prevent a release while their imported lines are unchanged in the text."""


@dataclass
class Outcome:
    """The outcome of a region: its state, the lines that replace it, and both values if they exist.

    `name` is the name of the value that is compared with `cached`. `first` is the line that declares this
    name if another region declares it.
    """

    original: Original
    state: State = "unverified"
    lines: list[str] = field(default_factory=list)
    name: str = ""
    cached: Result | None = None
    ours: tuple[float, ...] = ()
    construct: str = ""
    remedy: str = ""
    blocked_by: str = ""
    notes: list[str] = field(default_factory=list)

    def refuse(self, construct: str, remedy: str) -> None:
        """Record that the region has a construct that worksheets lack."""
        self.state, self.construct, self.remedy = "refused", construct, remedy
        self.name, self.blocked_by = "", ""
        self.lines = [f"// refused: {one_line(construct)} (region {self.original.number})"]

    def block(self, name: str, by: str) -> None:
        """Record that the region needs a name whose own region was not translated."""
        self.state, self.construct, self.blocked_by = "blocked", f"needs {one_line(name)}", by
        self.remedy, self.name = f"first write the content of region {by} says first", ""
        self.lines = [f"// blocked: needs {one_line(name)} of region {by} (region {self.original.number})"]

    def show(self, what: str) -> None:
        """Record that the region calculates nothing."""
        self.state, self.construct = "shown", what


def one_line(text: str) -> str:
    """Return the text as a remark needs it: one line without control characters."""
    plain = "".join(sign if sign.isprintable() else " " for sign in text)
    return " ".join(plain.split())[:200]
