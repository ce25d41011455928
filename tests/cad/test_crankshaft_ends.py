"""Fillets, chamfers, keyway and thrust collars of a `crankshaft`: volumes, measurements, refusals."""

import math
from math import acos, pi, sqrt
from typing import Any

import numpy as np
import pytest
from seeds import seeded
from test_crankshaft_random import drawn, is_bad, refused

from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import Build, regenerate

PLAIN: dict[str, Any] = {
    "pin_angles": {"value": [0, 180], "unit": "deg"}, "journal_diameter": "50 mm", "nose_diameter": "40 mm",
    "nose_length": "50 mm", "flange_diameter": "80 mm", "flange_thickness": "20 mm", "web_width": "80 mm",
}  # fmt: skip
D = 0.05
SHAFT: dict[str, Any] = {"journal_diameter": D, "pin_angles": [0.0, math.pi]}
FEATURES = {
    "nose_fillet": (0.004, 0.15), "flange_fillet": (0.004, 0.3), "nose_chamfer": (0.004, 0.2),
    "flange_chamfer": (0.004, 0.2), "keyway_width": (0.05, 0.5), "keyway_depth": (0.03, 0.4),
    "keyway_length": (0.02, 1.2), "thrust_diameter": (1.02, 1.5), "thrust_height": (5e-4, 0.1),
}  # fmt: skip
ENDS = {
    "nose_diameter": (0.5, 1.6), "nose_length": (0.4, 2), "flange_diameter": (0.6, 3),
    "flange_thickness": (0.1, 0.8), "journal_bore": (0.1, 0.5), "fillet": (0.01, 0.1),
    "bolt_hole_diameter": (0.05, 0.2), "oil_drilling_diameter": (0.03, 0.1),
}  # fmt: skip


def build(**changes: Any) -> Build:
    return regenerate("crankshaft", 1, Crankshaft.from_quantities({**PLAIN, **changes}).inputs_si())


@pytest.fixture(scope="module")
def plain() -> float:
    return build().measures["volume"]


def ring(radius: float, size: float) -> float:
    """A fillet's section round a cylinder, integrated over the radius."""
    steps = 200_000
    x = (np.arange(steps) + 0.5) * size / steps
    return float(np.sum(2 * pi * (radius + x) * (size - np.sqrt(size**2 - (size - x) ** 2))) * size / steps)


@pytest.mark.parametrize(
    ("changes", "wanted"),
    [
        ({"nose_fillet": "2 mm", "flange_fillet": "3 mm"}, ring(20, 2) + ring(25, 3)),
        ({"nose_chamfer": "1.5 mm"}, -pi * (1.5 * 20**2 - (20**3 - 18.5**3) / 3)),
        ({"flange_chamfer": "2 mm"}, -pi * (2 * 40**2 - (40**3 - 38**3) / 3)),
        ({"thrust_main": 1, "thrust_diameter": "70 mm", "thrust_height": "1 mm"}, pi * (35**2 - 25**2)),
        ({"thrust_main": 2, "thrust_diameter": "70 mm", "thrust_height": "1 mm"}, 2 * pi * (35**2 - 25**2)),
        ({"thrust_main": 3, "thrust_diameter": "70 mm", "thrust_height": "1 mm"}, pi * (35**2 - 25**2)),
    ],
)
def test_analytic_features_change_the_volume_by_their_own(
    plain: float, changes: dict[str, Any], wanted: float
) -> None:
    assert build(**changes).measures["volume"] - plain == pytest.approx(wanted, rel=1e-5)


def test_analytic_a_keyway_removes_a_segment_strip(plain: float) -> None:
    """By the area between two chords and an arc, without a chamfer."""
    R, half, floor = 20.0, 4.0, 15.0
    angle = pi / 2 - acos(half / R)
    area = R**2 * angle + half * sqrt(R**2 - half**2) - 2 * half * floor
    measured = build(keyway_width="8 mm", keyway_depth="5 mm", keyway_length="30 mm").measures["volume"]
    assert measured - plain == pytest.approx(-area * 30, rel=1e-6)


