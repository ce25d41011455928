"""The kind of an operation's result, from the kinds of its operands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product as pairs_of
from typing import Any

from templates.core.errors import FaultyText, listed
from templates.core.units.nodes import DIFFERENCE, EITHER, Apply, Constant, Kind, Operation, Temperatures
from templates.core.units.units import (
    base_text,
    compatible,
    difference_of,
    is_rate,
    named_unit,
    radians,
    registry,
    unit,
    unit_symbol,
)

RADIAN = registry.Unit("radian")
MAX_EXPONENT, MAX_UNIT_POWER = 12, 1000
_MOST_COUNTS = 64  # most possible counts of temperatures that a value may contain


def same(operation: Operation, kinds: list[Kind], nodes: tuple[Any, ...]) -> Kind:
    """Return the kind shared by all operands."""
    kind = kinds[0]
    for count, other in enumerate(kinds[1:], 1):
        before = nodes[0] if count == 1 else Apply(operation, tuple(nodes[:count]))
        kind = shared(operation.sign, kind, other, (before, nodes[count]))
    return kind


def shared(sign: str, one: Kind, other: Kind, nodes: tuple[Any, Any]) -> Kind:
    """Return the kind that two values share."""
    counted = _joined(sign, one, other, nodes)
    if one.temperatures is None or other.temperatures is None:
        return _kind(counted, None, is_literal=one.literal or other.literal)
    if not (both := one.temperatures & other.temperatures):
        what = "a temperature and a difference of temperatures"
        remedy = _remedy(one.temperatures, other.temperatures, nodes)
        raise FaultyText("unit_mismatch", f"{sign} needs values of the same kind, not {what}; {remedy}")
    return _kind(counted, both, is_literal=one.literal or other.literal)


def _remedy(one: frozenset[float], other: frozenset[float], nodes: tuple[Any, Any]) -> str:
    """Return advice on how a temperature and a difference can become values of one kind.

    A number in degC or degF that is added to either of them may be meant as a difference.
    """
    for (own, beside), node in zip(((one, other), (other, one)), nodes, strict=True):
        for texts, sign in _summands(node):
            if {count - sign for count in own} & beside:
                meant = "a difference" if len(texts) == 1 else "differences"
                return f"write {listed([as_difference(text) for text in texts])} for {meant}"
    return "subtract a temperature from the temperature, or add one to the difference"


def _summands(node: Any, sign: int = 1) -> Iterator[tuple[tuple[str, ...], int]]:
    """Yield numbers typed in degC or degF that a sum adds or subtracts.

    Those in a `min` or `max` form one group.
    """
    match node:
        case Constant() if text := literal(node):
            yield (text,), sign
        case Apply(Operation("min" | "max"), arguments) if all(map(literal, arguments)):
            yield tuple(map(literal, arguments)), sign
        case Apply(Operation("+" | "-" as operator), (*firsts, last)):
            for first in firsts:
                yield from _summands(first, sign)
            yield from _summands(last, -sign if operator == "-" else sign)


def _joined(sign: str, one: Kind, other: Kind, nodes: tuple[Any, ...]) -> Kind:
    """Return the common kind of two operands; 1/s becomes rad/s or Hz if the other operand has that unit."""
    detail = f"{sign} needs equal units, not {in_words(one)} and {in_words(other)}"
    if not compatible(one, other):
        is_of_rates = is_rate(one.base) and is_rate(other.base)
        remedy = (
            "; write 2*pi times what is in Hz, or what is in rad/s divided by (2*pi)" if is_of_rates else ""
        )
        raise FaultyText("unit_mismatch", detail + remedy)
    counts = [kind for kind in (one, other) if radians(kind.base) or kind.cycles]
    turned = one.turned | other.turned
    if is_rate(one.base) and turned and len(counts) == 1:
        remedy = next(filter(None, map(_counted, nodes)), "multiply 1/s by 1 turn or by 1 rad")
        raise FaultyText(
            "unit_mismatch", f"{detail}: {' and '.join(sorted(turned))} is a number of turns; {remedy}"
        )
    first = counts[0] if counts else one
    return Kind(first.base, first.cycles, turned=turned)


def _counted(node: Any) -> str:
    """Return a hint to write a number in 1/s in turn/s or rad/s; empty for any other operand."""
    per = node.text.partition(" 1/") if isinstance(node, Constant) else ("", "", "")
    return f"write {per[0]} turn/{per[2]} or {per[0]} rad/{per[2]}" if per[1] else ""


def _kind(
    of: Kind, temperatures: Temperatures, *, is_literal: bool = False, pi: int = 0, twos: Iterable[int] = ()
) -> Kind:
    """Return a kind; only a unit of temperature can count temperatures, only one with an angle turns."""
    is_kelvin = of.base == registry.kelvin
    few = temperatures is None or len(temperatures) <= _MOST_COUNTS
    return Kind(
        of.base,
        of.cycles,
        (temperatures if few else None) if is_kelvin else DIFFERENCE,
        literal=is_literal and bool(is_kelvin),
        turned=of.turned if radians(of.base) else frozenset(),
        pi=pi,
        twos=frozenset(twos),
    )


def relative(operation: Operation, kinds: list[Kind], nodes: tuple[Any, ...] = ()) -> None:
    """Raise an error for numbers typed in degC or degF, which may be meant as differences."""
    if any(kind.literal for kind in kinds):
        texts = [text for node in nodes if (text := literal(node))]
        what = texts[0] if texts else "a temperature in degC or degF"
        hint = f"; write {meanings_of(texts[0])}" if texts else "; write it in K, differences in delta_degC"
        message = f"{operation.sign} cannot take {what}, which may be a temperature or a difference"
        raise FaultyText("unit_mismatch", message + hint)


def literal(node: Any) -> str:
    """Return the text of a number typed in degC or degF; empty for any other node."""
    return node.text if isinstance(node, Constant) and node.kind.literal else ""


def meanings_of(text: str) -> str:
    """Return the two possible meanings of a number typed in degC or degF."""
    number, _, name = text.partition(" ")
    return (
        f"{unit(name).to_si(float(number)):.9g} K for a temperature, {as_difference(text)} for a difference"
    )


def as_difference(text: str) -> str:
    """Return a number typed in degC or degF as a difference: `30 delta_degC`."""
    number, _, name = text.partition(" ")
    return f"{number} {difference_of(name)}"


def as_compared(sign: str, other: Kind, node: Any, beside: Any) -> str:
    """Return a number typed in degC or degF as a comparison reads it; empty if it is read as typed.

    If the other side is a temperature difference, the number is read as a difference too.

    Raises
    ------
    FaultyText
        If the other side is a value in K that may be either; the code is `unit_mismatch`.
    """
    if not (text := literal(node)):
        return ""
    if other.base == registry.kelvin and other.temperatures == EITHER and not isinstance(beside, Constant):
        detail = f"{sign} compares {text} with a value in K that may be a temperature or a difference"
        raise FaultyText("unit_mismatch", f"{detail}; write {meanings_of(text)}")
    return as_difference(text) if other.is_difference else ""


def summed(operation: Operation, kinds: list[Kind], nodes: tuple[Any, ...]) -> Kind:
    """Return the kind of a sum, a difference or a negated value."""
    if len(kinds) == 1:
        (kind,) = kinds
        counts = None if kind.temperatures is None else frozenset(-n for n in kind.temperatures)
        return _kind(kind, counts, is_literal=kind.literal, pi=kind.pi, twos=kind.twos)
    one, other = kinds
    counted = _joined(operation.sign, one, other, nodes)
    if one.temperatures is None or other.temperatures is None:
        return _kind(counted, None, is_literal=one.literal or other.literal)
    sign = 1 if operation.sign == "+" else -1
    counts = frozenset(n + sign * m for n, m in pairs_of(one.temperatures, other.temperatures))
    has_literal = one.literal or other.literal
    if has_literal and not counts & {0.0, 1.0}:
        text = next((literal(node) for node in reversed(nodes) if literal(node)), "")
        detail = f"{operation.sign} {text or 'a temperature in degC or degF'} gives no temperature"
        remedy = f"write {as_difference(text)}" if text else "write differences in delta_degC"
        raise FaultyText("unit_mismatch", f"{detail}; {remedy} for a difference")
    return _kind(counted, counts, is_literal=has_literal and 0.0 not in counts)


def product(operation: Operation, kinds: list[Kind], nodes: tuple[Any, ...]) -> Kind:
    """Return the kind of a product or quotient; a literal factor 2*pi converts cycles to angles, or back."""
    relative(operation, kinds, nodes)
    one, other = kinds
    sign = -1 if operation.sign == "/" else 1
    base = one.base / other.base if sign < 0 else one.base * other.base
    cycles, pi = one.cycles + sign * other.cycles, one.pi + sign * other.pi
    twos = one.twos | {sign * place for place in other.twos}
    if cycles > 0 and pi > 0 and 1 in twos:
        base = base if radians(base) else base * RADIAN
        cycles, pi, twos = cycles - 1, pi - 1, twos - {1}
    elif pi < 0 and -1 in twos and (radians(base) > 0 or (is_rate(base) and radians(base))):
        base, pi, twos = base / RADIAN ** (1 if radians(base) > 0 else radians(base)), pi + 1, twos - {-1}
    whole = Kind(registry.Unit(base), cycles, turned=one.turned | other.turned)
    return _kind(whole, _scaled(operation.sign, nodes, one, other), pi=pi, twos=twos)


def _scaled(sign: str, nodes: tuple[Any, ...], one: Kind, other: Kind) -> Temperatures:
    """Return the number of temperatures in a product or quotient; only pure numbers may be factors."""
    factor, divided = plain_number(nodes[1]), plain_number(nodes[0])
    if factor is not None and one.base == registry.kelvin:
        if one.temperatures is None or (sign == "/" and not factor):
            return None
        return frozenset(n * factor if sign == "*" else n / factor for n in one.temperatures)
    if sign == "*" and divided is not None and other.base == registry.kelvin:
        return None if other.temperatures is None else frozenset(n * divided for n in other.temperatures)
    operands = [kind.temperatures for kind in (one, other) if kind.base == registry.kelvin]
    if not operands:
        return EITHER  # heat / heat capacity is a difference; pressure / density gives a temperature
    return DIFFERENCE if all(counts and 0.0 in counts for counts in operands) else None


def power(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return the kind of a power; a quantity with a unit needs a constant exponent."""
    relative(operation, kinds, arguments)
    base, exponent = kinds
    if not is_number(exponent):
        raise FaultyText("unit_mismatch", f"an exponent must be a pure number, not {in_words(exponent)}")
    if is_number(base):
        return Kind()
    plain = plain_number(arguments[1])
    if plain is None:
        raise FaultyText(
            "unit_mismatch", "the exponent of a quantity with a unit must be a plain number, such as `d**2`"
        )
    if not abs(plain) <= MAX_EXPONENT:
        raise FaultyText(
            "unit_mismatch", f"an exponent of a quantity with a unit must be at most {MAX_EXPONENT}"
        )
    degrees: list[Any] = list(registry.get_dimensionality(base.base).values())
    if any(abs(degree * plain) > MAX_UNIT_POWER for degree in degrees):
        raise FaultyText("unit_mismatch", f"the power of a unit must not exceed {MAX_UNIT_POWER}")
    return _raised(base, plain)


