"""Worksheets: an engineer's text is checked and becomes a template class like one from a file.

`read` gives a `Sheet`, or raises `SheetRefused` with all faults; `Sheet.template` makes the class, and
`run_tests` runs the tests that the worksheet holds. The language: `docs/reference/worksheets.md`.
"""

from templates.core.sheets.faults import SheetFault, SheetRefused
from templates.core.sheets.names import KnownName
from templates.core.sheets.sheet import Sheet, Statement, read
from templates.core.sheets.worksheet_tests import SheetTest, TestResult, run_tests

__all__ = [
    "KnownName", "Sheet", "SheetFault", "SheetRefused", "SheetTest", "Statement", "TestResult", "read",
    "run_tests",
]  # fmt: skip
