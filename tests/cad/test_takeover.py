"""Every parameter set of a superseded model has an equal in the newest version, which draws the same solid.

This file goes with `crankshaft` 1 and 2.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
import test_cranks_random
import test_crankshaft_2_random
from seeds import seeded

from cad.catalogue import models
from cad.model import CadModel
from cad.regenerate import as_text, regenerate
from templates.core.errors import InvalidInputs

Values = dict[str, Any]
ENDS = {
    "front_length": "nose_length", "front_diameter": "nose_diameter", "rear_length": "flange_thickness",
    "rear_diameter": "flange_diameter",
}  # fmt: skip


def one_throw(values: Mapping[str, Any]) -> Values:
    """Return the equal of a `crankshaft` 1: its timing end as nose, its other end as flange without bolts."""
    kept = {ENDS.get(name, name): value for name, value in values.items()}
    return {**kept, "pin_angles": [0.0], "bolt_hole_diameter": 0.0}


def as_it_is(values: Mapping[str, Any]) -> Values:
    return dict(values)


def short_mains(cls: type[CadModel], rng: np.random.Generator) -> Values:
    """Return parameters of a crank, in every second set with short or long mains and large fillets."""
    given = test_cranks_random.sample(cls, rng)
    if rng.random() < 0.5:
        given["journal_length"] = given["journal_diameter"] * 10 ** rng.uniform(-2, 1)
        given["fillet"] = given["journal_length"] * rng.uniform(0.3, 0.9)
    return given


Case = tuple[str, int, Callable[[type[CadModel], np.random.Generator], Values], Callable[[Values], Values]]
CASES: list[Case] = [
    ("crankshaft", 1, short_mains, one_throw),
    ("crankshaft", 2, lambda cls, rng: test_crankshaft_2_random.sample(rng), as_it_is),
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
    """Compare volume, mass, centre, box and inertia; `crankshaft` 1 has z = 0 at mid-pin, 3 at mid-main."""
    name, version, *_ = case
    one, other = regenerate(name, version, old), regenerate(name, 3, new)
    shift = 0.0
    if (name, version) == ("crankshaft", 1):
        shift = float(getattr(models().get(name, 3).from_si(new), "p")) / 2 * 1e3  # noqa: B009
    inertia = max(abs(value) for measure, value in one.measures.items() if measure.startswith("inertia"))
    for measure, value in one.measures.items():
        along = shift if measure in ("centre_z", "low_z", "high_z") else 0.0
        least = 1e-7 * inertia if measure.startswith("inertia") else 0.0
        if measure.startswith(("centre", "low", "high")):
            least = 1e-5  # [mm], the kernel's boxes are good to some 1e-6
        found = other.measures[measure] - along
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
