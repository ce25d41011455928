"""Declared criteria, such as `minimum_film_thickness >= smallest_permissible_film`, with words and sources.

A criterion compares two sides by one `>=` or `<=`. Each side is a relation (`templates.core.units.relation`),
and both sides measure the same kind of quantity. A criterion may declare *limits*: values that the user gives
and that the calculation itself does not use.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any, Literal

from templates.core.errors import FaultyText, excerpt, unknown_name
from templates.core.units.conditions import COMPARISONS
from templates.core.units.nodes import Kind, kind_of
from templates.core.units.relation import Relation, parse
from templates.core.units.rules import as_compared, in_words, shared
from templates.core.units.units import (
    Unit,
    compatible,
    difference_in,
    is_rate,
    registry,
    require_same_kind,
    unit,
)

Sign = Literal[">=", "<="]

LONGEST_REQUIRE = 2000  # characters
_SIGN = re.compile("(>=|<=)")
_KEYS = frozenset({"require", "words", "source", "limits", "unverified", "warning", "absent"})
_LIMIT_KEYS = frozenset({"unit", "words", "from", "default"})
_ABSENT_KEYS = frozenset({"with", "reason", "instead"})
_OBJECTS = frozenset({"limits", "absent"})
_DEFAULT = re.compile(r"(min|max)\(([a-z][a-z0-9_]*)\)")
_SIGNS = {">=": "≥", "<=": "≤"}
_RADIAN = registry.Unit("radian")


@dataclass(frozen=True, slots=True)
class NameDescription:
    """The declared unit and the label of a name in a criterion."""

    unit: str
    words: str
    kind: Kind | None = None  # given where the unit alone does not determine it

    @property
    def measured(self) -> Kind:
        """Return the kind of quantity of the value."""
        return self.kind or kind_of(self.unit)


@dataclass(frozen=True)
class Limit:
    """A limit that only the criterion uses, not the calculation.

    `library` names the library whose rows have a value for the limit. If nobody gives the limit, the
    `default` applies, if there is one: the `min` or `max` of an input that is a list.
    """

    name: str
    unit: str
    words: str
    library: str | None = None
    default: tuple[str, str] | None = None

    @cached_property
    def remedy(self) -> str:
        """Return a sentence that names the input to give."""
        unit = "" if self.unit == "1" else f" in {self.unit}"
        row = f", or a row of {self.library}" if self.library else ""
        other = f", or {self.default[1]}" if self.default else ""
        return f"give {self.name}{unit}{row}{other}"


@dataclass(frozen=True, slots=True)
class MissingValue:
    """Why a name has no value although another name, `beside`, has one.

    `instead` is an equivalent comparison of quantities that do have values in this case.
    """

    beside: str
    reason: str
    instead: Criterion | None = None


@dataclass(frozen=True)
class Criterion:
    """A criterion whose names exist and whose sides measure the same kind of quantity.

    Value and limit are shown in `unit`; `names` are in the order of the text.
    """

    name: str
    require: str
    sign: Sign
    value: Relation
    limit: Relation
    names: tuple[str, ...]
    unit: str
    words: str
    limits: tuple[Limit, ...] = ()
    source: str | None = None
    unverified: str | None = None
    warning: str | None = None
    absent: Mapping[str, MissingValue] = field(default_factory=dict)

    @cached_property
    def limits_by_name(self) -> dict[str, Limit]:
        """Return the limits that the criterion declares, by name."""
        return {limit.name: limit for limit in self.limits}

    @cached_property
    def limits_last(self) -> tuple[str, ...]:
        """Return the names in the order of the text, but with limits last."""
        return tuple(sorted(self.names, key=self.limits_by_name.__contains__))

    @cached_property
    def all_names(self) -> frozenset[str]:
        """Return the names that the criterion uses."""
        return frozenset(self.names)

    @cached_property
    def stated(self) -> Mapping[str, Any]:
        """Return, by name, the fields that all judgements of this criterion share."""
        return {
            "name": self.name,
            "words": self.words,
            "require": self.require,
            "unit": self.unit,
            "unverified": self.unverified,
            "warning": self.warning,
            "source": self.source,
        }

    @cached_property
    def scale(self) -> Unit:
        """Return the unit in which value and limit are shown."""
        return unit(self.unit)

    @cached_property
    def is_temperature(self) -> bool:
        """Return whether the criterion compares temperatures, whose ratios have no meaning."""
        return bool(self.scale.base == registry.kelvin) and not self.scale.difference

    @cached_property
    def subject(self) -> str | None:
        """Return the judged name if the value is a single name, else None."""
        return self.value.only_name


@cache
def is_angle(name: str) -> bool:
    """Return whether a unit measures an angle; the errors of angles are relative to 90°."""
    return bool(unit(name).base == _RADIAN)


def read_criterion(name: str, raw: Any, meanings: Mapping[str, NameDescription]) -> Criterion:
    """Return a criterion from its declaration: only the text of `require`, or an object that contains it.

    Parameters
    ----------
    name
        The name of the criterion.
    raw
        The text of the comparison, or a mapping with `require` and further keys.
    meanings
        Unit and label of each name that it may use; limits that it declares are added to these.

    Raises
    ------
    FaultyText
        If the declaration is wrong; the error states a code and a remedy.
    """
    parts = {"require": raw} if isinstance(raw, str) else raw
    _check_keys(parts, _KEYS, "require")
    limits = tuple(_limit(n, part, meanings) for n, part in _mapping(parts.get("limits", {})).items())
    names = {**meanings, **{limit.name: NameDescription(limit.unit, limit.words) for limit in limits}}
    value, sign, limit_side = read_comparison(parts["require"])
    used = _ordered(parts["require"], value.names | limit_side.names)
    for used_name in used:
        if used_name not in names:
            raise FaultyText("unknown_name", unknown_name(used_name, names, "name").detail)
    if unused := [limit.name for limit in limits if limit.name not in used]:
        raise FaultyText("unused_limit", f"the limit {unused[0]} does not occur in `require`")
    kinds = {n: names[n].measured for n in used}
    value, limit_side = _as_compared(sign, value, limit_side, kinds)
    kind = _shared_kind(sign, value, limit_side, kinds)
    limits = tuple(replace(limit, unit=_in_kind(limit.unit, kind)) for limit in limits)
    return Criterion(
        name=name,
        require=f"{value.text} {sign} {limit_side.text}",
        sign=sign,
        value=value,
        limit=limit_side,
        names=used,
        unit=_shown_unit(kind, [names[n] for n in used]),
        words=parts.get("words") or _in_words(value, sign, limit_side, names),
        limits=limits,
        source=parts.get("source"),
        unverified=parts.get("unverified"),
        warning=parts.get("warning"),
        absent={
            n: _missing(n, part, used, meanings) for n, part in _mapping(parts.get("absent", {})).items()
        },
    )


def read_comparison(text: str) -> tuple[Relation, Sign, Relation]:
    """Return the left side, the sign and the right side of a comparison.

    Raises
    ------
    FaultyText
        If there is not exactly one `>=` or `<=` (code `syntax`), if a side contains an item, a condition or a
        list (code `index`, `no_truth` or `shape`), or if `parse` refuses a side.
    """
    if not isinstance(text, str) or len(text) > LONGEST_REQUIRE:
        raise FaultyText("syntax", f"`require` must be a text of at most {LONGEST_REQUIRE} characters")
    sides = _SIGN.split(text)
    if len(sides) != 3 or "=" in sides[0] + sides[2]:
        form = "write it like `film.minimum_film_thickness >= 3 um`"
        raise FaultyText("syntax", f"a criterion needs exactly one >= or <=; {form}")
    sign: Sign = ">=" if sides[1] == ">=" else "<="
    value, limit = parse(sides[0].strip()), parse(sides[2].strip())
    if items := value.items + limit.items:
        item = items[0].text
        detail = (
            f"a criterion cannot use an item of a list; make {item} a parameter or an input, and compare that"
        )
        raise FaultyText("index", detail)
    for side in (value, limit):
        if side.rounding:
            remedy = f"make {excerpt(side.text)} a parameter of the design and compare that"
            raise FaultyText("syntax", f"a side of a criterion cannot be rounded; {remedy}")
        if side.has_conditions or side.has_lists:
            what, code = ("condition", "no_truth") if side.has_conditions else ("list", "shape")
            remedy = f"make {excerpt(side.text)} a parameter of the design and compare that"
            raise FaultyText(code, f"a side of a criterion cannot contain a {what}; {remedy}")
    return value, sign, limit


def _check_keys(raw: Any, keys: frozenset[str], needed: str) -> None:
    if not isinstance(raw, Mapping) or needed not in raw:
        form = f"an object with the key {needed!r}"
        wanted = f"a text or {form}" if needed == "require" else form
        raise FaultyText("syntax", f"give {wanted}, not {excerpt(raw)}")
    for key, value in raw.items():
        if key not in keys:
            raise FaultyText("unknown_name", unknown_name(str(key), sorted(keys), "key").detail)
        if key not in _OBJECTS and not (isinstance(value, str) and value.strip()):
            raise FaultyText("syntax", f"{key} must be a text that is not empty, not {excerpt(value)}")


def _mapping(raw: Any) -> Mapping[str, Any]:
    if not isinstance(raw, Mapping):
        raise FaultyText("syntax", f"limits and absent must be objects keyed by name, not {excerpt(raw)}")
    return raw


def _limit(name: str, raw: Any, meanings: Mapping[str, NameDescription]) -> Limit:
    if name in meanings:
        raise FaultyText("twice", f"{name} is already an input or output; give the limit another name")
    _check_keys(raw, _LIMIT_KEYS, "unit")
    unit(raw["unit"])
    default = _default(raw["default"], meanings, raw["unit"]) if "default" in raw else None
    return Limit(name, raw["unit"], raw.get("words") or name.replace("_", " "), raw.get("from"), default)


def _default(text: str, meanings: Mapping[str, NameDescription], wanted: str) -> tuple[str, str]:
    """Return the function and the name of a default such as `min(speed_range)`."""
    match = _DEFAULT.fullmatch(text)
    if match is None or match[2] not in meanings:
        raise FaultyText(
            "syntax", f"a default must be min(NAME) or max(NAME) of an input, not {excerpt(text)}"
        )
    require_same_kind(meanings[match[2]].unit, wanted)
    return match[1], match[2]


def _missing(
    name: str, raw: Any, used: tuple[str, ...], meanings: Mapping[str, NameDescription]
) -> MissingValue:
    _check_keys(raw, _ABSENT_KEYS, "reason")
    beside = raw.get("with", "")
    for candidate, candidates in ((name, used), (beside, meanings)):
        if candidate not in candidates:
            raise FaultyText("unknown_name", unknown_name(candidate, candidates, "name").detail)
    instead = read_criterion(name, raw["instead"], meanings) if "instead" in raw else None
    return MissingValue(beside, raw["reason"], instead)


def _ordered(text: str, names: frozenset[str]) -> tuple[str, ...]:
    """Return the names in the order in which they occur in the text."""
    return tuple(sorted(names, key=text.find))


def _as_compared(
    sign: Sign, value: Relation, limit: Relation, kinds: Mapping[str, Kind]
) -> tuple[Relation, Relation]:
    """Return both sides; a number in degC is read as a difference if the other side is one.

    Raises
    ------
    FaultyText
        If the other side is a value in K that may be either; the code is `unit_mismatch`.
    """
    one, other = value.kind(kinds), limit.kind(kinds)
    meant = as_compared(sign, other, value.tree, limit.tree), as_compared(sign, one, limit.tree, value.tree)
    return parse(meant[0]) if meant[0] else value, parse(meant[1]) if meant[1] else limit


def _shared_kind(sign: Sign, value: Relation, limit: Relation, kinds: Mapping[str, Kind]) -> Kind:
    """Return the common kind of both sides."""
    one, other = value.kind(kinds), limit.kind(kinds)
    if not compatible(one, other) and not (is_rate(one.base) and is_rate(other.base)):
        raise FaultyText(
            "unit_mismatch",
            f"{value.text} gives {in_words(one)}, but {limit.text} gives {in_words(other)}",
        )
    nodes = value.tree, limit.tree
    COMPARISONS[sign].kind(COMPARISONS[sign], [one, other], nodes)
    return shared(sign, one, other, nodes)


def _in_kind(name: str, kind: Kind) -> str:
    """Return the unit of a limit; beside a temperature difference, K becomes a unit of difference."""
    return difference_in(name) if kind.is_difference and not unit(name).difference else name


def _shown_unit(kind: Kind, declared: list[NameDescription]) -> str:
    """Return the unit of the first name that has the kind of the sides, otherwise the SI base unit."""
    fitting = (one.unit for one in declared if _is_alike(one.measured, kind))
    return next(fitting, None) or kind.unit


def _is_alike(one: Kind, kind: Kind) -> bool:
    return compatible(one, kind) and (not kind.is_difference or one.is_difference)


def _in_words(value: Relation, sign: Sign, limit: Relation, names: Mapping[str, NameDescription]) -> str:
    return f"{_side(value, names)} {_SIGNS[sign]} {_side(limit, names)}"


def _side(relation: Relation, names: Mapping[str, NameDescription]) -> str:
    name = relation.only_name
    return names[name].words if name else relation.text
