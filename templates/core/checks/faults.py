"""Faults of template files."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FileFault:
    """One fault of a file: a code for programs; the line, the fault and the remedy for people.

    A fault that does not quarantine the version is only reported.
    """

    code: str
    what: str
    remedy: str
    line: int | None = None
    quarantines: bool = True

    @property
    def sentence(self) -> str:
        """Return the fault as one line of text, such as `line 12: …; correct this line`."""
        where = f"line {self.line}: " if self.line else ""
        return f"{where}{self.what}; {self.remedy}"
