"""The meaning of a number: words, unit, symbol, bounds and source, each declared once."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypedDict

import numpy as np

from templates.core.units.nodes import Kind, kind_of
from templates.core.units.units import Unit, unit

_RELATIONS = (("gt", ">"), ("ge", "≥"), ("lt", "<"), ("le", "≤"))


@dataclass(frozen=True)
class Bounds:
    """Bounds of a value in its declared unit; None leaves a side open."""

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None

    def in_si(self, scale: Unit) -> Bounds:
        """Return these bounds converted to SI."""
        limits = (getattr(self, side) for side, _ in _RELATIONS)
        return Bounds(*(None if limit is None else float(scale.to_si(limit)) for limit in limits))

    def admits(self, value: Any) -> Any:
        """Return the mask of the values (scalar or array) within the bounds; NaN is outside."""
        inside = value == value
        if self.gt is not None:
            inside = inside & (value > self.gt)
        if self.ge is not None:
            inside = inside & (value >= self.ge)
        if self.lt is not None:
            inside = inside & (value < self.lt)
        if self.le is not None:
            inside = inside & (value <= self.le)
        return inside

    def interval(self) -> tuple[float, float]:
        """Return the smallest and largest finite number within the bounds."""
        low, high = -sys.float_info.max, sys.float_info.max
        low = low if self.gt is None else max(low, math.nextafter(self.gt, math.inf))
        low = low if self.ge is None else max(low, self.ge)
        high = high if self.lt is None else min(high, math.nextafter(self.lt, -math.inf))
        high = high if self.le is None else min(high, self.le)
        return low, high

    def text(self, name: str) -> str:
        """Return the bounds in words: `> 0 mm and ≤ 5 mm`."""
        scale = "" if name == "1" else f" {name}"
        limits = ((sign, getattr(self, side)) for side, sign in _RELATIONS)
        return " and ".join(f"{sign} {limit:.6g}{scale}" for sign, limit in limits if limit is not None)

    @property
    def open(self) -> bool:
        """Return whether there is no bound."""
        return all(getattr(self, side) is None for side, _ in _RELATIONS)


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """The meaning of a number: its words, unit, symbol, bounds and source.

    `domain` is the range in which the number has a meaning, `published` the range that its source states;
    `remedy` tells the user what to do outside. `also` are alternative names. `assumes` are attributes of the
    template whose published range also limits this formula, although it does not use them. `absent` is the
    reason why a result may be NaN without being a fault. `assumed` is the unsafe assumption behind an input's
    default, if there is one. `per_level` narrows domain and published range at single levels of fidelity.
    `read_as` is degC for a temperature declared in K, which could otherwise also be a difference.
    """

    words: str
    unit: str
    name: str
    symbol: str | None = None
    source: str | None = None
    domain: Bounds = Bounds()
    published: Bounds = Bounds()
    remedy: str | None = None
    also: tuple[str, ...] = ()
    integer: bool = False
    assumes: tuple[str, ...] = ()
    absent: str | None = None
    assumed: str | None = None
    per_level: Mapping[str, tuple[Bounds, Bounds]] = field(default_factory=dict, hash=False)
    read_as: str | None = None

    def at(self, level: str) -> Meaning:
        """Return the meaning of the number at one level of fidelity, which may have its own bounds."""
        return self._at_levels.get(level, self) if self.per_level else self

    @cached_property
    def _at_levels(self) -> dict[str, Meaning]:
        narrowed = self.per_level.items()
        return {level: replace(self, domain=d, published=p, per_level={}) for level, (d, p) in narrowed}

    @property
    def wanted(self) -> str:
        """Return the required value in words, such as `a whole number ≥ 3 and ≤ 200` or `> 0 mm`."""
        limits = self.domain.text(self.unit)
        return " ".join(filter(None, ("a whole number" if self.integer else "", limits))) or "finite"

    def with_unit(self, si: float) -> str:
        """Return an SI value as text in the declared unit, for a message."""
        return f"{self.scale.from_si(float(si)):.6g}{'' if self.unit == '1' else ' ' + self.unit}"

    def admits(self, value: Any) -> Any:
        """Return the mask of SI values that are finite, in the domain, and integers if required."""
        if isinstance(value, float):
            low, high = self.interval
            return low <= value <= high and not (self.integer and value != round(value))
        inside = np.isfinite(value)
        if self.domain_si is not None:
            inside = inside & self.domain_si.admits(value)
        return inside & (np.round(value) == value) if self.integer else inside

    @cached_property
    def scale(self) -> Unit:
        """Return the declared unit with its conversion to SI."""
        return unit(self.unit)

    @cached_property
    def accepted(self) -> str:
        """Return the unit that determines which units may be typed; degC for a temperature in K."""
        return self.read_as or self.unit

    @cached_property
    def kind(self) -> Kind:
        """Return the kind of quantity that the value has in relations."""
        return kind_of(self.accepted, self.name)

    @cached_property
    def domain_si(self) -> Bounds | None:
        """Return the domain in SI, or None if every finite value is allowed."""
        return None if self.domain.open else self.domain.in_si(self.scale)

    @cached_property
    def interval(self) -> tuple[float, float]:
        """Return the smallest and largest finite number [SI] within the domain."""
        return (self.domain_si or Bounds()).interval()

    @cached_property
    def published_si(self) -> Bounds | None:
        """Return the published range in SI, or None if the source states none."""
        return None if self.published.open else self.published.in_si(self.scale)


def api_name(words: str) -> str:
    """Return the words as an API name: `minimum film thickness` → `minimum_film_thickness`."""
    return re.sub(r"[^a-z0-9]+", "_", words.lower()).strip("_")


_API_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def _named(words: str, name: str | None) -> str:
    """Return the explicit name, or the words converted to a name.

    Raises
    ------
    TypeError
        If the result is not a name in snake_case.
    """
    name = name or api_name(words)
    if not _API_NAME.fullmatch(name):
        raise TypeError(f"{words!r} gives the API name {name!r}; give it a name= in snake_case")
    return name


class Keywords(TypedDict, total=False):
    """The keywords that every declaration accepts, those of `meaning`, for editors and type checkers."""

    name: str | None
    """API name, if the words would give another."""
    symbol: str | None
    """Printed symbol in LaTeX, if the attribute would give another."""
    source: str | None
    """Source of the formula or value."""
    gt: float | None
    ge: float | None
    lt: float | None
    le: float | None
    """The domain, in the declared unit; a value outside is refused."""
    published: tuple[float | None, float | None]
    """The range that the source states; outside it an answer carries a warning."""
    remedy: str | None
    """What to do outside the domain."""
    also: tuple[str, ...]
    """Other words under which the quantity is known."""
    integer: bool
    """Whether the value is a whole number."""
    assumes: tuple[str, ...]
    """Attributes whose published range also limits this formula, although it does not use them."""
    absent: str | None
    """Why a result may be missing without being a fault."""
    assumed: str | None
    """The unsafe assumption behind an input's default, if there is one."""
    per_level: Mapping[str, tuple[Bounds, Bounds]] | None
    """Domain and published range at single levels of fidelity."""


def meaning(
    unit: str,
    words: str,
    *,
    name: str | None = None,
    symbol: str | None = None,
    source: str | None = None,
    gt: float | None = None,
    ge: float | None = None,
    lt: float | None = None,
    le: float | None = None,
    published: tuple[float | None, float | None] = (None, None),
    remedy: str | None = None,
    also: tuple[str, ...] = (),
    integer: bool = False,
    assumes: tuple[str, ...] = (),
    absent: str | None = None,
    assumed: str | None = None,
    per_level: Mapping[str, tuple[Bounds, Bounds]] | None = None,
) -> Meaning:
    """Return a `Meaning` from the keywords of every declaration; bounds are in the declared unit."""
    return Meaning(
        words=words,
        unit=unit,
        name=_named(words, name),
        symbol=symbol,
        source=source,
        domain=Bounds(gt, ge, lt, le),
        published=Bounds(ge=published[0], le=published[1]),
        remedy=remedy,
        also=tuple(api_name(other) for other in also),
        integer=integer,
        assumes=assumes,
        absent=absent,
        assumed=assumed,
        per_level=per_level or {},
    )
