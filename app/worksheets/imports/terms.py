"""An expression of a worksheet under construction: its text, its precedence, and its shape."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.worksheets.imports.errors import Untranslatable

LOOSE, SUM, PRODUCT, SIGNED, POWER, ATOM = range(6)
"""Precedence of each expression; a condition or an `if` has the lowest."""

LONGEST = 1_800
"""Largest number of characters in an expression; a statement of a worksheet has at most 2,000."""


@dataclass(frozen=True)
class Axis:
    """The axis of a list, named after the range or the list that it belongs to.

    `start` is the index of the first item in Mathcad. `numbers` are the values of a range.
    """

    name: str
    length: int
    start: int
    numbers: tuple[float, ...] = ()


@dataclass(frozen=True)
class Term:
    """An expression of a worksheet.

    A list is either a vector of Mathcad, for which a product is a scalar product, or a list of values along a
    range, with which Mathcad calculates as with single numbers. `number` is the value if it is known without
    calculating the sheet.
    """

    text: str
    tight: int = ATOM
    axis: Axis | None = None
    is_vector: bool = False
    is_row: bool = False
    is_truth: bool = False
    number: float | None = None

    def __post_init__(self) -> None:
        if len(self.text) > LONGEST:
            remedy = "split it into several named formulas, in Mathcad or in the worksheet"
            raise Untranslatable("the formula has more than 1,800 characters", remedy)

    def bound(self, least: int) -> str:
        """Return the text, in parentheses if its operator binds less tightly than required."""
        return self.text if self.tight >= least else f"({self.text})"

    def shaped(self, *others: Term) -> Term:
        """Return the same term with the shape that follows from its parts."""
        lists = [(part, part.axis) for part in others if part.axis is not None]
        if not lists:
            return self
        if len({axis.length for _, axis in lists}) > 1:
            remedy = "give both as many items, or write the formula for each item"
            raise Untranslatable("the formula combines lists of different lengths", remedy)
        axis = next((axis for part, axis in lists if not part.is_vector), lists[0][1])
        is_vector, is_row = (all(getattr(p, name) for p, _ in lists) for name in ("is_vector", "is_row"))
        return replace(self, axis=axis, is_vector=is_vector, is_row=is_row)


def binary(left: Term, sign: str, right: Term, tight: int) -> Term:
    """Return two terms joined by an operator; a sum or product on the left needs no parentheses."""
    text = f"{left.bound(tight)} {sign} {right.bound(tight + 1)}"
    return Term(text, tight, number=_folded(left.number, sign, right.number)).shaped(left, right)


def power(base: Term, exponent: Term) -> Term:
    """Return a power; an exponent that is a signed number needs no parentheses."""
    text = f"{base.bound(ATOM)}**{exponent.bound(ATOM)}"
    return Term(text, POWER, number=_folded(base.number, "**", exponent.number)).shaped(base, exponent)


def negative(part: Term) -> Term:
    """Return the negative of a term."""
    number = None if part.number is None else -part.number
    return Term(f"-{part.bound(POWER)}", SIGNED, number=number).shaped(part)


def called(name: str, *parts: Term) -> Term:
    """Return a function call; for lists, it is applied item by item."""
    return Term(f"{name}({', '.join(part.text for part in parts)})").shaped(*parts)


def reduced(name: str, part: Term) -> Term:
    """Return a call of a function that reduces a list to a single value."""
    return Term(f"{name}({part.text})")


def number(value: float) -> Term:
    """Return a plain number as a term."""
    text = repr(float(value)).removesuffix(".0")
    return Term(text, SIGNED if value < 0 else ATOM, number=float(value))


def listed(items: tuple[Term, ...], axis: Axis) -> Term:
    """Return a list of single values as a vector."""
    return Term(f"[{', '.join(item.text for item in items)}]", ATOM, axis, is_vector=True)


def _folded(left: float | None, sign: str, right: float | None) -> float | None:
    if left is None or right is None:
        return None
    try:
        match sign:
            case "+":
                value = left + right
            case "-":
                value = left - right
            case "*":
                value = left * right
            case "/":
                value = left / right
            case _:
                value = float(left) ** float(right) if abs(right) < 100 else float("nan")
    except (ArithmeticError, TypeError, ValueError):
        return None
    return value if isinstance(value, float) and abs(value) < 1e15 else None
