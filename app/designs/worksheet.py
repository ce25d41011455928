"""A revision as a worksheet shows it: the steps with their formulas written out, in one system of units."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any, NamedTuple, Self

from app.calculations.begun import fingerprint
from app.calculations.cache import results as kept
from app.calculations.cost import EXPENSIVE
from app.calculations.errors import StepDeferred
from app.calculations.steps import evaluated_step
from app.calculations.worksheet import formulas
from app.designs.calculate import Calculation
from app.presentation.units import System, converted
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
from templates.core.language.evaluate import Evaluation
from templates.core.language.template import Template
from templates.core.paper.verdicts import Check, checks


def worksheets(steps: Mapping[str, Any], catalogue: Catalogue[Template], system: System) -> dict[str, Any]:
    """The steps of a revision with `formulas`, from the inputs and at the level that its job used."""
    return {
        name: {
            **converted(told, system),
            "inputs": told["inputs"],
            "formulas": _formulas(told, catalogue, system),
        }
        for name, told in steps.items()
    }


def previewed(
    calculation: Calculation, steps: Mapping[str, Any], system: System
) -> dict[str, dict[str, Any]]:
    """The steps of a preview with `formulas`; a step that waits for a solid has none yet."""
    made = calculation.evaluations
    return {
        name: {
            **converted(told, system),
            "inputs": told.get("inputs", {}),
            "formulas": formulas(made[name].template, system, made[name].outputs) if name in made else [],
        }
        for name, told in steps.items()
    }


def checked(told: Mapping[str, Any], catalogue: Catalogue[Template]) -> list[Check]:
    """Every bound and rule of a revision's step, held against its values."""
    return _again(told, catalogue, "si")[1]


def _formulas(
    told: Mapping[str, Any], catalogue: Catalogue[Template], system: System
) -> list[dict[str, Any]]:
    return _again(told, catalogue, system)[0]


def _again(
    told: Mapping[str, Any], catalogue: Catalogue[Template], system: System
) -> tuple[list[dict[str, Any]], list[Check]]:
    """Formulas and checks of a step that has results, calculated as its job did; none if it is deferred."""
    if not told["outputs"]:
        return [], []
    try:
        cls: Any = catalogue.get(told["template"]["id"], told["template"]["version"])
        return _written_out(cls, told, system)
    except TemplateError:  # the file of this version was taken away, or changed: its results stay
        return [], []
    except StepDeferred:
        return [], []


def _retyped(echo: Mapping[str, Any]) -> Any:
    """An input as it was used, as one that can be given again."""
    return {name: part for name, part in echo.items() if name != "from"} if "unit" in echo else echo["value"]


class _Question(NamedTuple):
    """What a revision's step was asked, as it can be asked again."""

    inputs: dict[str, Any]
    outputs: tuple[str, ...]
    level: str | None

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> Self:
        given = {name: _retyped(value) for name, value in told["inputs"].items() if value["from"] == "given"}
        level = told["level"] if isinstance(told["level"], str) else None
        return cls(given, tuple(sorted(told["outputs"])), level)  # as the database has them

    def key(self, *more: Any) -> Hashable:
        return (_Question, fingerprint(self.inputs), self.outputs, self.level, *more)


def remember(told: Mapping[str, Any], evaluation: Evaluation) -> None:
    """Keep the evaluation of an expensive step, so that its worksheet does not calculate it again."""
    if evaluation.seconds > EXPENSIVE:
        kept.keep(_Question.of(told).key(type(evaluation.template)), evaluation)


def _written_out(
    cls: Any, told: Mapping[str, Any], system: System
) -> tuple[list[dict[str, Any]], list[Check]]:
    """Formulas and checks, kept because a revision never changes."""
    question = _Question.of(told)
    key = question.key(cls, system)
    written: tuple[list[dict[str, Any]], list[Check]] | None = kept.get(key)
    if written is None:
        evaluation = kept.get(question.key(cls)) or evaluated_step(cls, *question, None)
        written = formulas(evaluation.template, system, evaluation.outputs), list(checks(evaluation.template))
        kept.keep(key, written)
    return written
