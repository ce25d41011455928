"""Check a request to a template as a whole, before any formula is evaluated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import filterfalse
from typing import Any

from templates.core.criteria.limits import GivenLimit, read_limits
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_name, unknown_names
from templates.core.language.levels import at_level
from templates.core.language.template import Template
from templates.core.units.quantity import Unit, beside, require_same_kind


@dataclass(frozen=True, slots=True)
class Request:
    """A valid request: inputs, names of outputs, and the units in which some outputs are shown."""

    template: Template
    names: list[str]
    shown_in: Mapping[str, Unit]
    limits: Mapping[str, GivenLimit]


def read_request(
    cls: type[Template],
    raw: Mapping[str, Any],
    outputs: Iterable[str] | None = None,
    units: Mapping[str, str] | None = None,
    level: str | None = None,
    limits: Mapping[str, Any] | None = None,
) -> Request:
    """Return the request read from typed inputs and limits and from the names of the requested outputs.

    Raises
    ------
    InvalidInputs
        If the request has faults; the error lists all of them.
    """
    names, shown_in, faults = read_options(cls, outputs, units, level)
    given, wrong = _limits(cls, limits) if limits else ({}, [])
    faults += wrong
    try:
        template = cls.from_quantities(raw)
    except InvalidInputs as error:
        raise InvalidInputs([*faults, *error.faults]) from None
    if faults:
        raise InvalidInputs(faults)
    return Request(template, names, shown_in, given)


def _limits(cls: type[Template], raw: Mapping[str, Any]) -> tuple[dict[str, GivenLimit], list[Fault]]:
    """Return the limits given for the template's criteria, and their faults."""
    try:
        return read_limits(cls.declared_criteria, raw), []
    except InvalidInputs as error:
        return {}, list(error.faults)


def require_points(template: Template, level: str | None, tolerance: float | None) -> None:
    """Raise InvalidInputs if the level does not accept the number of points.

    With a tolerance, the calculation chooses the level of each point, so there is nothing to check here.
    """
    if template.levels and (level is not None or tolerance is None):
        at_level(template, level or template.starting_level())


def read_options(
    cls: type[Template],
    outputs: Iterable[str] | None = None,
    units: Mapping[str, str] | None = None,
    level: str | None = None,
) -> tuple[list[str], dict[str, Unit], list[Fault]]:
    """Return the requested outputs, their units, and all faults in these and in the level."""
    names = list(cls.formulas) if outputs is None else list(outputs)
    faults = unknown_names(filterfalse(cls.formulas.__contains__, names), cls.formulas, "output")
    shown_in = _units(cls, units or {}, faults)
    return names, shown_in, faults + _level_faults(cls, level)


def _level_faults(cls: type[Template], level: str | None) -> list[Fault]:
    if level is None or level in cls.levels:
        return []
    if not cls.levels:
        return [Fault("level", "unknown_name", f"{cls.id} {cls.version} has only one level; omit `level`")]
    return [unknown_name(level, cls.levels, "level").within("level")]


def _units(cls: type[Template], units: Mapping[str, str], faults: list[Fault]) -> dict[str, Unit]:
    shown: dict[str, Unit] = {}
    if not units:
        return shown
    unknown = unknown_names(filterfalse(cls.formulas.__contains__, units), cls.formulas, "output")
    faults += [fault.within("units") for fault in unknown]
    for name, text in units.items():
        if name not in cls.formulas:
            continue
        try:
            accepted = cls.formulas[name].meaning.accepted
            shown[name] = require_same_kind(beside(text, accepted), accepted)
        except FaultyText as error:
            faults.append(error.fault(f"units.{name}"))
    return shown
