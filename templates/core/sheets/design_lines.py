"""The worksheet of a design: its formulas use values of the design by name, and it may draw plots.

The values of the design are its inputs, so `given`, `choice`, `require` and `test` are refused there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import lark

from templates.core.sheets.clauses import words_of
from templates.core.sheets.expressions import Reader
from templates.core.sheets.grammar import ParsedStatement

_PARAMETER = "make it a parameter of the design, and use its name here"
_INSTEAD = {
    "given": ("an input", _PARAMETER),
    "choice": ("a choice", _PARAMETER),
    "require": ("a rule", "write it as a check, such as `check p <= 30 MPa`"),
    "test": ("a test", 'write the expected value as a check, such as `check h >= 3 um "by hand"`'),
}

NOT_IN_DESIGNS = tuple(_INSTEAD)
"""Kinds of statements that the worksheet of a design refuses."""
ONLY_IN_DESIGNS = ("plot",)
"""Kinds of statements that every other worksheet refuses."""


@dataclass(frozen=True)
class Plot:
    """A plot of one value over another, given by the attributes of both."""

    line: int
    y: str
    x: str
    words: str


def require_line(statement: ParsedStatement) -> None:
    """Refuse a statement that the worksheet of a design cannot have.

    Raises
    ------
    Refusal
        The code is `not_here`.
    """
    if statement.kind in _INSTEAD:
        what, remedy = _INSTEAD[statement.kind]
        raise statement.refuse("not_here", f"the worksheet of a design cannot declare {what}", None, remedy)


def plot_of(statement: ParsedStatement, reader: Reader) -> Plot:
    """Return the plot that a statement declares.

    Raises
    ------
    Refusal
        The code is `not_here`, `no_truth` or `axis_mismatch`, or that of a faulty name.
    """
    if reader.names.design is None:
        message, remedy = "only the worksheet of a design draws plots", "take this line away"
        raise statement.refuse("not_here", message, None, remedy)
    upright, across, words = statement.parts
    (y, over_y), (x, over_x) = (_drawn(statement, reader, at) for at in (upright, across))
    if over_y != over_x:
        message = f"{upright} is {_shape(over_y)}, but {across} is {_shape(over_x)}"
        remedy = "plot two single values, or two lists over the same name"
        raise statement.refuse("axis_mismatch", message, across, remedy)
    title = words_of(statement, words) if words else ""
    return Plot(statement.chunk.line, y, x, title)


def _drawn(statement: ParsedStatement, reader: Reader, at: lark.Token) -> tuple[str, str]:
    """Return the attribute of a plotted name, and the axis of its list."""
    node, sort = reader.part(statement, _name_tree(at))
    if sort.truth or sort.words:
        raise statement.refuse("no_truth", f"{at} is not a quantity", at, "plot a quantity")
    return node.name, sort.axis


def _name_tree(token: lark.Token) -> lark.Tree[Any]:
    """Return a name as the expression that consists of it alone, at its place."""
    meta = lark.tree.Meta()  # type: ignore[no-untyped-call]
    for part in ("line", "column", "end_line", "end_column", "start_pos", "end_pos"):
        setattr(meta, part, getattr(token, part))
    meta.empty = False
    return lark.Tree("name", [token], meta)


def _shape(axis: str) -> str:
    return f"a list over {axis}" if axis else "a single value"
