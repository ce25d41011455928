"""A revision as a worksheet shows it: the steps with their formulas written out, in one system of units."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from typing import Any

from pydantic_core import from_json, to_json

from app.cache import results as kept
from app.calculations.display import System, converted
from app.calculations.errors import StepDeferred
from app.calculations.steps import evaluated_step
from app.calculations.worksheet import formulas
from app.designs.calculate import Calculation
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
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
    level = told["level"] if isinstance(told["level"], str) else None
    inputs = {name: _retyped(value) for name, value in told["inputs"].items() if value["from"] == "given"}
    try:
        cls: Any = catalogue.get(told["template"]["id"], told["template"]["version"])
        return _written_out(cls, to_json(inputs), tuple(told["outputs"]), level, system)
    except TemplateError:  # the file of this version was taken away, or changed: its results stay
        return [], []
    except StepDeferred:
        return [], []


def _retyped(echo: Mapping[str, Any]) -> Any:
    """An input as it was used, as one that can be given again."""
    return {name: part for name, part in echo.items() if name != "from"} if "unit" in echo else echo["value"]


def _written_out(
    cls: Any, inputs: bytes, outputs: tuple[str, ...], level: str | None, system: System
) -> tuple[list[dict[str, Any]], list[Check]]:
    """Formulas and checks, kept because a revision never changes."""
    key = (_written_out, cls, sha256(inputs).digest(), outputs, level, system)
    written: tuple[list[dict[str, Any]], list[Check]] | None = kept.get(key)
    if written is None:
        evaluation = evaluated_step(cls, from_json(inputs), outputs, level, None)
        written = formulas(evaluation.template, system, evaluation.outputs), list(checks(evaluation.template))
        kept.keep(key, written)
    return written