@pytest.mark.parametrize(("nose", "flange"), [("60 mm", "40 mm"), ("50 mm", "50 mm")])
def test_each_feature_is_read_back_for_thick_noses_and_thin_flanges(nose: str, flange: str) -> None:
    """Of equal diameters there is no shoulder, so no fillet."""
    fillets = {} if nose == flange else {"nose_fillet": "1 mm", "flange_fillet": "2 mm"}
    build(
        nose_diameter=nose, flange_diameter=flange, keyway_width="8 mm", nose_chamfer="1 mm",
        flange_chamfer="1 mm", thrust_main=1, **fillets,
    )  # fmt: skip


def sample(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI] with features about a third of the way to what the rules refuse."""
    size, count = 10 ** rng.uniform(-2.3, 0), int(rng.integers(1, 4))
    chosen: dict[str, Any] = {"journal_diameter": size, "web_width": size * rng.uniform(1.4, 2)}
    chosen["pin_angles"] = rng.uniform(-3, 3, count).tolist()
    for name, (low, high) in {**FEATURES, **ENDS}.items():
        if rng.random() < (0.5 if name in FEATURES else 0.3):
            chosen[name] = size * low * (high / low) ** rng.random()
    if rng.random() < 0.7:
        chosen["thrust_main"] = float(rng.integers(0, count + 3))
    if rng.random() < 0.2:
        chosen["pin_split"] = rng.uniform(0.3, 1)
    if rng.random() < 0.2:
        chosen["face_inclination"] = rng.uniform(0.01, 0.2)
    return chosen


def test_property_some_random_ends() -> None:
    rng = np.random.default_rng(3)
    assert 2 < sum(drawn(sample(rng)) for _ in range(20)) < 20


@pytest.mark.slow
def test_property_many_random_ends() -> None:
    rng = np.random.default_rng(seeded(3702))
    assert 60 < sum(drawn(sample(rng)) for _ in range(300)) < 300


VALUES = (math.nan, math.inf, -1e-3, 0.0, 1e-9, 1e-5, 0.2 * D, 0.5 * D, D, 5.0)
HOSTILE: list[dict[str, Any]] = [
    {"keyway_width": 0.16 * D, "thrust_main": 2.0, name: value} for name in FEATURES for value in VALUES
] + [
    {"thrust_main": value} for value in (math.nan, -1.0, 1.5, 4.0, 17.0, 18.0, 1e300)
] + [
    {"nose_diameter": D, "nose_fillet": 1e-3}, {"flange_diameter": D, "flange_fillet": 1e-3},
    {"flange_diameter": 1.2 * D, "flange_fillet": 0.1 * D},
    {"nose_diameter": 1.2 * D, "nose_fillet": 0.09 * D},
    {"keyway_width": 0.2 * D, "nose_diameter": 1.4 * D}, {"keyway_width": 0.1 * D, "journal_bore": 0.6 * D},
    {"thrust_main": 1.0, "journal_length": 0.1 * D}, {"thrust_main": 2.0, "web_width": 1.25 * D},
]  # fmt: skip


@pytest.mark.parametrize("given", [
    pytest.param(given, marks=() if n % 9 == 0 else pytest.mark.slow, id=str(given)[-40:])
    for n, given in enumerate(HOSTILE)
])  # fmt: skip
@pytest.mark.sampled(4)
def test_property_hostile_ends(given: dict[str, Any]) -> None:
    assert not (drawn({**SHAFT, **given}) and is_bad(given))


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({"nose_fillet": 1e-3, "nose_diameter": D}, {"nose_fillet", "nose_diameter", "journal_diameter"}),
        ({"keyway_width": 0.6 * D}, {"keyway_width", "nose_diameter", "nose_chamfer", "keyway_depth"}),
        ({"thrust_main": 4.0}, {"thrust_main", "pin_angles"}),
        ({"thrust_main": 1.0, "thrust_diameter": 2 * D}, {"thrust_main", "thrust_diameter", "web_width"}),
    ],
)
def test_what_does_not_fit_is_refused_by_name(changes: dict[str, Any], names: set[str]) -> None:
    assert refused({**SHAFT, **changes}) == names
