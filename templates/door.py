"""Call templates from Python, in notebooks and scripts, with quantities as inputs and results.

    from templates import get

    film = get("oil_film", 2)(radial_load="25 kN", bearing_diameter="48 mm", …)
    film.minimum_film_thickness         # 2.657 µm, a Pint quantity
    film.level, film.error["minimum_film_thickness"], film.warnings

The built-in templates run in this process; no service is needed. An input is a string, a Pint quantity of any
registry, an object `{"value": 25, "unit": "kN"}`, or a bare number or array where the unit is 1.
Array inputs give array results.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pint

from templates.core.catalogue.discovery import Catalogue, find
from templates.core.errors import Fault, InvalidInputs, unknown_name
from templates.core.language.answer import Answer
from templates.core.language.evaluate import criterion_warnings, evaluate, evaluate_at_level
from templates.core.language.ledger import Notice
from templates.core.language.levels import at_level
from templates.core.language.spec import Choice, Declaration, Input, Text
from templates.core.language.template import Template
from templates.core.units.units import registry

__all__ = ["Calculation", "NoValue", "Version", "built_in", "get"]


class NoValue(LookupError):
    """A result that does not exist for these inputs, such as a friction coefficient at no load."""

    def __init__(self, name: str, reason: str) -> None:
        self.name, self.reason = name, reason
        super().__init__(f"{name} has no value: {reason}")


@cache
def built_in() -> Catalogue[Template]:
    """Return the catalogue of all built-in templates."""
    return find([Path(__file__).parent], Template)


def get(id: str, version: int | None = None) -> Version:
    """Return one version of a built-in template; the latest if no version is given.

    Raises
    ------
    UnknownTemplate
        If there is no such template or version.
    """
    catalogue = built_in()
    return Version(catalogue.latest(id) if version is None else catalogue.get(id, version))


class Version:
    """One version of a template, to be called with its inputs."""

    def __init__(self, template: type[Template]) -> None:
        self.template = template
        self.__doc__ = template.documentation()

    def __repr__(self) -> str:
        return f"<{self.template.id} {self.template.version}: {self.template.title()}>"

    @property
    def inputs(self) -> dict[str, str | None]:
        """Return the unit of each input; None for a choice among words."""
        return {name: _unit(declared) for name, declared in self.template.inputs.items()}

    @property
    def outputs(self) -> dict[str, str | None]:
        """Return the unit of each output; None for a text."""
        return {name: _unit(declared) for name, declared in self.template.formulas.items()}

    @property
    def levels(self) -> tuple[str, ...]:
        """Return the levels of fidelity, cheapest first; empty if the template has a single level."""
        return self.template.levels

    @property
    def example(self) -> dict[str, Any]:
        """Return a valid set of inputs."""
        return dict(self.template.example)

    def __call__(
        self,
        *,
        level: str | None = None,
        tolerance: float | None = None,
        outputs: Iterable[str] | None = None,
        per_point: bool = False,
        **inputs: Any,
    ) -> Calculation:
        """Return a calculation for these inputs.

        Parameters
        ----------
        level
            The level of fidelity; None selects the template's default. An output is computed when it is first
            read.
        tolerance
            The largest acceptable relative error. The outputs are computed at once, at the cheapest level
            whose measured error is within the tolerance for all `outputs` at all points.
        outputs
            The outputs to which the tolerance applies; None means all.
        per_point
            Whether each point of an array gets its own cheapest level.
        **inputs
            The template's inputs by name.

        Raises
        ------
        InvalidInputs
            If inputs are wrong, or `outputs` is given without a tolerance. The error names each wrong input
            and states what would be right.
        """
        raw = {name: _written(value) for name, value in inputs.items()}
        if tolerance is None:
            _refuse_names(self.template, level, outputs)
            instance = self.template.from_quantities(raw)
            return Calculation(
                at_level(instance, level or instance.starting_level()) if instance.levels else instance
            )
        done = evaluate(
            self.template, raw, outputs=outputs, level=level, tolerance=tolerance, per_point=per_point
        )
        return Calculation(done.template, done.outputs, done.error, done.warnings, level=done.level)


class Calculation:
    """The results of one set of inputs; each is an attribute, computed when first asked for.

    A number is a Pint quantity in its declared unit; inputs are attributes as well. A point of an array that
    has no value is NaN, and `reasons` says why.
    """

    def __init__(
        self,
        template: Template,
        answers: Mapping[str, Answer] | None = None,
        error: Mapping[str, Any] | None = None,
        warnings: Iterable[Notice] = (),
        *,
        level: Any = None,
    ) -> None:
        self.template = template
        self._answers: dict[str, Answer] = dict(answers or {})
        self._complete = answers is not None  # a tolerance chose the level for these outputs and no others
        self._warnings, self._errors = list(warnings), dict(error or {})
        self.error = Errors(self, error or {})
        self.level = level if self._complete else template.level or None

    def __getattr__(self, name: str) -> Any:
        cls = type(self.__dict__["template"])
        if name in cls.formulas:
            return _value(name, self.answer(name))
        if name in cls.inputs:
            return _input(self.template, cls.inputs[name])
        raise AttributeError(unknown_name(name, [*cls.formulas, *cls.inputs], "result").detail)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.template.formulas, *self.template.inputs]

    def __repr__(self) -> str:
        level = f" at level {self.level}" if isinstance(self.level, str) else ""
        return f"<a calculation of {self.template.id} {self.template.version}{level}>"

    @property
    def warnings(self) -> list[Notice]:
        """Return the warnings about the results computed so far, each with name, code and sentence."""
        if self._complete:
            return list(self._warnings)
        return [*self._warnings, *criterion_warnings(self.template, self._answers, self._errors)]

    def answer(self, name: str) -> Answer:
        """Return a result in the form of the service: a value in its unit, or no value and the reason.

        Raises
        ------
        InvalidInputs
            If the result is outside its domain, or if a tolerance chose the level for other outputs.
        """
        if name not in self._answers:
            if self._complete:
                detail = f"the tolerance is about {', '.join(self._answers)}; name {name} in outputs too"
                raise InvalidInputs([Fault(name, "not_computed", detail)])
            answers, errors, self._warnings = evaluate_at_level(self.template, [name])
            self._answers |= answers
            self._errors |= errors
            self.error.update({output: _plain(error) for output, error in errors.items()})
        return self._answers[name]

    def reasons(self, name: str) -> Any:
        """Return the reason for each point without a value, None for others; None if all have values."""
        return self.answer(name).reasons


class Errors(dict[str, Any]):
    """Relative error estimates by output: None, or NaN in an array, where the error was not measured.

    It holds the outputs computed so far; another one is computed when it is asked for.
    """

    def __init__(self, calculation: Calculation, errors: Mapping[str, Any]) -> None:
        self._calculation = calculation
        super().__init__({name: _plain(error) for name, error in errors.items()})

    def __missing__(self, name: str) -> Any:
        self._calculation.answer(name)
        return self[name]


def _plain(error: Any) -> Any:
    """Return a single estimate as a float, or None if it is unknown; return an array unchanged."""
    if error is None or np.ndim(error):
        return error
    return None if error != error else float(error)


def _refuse_names(cls: type[Template], level: str | None, outputs: Iterable[str] | None) -> None:
    if outputs is not None:
        message = (
            "`outputs` names the outputs to which `tolerance` applies; give `tolerance`, or omit `outputs`"
        )
        raise InvalidInputs([Fault("outputs", "no_tolerance", message)])
    if level is not None and level not in cls.levels:
        raise InvalidInputs([unknown_name(level, cls.levels, "level").within("level")])


def _written(value: Any) -> Any:
    """Return an input in the form that the template language reads.

    Pint quantities become texts with units.
    """
    if isinstance(value, pint.Quantity):
        return {"value": _listed(value.magnitude), "unit": f"{value.units:~C}" or "1"}
    if isinstance(value, list | tuple):
        return [_written(item) for item in value]
    return value


def _listed(magnitude: Any) -> Any:
    return magnitude.tolist() if hasattr(magnitude, "tolist") else magnitude


def _unit(declared: Declaration) -> str | None:
    return None if isinstance(declared, Choice | Text) else declared.meaning.unit


def _value(name: str, answer: Answer) -> Any:
    if answer.value is None:
        raise NoValue(name, answer.reason or "the formula has no value for these inputs")
    return answer.value if answer.unit is None else _quantity(answer.value, answer.unit)


def _input(template: Template, declared: Input) -> Any:
    si = getattr(template, declared.attribute)
    unit = _unit(declared)
    if unit is None:
        return si
    if np.ndim(si) == 0 and np.isnan(si):
        raise NoValue(declared.name, "it was not given, and has no default")
    return _quantity(declared.meaning.scale.from_si(np.asarray(si)[()]), unit)


def _quantity(value: Any, unit: str) -> Any:
    return registry.Quantity(value, "" if unit == "1" else unit)