def _raised(kind: Kind, exponent: float) -> Kind:
    base = registry.Unit(kind.base**exponent)
    if is_rate(base) and (angles := radians(base)) % 1:  # sqrt(k/J) with k in N*m/rad is in rad/s
        base = registry.Unit(base / RADIAN**angles * RADIAN)
    return _kind(Kind(base, kind.cycles * exponent, turned=kind.turned), None)


def plain_number(node: Any) -> float | None:
    """Return the value of a pure number, or of a quotient of two, such as 1/3; None for everything else."""
    match node:
        case Constant(value=value, kind=kind) if is_number(kind):
            return value
        case Apply(Operation("/"), (Constant() as over, Constant() as under)):
            one, other = plain_number(over), plain_number(under)
            return one / other if one is not None and other else None
    return None


def root(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return the kind of a square root."""
    relative(operation, kinds, arguments)
    return _raised(kinds[0], 0.5)


def keep(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return the kind of the first operand."""
    return kinds[0]


def pure(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return the kind of a function that takes a pure number or an angle."""
    if not is_number(kinds[0]):
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} takes an angle or a pure number, not {in_words(kinds[0])}"
        )
    return Kind(RADIAN) if operation.sign in ("asin", "acos", "atan") else Kind()


def angle(operation: Operation, kinds: list[Kind], arguments: tuple[Any, ...]) -> Kind:
    """Return the kind of the angle given by two lengths, or by two values of the same kind."""
    same(operation, kinds, arguments)
    return Kind(RADIAN)


def whole(operation: Operation, kinds: list[Kind], _: tuple[Any, ...]) -> Kind:
    """Return the kind of a rounded pure number.

    A quantity with a unit is refused, because its rounded value would depend on the unit.
    """
    if kinds[0].base != Kind().base:
        hint = f"divide by a unit, for example `{operation.sign}(d / 1 mm)`"
        raise FaultyText(
            "unit_mismatch", f"{operation.sign} takes a pure number, not {in_words(kinds[0])}; {hint}"
        )
    return Kind()


def is_number(kind: Kind) -> bool:
    """Return whether a kind is a pure number, or an angle."""
    return bool(registry.get_dimensionality(kind.base) == registry.get_dimensionality(Kind().base))


def in_words(kind: Kind) -> str:
    """Return a kind as text, by a unit with its own name if there is one: `N` for `kg·m/s²`."""
    if is_rate(kind.base) and kind.cycles:
        return base_text(kind)
    name = named_unit(kind.base)
    return unit_symbol(name) if name else f"{kind.base:~P}" or "a pure number"
