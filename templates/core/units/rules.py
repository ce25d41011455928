"""The kind of an operation's result, from the kinds of its operands."""

from __future__ import annotations

from functools import cache, reduce
from typing import Any

from templates.core.errors import FaultyText
from templates.core.units.nodes import Apply, Constant, Kind, Operation
from templates.core.units.units import compatible, registry

RADIAN = registry.Unit("radian")
MAX_EXPONENT, MAX_UNIT_POWER = 12, 1000


def same(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return all in units of one kind."""
    for other in kinds[1:]:
        if not compatible(kinds[0].base, other.base):
            what = f"{in_words(kinds[0])} and {in_words(other)}"
            raise FaultyText("unit_mismatch", f"{operation.sign} needs equal units, not {what}")
    return Kind(kinds[0].base, any(kind.absolute for kind in kinds))


def relative(operation: Operation, kinds: list[Kind]) -> None:
    """Refuse temperatures in degC or degF, which have a zero of their own."""
    if any(kind.absolute for kind in kinds):
        hint = "write it in K, and differences in delta_degC"
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} cannot take a temperature in degC or degF; {hint}"
        )


def summed(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return a sum or a difference."""
    relative(operation, kinds)
    return same(operation, kinds, arguments)


def product(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return a product or a quotient."""
    relative(operation, kinds)
    return Kind(reduce(lambda a, b: a / b if operation.sign == "/" else a * b, (k.base for k in kinds)))


def power(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return a power; of a quantity with a unit its exponent is known beforehand."""
    relative(operation, kinds)
    base, exponent = kinds
    if not is_number(exponent):
        raise FaultyText("unit_mismatch", f"an exponent is a pure number, not {in_words(exponent)}")
    if is_number(base):
        return Kind()
    plain = plain_number(arguments[1])
    if plain is None:
        raise FaultyText(
            "unit_mismatch", "a quantity with a unit takes a plain number as exponent, as in d**2"
        )
    if not abs(plain) <= MAX_EXPONENT:
        raise FaultyText("unit_mismatch", f"an exponent of a quantity with a unit is at most {MAX_EXPONENT}")
    degrees: list[Any] = list(registry.get_dimensionality(base.base).values())
    if any(abs(degree * plain) > MAX_UNIT_POWER for degree in degrees):
        raise FaultyText("unit_mismatch", f"a unit to a power beyond {MAX_UNIT_POWER} has no meaning")
    return Kind(registry.Unit(base.base**plain))


def plain_number(node: Any) -> float | None:
    """Return the value of a pure number, or of one divided by another, such as 1/3.

    None of everything else.
    """
    match node:
        case Constant(value=value, kind=kind) if is_number(kind):
            return value
        case Apply(Operation("/"), (Constant() as over, Constant() as under)):
            one, other = plain_number(over), plain_number(under)
            return one / other if one is not None and other else None
    return None


def root(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return a square root."""
    relative(operation, kinds)
    return Kind(registry.Unit(kinds[0].base ** 0.5))


def keep(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return the kind of the first operand."""
    return kinds[0]


def pure(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return a function of a pure number or an angle."""
    if not is_number(kinds[0]):
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} takes an angle or a pure number, not {in_words(kinds[0])}"
        )
    return Kind(RADIAN) if operation.sign in ("asin", "acos", "atan") else Kind()


def angle(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return the angle of two lengths, or of two values of any one kind."""
    same(operation, kinds, arguments)
    return Kind(RADIAN)


def whole(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """A quantity has no whole part of its own: 3.7 mm are 0.0037 m."""
    if kinds[0] != Kind():
        hint = f"divide by a unit, as in {operation.sign}(d / 1 mm)"
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} takes a pure number, not {in_words(kinds[0])}; {hint}"
        )
    return Kind()


def is_number(kind: Kind) -> bool:
    """Return whether a kind is a pure number, or an angle."""
    return bool(registry.get_dimensionality(kind.base) == registry.get_dimensionality(Kind().base))


def in_words(kind: Kind) -> str:
    """Return a kind in words: by the unit that has a name, `N` for `kg·m/s²`."""
    named = (name for name, base in _named().items() if base == kind.base)
    return next(named, f"{kind.base:~P}") or "a pure number"


@cache
def _named() -> dict[str, Any]:
    """Return the derived units that engineers call by name, and what they are in SI base units."""
    names = ("N", "Pa", "N·m", "W", "Pa·s", "N/m", "N·m/rad", "W/(m·K)", "J/(kg·K)")
    return {name: registry.Unit(registry.get_base_units(name.replace("·", "*"))[1]) for name in names}
