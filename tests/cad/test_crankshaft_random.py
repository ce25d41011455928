"""Random and hostile parameters of `crankshaft` give a checked solid, or a refusal by name before drawing."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from seeds import seeded
from test_cranks_random import HOSTILE as HOSTILE_THROWS
from test_cranks_random import MAY_BE_NONE, RANGES

from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import as_text, regenerate
from templates.core.errors import InvalidInputs

ENDS = {
    "nose_length": (0.2, 3), "nose_diameter": (0.4, 2.5), "flange_thickness": (0.1, 1),
    "flange_diameter": (0.4, 3), "bolt_hole_diameter": (0.02, 0.4), "bolt_circle_diameter": (0.5, 2.5),
    "bolt_hole_depth": (0.05, 0.8),
}  # fmt: skip
COMMON = (0.0, math.pi / 2, math.pi, 2 * math.pi / 3, -math.pi / 2, 3 * math.pi)

D = 0.055
PINS = [0.0, math.pi / 2]
HOSTILE: list[dict[str, Any]] = [
    {"pin_angles": value} for value in (
        0.0, [], [math.nan], [0.0, math.inf], [1e300], [0.0] * 17, [0.0] * 5000, [[0.0, 1.0]], [[[0.0]]],
        [1e-300], [4 * math.pi], [4 * math.pi + 1e-9], [0.0, 0.0], [1e-9, 0.0], [-1e-13],
    )
] + [
    {"counterweight_radius": value} for value in (
        [], [2 * D], [2 * D] * 3, [2 * D] * 4, [2 * D, 0, 0, math.nan], [-D] * 4, [0.0] * 4, [1e-9] * 4,
        [[2 * D] * 4], [2 * D, 0.72 * D, 0, 0], [9.9, 0, 0, 0], 9.9, [2 * D] * 1000,
    )
] + [
    {name: value}
    for name in ("nose_length", "nose_diameter", "flange_thickness", "flange_diameter")
    for value in (math.nan, -1e-3, 0.0, 1e-9, D, 10.0)
] + [
    {"nose_diameter": D, "journal_bore": 0.9 * D}, {"flange_diameter": 0.3 * D, "journal_bore": 0.3 * D},
    {"flange_diameter": 3 * D, "flange_thickness": 1e-4},
    {"bolt_hole_diameter": 1e-9}, {"bolt_hole_diameter": D}, {"bolt_hole_diameter": -1e-3},
    {"bolt_hole_diameter": 0.1 * D, "bolt_holes": 1}, {"bolt_hole_diameter": 0.1 * D, "bolt_holes": 2},
    {"bolt_hole_diameter": 0.1 * D, "bolt_holes": 64}, {"bolt_hole_diameter": 0.1 * D, "bolt_holes": 0},
    {"bolt_hole_diameter": 0.1 * D, "bolt_holes": 2.5}, {"bolt_holes": 1e12},
    {"bolt_hole_diameter": 0.1 * D, "bolt_circle_diameter": 0.1 * D},
    {"bolt_hole_diameter": 0.1 * D, "bolt_circle_diameter": D},
    {"bolt_hole_diameter": 0.1 * D, "bolt_circle_diameter": 1.5 * D},
    {"bolt_hole_diameter": 0.1 * D, "bolt_hole_depth": 1e-5},
    {"bolt_hole_diameter": 0.1 * D, "bolt_hole_depth": 0.3 * D},
    {"bolt_hole_diameter": 0.1 * D, "bolt_hole_depth": 0.285 * D},
    {"bolt_hole_diameter": 0.1 * D, "bolt_circle_diameter": 0.6 * D, "journal_bore": 0.45 * D},
]  # fmt: skip

SPLITS = (math.pi / 6, -math.pi / 6, math.pi / 3, math.pi, -2 * math.pi / 3, 2 * math.pi)
HOSTILE_SPLITS: list[dict[str, Any]] = [
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


def sample(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI]: each length is left out, 0 where that means none, or anything in its range."""
    size = 10 ** rng.uniform(-2.5, 0.3)
    count = int(rng.integers(1, 6))
    angles = [rng.choice(COMMON) if rng.random() < 0.5 else rng.uniform(-7, 12) for _ in range(count)]
    chosen: dict[str, Any] = {"journal_diameter": size, "pin_angles": [float(a) for a in angles]}
    chosen["web_shape"] = rng.choice(["obround", "rectangular"]).item()
    for name, (low, high) in {**RANGES, **ENDS}.items():
        if name != "counterweight_radius" and rng.random() < 0.4:
            none = name in MAY_BE_NONE and rng.random() < 0.3
            chosen[name] = 0.0 if none else size * low * (high / low) ** rng.random()
    if rng.random() < 0.6:
        heavy = rng.random(2 * count) < 0.6
        radii = (heavy * size * rng.uniform(1.1, 3, 2 * count)).tolist()
        chosen["counterweight_radius"] = radii if rng.random() < 0.7 else max(radii)
    if rng.random() < 0.3:
        chosen["face_inclination"] = rng.uniform(0, 0.4)
    if rng.random() < 0.5:
        chosen["counterweight_angle"] = rng.choice([math.pi / 2, math.pi, rng.uniform(0.2, 3.1)]).item()
    if rng.random() < 0.3:
        chosen["bolt_holes"] = float(rng.integers(1, 13))
    return chosen


