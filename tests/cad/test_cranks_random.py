"""Random and hostile parameters of `crank_throw` give a checked solid, or a refusal by name before drawing.

`regenerate` lets nothing pass but one valid solid of the right volume, box and dimensions; that dimensions
are those requested is asserted here once more.
"""

import math
from typing import Any

import numpy as np
import pytest
from seeds import seeded

from cad.models.crank_throw_v1 import CrankThrow
from cad.regenerate import regenerate
from templates.core.errors import InvalidInputs

# Of the journal's diameter: wide enough that pin and journal overlap or not, and that many sets are refused.
RANGES = {
    "journal_length": (0.3, 1.5), "pin_diameter": (0.5, 1.2), "pin_length": (0.3, 1.2),
    "web_thickness": (0.1, 0.8), "web_width": (1.2, 2.2), "throw": (0.2, 2.5), "fillet": (0.01, 0.12),
    "journal_bore": (0.05, 0.6), "pin_bore": (0.05, 0.5), "oil_drilling_diameter": (0.02, 0.2),
    "counterweight_radius": (0.7, 3),
}  # fmt: skip
MAY_BE_NONE = {"fillet", "journal_bore", "pin_bore", "oil_drilling_diameter", "counterweight_radius"}

D = 0.055
HOSTILE: list[dict[str, Any]] = [
    *({"journal_diameter": value} for value in (math.nan, math.inf, -D, 0.0, 1e12, 1e-12)),
    {"journal_length": 0.0}, {"journal_length": 5.0},
    {"pin_length": 5e-5, "fillet": 0.0}, {"pin_length": 5.0},
    {"journal_bore": D}, {"journal_bore": 2 * D}, {"journal_bore": 1e-9}, {"pin_bore": math.inf},
    {"pin_bore": 0.9 * D},
    {"pin_diameter": 1e-4, "throw": D}, {"pin_diameter": 2.0}, {"pin_diameter": math.nan},
    {"web_width": 0.8 * D}, {"web_width": 10.0}, {"web_thickness": 5e-5}, {"web_thickness": -1.0},
    {"throw": 0.0}, {"throw": 10.0}, {"throw": 1e300}, {"throw": 0.02 * D},
    {"fillet": 0.0}, {"fillet": 0.5 * D}, {"fillet": 1e-9}, {"fillet": -1e-3},
    {"oil_drilling_diameter": 0.85 * D}, {"oil_drilling_diameter": 0.3 * D}, {"oil_drilling_diameter": 1e-4},
    {"counterweight_radius": 10.0}, {"counterweight_radius": 0.7 * D},
    {"counterweight_radius": 2 * D, "counterweight_angle": math.pi},
    {"counterweight_radius": 2 * D, "counterweight_angle": math.pi - 1e-6},
    {"counterweight_radius": 2 * D, "counterweight_angle": math.pi / 2, "web_shape": "rectangular"},
    {"counterweight_angle": 0.0}, {"counterweight_angle": 2 * math.pi},
    {"face_inclination": math.pi / 2}, {"face_inclination": 1e-8}, {"face_inclination": math.nan},
    {"face_inclination": 0.2, "throw": 0.51 * D, "fillet": 0.0},
    {"web_shape": "heart-shaped"},
]  # fmt: skip


def sample(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI]: each length is left out, 0 where that means none, or anything in its range."""
    size = 10 ** rng.uniform(-3, 0.3)
    chosen: dict[str, Any] = {
        "journal_diameter": size,
        "web_shape": rng.choice(["obround", "rectangular"]).item(),
    }
    for name, (low, high) in RANGES.items():
        if rng.random() < 0.55:
            none = name in MAY_BE_NONE and rng.random() < 0.3
            chosen[name] = 0.0 if none else size * low * (high / low) ** rng.random()
    if rng.random() < 0.4:
        chosen["face_inclination"] = rng.uniform(0, 0.5)
    if rng.random() < 0.5:
        chosen["counterweight_angle"] = rng.choice([math.pi / 2, math.pi, rng.uniform(0.2, 3.1)]).item()
    return chosen


def refused(given: dict[str, Any]) -> set[str]:
    try:
        CrankThrow.from_si(given)
    except InvalidInputs as error:
        return {name for fault in error.faults for name in fault.names}
    return set()


def drawn(given: dict[str, Any]) -> bool:
    """Whether a solid was made of it, after a look at its dimensions; what is refused is refused by name."""
    if named := refused(given):
        assert named & set(given)
        return False
    model, result = CrankThrow.from_si(given), regenerate("crank_throw", 1, given)
    for name, value in result.dimensions.items():
        declared = CrankThrow.inputs[name]
        wanted = declared.meaning.scale.from_si(float(getattr(model, declared.attribute)))
        assert value == pytest.approx(wanted, rel=1e-12, abs=1e-6), name
    return True


def solids_among(sets: int, seed: int) -> int:
    rng = np.random.default_rng(seed)
    return sum(drawn(sample(rng)) for _ in range(sets))


def test_property_some_random_throws() -> None:
    assert 1 < solids_among(12, seed=1) < 12


@pytest.mark.slow
def test_property_many_random_throws() -> None:
    assert 50 < solids_among(700, seed=seeded(2)) < 700


@pytest.mark.parametrize("given", HOSTILE, ids=str)
@pytest.mark.sampled(9)
def test_property_hostile_throws(given: dict[str, Any]) -> None:
    bad = any(isinstance(v, float) and not (0 <= v < 1e9) for v in given.values())
    assert not (drawn({"journal_diameter": D, **given}) and bad)
