"""Record the comparisons of a rule while the rule is evaluated.

A rule reads the values of a template. Here it reads `Operand`s: values that also record how they were
calculated. Comparing two operands gives an `Outcome`: a truth value that also holds both sides. A report can
then state how close each compared value is to its limit, without parsing the source of the rule.

Rules combine truth values by `&`, `|` and `~`. If a rule uses Python's `and`, `or` or `if`, only the returned
comparison is recorded.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import NDArray

from templates.core.arrays import Truth
from templates.core.language.calculation import Calculation
from templates.core.language.spec import Requirement

Sign = Literal["<", "<=", ">", ">="]
Mask = NDArray[np.bool_]

_SIGNS: dict[Any, Sign] = {np.less: "<", np.less_equal: "<=", np.greater: ">", np.greater_equal: ">="}
OPPOSITE: dict[Sign, Sign] = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
_OPERATORS: dict[Any, type[ast.operator]] = {
    np.add: ast.Add, np.subtract: ast.Sub, np.multiply: ast.Mult, np.true_divide: ast.Div, np.power: ast.Pow,
}  # fmt: skip
_WRITTEN = {  # functions that a formula on paper may have
    "absolute": "abs",
    **{name: name for name in ("sqrt", "log", "log10", "exp", "sin", "cos", "tan", "minimum", "maximum")},
}


class _RecordingValue(NDArrayOperatorsMixin):
    """A NumPy value that records operations: its operators become ufuncs, which call `__array_ufunc__`."""

    value: Any

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **keywords: Any) -> Any:
        result = getattr(ufunc, method)(*map(plain, inputs), **keywords)
        if method != "__call__" or keywords or ufunc.nout > 1:
            return result
        return _recorded(ufunc, inputs, result)

    def __array_function__(
        self, function: Callable[..., Any], types: Any, arguments: Sequence[Any], keywords: Mapping[str, Any]
    ) -> Any:
        """Call another NumPy function with the plain values; return a numeric result as an operand."""
        result = function(*map(plain, arguments), **{name: plain(v) for name, v in keywords.items()})
        is_number = isinstance(result, (np.floating, np.ndarray)) and np.issubdtype(result.dtype, np.floating)
        return Operand(result, _call(function.__name__, arguments)) if is_number else result

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.asarray(self.value, dtype=dtype)

    def __bool__(self) -> bool:
        return bool(self.value)

    def __getattr__(self, name: str) -> Any:
        """Return any other attribute of the plain NumPy value, such as `shape` or `max`."""
        if name.startswith("__") or name == "value":
            raise AttributeError(name)
        return getattr(self.value, name)


class Operand(_RecordingValue):
    """A value and the syntax tree of its calculation, or None if it cannot be written as a formula."""

    def __init__(self, value: Any, node: ast.expr | None = None) -> None:
        self.value, self.node = value, node

    def __float__(self) -> float:
        return float(self.value)

    def __int__(self) -> int:
        return int(self.value)

    def __len__(self) -> int:
        return len(self.value)

    def __getitem__(self, key: Any) -> Operand:
        return Operand(self.value[plain(key)])

    @property
    def attribute(self) -> str | None:
        """Return the attribute of the template whose value this is; empty for a calculated value."""
        match self.node:
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                return name
        return None

    @property
    def constant(self) -> float | None:
        """Return the number, if it does not depend on the template; otherwise None."""
        return self.node.value if isinstance(self.node, ast.Constant) else None  # type: ignore[return-value]


@dataclass(frozen=True)
class Comparison:
    """Two sides, the sign between them, whether the comparison holds, and where the rule depends on it."""

    left: Operand
    sign: Sign
    right: Operand
    holds: Truth
    where: Truth = True

    @property
    def actual(self) -> Sign:
        """Return the sign that holds between the values: the opposite of the written one if that is false."""
        return self.sign if np.all(plain(self.holds) | ~np.asarray(self.where)) else OPPOSITE[self.sign]

    @property
    def ordered(self) -> tuple[Operand, Operand]:
        """Return first the side that must be smaller, then the side that must be larger."""
        return (self.left, self.right) if self.sign in ("<", "<=") else (self.right, self.left)

    @property
    def share(self) -> float | None:
        """Return the ratio of the side that must be smaller to the other side, at the worst point.

        The result is None if a side is the constant 0 or is negative at one of the points.
        """
        small, large = self.ordered
        if small.constant == 0 or large.constant == 0:
            return None
        return worst_share(small.value, large.value, self.where)


def worst_share(small: Any, large: Any, where: Truth = True) -> float | None:
    """Return the largest ratio of the side that must be smaller to the other, over the points in `where`.

    The result is None if no point has both values, if a value is negative, or if the larger side is 0.
    """
    low, high, counts = np.broadcast_arrays(
        np.asarray(small, dtype=float), np.asarray(large, dtype=float), np.asarray(where)
    )
    counts = counts.astype(bool) & np.isfinite(low) & np.isfinite(high)
    low, high = low[counts], high[counts]
    return None if not counts.any() or (high <= 0).any() or (low < 0).any() else float(np.max(low / high))


@dataclass(frozen=True, eq=False)
class Outcome(_RecordingValue):
    """A truth value and its origin: one comparison, all or any of several outcomes, or unknown causes.

    An equality has no limit to be close to, so it is not a comparison; `equated` are its two sides.
    """

    value: Any
    comparison: Comparison | None = None
    parts: tuple[Outcome, ...] = ()
    needs_all: bool = True
    equated: tuple[Operand, ...] = ()

    def decisive(self, where: Truth = True) -> Iterator[Comparison]:
        """Yield the comparisons that decide the truth value, each with the points where it does so.

        Where none of several alternatives is true, the last one counts.
        """
        if self.comparison is not None:
            if np.any(where):
                yield replace(self.comparison, where=where)
        elif self.needs_all:
            for part in self.parts:
                yield from part.decisive(where)
        else:
            *guards, last = sorted(self.parts, key=lambda part: part.has_comparisons)
            yield from last.decisive(_none_of(guards, where))

    @property
    def has_comparisons(self) -> bool:
        """Return whether the truth value depends on any comparison."""
        return self.comparison is not None or any(part.has_comparisons for part in self.parts)

    def negated(self) -> Outcome:
        """Return the negated outcome: `<` becomes `>=`, "all" becomes "any"."""
        value, one = np.logical_not(self.value), self.comparison
        opposite = one and replace(one, sign=OPPOSITE[one.sign], holds=value)
        parts = tuple(part.negated() for part in self.parts)
        return Outcome(value, opposite, parts, not self.needs_all, self.equated)


def _none_of(guards: Sequence[Outcome], where: Truth) -> Mask:
    free = np.asarray(where, dtype=bool)
    for guard in guards:
        free = free & ~np.asarray(guard.value, dtype=bool)
    return free


def outcome(template: Calculation, rule: Requirement) -> Outcome:
    """Return the outcome of a rule with its comparisons.

    If the rule cannot be evaluated with operands, only its truth value is known.
    """
    truth = rule.function(template)
    try:
        recorded = rule.function(_RecordedTemplate(template))
    except (TypeError, ValueError, AttributeError, LookupError):  # the rule needs real arrays or numbers
        return Outcome(truth)
    agrees = isinstance(recorded, Outcome) and np.array_equal(recorded.value, truth)
    return recorded if agrees else Outcome(truth)


class _RecordedTemplate:
    """A template whose values are operands, used to evaluate one rule."""

    def __init__(self, template: Calculation) -> None:
        self._template = template

    def __getattr__(self, name: str) -> Any:
        return _read(name, getattr(self._template, name))

    def as_given(self, attribute: str) -> Any:
        """Return the given value of an input as an operand that does not include the input's formula."""
        return _read(attribute, self._template.as_given(attribute))


