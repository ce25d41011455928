"""A main bearing housing with shoulders, bulkhead, bolts and dowels: volumes, places, overlaps, analyses."""

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from cadquery import Shape
from part21_reader import File
from seeds import seeded
from test_bearing_parts import drawn

from cad.model import mm
from cad.models.bearing_housing_v1 import BearingHousing
from cad.overlaps import overlaps
from cad.regenerate import Build, as_text, regenerate_class
from cad.shells.bore_place import bore_place
from cad.step import Body, read_step, rigid
from templates.core.errors import InvalidInputs

PLAIN: dict[str, Any] = {
    "housing_bore": "50 mm", "housing_width": "25 mm", "housing_breadth": "110 mm", "block_height": "70 mm",
    "cap_height": "45 mm", "bolt_hole_diameter": "11 mm", "bolt_spacing": "78 mm", "bolt_hole_depth": "50 mm",
}  # fmt: skip


def build(**changes: Any) -> Build:
    given = {**PLAIN, **changes}
    return regenerate_class(BearingHousing, as_text(BearingHousing.from_quantities(given)))


def volumes(made: Build) -> dict[str, float]:
    return {body.name: Shape.cast(body.shape.wrapped).Volume() for body in read_step(made.step)}


@pytest.fixture(scope="module")
def plain() -> dict[str, float]:
    return volumes(build())


@pytest.fixture(scope="module")
def example() -> Build:
    return regenerate_class(BearingHousing, as_text(BearingHousing.from_quantities(BearingHousing.example)))


def test_without_the_new_features_it_is_two_boxes(plain: dict[str, float]) -> None:
    half, hole = pi * 25**2 / 2, pi * 5.5**2
    drilling = 8.7e2  # about that of 5 mm from the bore to the top
    assert plain.keys() == {"block", "cap"}
    assert plain["cap"] == pytest.approx(25 * (110 * 45 - half) - 2 * hole * 45, rel=1e-9)
    assert plain["block"] == pytest.approx(25 * (110 * 70 - half) - 2 * hole * 50 - drilling, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "part", "wanted"),
    [
        ({"shoulder_depth": "15 mm", "crown_width": "60 mm"}, "cap", -25 * 50 * 15 + 2 * pi * 5.5**2 * 15),
        ({"bulkhead_thickness": "15 mm", "saddle_height": "42 mm"}, "block", -110 * 28 * 10),
        ({"bolt_diameter": "10 mm"}, "block", 2 * pi * 50 * (5.5**2 - 5**2)),
        ({"dowel_diameter": "15 mm", "dowel_length": "14 mm"}, "cap", -2 * pi * 7 * (7.5**2 - 5.5**2)),
        ({"dowel_diameter": "15 mm", "dowel_length": "14 mm"}, "block", -2 * pi * 7 * (7.5**2 - 5.5**2)),
    ],
)
def test_analytic_features_change_the_volume_by_their_own(
    plain: dict[str, float], changes: dict[str, Any], part: str, wanted: float
) -> None:
    assert volumes(build(**changes))[part] == pytest.approx(plain[part] + wanted, rel=1e-7)


def test_analytic_bolts_and_dowels_have_their_volumes(example: Build) -> None:
    found = volumes(example)
    assert found["bolt"] == pytest.approx(pi * 25 * 70 + sqrt(3) / 2 * 16**2 * 6.4, rel=1e-9)
    assert found["dowel"] == pytest.approx(pi * (7**2 - 5.5**2) * 16, rel=1e-9)


def test_bolts_stand_on_their_seats_and_touch_nothing_but_seats_and_threads(example: Build) -> None:
    bodies = {body.name: body for body in read_step(example.step)}
    for name, height in (("bolt", -29.0), ("dowel", -8.0)):
        turns, shifts = zip(*(rigid(place) for place in bodies[name].places), strict=True)
        assert np.allclose(shifts, [[-39, height, 0], [39, height, 0]], atol=1e-9)
        assert all(np.allclose(turn[:, 2], [0, 1, 0], atol=1e-12) for turn in turns)
    assert not list(overlaps([*bodies.values()]))


