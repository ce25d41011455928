"""Every parameter set of a superseded model has an equal in the newest version, which draws the same solid.

This file goes with `plain_bearing` 1 and 2.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
import test_bearing_parts
from seeds import seeded

from cad.catalogue import models
from cad.model import CadModel
from cad.regenerate import as_text, regenerate
from templates.core.errors import InvalidInputs

Values = dict[str, Any]
NONE_OF_A_PLAIN_SHELL = (
    "lining_thickness", "tang_width", "relief_depth", "inner_chamfer", "outer_chamfer", "flange_diameter",
    "crush_height",
)  # fmt: skip


def plain_shell(values: Mapping[str, Any]) -> Values:
    """Return the equal of a `plain_bearing` 1: a shell of one material, all round or the upper half."""
    kept = {name: value for name, value in values.items() if name != "shell"}
    shells = {"half": "upper", "full": "full"}[values["shell"]]
    return {**kept, "shells": shells, **dict.fromkeys(NONE_OF_A_PLAIN_SHELL, 0.0)}


def as_it_is(values: Mapping[str, Any]) -> Values:
    return dict(values)


def anywhere(cls: type[CadModel], rng: np.random.Generator) -> Values:
    """Return parameters of a plain bearing in all of their ranges, or by shares of the bore."""
    wide = bool(rng.random() < 0.3)
    d = 10 ** rng.uniform(-3, np.log10(5))

    def length(name: str, low: float, high: float) -> float:
        if not wide:
            return float(d * low * (high / low) ** rng.random())
        bounds = cls.inputs[name].meaning.domain_si
        least = max(bounds.ge, 1e-5)
        return float(least * (bounds.le / least) ** rng.random())

    given: Values = {"inner_diameter": d, "shell": str(rng.choice(["half", "full"]))}
    if rng.random() < 0.8:
        given["wall"] = length("wall", 0.03, 2)
    if rng.random() < 0.8:
        given["width"] = length("width", 0.1, 3)
    for name, low, high in (("oil_hole_diameter", 0.02, 0.8), ("oil_groove_width", 0.02, 1)):
        if rng.random() < 0.7:
            given[name] = 0.0 if rng.random() < 0.2 else length(name, low, high)
    if rng.random() < 0.7:
        wall = given.get("wall", 0.05 * d)
        given["oil_groove_depth"] = 0.0 if rng.random() < 0.3 else float(wall * rng.uniform(0.01, 0.9))
    return given


Case = tuple[str, int, Callable[[type[CadModel], np.random.Generator], Values], Callable[[Values], Values]]
CASES: list[Case] = [
    ("plain_bearing", 1, anywhere, plain_shell),
    ("plain_bearing", 2, test_bearing_parts.sample, as_it_is),
]


def accepted(cls: type[CadModel], given: Values) -> Values | None:
    """Return all parameters of a model [SI], defaults included; None if it refuses them."""
    try:
        model = cls.from_si(given)
        as_text(model)
    except InvalidInputs:
        return None
    return {
        name: value if isinstance(value, str) else np.asarray(value).tolist()
        for name, value in model.inputs_si().items()
    }


def equals(case: Case, sets: int, seed: int) -> list[tuple[Values, Values]]:
    """Return the sets among random ones that the older version accepts, each with its equal in version 3."""
    name, version, sample, equal = case
    cls, rng = models().get(name, version), np.random.default_rng(seed)
    values = (accepted(cls, sample(cls, rng)) for _ in range(sets))
    return [(old, equal(old)) for old in values if old is not None]


def same_solid(case: Case, old: Values, new: Values) -> None:
    """Compare volume, mass, centre, box and inertia."""
    name, version, *_ = case
    one, other = regenerate(name, version, old), regenerate(name, 3, new)
    inertia = max(abs(value) for measure, value in one.measures.items() if measure.startswith("inertia"))
    for measure, value in one.measures.items():
        least = 1e-7 * inertia if measure.startswith("inertia") else 0.0
        if measure.startswith(("centre", "low", "high")):
            least = 1e-5  # [mm], the kernel's boxes are good to some 1e-6
        found = other.measures[measure]
        # models draw in steps of 1e-9 mm, and the thinnest wall here has 0.04 mm
        assert found == pytest.approx(value, rel=1e-7, abs=least), (old, measure)


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}_v{case[1]}")
def test_the_newest_version_accepts_what_an_older_one_accepts(case: Case) -> None:
    newest = models().get(case[0], 3)
    pairs = equals(case, 400, seed=seeded(7))
    assert len(pairs) > 40
    assert [old for old, new in pairs if accepted(newest, new) is None] == []


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}_v{case[1]}")
def test_the_newest_version_draws_the_same_solid(case: Case) -> None:
    for old, new in equals(case, 40, seed=8)[:3]:
        same_solid(case, old, new)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}_v{case[1]}")
def test_the_newest_version_draws_many_of_the_same_solids(case: Case) -> None:
    for old, new in equals(case, 300, seed=seeded(9))[:40]:
        same_solid(case, old, new)
