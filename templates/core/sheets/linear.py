"""Several unknowns in as many linear equations: `solve x [N] "…", y [N] "…" so that … == … and … == …`.

The coefficients are derived symbolically from the equations when the worksheet is read, without numerical
differentiation; a nonlinear equation is refused before any calculation.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import lark
import numpy as np
from numpy.typing import NDArray

from templates.core.language.body import Body
from templates.core.language.ledger import Mask
from templates.core.paper.expressions import latex
from templates.core.sheets.body import names_in, unequal_lengths
from templates.core.sheets.expressions import Reader
from templates.core.sheets.grammar import ParsedStatement
from templates.core.units.closures import closure
from templates.core.units.operations import OPERATORS, Apply, Constant, Kind, Name

MOST_UNKNOWNS = 10
WORST_CONDITION = 1e12
"""Largest condition number, with equilibrated rows and columns; above it fewer than four digits are
significant.
"""

_ADD, _SUBTRACT, _MULTIPLY = (OPERATORS[name] for name in ("add", "subtract", "multiply"))
_DIVIDE, _NEGATIVE = OPERATORS["divide"], OPERATORS["negative"]
_ONE = Constant(1.0, Kind(), "1")

Terms = dict[str, Any]
"""The tree of the coefficient of each unknown, and under the empty name the constant term."""


class NotLinear(Exception):
    """An equation is not linear in one of its unknowns."""


class System:
    """Linear equations of some unknowns: computes matrices and right sides from the values of a template."""

    def __init__(self, unknowns: Sequence[str], tree: Any, rows: Sequence[Terms]) -> None:
        self.unknowns, self.tree = tuple(unknowns), tree
        self.uses = tuple(name for name in dict.fromkeys(names_in(tree)) if name not in unknowns)
        self._matrix = [closure(row[name]) if name in row else _zero for row in rows for name in unknowns]
        self._right = [closure(row[""]) if "" in row else _zero for row in rows]

    def numbers(self, template: Any) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the matrices and right sides [SI] for the values of a template.

        Raises
        ------
        ValueError
            If one expression combines lists of different lengths.
        """
        parts = [*(part(template) for part in self._matrix), *(-part(template) for part in self._right)]
        values = np.stack(np.broadcast_arrays(*parts), axis=-1).astype(float)
        count = len(self.unknowns)
        matrices, sides = values[..., : count * count], values[..., count * count :]
        return matrices.reshape(*values.shape[:-1], count, count), sides


def _zero(template: Any) -> float:
    """Return 0, the coefficient of an unknown that does not occur in an equation."""
    return 0.0


class LinearBody(Body):
    """One unknown of a linear system, in place of a formula's function; a call with a template returns it.

    Source: LU factorisation with partial pivoting, by LAPACK's `gesv` in NumPy.
    """

    has_numbers = False

    def __init__(self, name: str, system: System, line: int) -> None:
        self.node, self.uses, self.first = system.tree, system.uses, tuple[str, ...]()
        self.name, self.line, self._system = name, line, system
        self._place = system.unknowns.index(name)
        self.reason = f"the equations do not determine {', '.join(system.unknowns)}"
        self.__doc__ = None
        self.__qualname__ = f"line {line}"

    def __call__(self, template: Any) -> Any:
        """Return the unknown [SI]; NaN if the equations do not determine it, with the reason in the ledger.

        Raises
        ------
        InvalidInputs
            If one expression combines lists of different lengths.
        """
        for name in self.first:
            getattr(template, name)
        with np.errstate(all="ignore"):
            try:
                matrices, right = self._system.numbers(template)
            except ValueError:
                raise unequal_lengths(self, template) from None
            solutions, singular = solved(matrices, right)
        if singular.any() and (ledger := getattr(template, "ledger", None)):
            ledger.masks.append(Mask((self.name,), singular, self.reason, explains=True))
        return solutions[..., self._place][()]

    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """Return the equations in LaTeX, with the given symbols or numbers in place of attributes."""
        return rf"\text{{solution of }}\ {latex(self.node, symbols, times)}"


