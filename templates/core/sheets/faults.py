"""Faults of a worksheet: each with its place, a code, a sentence and a remedy."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from templates.core.errors import TemplateError


@dataclass(frozen=True, order=True)
class SheetFault:
    """One fault of a worksheet; lines and columns count from 1."""

    line: int
    column: int
    code: str
    message: str
    end_column: int | None = None
    remedy: str = ""

    @property
    def sentence(self) -> str:
        """Return the fault as one line of text: `line 9, column 5: …; write …`."""
        remedy = f"; {self.remedy}" if self.remedy else ""
        return f"line {self.line}, column {self.column}: {self.message}{remedy}"


class SheetRefused(TemplateError):
    """All faults of a worksheet, in the order of its lines."""

    def __init__(self, faults: Iterable[SheetFault]) -> None:
        self.faults = tuple(sorted(set(faults), key=lambda fault: (fault.line, fault.column, fault.message)))
        super().__init__("; ".join(fault.sentence for fault in self.faults))


class Refusal(TemplateError):
    """A single fault before it is added to the others; its place counts from the beginning of the sheet."""

    def __init__(self, fault: SheetFault) -> None:
        self.fault = fault
        super().__init__(fault.sentence)


class FollowsFromFault(TemplateError):
    """A statement uses a name whose own statement has a fault; only that fault is reported."""
