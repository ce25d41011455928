"""Random and hostile split pins of `crankshaft` 1: a checked solid, or a refusal by name before drawing."""

import math
from typing import Any

import numpy as np
import pytest
from seeds import seeded
from test_crankshaft_random import sample

from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import as_text, regenerate
from templates.core.errors import InvalidInputs

COMMON = (math.pi / 6, -math.pi / 6, math.pi / 3, math.pi, -2 * math.pi / 3, 2 * math.pi)
D = 0.055
HOSTILE: list[dict[str, Any]] = [
    {"pin_split": value} for value in (
        math.nan, math.inf, 1e300, 7.0, [0.5], [0.5, 0.5], 1e-12, 1e-6, math.radians(0.9), math.radians(1.1),
        math.pi, -math.pi, math.pi - 1e-9, math.pi + 1e-3,
    )
] + [
    {"pin_split": 0.5, name: value}
    for name in ("middle_web_thickness", "middle_web_width")
    for value in (math.nan, -1e-3, 0.0, 1e-9, D, 2 * D, 9.9)
] + [
    {"pin_split": 0.5, "oil_drilling_diameter": 0.1 * D, "pin_angles": [0.0, 0.5]},
    {"pin_split": 0.5, "oil_drilling_diameter": 0.1 * D, "pin_angles": [0.0, 0.8]},
    {"pin_split": 0.5, "journal_bore": 0.3 * D}, {"pin_split": 2.5, "journal_bore": 0.1 * D},
    {"pin_split": 0.5, "pin_bore": 0.3 * D}, {"pin_split": 0.01, "middle_web_width": 5.0},
]  # fmt: skip


def random_split(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI] of a shaft whose pins are split in most cases."""
    given = sample(rng)
    given["pin_split"] = float(rng.choice(COMMON) if rng.random() < 0.7 else rng.uniform(-6, 6))
    for name, (low, high) in {"middle_web_thickness": (0.05, 0.5), "middle_web_width": (0.9, 2)}.items():
        if rng.random() < 0.4:
            given[name] = given["journal_diameter"] * rng.uniform(low, high)
    return given


def refused(given: dict[str, Any]) -> set[str]:
    try:
        as_text(Crankshaft.from_si(given))
    except InvalidInputs as error:
        return {name for fault in error.faults for name in fault.names}
    return set()


def drawn(given: dict[str, Any]) -> bool:
    """Return whether a solid was made of it, its dimensions compared; what is refused is refused by name."""
    if named := refused(given):
        assert named & set(given)
        return False
    model, result = Crankshaft.from_si(given), regenerate("crankshaft", 1, given)
    for name, value in result.dimensions.items():
        declared = Crankshaft.inputs[name]
        wanted = np.asarray(declared.meaning.scale.from_si(getattr(model, declared.attribute)))
        each = np.broadcast_to(wanted, np.shape(value)).tolist()
        assert value == pytest.approx(each, rel=1e-12, abs=1e-6), name
    return True


def solids_among(sets: int, seed: int) -> int:
    rng = np.random.default_rng(seed)
    return sum(drawn(random_split(rng)) for _ in range(sets))


def test_property_some_random_split_pins() -> None:
    assert 1 <= solids_among(4, seed=5) < 4


@pytest.mark.slow
def test_property_many_random_split_pins() -> None:
    assert 60 < solids_among(300, seed=seeded(6)) < 300


def is_bad(given: dict[str, Any]) -> bool:
    numbers = [value for v in given.values() for value in np.ravel(v).tolist()]
    sizes = [value for name, value in given.items() if name.startswith("middle")]
    return not all(abs(value) < 1e9 for value in numbers) or any(size < 1e-6 for size in sizes)


@pytest.mark.parametrize(
    "given",
    [
        pytest.param(given, marks=() if n % 7 == 0 else pytest.mark.slow, id=str(given)[:60])
        for n, given in enumerate(HOSTILE)
    ],
)
def test_property_hostile_split_pins(given: dict[str, Any]) -> None:
    assert not (drawn({"journal_diameter": D, "pin_angles": [0.0, math.pi / 2], **given}) and is_bad(given))
