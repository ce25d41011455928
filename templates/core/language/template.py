"""The base class of templates: each given and each formula is declared once, and the rest is derived.

A template is a class in a file `<id>_v<version>.py`. Its instance has SI values: givens are attributes, and
formulas are evaluated when first used and then stored. The same code handles one point and 10⁶ points.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Collection, Mapping
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.errors import InvalidInputs
from templates.core.language.admission import absence, masked, outside_published, refusal, whole
from templates.core.language.calculation import Calculation
from templates.core.language.causes import by_cause
from templates.core.language.declare import (
    by_name,
    choice,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
    table,
    text,
    units,
)
from templates.core.language.declared_criteria import declared_criteria
from templates.core.language.intake import (
    admitted,
    as_typed,
    check_shapes,
    is_curve,
    plain,
    points_of,
    read_inputs,
    violations,
)
from templates.core.language.ledger import Ledger, Mask
from templates.core.language.spec import (
    Choice,
    Declaration,
    Derived,
    Formula,
    Given,
    Profile,
    Requirement,
    Shared,
)

__all__ = [
    "Array", "Template", "Truth", "choice", "curve", "derived", "formula", "given", "profile", "require",
    "shared", "table", "text", "units",
]  # fmt: skip


def _remark_of(declared: Declaration) -> str:
    """Return how a worksheet formula may be misread; empty if it is unambiguous."""
    return str(getattr(getattr(declared, "function", None), "remark", ""))


VERSIONED = re.compile(r"(?:^|.*\.)([a-z][a-z0-9_]*)_v([1-9][0-9]*)$")


class Template(Calculation):
    """Base of all templates and CAD models."""

    def __init_subclass__(cls) -> None:
        if match := VERSIONED.match(cls.__module__):
            cls.id, cls.version = match[1], int(match[2])
        everything = {name: v for base in reversed(cls.__mro__) for name, v in vars(base).items()}
        declared = {name: v for name, v in everything.items() if isinstance(v, Declaration)}
        if reserved := sorted(name for name in declared if name in cls._own_words()):
            names = ", ".join(reserved)
            raise TypeError(f"{cls.__name__}: {names} is reserved in every template; choose another name")
        cls.declarations, cls._ancestry, cls._dependencies = declared, {}, {}
        named = by_name(declared)
        cls.inputs = {name: v for name, v in named.items() if isinstance(v, (Given, Choice, Derived))}
        cls.formulas = {n: v for n, v in named.items() if n not in cls.inputs or getattr(v, "shown", False)}
        cls._derived = frozenset(name for name, v in cls.inputs.items() if isinstance(v, Derived))
        cls._results = frozenset(formula.attribute for formula in cls.formulas.values())
        cls._result_names = frozenset(cls.formulas)
        cls._curves = frozenset(name for name, v in cls.formulas.items() if isinstance(v, Profile))
        cls.requirements = tuple(v for v in everything.values() if isinstance(v, Requirement))
        cls._remarks = tuple(rule for rule in cls.requirements if rule.warning)
        cls._readings = tuple((v, remark) for v in declared.values() if (remark := _remark_of(v)))
        cls.intermediates = {name: v for name, v in everything.items() if isinstance(v, Shared)}
        cls.declared_criteria = declared_criteria(cls.__name__, cls.criteria, cls.inputs, cls.formulas)

    @classmethod
    def _own_words(cls) -> set[str]:
        """Return the attributes of the base classes that belong to the language."""
        bases = (vars(base) for base in cls.__mro__[1:])
        return {name for own in bases for name, v in own.items() if not isinstance(v, Declaration)}

    @classmethod
    def title(cls) -> str:
        """Return the first sentence of the docstring."""
        return cls.summary().split(". ")[0].rstrip(".")

    @classmethod
    def summary(cls) -> str:
        """Return the first paragraph of the docstring of the class, or of its module."""
        return " ".join(cls.documentation().split("\n\n")[0].split())

    @classmethod
    def documentation(cls) -> str:
        """Return the docstring of the class, or of its module."""
        return inspect.cleandoc(cls.__dict__.get("__doc__") or inspect.getmodule(cls).__doc__ or cls.__name__)

    @classmethod
    def from_quantities(cls, raw: Mapping[str, Any], pending: Collection[str] = ()) -> Self:
        """Return a template from typed inputs: read them, convert them to SI, and check them.

        This happens once, before any formula is evaluated. Inputs in `pending` follow later: they are not
        required yet, and rules that depend on them are not checked.

        Raises
        ------
        InvalidInputs
            If inputs are wrong; the error lists all of them.
        """
        if (inputs := plain(cls, raw)) is not None:
            ledger = Ledger(typed=inputs.typed, missing=inputs.missing)
            return cls._kept(cls(inputs.values, ledger), pending)
        typed, faults = read_inputs(cls, raw)
        intake = admitted(cls, typed)
        if faults := [*faults, *intake.faults]:
            faults = [fault for fault in faults if fault.name not in pending]
        if faults:
            raise InvalidInputs(faults)
        ledger = Ledger(typed=typed, warnings=intake.warnings, masks=intake.masks, missing=intake.missing)
        return cls._checked(intake.values, ledger, pending)

    def at(self, level: str, where: NDArray[np.bool_] | None = None) -> Self:
        """Return a template with the same inputs at another level.

        If `where` is given, it includes only the points of arrays for which `where` is true.
        """
        names = (declared.attribute for declared in self.inputs.values())
        values = {name: vars(self)[name] for name in names if name in self.ledger.handed}
        masks = self._own_masks()
        if where is not None:
            values = {name: _picked(value, where, is_curve(self, name)) for name, value in values.items()}
            masks = [Mask(m.names, np.broadcast_to(m.where, where.shape)[where], m.reason) for m in masks]
        ledger = Ledger(typed=self.ledger.typed, masks=masks, missing=self.ledger.missing)
        return type(self)({**values, "level": level}, ledger)

    def shape_of_points(self) -> tuple[int, ...]:
        """Return the common shape of the points of all inputs; the last axis of a curve does not count."""
        given = vars(self)
        arrays = {name: given[name] for name in self.ledger.handed if isinstance(given[name], np.ndarray)}
        return points_of(self, arrays) if arrays else ()

    def ladder(self) -> tuple[str, ...]:
        """Return the levels that can calculate these inputs, cheapest first."""
        return self.levels

    def is_measured(self) -> bool:
        """Return whether the measured errors apply to these inputs."""
        return True

    def measured_case(self) -> str:
        """Return the name of the case of these inputs, if errors were measured for several cases."""
        return ""

    def states_own_errors(self) -> bool:
        """Return whether the level's own error estimate replaces the measured errors for these inputs."""
        return True

    def own_error(self, output: str) -> Array:
        """Return the level's own estimate of the relative error of an output [-]; NaN if it makes none."""
        return np.full(self.shape_of_points(), np.nan)[()]

    def starting_level(self) -> str:
        """Return the default level, or the finest level if the default cannot calculate these inputs."""
        ladder = self.ladder()
        return self.default_level if self.default_level in ladder else ladder[-1]

    def _own_masks(self) -> list[Mask]:
        """Return the masks of inputs; those of formulas are omitted, because they are recalculated."""
        inputs = {declared.attribute for declared in self.inputs.values()}
        return [mask for mask in self.ledger.masks if inputs.issuperset(mask.names)]

    @classmethod
    def from_si(cls, values: Mapping[str, Any]) -> Self:
        """Return a template from SI values by API name, checked like a user's inputs."""
        return cls.from_quantities({name: as_typed(cls, name, value) for name, value in values.items()})

    @classmethod
    def _checked(cls, values: Mapping[str, Any], ledger: Ledger, pending: Collection[str] = ()) -> Self:
        self = cls(values, ledger)
        check_shapes(self)
        return cls._kept(self, pending)

    @classmethod
    def _kept(cls, self: Self, pending: Collection[str]) -> Self:
        """Return the template if it satisfies its rules; otherwise raise `InvalidInputs`."""
        with np.errstate(all="ignore"):
            faults = violations(self, cls._due(pending) if pending else cls.requirements)
        if faults:
            raise InvalidInputs(by_cause(faults))
        return self

    @classmethod
    def _due(cls, pending: Collection[str]) -> list[Requirement]:
        """Return the rules that do not depend on pending inputs."""
        return [rule for rule in cls.requirements if not cls._waits(rule, pending)]

    @classmethod
    def _waits(cls, rule: Requirement, pending: Collection[str]) -> bool:
        """Return whether a rule depends on any of the pending inputs."""
        beneath = {name for used in rule.uses for name in cls.dependencies(used)}.union(rule.uses_as_given)
        attributes = {cls.inputs[name].attribute for name in pending}
        return not (attributes.isdisjoint(beneath) and frozenset(pending).isdisjoint(rule.names))

    def inputs_si(self) -> dict[str, Any]:
        """Return every input in SI by API name, including defaults."""
        with np.errstate(all="ignore"):
            return {name: getattr(self, declared.attribute) for name, declared in self.inputs.items()}

    def admit(self, declaration: Formula[Any], value: Any) -> Any:
        """Check the result of a formula and return it: refuse a point, mask points of an array, or warn."""
        meaning = declaration.meaning
        if meaning.per_level:
            meaning = meaning.at(self.level)
        if isinstance(value, float) or (np.ndim(value) == 0 and not isinstance(value, str)):
            value = np.float64(value)
            low, high = meaning.interval
            if not low <= value <= high:
                why = absence(self, declaration) if math.isnan(value) else None
                if why is None:
                    raise InvalidInputs([refusal(self, declaration, value)])
                self.ledger.absent[declaration.attribute] = why
        elif isinstance(declaration, Profile) and value.ndim == declaration.axes:
            value = whole(self, declaration, value)
        elif isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
            value = masked(self, declaration, value)
        if meaning.published_si is not None:
            outside = outside_published(declaration, value, self.level)
            self.ledger.warnings += [outside] if outside else []
        for assumed in meaning.assumes:
            getattr(self, assumed)
        return value


def _picked(value: Any, where: NDArray[np.bool_], along_cycle: bool) -> Any:
    if not isinstance(value, np.ndarray):
        return value
    places = value.shape[-1:] if along_cycle else ()
    return np.broadcast_to(value, where.shape + places)[where]
