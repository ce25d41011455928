"""Read typed inputs as the SI values of a template, and report all faults together."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import filterfalse
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, unknown_names
from templates.core.language.admission import outside_published
from templates.core.language.calculation import Calculation
from templates.core.language.causes import BROKEN, suspects
from templates.core.language.ledger import Mask, Notice
from templates.core.language.spec import Choice, Curve, Declaration, Derived, Given, Input, Requirement, Table
from templates.core.language.violations import relations, required, stated_case, violation
from templates.core.units.quantity import TypedQuantity, read, scaled
from templates.core.units.tolerance import LONGEST_TEXT, Tolerance
from templates.core.units.units import Value, unit


def read_inputs(
    cls: type[Calculation], raw: Mapping[str, Any]
) -> tuple[dict[str, TypedQuantity | str], list[Fault]]:
    """Return every given input, read in its unit, and the faults of the other inputs."""
    typed: dict[str, TypedQuantity | str] = {}
    raw, faults = _in_declared_sizes(cls, raw)
    faults += unknown_names(filterfalse(cls.inputs.__contains__, raw), cls.inputs, "input")
    for name, declared in cls.inputs.items():
        if name in raw:
            try:
                given = raw[name]
                typed[name] = given if isinstance(given, TypedQuantity) else _read_one(declared, given)
            except FaultyText as error:
                faults.append(error.fault(name))
        elif declared.required:
            faults.append(Fault(name, "missing", f"{declared.meaning.words} is needed{_example(declared)}"))
    return typed, faults


def _in_declared_sizes(
    cls: type[Calculation], raw: Mapping[str, Any]
) -> tuple[Mapping[str, Any], list[Fault]]:
    """Return inputs with radial sizes converted to diametral ones, or vice versa, and the faults.

    A radial clearance is half the diametral one. If both are given, they must agree.
    """
    faults: list[Fault] = []
    for other, name in other_sizes(cls):
        if other not in raw:
            continue
        raw = dict(raw)
        given, declared = raw.pop(other), cls.inputs[name]
        factor = factor_of(name)
        try:
            typed = scaled(read(given, declared.meaning.accepted), factor)
            same = read(raw[name], declared.meaning.accepted) if name in raw else typed
        except FaultyText as error:
            faults.append(error.fault(other))
            continue
        if np.shape(same.si) != np.shape(typed.si) or not np.allclose(same.si, typed.si, rtol=1e-9, atol=0):
            ratio = "twice" if factor == 2.0 else "half of"
            detail = f"{name} is {ratio} {other}, and these differ; give one of them"
            faults.append(Fault(other, "conflict", detail, (name,)))
        raw.setdefault(name, typed)
    return raw, faults


def other_sizes(cls: type[Calculation]) -> tuple[tuple[str, str], ...]:
    """Return pairs of the opposite name (radial or diametral) and the declared name of a clearance.

    A template that declares both names needs no such pair.
    """
    pairs = ((name, _DIAMETRAL.sub(_opposite, name)) for name in cls.inputs)
    return tuple((other, name) for name, other in pairs if other != name and other not in cls.inputs)


def factor_of(name: str) -> float:
    """Return the ratio of a size, radial or diametral, to its counterpart."""
    return 2.0 if name.startswith("diametral") else 0.5


WIDEST_ROW = 9
"""Values of a row that a refusal prints one by one."""
_DIAMETRAL = re.compile(r"\A(?:diametral|radial)(?=_clearance)")


def _opposite(match: re.Match[str]) -> str:
    return "radial" if match[0] == "diametral" else "diametral"


def _read_one(declared: Input, raw: Any) -> TypedQuantity | str:
    if isinstance(declared, Choice):
        option = (
            raw["value"] if isinstance(raw, dict) and raw.keys() == {"value"} else raw
        )  # as answers write it
        if isinstance(option, str) and (meant := option_named(declared.options, option)):
            return meant
        raise FaultyText("not_an_option", f"{excerpt(raw)} is not one of {', '.join(declared.options)}")
    return read(raw, declared.meaning.accepted)


def option_named(options: tuple[str, ...], text: str) -> str | None:
    """Return the option that a text names, also in its printed form: `ISO VG 46` is iso_vg_46."""
    if text in options:
        return text
    letters = _letters(text)
    named = [option for option in options if letters and _letters(option) in (letters, f"iso{letters}")]
    return named[0] if len(named) == 1 else None


def _letters(text: str) -> str:
    return "".join(sign for sign in text[:LONGEST_TEXT].lower() if sign.isalnum())


def _example(declared: Input) -> str:
    if isinstance(declared, Choice):
        return f"; one of {', '.join(declared.options)}"
    scale = declared.meaning.unit
    return "; give a number" if scale == "1" else f"; give it in {scale} or another unit of the same kind"


@dataclass(frozen=True)
class Intake:
    """SI values of inputs by attribute, with the faults, masked points and warnings of reading them."""

    values: dict[str, Any] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)
    masks: list[Mask] = field(default_factory=list)
    warnings: list[Notice] = field(default_factory=list)
    missing: set[str] = field(default_factory=set)


def admitted(cls: type[Calculation], typed: Mapping[str, TypedQuantity | str]) -> Intake:
    """Return the SI values of inputs that were given or have a constant default, and their faults."""
    intake = Intake()
    for name, declared in cls.inputs.items():
        source = typed.get(name) or (None if isinstance(declared, Derived) else declared.default)
        if isinstance(source, TypedQuantity):
            si, plain = source.si, declared.plain
            if plain and isinstance(si, float) and source.tolerance is None and plain[0] <= si <= plain[1]:
                value = np.float64(si)  # most inputs are one number within its bounds
            else:
                value, remark = _bounded(declared, source)
                intake.faults.extend([remark] if isinstance(remark, Fault) else [])
                intake.masks.extend([remark] if isinstance(remark, Mask) else [])
            intake.values[declared.attribute] = value
            if declared.meaning.published_si is not None and not isinstance(declared, Table):
                warning = outside_published(declared, value)
                intake.warnings.extend([warning] if warning else [])
        elif source is not None:
            intake.values[declared.attribute] = source
        else:
            _note_missing(declared, intake)
    return intake


class Plain(NamedTuple):
    """Inputs without any fault or remark: single values and options."""

    typed: dict[str, TypedQuantity | str]
    values: dict[str, Any]
    missing: set[str]


class PlainText(NamedTuple):
    """An input as typed, with its value [SI] or option."""

    typed: TypedQuantity | str
    value: Any


def plain(cls: type[Calculation], raw: Mapping[str, Any]) -> Plain | None:
    """Return the inputs of a simple request, read and checked at once; None if any needs the full check."""
    left_out = _defaults.get(cls) or _left_out(cls)
    if not left_out.needed <= raw.keys():
        return None
    inputs, typed = cls.inputs, dict[str, TypedQuantity | str]()
    values, missing = left_out.values.copy(), left_out.missing.copy()
    for name, given in raw.items():
        declared = inputs.get(name)
        if declared is None:
            return None
        if type(given) is str and len(given) <= LONGEST_TEXT and (text := plain_text(declared, given)):
            typed[name], values[declared.attribute] = text
        elif isinstance(given, TypedQuantity) and (value := _plain_value(declared, given)) is not None:
            typed[name], values[declared.attribute] = given, value
        else:
            return None
        if missing:
            missing.discard(declared.attribute)
    return Plain(typed, values, missing)


class LeftOut(NamedTuple):
    """Replacements for missing inputs, by attribute, and the names of the inputs that are required."""

    values: dict[str, Any]
    missing: set[str]
    needed: set[str]


_defaults: WeakKeyDictionary[type[Calculation], LeftOut] = WeakKeyDictionary()


def _left_out(cls: type[Calculation]) -> LeftOut:
    """Return the defaults of a version for inputs that are not given."""
    intake, needed = Intake(), set[str]()
    for name, declared in cls.inputs.items():
        default = None if isinstance(declared, Derived) else declared.default
        value = default if isinstance(default, str) else default and _plain_value(declared, default)
        if value is not None:
            intake.values[declared.attribute] = value
        elif default is None and not declared.required:
            _note_missing(declared, intake)
        else:
            needed.add(name)
    _defaults[cls] = left_out = LeftOut(intake.values, intake.missing, needed)
    return left_out


@lru_cache(maxsize=4096)  # a user who varies one input sends the others again
def plain_text(declared: Input, text: str) -> PlainText | None:
    """Return an input as typed and its value [SI]; None if it needs the full check.

    Results are cached, so call this only with short texts.
    """
    try:
        typed = _read_one(declared, text)
    except FaultyText:
        return None
    value = typed if isinstance(typed, str) else _plain_value(declared, typed)
    return None if value is None else PlainText(typed, value)


def _plain_value(declared: Input, typed: TypedQuantity) -> np.float64 | None:
    """Return a single number within its bounds and its published range, otherwise None."""
    si, bounds = typed.si, declared.plain
    if bounds and isinstance(si, float) and typed.tolerance is None and bounds[0] <= si <= bounds[1]:
        value = np.float64(si)
        is_published = declared.meaning.published_si is None or not outside_published(declared, value)
        return value if is_published else None
    return None


def _note_missing(declared: Input, intake: Intake) -> None:
    """Note an optional input that is not given."""
    if isinstance(declared, Given) and declared.optional:
        intake.missing.update(set() if declared.alternative else {declared.attribute})
        intake.values[declared.attribute] = () if isinstance(declared, Table) else np.float64(np.nan)


def _bounded(declared: Input, typed: TypedQuantity) -> tuple[Any, Fault | Mask | None]:
    """Return the value and its fault, if there is one.

    An invalid point of an array is not a fault; the point is masked.
    """
    if isinstance(declared, Table):
        return _rows(declared, typed.si)
    if isinstance(typed.si, np.ndarray) and is_single(declared):
        detail = f"{declared.meaning.words} is one value for all points: give a number, not an array"
        return np.float64(np.nan), Fault(declared.name, "not_single", detail)
    if isinstance(declared, Curve) and not (declared.constant and isinstance(typed.si, float)):
        return _along_a_cycle(declared, typed)
    if isinstance(typed.si, np.ndarray):
        return _masked_points(declared, typed.si, declared.meaning.admits(typed.si))
    inside = declared.meaning.admits(typed.si)
    if not inside:
        return np.float64(typed.si), _out_of_bounds(declared, typed, inside)
    tolerance = typed.tolerance
    return np.float64(typed.si), _end_outside(declared, typed.si, tolerance) if tolerance else None


def _end_outside(declared: Declaration, si: Value, tolerance: Tolerance) -> Fault | None:
    """Return a fault if the tolerance of a single value extends beyond the bounds of the input."""
    ends = (si + tolerance.lower, si + tolerance.upper)
    outside = next((end for end in ends if not declared.meaning.admits(end)), None)
    if outside is None:
        return None
    meaning = declared.meaning
    reach = f"by its tolerance {meaning.words} may be {meaning.with_unit(float(outside))}"
    detail = f"{reach}; it must be {meaning.wanted}: give a smaller tolerance"
    return Fault(declared.name, "out_of_range", detail)


def _along_a_cycle(declared: Curve, typed: TypedQuantity) -> tuple[Any, Fault | None]:
    """Check a curve as a whole: a single point outside the domain refuses the curve."""
    meaning, value = declared.meaning, typed.si
    if not isinstance(value, np.ndarray):
        detail = f"{meaning.words} is a curve: give an array over the {declared.along}, in {meaning.unit}"
        return value, Fault(declared.name, "not_a_curve", detail)
    inside = meaning.admits(value)
    return value, None if np.all(inside) else _out_of_bounds(declared, typed, inside)


def _rows(declared: Table, value: Any) -> tuple[tuple[tuple[float, ...], ...], Fault | None]:
    """Return the rows of a table, and the fault if they are invalid; a single row need not be in a list."""
    rows = np.atleast_2d(value)
    fits = rows.ndim == 2 and rows.shape[1] == len(declared.columns) and len(rows) <= declared.most
    if not fits or not np.all(declared.meaning.admits(rows)):
        rows_of = f"at most {declared.most} rows of {', '.join(declared.columns)}"
        detail = f"{declared.meaning.words} are {rows_of}, each {declared.meaning.wanted}"
        return (), Fault(declared.name, "not_a_table", detail)
    return tuple(map(tuple, rows.tolist())), None


def _out_of_bounds(declared: Declaration, typed: TypedQuantity, inside: Any) -> Fault:
    meaning = declared.meaning
    first = np.atleast_1d(typed.si)[~np.atleast_1d(inside)][0]
    scale = unit(typed.unit)
    shown = f"{scale.from_si(float(first)):.9g}{'' if typed.unit == '1' else ' ' + typed.unit}"
    where = f" at {int(np.sum(~inside))} of its points" if np.ndim(inside) else ""
    remedy = f"; {meaning.remedy}" if meaning.remedy else ""
    detail = f"{meaning.words} is {shown}{where}; it must be {meaning.wanted}{remedy}"
    return Fault(declared.name, "out_of_range", detail)


def _masked_points(
    declared: Declaration, value: Array, inside: NDArray[np.bool_]
) -> tuple[Array, Mask | None]:
    if inside.all():
        return value, None
    reason = f"{declared.name} must be {declared.meaning.wanted}"
    return np.where(inside, value, np.nan), Mask((declared.attribute,), ~inside, reason)


def as_typed(cls: type[Calculation], name: str, value: Any) -> Any:
    """Return an SI value in the form in which a user would type it, in the declared unit."""
    declared = cls.inputs.get(name)
    if declared is None or isinstance(declared, Choice):
        return value
    si = np.asarray(value, dtype=float) if np.ndim(value) else float(value)
    shown = declared.meaning.scale.from_si(si)
    return TypedQuantity(
        shown.tolist() if isinstance(shown, np.ndarray) else shown, declared.meaning.unit, si, {}
    )


def check_shapes(self: Calculation) -> None:
    """Raise an error if arrays of points do not broadcast together, or if curves have different lengths.

    Only a curve that may be constant accepts a list of one value in place of a number.

    Raises
    ------
    InvalidInputs
        If they do not; the error names the arrays and their shapes.
    """
    arrays = {n: v for n, v in vars(self).items() if isinstance(v, np.ndarray)}
    if not arrays:
        return
    curves = {n: d for n, d in self.declarations.items() if isinstance(d, Curve) and n in arrays}
    points = {n: v.shape[:-1] if n in curves else v.shape for n, v in arrays.items()}
    for along in dict.fromkeys(curve.along for curve in curves.values()):
        own = {n: arrays[n].shape[-1:] for n, curve in curves.items() if curve.along == along}
        whole = {n: length for n, length in own.items() if length != (1,) or not curves[n].constant}
        if len(set(whole.values())) > 1:
            alone = ", ".join(self.declarations[n].name for n in own if curves[n].constant)
            remedy = f"give equal lengths{f', or a single value for {alone}' if alone else ''}"
            raise InvalidInputs(_of_different_shapes(self, own, remedy))
    shapes = {n: shape for n, shape in points.items() if shape}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        remedy = "give equal lengths or a single value"
        raise InvalidInputs(_of_different_shapes(self, shapes, remedy)) from None


def _of_different_shapes(self: Calculation, shapes: Iterable[str], remedy: str) -> list[Fault]:
    """Return a fault for each array of a set that must have a common shape; each fault lists all shapes."""
    names = {self.declarations[n].name: np.shape(getattr(self, n)) for n in shapes}
    listed = ", ".join(f"{name} {'×'.join(map(str, shape))}" for name, shape in names.items())
    detail = f"arrays of different shapes do not fit together ({listed}); {remedy}"
    return [Fault(name, "shape", detail) for name in names]


def is_single(declared: Declaration) -> bool:
    """Return whether all points share one value of an input."""
    return isinstance(declared, Given) and declared.single


def is_curve(self: Calculation, attribute: str) -> bool:
    """Return whether an attribute is an input over the crank angle."""
    return isinstance(self.declarations[attribute], Curve)


def points_of(self: Calculation, arrays: Mapping[str, Array]) -> tuple[int, ...]:
    """Return the shape of the points in arrays of inputs, by attribute.

    The last axis of a curve does not count as points.
    """
    shapes = (array.shape[:-1] if is_curve(self, name) else array.shape for name, array in arrays.items())
    return np.broadcast_shapes(*shapes)


def violations(self: Calculation, rules: Iterable[Requirement]) -> list[Fault]:
    """Return the faults of broken rules; invalid points of arrays are masked instead."""
    faults: list[Fault] = []
    missing = self.ledger.missing
    for rule in rules:
        if rule.warning or (not rule.missing and not missing.isdisjoint(rule.uses)):
            continue
        try:
            holds = rule.function(self)
            if isinstance(holds, np.ndarray) and holds.ndim:
                self.ledger.masks += _violated_points(self, rule, holds)
            elif not holds:
                faults.append(_violation(self, rule))
        except InvalidInputs as error:  # a default that the rule reads is refused
            faults += (fault for fault in error.faults if fault not in faults)
    return faults


def _violation(self: Calculation, rule: Requirement) -> Fault:
    """Return the fault of a broken rule."""
    name, *also = names = suspects(self, rule)
    values = ", ".join(f"{name} = {_shown(self, self.inputs[name])}" for name in names)
    case = stated_case(self, rule) or values
    return Fault(name, BROKEN, f"{case}; {required(rule)}", tuple(also))


def _violated_points(self: Calculation, rule: Requirement, holds: NDArray[np.bool_]) -> list[Mask]:
    """Return the masks of the points at which a rule is broken, if there are any."""
    if holds.all():
        return []
    names = tuple(self.inputs[name].attribute for name in rule.names)
    cases = [(np.broadcast_to(where, holds.shape), text) for where, text in relations(self, rule)]
    points = np.logical_or.reduce([where for where, _ in cases] or [holds & False])
    masks = [Mask(names, where, f"{text}; {required(rule)}") for where, text in cases]
    return [*masks, *([Mask(names, ~holds & ~points, required(rule))] if (~holds & ~points).any() else [])]


def remarks(self: Calculation) -> Iterator[Notice]:
    """Yield a warning for every broken rule that only warns, and for every remark of a worksheet.

    A rule does not warn about points that another rule refuses.
    """
    for rule in self._remarks:
        if not np.all(_or_refused(self, rule, rule.function(self))):
            for name in rule.names:
                yield Notice(rule.warning, name, f"{violation(self, rule, name)}; {rule.remedy}")
    for declared, remark in self._readings:
        if declared.attribute in vars(self) and declared.name not in self.ledger.typed:
            yield Notice("turns", declared.name, remark)


def _or_refused(self: Calculation, rule: Requirement, holds: Truth) -> Truth:
    """Return where a rule holds, or a value that it reads belongs to a refused point."""
    if np.ndim(holds) == 0:
        return holds
    beneath = set(rule.uses).union(*(self.depends_on(attribute) for attribute in rule.uses))
    for mask in self.ledger.masks:
        if not mask.explains and not beneath.isdisjoint(mask.names):
            holds = np.logical_or(holds, mask.where)
    return holds


def _shown(self: Calculation, declared: Declaration) -> str:
    value = getattr(self, declared.attribute)
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        if value and len(value[0]) > WIDEST_ROW:
            return f"{len(value)} × {len(value[0])} values"
        shown = [[float(f"{declared.meaning.scale.from_si(v):.6g}") for v in row] for row in value[:2]]
        return str(shown) if len(value) <= 2 else f"{len(value)} rows from {shown[0]}"
    if np.ndim(value):
        return f"{np.shape(value)[-1]} values from {declared.meaning.with_unit(value.flat[0])}"
    return "not given" if np.isnan(value) else declared.meaning.with_unit(value)
