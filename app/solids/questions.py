"""What can be asked of a solid by finite elements, and by what an answer is found again.

For the REST interface and for relations of designs. Which analyses exist stands in `cad.analysis.kinds`; that
module does not import the kernel that computes them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from typing import Any

from pydantic import ConfigDict, Field

from app.schemas.bounded import Bounded
from cad.analysis.kinds import (
    BOUNDARIES,
    DEFAULT_LEVEL,
    KINDS,
    LEVELS,
    STRESSES,
    SURFACE,
    Boundary,
    Level,
)
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText
from templates.core.units.quantity import read

LARGEST_LOAD = 1e12  # [N m]

DEAR = STRESSES | {SURFACE}
"""What is found only where it is asked for by name."""

RECIPE = 3
"""Raised whenever the same question to the same solid gets another answer."""

_MADE_BY = f"recipe {RECIPE}, ngsolve {version('ngsolve')}"


class Options(Bounded):
    """How a solid is held in an analysis, and how accurate the answer shall be."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    boundary: Boundary = Field(
        "free_end", description="the loaded end: `free_end`, or kept on the axis, `guided_end`"
    )
    level: Level | None = Field(None, description="how fine the mesh is; `default`, if nothing is said")
    tolerance: float | None = Field(
        None, gt=0, le=1, description="the largest relative error wanted, instead of a level"
    )
    load: str | dict[str, Any] | None = Field(
        None,
        description="the torque or bending moment under which stress is told; 1 N*m, if nothing is said",
        examples=["500 N*m"],
    )


@dataclass(frozen=True)
class Question:
    """An analysis as it was asked for."""

    kind: str
    boundary: Boundary
    level: Level | None
    tolerance: float | None
    load: float = 1.0  # [N m]

    def key(self, build: str) -> str:
        """By what the answers for a build are found: SHA-256 of build, question, solver and recipe.

        Not by the load: everything is linear in it, so what is kept is found under 1 N·m.
        """
        identity = [build, self.kept(), _MADE_BY]
        return hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()

    def whatever_level(self) -> Question:
        """The same of stress, whose mesh is refined until it settles; under 1 N·m."""
        return replace(self, level=None, tolerance=None, load=1.0)

    def kept(self) -> dict[str, Any]:
        """The question as it is kept with its answers, without the load."""
        return {name: value for name, value in asdict(self).items() if name != "load"}

    def shown(self) -> dict[str, Any]:
        """The question as it is shown."""
        return {**asdict(self), "load": {"value": self.load, "unit": "N*m"}}


def question(kind: str, options: Options) -> Question:
    """The question that options of a kind ask; nothing said is the default level, and a load of 1 N·m."""
    level = options.level or (None if options.tolerance else DEFAULT_LEVEL)
    load = 1.0 if options.load is None or load_faults(options.load) else load_of(options.load)
    return Question(kind, options.boundary, level, options.tolerance, load)


def load_of(raw: Any) -> float:
    """A load [N·m] without faults."""
    return float(read(raw, "N*m").si)


def faults(options: Options) -> list[Fault]:
    """What is wrong with options beside their types."""
    both = options.level is not None and options.tolerance is not None
    detail = "give either a level or a tolerance, which chooses the level"
    found = [Fault("tolerance", "conflict", detail)] if both else []
    return found + ([] if options.load is None else load_faults(options.load))


def load_faults(raw: Any) -> list[Fault]:
    """What is wrong with a load."""
    try:
        load = read(raw, "N*m").si
    except FaultyText as error:
        return [error.fault("load")]
    if isinstance(load, float) and 0 < load <= LARGEST_LOAD:
        return []
    told = f'load is one torque or moment > 0 N*m and ≤ {LARGEST_LOAD:g} N*m, such as "500 N*m"'
    return [Fault("load", "out_of_range", told)]


def under_load(asked: Question, found: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """What was found under 1 N·m as it is under the load of the question: stress is proportional to it."""
    return {name: _times(asked.load, told) if name in STRESSES else {**told} for name, told in found.items()}


def _times(load: float, told: Mapping[str, Any]) -> dict[str, Any]:
    value = None if told["value"] is None else told["value"] * load
    steps = [{**step, "value": step["value"] * load} for step in told["convergence"]]
    return {**told, "value": value, "convergence": steps}


def offered(kind: str) -> tuple[str, ...]:
    """All outputs of a kind that can be asked for."""
    return (*KINDS[kind], SURFACE)


def in_order(kind: str, outputs: Any) -> tuple[str, ...]:
    """Outputs of a kind, each once and always in the same order."""
    return tuple(name for name in offered(kind) if name in outputs)


def no_shaft(cls: type[CadModel]) -> str | None:
    """Why solids of a model cannot be analysed; None if they can."""
    if cls.shaft is not CadModel.shaft:
        return None
    return f"{cls.id} is no shaft: it does not say by which ends it is held and loaded"


def what_can_be_asked(cls: type[CadModel]) -> dict[str, Any]:
    """The kinds of analyses of a model, each with its outputs and their units; none of what is no shaft."""
    if no_shaft(cls):
        return {}
    options = {"boundaries": list(BOUNDARIES), "levels": list(LEVELS)}
    return {
        kind: {"outputs": {**units, SURFACE: None}, **options, "default_level": DEFAULT_LEVEL}
        for kind, units in KINDS.items()
    }


def warnings(asked: Question, found: Mapping[str, Mapping[str, Any]]) -> list[dict[str, str]]:
    """The outputs whose error may be larger than was wanted."""
    return [
        {"code": "tolerance_unmet", "name": name, "detail": _unmet(told["error"], asked.tolerance)}
        for name, told in found.items()
        if asked.tolerance and told["error"] is not None and told["error"] > asked.tolerance
    ]


def _unmet(error: float, tolerance: float) -> str:
    return f"the error may be {error:.2g}, more than the {tolerance:g} asked for, and no finer mesh is tried"
