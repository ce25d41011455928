"""The free places of a request: which values each may take, and the values that the engine receives."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from app.answers.bodies import FreeIn
from app.answers.fits import Fit, clearance_fits, zone_ends
from app.designs.network import Graph
from app.plain import Raw
from app.reference import Reference
from app.studies.methods.space import Interval, Values, Variable
from app.studies.question import single
from cad.deep_groove import SIZES
from templates.core.arrays import Array
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_names
from templates.core.language.intake import option_named
from templates.core.language.spec import Choice
from templates.core.units.fits import deviations
from templates.core.units.quantity import read
from templates.core.units.units import unit

ISO_286, ISO_15 = "ISO 286", "ISO 15"
STANDARDS = (ISO_286, ISO_15)
MOST_STEPS = 10_000
DIGITS = 12


@dataclass(frozen=True)
class FreePlace:
    """A free place, its variable in the search, and its unit.

    Attributes
    ----------
    options, fits
        What a whole number of the variable stands for; empty if the variable is the value itself [SI].
    size
        The nominal size [m] of a fit, or the name of the place that has it.
    zone
        The ISO 286 zone of the value.
    """

    name: str
    variable: Variable
    unit: str
    options: tuple[str, ...] = ()
    fits: tuple[Fit, ...] = ()
    size: float | Reference = 0.0
    zone: str | None = None
    grid: Mapping[float, str] = field(default_factory=dict)

    @property
    def reference(self) -> Reference:
        """Return the place in the design."""
        return Reference.parse(self.name)

    @property
    def has_ends(self) -> bool:
        """Return whether the value has a least and a greatest one."""
        return bool(self.fits) or self.zone is not None

    def ends(self, column: Array, sizes: Array) -> Array:
        """Return the values that the engine receives [SI]: shape (N, 1), or (N, 2) with two ends."""
        if self.fits:
            both = np.empty((len(column), 2))
            for number in np.unique(column).tolist():
                rows = column == number
                both[rows] = self.fits[int(number)].ends(sizes[rows])
            return both
        return column[:, None] if self.zone is None else zone_ends(self.zone, column)

    def typed(self, value: float, size: float) -> Raw:
        """Return a chosen value as the design stores it."""
        if self.options:
            return self.options[int(value)]
        scale = unit(self.unit)
        if self.fits:
            least, greatest = (end / scale.factor for end in self.fits[int(value)].clearance(size))
            half = _short((greatest - least) / 2)
            return {"value": _short((greatest + least) / 2), "unit": self.unit, "plus": half, "minus": half}
        text = self.grid.get(value) or f"{float(scale.from_si(value)):.{DIGITS}g} {self.unit}".removesuffix(
            " 1"
        )
        return text if self.zone is None else f"{text} {self.zone}"


def _short(number: float) -> float:
    return float(f"{number:.{DIGITS}g}")


@dataclass(frozen=True)
class PlaceReader:
    """Reads free places; `accepted` returns the unit in which a user may type a value of a place."""

    graph: Graph
    accepted: Callable[[Reference], str]
    sizes: Callable[[Reference], float]

    def read(self, free: Mapping[str, FreeIn]) -> list[FreePlace]:
        """Return the free places.

        Raises
        ------
        InvalidInputs
            If values are wrong; the error lists all faults.
        """
        places, faults = list[FreePlace](), list[Fault]()
        for name, body in free.items():
            try:
                places.append(self._place(name, body))
            except InvalidInputs as error:
                faults += [fault.within("free") for fault in error.faults]
            except FaultyText as error:
                faults.append(error.fault(f"free.{name}"))
        if faults:
            raise InvalidInputs(faults)
        return places

    def _place(self, name: str, body: FreeIn) -> FreePlace:
        if options := choice_of(self.graph, name):
            return FreePlace(name, *_options(name, body, options))
        shown = self.accepted(Reference.parse(name))
        if body.standard == ISO_286:
            return self._fitted(name, body, shown)
        variable, grid = _numbers(name, body, shown)
        if body.zone is not None:
            for end in bounds_of(variable):
                deviations(body.zone, end)
        return FreePlace(name, variable, shown, zone=body.zone, grid=grid)

    def _fitted(self, name: str, body: FreeIn, shown: str) -> FreePlace:
        size = self._size(name, body.size)
        nominal = self.sizes(size) if isinstance(size, Reference) else size
        fits = list(map(Fit.read, body.fits)) if body.fits else clearance_fits()
        each = sorted(((fit.clearance(nominal), fit) for fit in fits), key=lambda one: sum(one[0]))
        low, high = 0.0, math.inf
        if body.between is not None:
            low, high = (single(raw, shown, name) for raw in body.between)
            _check_order(name, low, high)
        chosen = tuple(fit for (least, most), fit in each if low <= least and most <= high and least > 0)
        if not chosen:
            detail = (
                f"none of {len(fits)} fits has its clearance between these bounds at {nominal * 1e3:g} mm"
            )
            raise InvalidInputs([Fault(name, "no_value", f"{detail}; widen `between`, or name other `fits`")])
        variable = Values(name, tuple(map(float, range(len(chosen)))))
        return FreePlace(name, variable, shown, fits=chosen, size=size)

    def _size(self, name: str, raw: Raw) -> float | Reference:
        if raw is None:
            detail = "a fit needs its nominal `size`, such as `48 mm` or `film.bearing_diameter`"
            raise InvalidInputs([Fault(f"{name}.size", "missing", detail)])
        if isinstance(raw, str) and raw[:1].isalpha():
            return Reference.parse(raw)
        return single(raw, "mm", f"{name}.size")


def choice_of(graph: Graph, name: str) -> tuple[str, ...]:
    """Return the options of a place that is a choice; empty for any other place."""
    reference = Reference.parse(name)
    block = graph.blocks.get(reference.block)
    declared = block.cls.inputs.get(reference.member) if block and reference.analysis is None else None
    return tuple(declared.options) if isinstance(declared, Choice) else ()


def form_faults(name: str, body: FreeIn, *, is_choice: bool) -> Iterator[Fault]:
    """Yield the faults in the form of a free place: no values, or two kinds of them."""
    if body.standard is not None and body.standard not in STANDARDS:
        detail = f"the standard {body.standard[:40]!r} is unknown; use `ISO 286` for fits or `ISO 15` for"
        yield Fault(f"{name}.standard", "unknown_standard", f"{detail} bearing designations, or give `step`")
        return
    given = [key for key in ("between", "values", "options", "standard") if getattr(body, key) is not None]
    kinds = {"between", "values", "options"}.intersection(given)
    if is_choice:
        if body.standard == ISO_286 or kinds - {"options"}:
            yield Fault(name, "not_a_number", f"{name} is a choice; give its `options`")
        elif not given:
            yield Fault(name, "missing", f"{name} is a choice; give the `options` to choose from")
    elif "options" in kinds or body.standard == ISO_15:
        yield Fault(name, "not_a_choice", f"{name} is a quantity; give `between`, two bounds, or `values`")
    elif not given:
        yield Fault(
            name, "missing", f"give {name} bounds: `between`, two values with their unit, or `values`"
        )
    elif len(kinds) > 1:
        yield Fault(name, "contradiction", f"give one of {', '.join(f'`{key}`' for key in sorted(kinds))}")
    elif body.step is not None and "between" not in kinds:
        yield Fault(f"{name}.step", "contradiction", "a step divides an interval; give `between` too")
    if body.standard != ISO_286 and (body.size is not None or body.fits is not None):
        yield Fault(name, "contradiction", "`size` and `fits` need `standard`: `ISO 286`")


def _options(name: str, body: FreeIn, declared: tuple[str, ...]) -> tuple[Variable, str, tuple[str, ...]]:
    if body.standard == ISO_15 and not {*declared} & SIZES.keys():
        detail = f"{name} is not the designation of a bearing; give its `options`"
        raise InvalidInputs([Fault(f"{name}.standard", "unknown_standard", detail)])
    if body.options is None:
        chosen = tuple(one for one in declared if one in SIZES)
    else:
        unknown = [one for one in body.options if option_named(declared, one) is None]
        if unknown:
            raise InvalidInputs(
                f.within(f"{name}.options") for f in unknown_names(unknown, declared, "option")
            )
        chosen = tuple(dict.fromkeys(option_named(declared, one) or one for one in body.options))
    return Values(name, tuple(map(float, range(len(chosen))))), "", chosen


def _numbers(name: str, body: FreeIn, shown: str) -> tuple[Variable, dict[float, str]]:
    """Return the variable of a quantity, and the texts of the values on its grid."""
    if body.values is not None:
        values = sorted({single(raw, shown, name) for raw in body.values})
        return _listed(name, values), {}
    assert body.between is not None
    low, high = (single(raw, shown, name) for raw in body.between)
    _check_order(name, low, high)
    if body.step is None:
        return Interval(name, low, high), {}
    grid = _multiples(name, body.step, shown, low, high)
    return _listed(name, list(grid)), grid


def _check_order(name: str, low: float, high: float) -> None:
    if low >= high:
        detail = "the first bound must be below the second; swap them"
        raise InvalidInputs([Fault(f"{name}.between", "not_ascending", detail)])


def _listed(name: str, values: list[float]) -> Variable:
    if len(values) == 1:
        return Values(name, tuple(values))
    return Interval(name, values[0], values[-1], grid=tuple(values))


def _multiples(name: str, raw: Raw, shown: str, low: float, high: float) -> dict[float, str]:
    """Return the multiples of a step between two bounds [SI], each with its text."""
    typed = read(raw, shown)
    scale, step = unit(typed.unit), Fraction(str(typed.value)) if np.ndim(typed.value) == 0 else Fraction(0)
    if step <= 0:
        raise InvalidInputs(
            [Fault(f"{name}.step", "out_of_range", "the step must be above 0, such as 0.5 mm")]
        )
    first = math.ceil(float(scale.from_si(low)) / float(step) - 1e-9)
    last = math.floor(float(scale.from_si(high)) / float(step) + 1e-9)
    if last < first:
        detail = f"no multiple of {raw} lies between the bounds; widen them, or give a smaller step"
        raise InvalidInputs([Fault(f"{name}.step", "no_value", detail)])
    if last - first >= MOST_STEPS:
        detail = f"the grid has {last - first + 1} values, more than {MOST_STEPS}; give a larger step"
        raise InvalidInputs([Fault(f"{name}.step", "too_many", detail)])
    magnitudes = [float(number * step) for number in range(first, last + 1)]
    suffix = "" if typed.unit == "1" else f" {typed.unit}"
    return {float(scale.to_si(one)): f"{one:.{DIGITS}g}{suffix}" for one in magnitudes}


def bounds_of(variable: Variable) -> tuple[float, float]:
    """Return the least and the greatest value of a variable."""
    if isinstance(variable, Interval):
        return variable.low, variable.high
    return min(variable.values), max(variable.values)