def test_a_bolt_that_is_moved_into_the_cap_overlaps_it(example: Build) -> None:
    """So that the test above can fail."""
    cap, bolt = (next(b for b in read_step(example.step) if b.name == name) for name in ("cap", "bolt"))
    moved = Body("bolt", bolt.shape.translate((0, 0, 1.0)), bolt.colour, bolt.places)
    head = sqrt(3) / 2 * 16**2 - pi * 5.5**2
    (first, _) = overlaps([cap, moved])
    assert first.volume == pytest.approx(head, rel=1e-6)


def test_tolerances_of_bolts_are_drawn_where_the_bolts_stand() -> None:
    texts = as_text(BearingHousing.from_quantities(BearingHousing.example))
    texts["bolt_head_height"] += " ±0.1 mm"
    made = regenerate_class(BearingHousing, texts)
    ((name, lines),) = File(made.step).lines()
    ends = np.array(lines)[-2:].reshape(-1, 3)
    assert name == "bolt_head_height"
    levels = np.abs(ends[:, 1:2] - [-29.0, -35.4]).min(axis=0)
    assert levels == pytest.approx([0, 0], abs=1e-9)


def test_finite_elements_take_the_solids_about_the_bore(example: Build) -> None:
    model = BearingHousing.from_quantities(BearingHousing.example)
    place = bore_place(model)
    assert place is not None
    names = [name for body in read_step(example.step) for name in body.names]
    assert names[: place.solids] == ["block", "cap", "dowel_1", "dowel_2"]
    assert mm(model.H_b) == place.held_at
    assert bore_place(BearingHousing.from_quantities(PLAIN)).solids == 2  # type: ignore[union-attr]


RANGES = {
    "shoulder_depth": (0.1, 0.5), "crown_width": (0.5, 1.4), "bulkhead_thickness": (0.15, 0.45),
    "saddle_height": (0.55, 1.1), "bolt_diameter": (0.11, 0.21), "bolt_length": (0.5, 1.6),
    "bolt_head_width": (0.15, 0.4), "bolt_head_height": (0.05, 0.3), "dowel_diameter": (0.2, 0.35),
    "dowel_length": (0.05, 0.6),
}  # fmt: skip


def sample(rng: np.random.Generator) -> dict[str, Any]:
    """Random parameters [SI] whose features fit more often than not, each left out now and then."""
    size = 10 ** rng.uniform(-2, -0.2)
    given: dict[str, Any] = {"housing_bore": size, "housing_width": size * rng.uniform(0.4, 0.8)}
    given["bolt_spacing"] = size * rng.uniform(1.3, 1.8)
    given["housing_breadth"] = given["bolt_spacing"] + size * rng.uniform(0.3, 0.6)
    for name, (low, high) in RANGES.items():
        if rng.random() < 0.6:
            given[name] = size * low * (high / low) ** rng.random()
    return given


def test_property_some_random_housings() -> None:
    rng = np.random.default_rng(4)
    assert 3 < sum(drawn(BearingHousing, sample(rng)) for _ in range(20)) < 20


@pytest.mark.slow
def test_property_many_random_housings() -> None:
    rng = np.random.default_rng(seeded(3703))
    assert 45 < sum(drawn(BearingHousing, sample(rng)) for _ in range(300)) < 300


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({"bolt_diameter": "12 mm"}, {"bolt_diameter", "bolt_hole_diameter"}),
        ({"dowel_diameter": "11 mm"}, {"dowel_diameter", "bolt_hole_diameter"}),
        ({"shoulder_depth": "15 mm", "crown_width": "70 mm"},
         {"shoulder_depth", "crown_width", "bolt_spacing", "bolt_hole_diameter", "bolt_head_width"}),
        ({"bulkhead_thickness": "10 mm"},
         {"bulkhead_thickness", "bolt_hole_diameter", "oil_drilling_diameter"}),
        ({"bolt_diameter": "10 mm", "bolt_length": "100 mm"},
         {"bolt_diameter", "bolt_length", "bolt_hole_depth", "cap_height"}),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_by_name(changes: dict[str, Any], names: set[str]) -> None:
    with pytest.raises(InvalidInputs) as caught:
        BearingHousing.from_quantities({**PLAIN, **changes})
    assert {name for fault in caught.value.faults for name in fault.names} == names
