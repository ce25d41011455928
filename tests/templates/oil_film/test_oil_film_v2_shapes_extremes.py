"""`oil_film` 2 over the ranges of physics.md, section 5: finite, or without a value and with the reason."""

import numpy as np
import pytest
from bearings import assert_finite_or_reasoned, bearing, drawn_bearings, si
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm

REFUSED = {"relative_eccentricity", "hydrodynamic_speed", "load_speed"}
"""What refuses: nothing bears the load, nothing turns, or a lobed sleeve turns."""


@pytest.mark.slow
@pytest.mark.parametrize("level", ["short_bearing", "fit", "map"])
def test_property_a_hundred_thousand_plain_bearings(level):
    rng, n = np.random.default_rng(seeded(41)), 100_000
    raw = {**drawn_bearings(rng, n), "start_line": str(rng.choice(["fixed", "moving"]))}
    answers = evaluate(OilFilm, raw, level=level).outputs
    assert_finite_or_reasoned(answers, n)
    assert np.isfinite(answers["minimum_film_thickness"].value).sum() > n / 20


def shaped(rng):
    """A bearing of any load, width, bore and tilt, fed anyhow."""
    kind = str(rng.choice(["plain", "lemon", "offset", "multi_lobe"]))
    raw = bearing(
        10 ** rng.uniform(-8, 6) * (rng.random() > 0.05),
        10 ** rng.uniform(-2, 2),
        speed=si(rng.choice([-1, 0, 1], p=[0.3, 0.05, 0.65]) * 10 ** rng.uniform(-3, 4), "rad/s"),
        load_speed=si(rng.choice([0.0, -30.0], p=[0.9, 0.1]), "rad/s"),
        bore_shape=kind,
        start_line=str(rng.choice(["fixed", "moving"])),
        lobes=int(rng.integers(2, 9)),
        preload=0.0 if kind == "plain" else rng.uniform(0, 0.95),
        lobe_angle=si(np.radians(rng.uniform(-360, 720)), "rad"),
    )
    if rng.random() < 0.5:
        raw |= {f"tilt_{way}_load": si(10 ** rng.uniform(-9, -2.5), "rad") for way in ("along", "across")}
    if rng.random() < 0.3:
        width = raw["bearing_width"].si
        raw |= {"bell_mouth_depth": si(10 ** rng.uniform(-8, -4), "m"),
                "bell_mouth_length": si(width * rng.uniform(0.01, 0.5), "m")}  # fmt: skip
    if rng.random() < 0.4:
        rows = [[rng.uniform(-360, 720), rng.uniform(0, 80)] for _ in range(int(rng.integers(1, 4)))]
        raw |= {"grooves": si(np.radians(rows), "rad")}
        raw |= {"supply_pressure": si(rng.choice([0.0, 10 ** rng.uniform(2, 7)]), "Pa")}
    return raw


def answered(raw, level):
    """Whether it has an answer; else it is refused by one of few names."""
    try:
        answers = evaluate(OilFilm, raw, level=level).outputs
    except InvalidInputs as refusal:
        if unexpected := {fault.name for fault in refusal.faults} - REFUSED:
            pytest.fail(f"{unexpected} refuse {raw}")
        return False
    assert_finite_or_reasoned(answers, 1)
    return True


@pytest.mark.sampled(1)
@pytest.mark.parametrize("level", [None, "reynolds"])
def test_property_a_few_shaped_bearings(level):
    rng = np.random.default_rng(46)
    assert sum(answered(shaped(rng), level) for _ in range(4)) >= 2


@pytest.mark.slow
@pytest.mark.parametrize("level", ["reynolds", "mass_conserving"])
def test_property_three_hundred_shaped_bearings(level):
    rng = np.random.default_rng(seeded(42))
    assert sum(answered(shaped(rng), level) for _ in range(300)) >= 100