def solved(matrices: NDArray[Any], right: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """Return the solutions of linear systems, and a mask of the singular ones.

    Parameters
    ----------
    matrices
        Of shape (*points, n, n), in any units.
    right
        Right sides, of shape (*points, n).

    Returns
    -------
    tuple
        Solutions (*points, n), NaN where a matrix is singular or a number is missing; mask (*points).
    """
    rows = _sizes(matrices, -1)
    columns = _sizes(matrices / rows, -2)
    scaled, sides = matrices / rows / columns, right / rows[..., 0]
    finite = np.isfinite(scaled).all(axis=(-2, -1)) & np.isfinite(sides).all(axis=-1)
    usable = np.where(finite[..., None, None], scaled, np.eye(matrices.shape[-1]))
    singular = finite & ~(np.linalg.cond(usable) < WORST_CONDITION)
    usable = np.where(singular[..., None, None], np.eye(matrices.shape[-1]), usable)
    solution = np.linalg.solve(usable, sides[..., None])[..., 0] / columns[..., 0, :]
    return np.where((finite & ~singular)[..., None], solution, np.nan), singular


def _sizes(matrices: NDArray[Any], axis: int) -> NDArray[Any]:
    """Return the size of each row or column as a power of 2, so that division by it is exact."""
    most = np.abs(matrices).max(axis=axis, keepdims=True)
    return np.ldexp(1.0, np.frexp(most)[1] - 1)


def system_of(
    statement: ParsedStatement, reader: Reader, tree: lark.Tree[Any], unknowns: Sequence[str]
) -> System:
    """Return the equations after `so that`, joined by `and`.

    Raises
    ------
    Refusal
        The code is `equation` or `axis_mismatch`.
    """
    node, sort = reader.part(statement, tree)
    if sort.axis:
        message = f"the equations contain a list over {sort.axis}"
        raise statement.refuse("axis_mismatch", message, tree, "take `max(…)` or `sum(…)` of it")
    equations = list(_joined(node))
    remedy = "write as many equations as unknowns, for example `x + y == 3 N and x - y == 1 N`"
    if not all(isinstance(one, Apply) and one.operation.sign == "==" for one in equations):
        raise statement.refuse("equation", "only equations can be joined by `and` here", tree, remedy)
    if len(equations) != len(unknowns):
        message = f"{len(unknowns)} unknowns need {len(unknowns)} equations, not {len(equations)}"
        raise statement.refuse("equation", message, tree, remedy)
    try:
        rows = [
            _combined(_SUBTRACT, *(_terms(side, unknowns) for side in one.arguments)) for one in equations
        ]
    except NotLinear:
        message = f"the equations are not linear in {', '.join(unknowns)}"
        remedy = (
            "only add unknowns, or multiply or divide them by known values; or solve for one between bounds"
        )
        raise statement.refuse("equation", message, tree, remedy) from None
    for name in unknowns:
        if not any(name in row for row in rows):
            message = f"{name} does not occur in the equations"
            raise statement.refuse("equation", message, tree, "remove it, or write an equation with it")
    return System(unknowns, node, rows)


def _joined(node: Any) -> Iterator[Any]:
    """Yield the conditions joined by `and`."""
    left = [node]
    while left:
        first = left.pop()
        if isinstance(first, Apply) and first.operation.sign == "and":
            left += reversed(first.arguments)
        else:
            yield first


def _terms(node: Any, unknowns: Sequence[str]) -> Terms:
    """Return the coefficients of the unknowns in a tree that is linear in them.

    Raises
    ------
    NotLinear
        If the tree is not linear.
    """
    if isinstance(node, Name) and node.name in unknowns:
        return {node.name: _ONE}
    parts = [_terms(part, unknowns) for part in getattr(node, "arguments", ())]
    if all(part.keys() == {""} for part in parts):
        return {"": node}
    operation = node.operation
    if operation in (_ADD, _SUBTRACT):
        return _combined(operation, *parts)
    if operation is _NEGATIVE:
        return {name: Apply(_NEGATIVE, (term,)) for name, term in parts[0].items()}
    if operation is _MULTIPLY and parts[0].keys() == {""}:
        parts.reverse()
    if operation in (_MULTIPLY, _DIVIDE) and parts[1].keys() == {""}:
        return {name: Apply(operation, (term, parts[1][""])) for name, term in parts[0].items()}
    raise NotLinear


def _combined(operation: Any, left: Terms, right: Terms) -> Terms:
    """Return the terms of a sum or a difference."""
    terms = dict(left)
    for name, term in right.items():
        if name in left:
            terms[name] = Apply(operation, (left[name], term))
        else:
            terms[name] = term if operation is _ADD else Apply(_NEGATIVE, (term,))
    return terms
