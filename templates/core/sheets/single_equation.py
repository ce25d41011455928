"""`solve x from a to b so that … == …`: find the root between two bounds, at all points at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, reduce
from operator import attrgetter
from types import SimpleNamespace
from typing import Any

import lark
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import elementwise

from templates.core.language.body import Body
from templates.core.language.ledger import Mask
from templates.core.paper.expressions import latex
from templates.core.sheets.body import names_in, operations_seconds, unequal_lengths
from templates.core.sheets.expressions import Reader
from templates.core.sheets.grammar import ParsedStatement
from templates.core.units.closures import closure
from templates.core.units.evaluation import nodes_of
from templates.core.units.operations import Apply

NEAR = (
    1e-6  # largest difference of the sides at a root, relative to that at the bounds; it is larger at a pole
)
STEPS, PER_STEP = (
    40,
    2e-4,
)  # number of steps, and time per step in addition to the operations of the equation [s]
SEVERAL = "the equation holds at both bounds, so it does not say which value is meant"


class SolveBody(Body):
    """An equation in place of a formula's function: called with a template, it returns the unknown.

    Source: Chandrupatla, Advances in Engineering Software 28(3), 1997, by SciPy's `find_root`.
    """

    has_numbers = False

    def __init__(
        self,
        name: str,
        equation: Apply,
        bounds: tuple[Any, ...],
        line: int,
        words: str,
        lists: frozenset[str],
    ) -> None:
        self.node, self.first = equation, tuple[str, ...]()
        self.name, self.line, self.equation, self.bounds, self._lists = name, line, equation, bounds, lists
        self.reason = f"there is no {words} {self._between()} for which the equation holds"
        self._sides = [closure(side) for side in equation.arguments]
        self._bounds = [closure(bound) for bound in bounds]
        inside = dict.fromkeys(names_in(equation))
        self._others = tuple(other for other in inside if other != name)
        self.uses = tuple(dict.fromkeys([*self._others, *(n for bound in bounds for n in names_in(bound))]))
        self.__doc__ = None
        self.__qualname__ = f"line {line}"

    def __call__(self, template: Any) -> Any:
        """Return the root [SI]; NaN if there is none, with the reason in the ledger."""
        for name in self.first:
            getattr(template, name)
        values = {name: attrgetter(name)(template) for name in self._others}
        low, high = (np.asarray(bound(template), dtype=float) for bound in self._bounds)
        singles = [value for name, value in values.items() if _is_number(value) and name not in self._lists]
        firsts = [np.asarray(values[name])[..., 0] for name in self._lists & values.keys()]
        shape = np.broadcast_shapes(low.shape, high.shape, *(np.shape(v) for v in (*singles, *firsts)))
        try:
            roots, several = self._roots(values, np.broadcast_to(low, shape), np.broadcast_to(high, shape))
        except ValueError:
            raise unequal_lengths(self, template) from None
        missing = np.isnan(roots)
        if missing.any() and (ledger := getattr(template, "ledger", None)):
            reasons = ((missing & ~several, self.reason), (several, SEVERAL))
            masks = (Mask((self.name,), where, why, explains=True) for where, why in reasons if where.any())
            ledger.masks.extend(masks)
        return roots[()]

    def seconds(self, points: int) -> float:
        """Return the order of magnitude of the time of the search at a number of points [s]."""
        return STEPS * (PER_STEP + operations_seconds(self._operations, points))

    @cached_property
    def _operations(self) -> int:
        return sum(1 for _ in nodes_of(self.equation))

    def _roots(
        self, values: Mapping[str, Any], low: NDArray[Any], high: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the roots, NaN without one, and a mask of the points where both bounds are roots."""
        flat = {name: self._flat(name, value, low.shape) for name, value in values.items()}
        places = np.arange(low.size)
        ends = np.minimum(low, high).ravel(), np.maximum(low, high).ravel()

        def residual(unknown: NDArray[Any], at: NDArray[Any]) -> NDArray[Any]:
            here = SimpleNamespace(**{self.name: unknown}, **{n: pick(at) for n, pick in flat.items()})
            left, right = (side(here) for side in self._sides)
            return np.broadcast_to(np.subtract(left, right), unknown.shape).copy()

        with np.errstate(all="ignore"):
            search = elementwise.find_root(residual, ends, args=(places,))
            scale = reduce(np.maximum, (np.abs(residual(end, places)) for end in ends))
            near = np.abs(residual(search.x, places)) <= NEAR * scale
        several = (scale == 0) & (ends[0] < ends[1])
        roots = np.where(search.success & near & ~several, search.x, np.nan)
        return roots.reshape(low.shape), several.reshape(low.shape)

    def _flat(self, name: str, value: Any, shape: tuple[int, ...]) -> Callable[[NDArray[Any]], Any]:
        """Return a value at the selected points as a one-dimensional array."""
        if not isinstance(value, np.ndarray):
            return lambda at: value
        if name in self._lists:
            rows = np.broadcast_to(value, (*shape, value.shape[-1])).reshape(-1, value.shape[-1])
            return lambda at: rows[at]
        row = np.broadcast_to(value, shape).ravel()
        return lambda at: row[at]

    def _between(self) -> str:
        low, high = (getattr(bound, "text", "") for bound in self.bounds)
        return f"between {low} and {high}" if low and high else "between its bounds"

    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """Return the equation in LaTeX, with the given symbols or numbers in place of attributes."""
        return rf"\text{{root of }}\ {latex(self.equation, symbols, times)}"


def _is_number(value: Any) -> bool:
    return not isinstance(value, str)


def equation_of(statement: ParsedStatement, reader: Reader, tree: lark.Tree[Any], name: str) -> Apply:
    """Return the equation after `so that`; refuse it unless it has exactly two sides.

    Raises
    ------
    Refusal
        The code is `equation`.
    """
    node, sort = reader.part(statement, tree)
    if not (isinstance(node, Apply) and node.operation.sign == "=="):
        raise statement.refuse("equation", "this is not an equation", tree, "write it like `F / A == 10 MPa`")
    if sort.axis:
        message = f"the equation contains a list over {sort.axis}"
        raise statement.refuse("axis_mismatch", message, tree, "take `max(…)` or `sum(…)` of it")
    if name not in names_in(node):
        raise statement.refuse("equation", f"{name} does not occur in the equation", tree)
    return node