def _read(attribute: str, value: Any) -> Any:
    """Return a value of the template, as an operand if it is a number or an array."""
    if not isinstance(value, (int, float, np.ndarray)) or isinstance(value, bool):
        return value
    return Operand(value, ast.Attribute(ast.Name("self"), attribute))


def plain(value: Any) -> Any:
    """Return a value without its recorded comparison."""
    if isinstance(value, _RecordingValue):
        return value.value
    return type(value)(map(plain, value)) if type(value) in (list, tuple) else value


def _recorded(ufunc: np.ufunc, inputs: Sequence[Any], result: Any) -> Any:
    """Return the result of a ufunc as an operand or outcome that knows its origin."""
    if ufunc in _SIGNS:
        left, right = map(_operand, inputs)
        return Outcome(result, Comparison(left, _SIGNS[ufunc], right, result))
    if ufunc in (np.bitwise_and, np.logical_and, np.bitwise_or, np.logical_or):
        needs_all = ufunc in (np.bitwise_and, np.logical_and)
        return Outcome(result, parts=tuple(map(_outcome, inputs)), needs_all=needs_all)
    if ufunc in (np.invert, np.logical_not):
        return _outcome(inputs[0]).negated()
    if ufunc in (np.equal, np.not_equal):
        return Outcome(result, equated=tuple(map(_operand, inputs)))
    return result if np.asarray(result).dtype == bool else Operand(result, _calculated(ufunc, inputs))


def _calculated(ufunc: np.ufunc, inputs: Sequence[Any]) -> ast.expr | None:
    """Return the syntax tree of a ufunc's result."""
    nodes = _nodes(inputs)
    if nodes is None:
        return None
    if ufunc in _OPERATORS:
        return ast.BinOp(nodes[0], _OPERATORS[ufunc](), nodes[1])
    if ufunc is np.negative:
        return ast.UnaryOp(ast.USub(), nodes[0])
    return _call(ufunc.__name__, inputs)


def _call(name: str, arguments: Sequence[Any]) -> ast.expr | None:
    nodes = _nodes(arguments) if name in _WRITTEN else None
    return None if nodes is None else ast.Call(ast.Name(_WRITTEN[name]), nodes, [])


def _nodes(values: Sequence[Any]) -> list[ast.expr] | None:
    """Return the syntax trees of values, or None if one of them cannot be written."""
    nodes = [_operand(value).node for value in values]
    return None if any(node is None for node in nodes) else nodes  # type: ignore[return-value]


def _operand(value: Any) -> Operand:
    if isinstance(value, Operand):
        return value
    return Operand(value, _written(value))


def _written(value: Any) -> ast.expr | None:
    """Return a literal number in a rule as a syntax tree; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    if value == math.pi:
        return ast.Name("pi")
    return ast.Constant(value if isinstance(value, int) else float(value))


def _outcome(value: Any) -> Outcome:
    return value if isinstance(value, Outcome) else Outcome(plain(value))