def random_split(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI] of a shaft whose pins are split in most cases."""
    given = sample(rng)
    given["pin_split"] = float(rng.choice(SPLITS) if rng.random() < 0.7 else rng.uniform(-6, 6))
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
    """Whether a solid was made of it, after a look at its dimensions; what is refused is refused by name."""
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


def solids_among(sets: int, seed: int, sampled: Callable[[np.random.Generator], dict[str, Any]]) -> int:
    rng = np.random.default_rng(seed)
    return sum(drawn(sampled(rng)) for _ in range(sets))


def test_property_some_random_crankshafts() -> None:
    assert 2 < solids_among(10, 5, sample) < 10


def short_mains(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI] of one throw, its main journals shorter than two fillets."""
    given = {**sample(rng), "pin_angles": [0.0]}
    given["counterweight_radius"] = float(np.max(given.get("counterweight_radius", 0.0)))
    given["journal_length"] = given["journal_diameter"] * 10 ** rng.uniform(-2, 0)
    given["fillet"] = given["journal_length"] * rng.uniform(0.51, 0.89)
    return given


def test_property_one_throw_takes_mains_shorter_than_two_fillets() -> None:
    """Each main then has one fillet; between two throws it has two, which do not fit."""
    rng = np.random.default_rng(8)
    accepted = [given for given in (short_mains(rng) for _ in range(60)) if not refused(given)]
    assert len(accepted) > 5
    assert all(map(drawn, accepted[:3]))
    between = {"pin_angles": [0.0, math.pi / 2]}
    assert all({"fillet", "journal_length"} <= refused({**given, **between}) for given in accepted)


@pytest.mark.slow
def test_property_many_shafts_of_one_throw_with_short_mains() -> None:
    assert solids_among(300, seeded(9), short_mains) > 20


@pytest.mark.slow
def test_property_many_random_crankshafts() -> None:
    assert 60 < solids_among(300, seeded(6), sample) < 300


def is_bad(given: dict[str, Any]) -> bool:
    numbers = [value for v in given.values() if not isinstance(v, str) for value in np.ravel(v).tolist()]
    signed = [value for name, v in given.items() if name != "pin_angles" for value in np.ravel(v).tolist()
              if not isinstance(value, str)]  # fmt: skip
    return not all(abs(value) < 1e9 for value in numbers) or any(value < 0 for value in signed)


@pytest.mark.parametrize("given", [*HOSTILE[::6], *HOSTILE_THROWS[::8]], ids=lambda given: str(given)[:60])
@pytest.mark.sampled(2)
def test_property_some_hostile_crankshafts(given: dict[str, Any]) -> None:
    assert not (drawn({"journal_diameter": D, "pin_angles": PINS, **given}) and is_bad(given))


@pytest.mark.slow
@pytest.mark.parametrize("given", [*HOSTILE, *HOSTILE_THROWS], ids=lambda given: str(given)[:60])
def test_property_hostile_crankshafts(given: dict[str, Any]) -> None:
    assert not (drawn({"journal_diameter": D, "pin_angles": PINS, **given}) and is_bad(given))


def test_property_some_random_split_pins() -> None:
    assert 1 <= solids_among(4, 5, random_split) < 4


@pytest.mark.slow
def test_property_many_random_split_pins() -> None:
    assert 60 < solids_among(300, seeded(6), random_split) < 300


@pytest.mark.parametrize(
    "given",
    [
        pytest.param(given, marks=() if n % 7 == 0 else pytest.mark.slow, id=str(given)[:60])
        for n, given in enumerate(HOSTILE_SPLITS)
    ],
)
def test_property_hostile_split_pins(given: dict[str, Any]) -> None:
    flat = any(size < 1e-6 for name, size in given.items() if name.startswith("middle"))
    bad = flat or not all(abs(value) < 1e9 for one in given.values() for value in np.ravel(one).tolist())
    assert not (drawn({"journal_diameter": D, "pin_angles": PINS, **given}) and bad)
