"""Worksheets: the text of an engineer is checked and becomes a template class like one from a file.

`read` returns a `Sheet`, or raises `SheetRefused` with all faults. `Sheet.template` creates the class, and
`run_tests` runs the tests in the worksheet. `docs/reference/worksheets.md` describes the language.
"""

from templates.core.sheets.design_names import DesignName
from templates.core.sheets.faults import SheetFault, SheetRefused
from templates.core.sheets.names import KnownName
from templates.core.sheets.sheet import Sheet, Statement, read
from templates.core.sheets.worksheet_tests import SheetTest, TestResult, run_tests

__all__ = [
    "DesignName", "KnownName", "Sheet", "SheetFault", "SheetRefused", "SheetTest", "Statement", "TestResult",
    "read", "run_tests",
]  # fmt: skip
