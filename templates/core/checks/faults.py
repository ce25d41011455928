"""Faults of template files."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FileFault:
    """One fault of a file: a code for programs; for people the line, what is wrong, and what would be right.

    A fault that does not quarantine is reported, and the version is used.
    """

    code: str
    what: str
    remedy: str
    line: int | None = None
    quarantines: bool = True

    @property
    def sentence(self) -> str:
        """Return the fault in one line, such as `line 12: …; correct this line`."""
        where = f"line {self.line}: " if self.line else ""
        return f"{where}{self.what}; {self.remedy}"
