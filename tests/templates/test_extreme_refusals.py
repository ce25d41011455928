"""Inputs on which templates failed or returned rounding noise: each is refused by name, or has a reason."""

import numpy as np
import pytest
from test_catalogue_properties import starting, typed

from templates import get
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

REFUSED = [
    ("measured_curves", {"measured_film": [3.4e-6]}, "measured_film"),
    ("engine", {"rod_length": [1.45e-4, 1.07e-4]}, "rod_length"),
    ("engine", {"gas_cycle": "table", "pressure_angle": np.linspace(0, 4 * np.pi, 9)[:-1]}, "pressure"),
    ("engine", {"web_thickness": 1e-9}, "elastic_main_load_x"),
    ("engine", {"web_thickness": 1e-6, "cylinder_positions": [0.2, 0.2]}, "elastic_main_load_x"),
    ("mixed_friction", {"bearing_roughness": 4e-5}, "journal_roughness"),
    ("mixed_friction", {"journal_roughness": 9e-6}, "journal_roughness"),
]


@pytest.mark.parametrize(("name", "changes", "refused"), REFUSED)
def test_refused_by_name(name, changes, refused):
    cls = get(name, 1).template
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(cls, typed(cls, {**starting(cls), **changes}))
    assert refused in {fault.name for fault in refusal.value.faults}


def test_a_pad_whose_hole_is_wider_than_itself_has_no_area():
    cls = get("hydrostatic_pad", 1).template
    annular = {"inner_diameter": np.array([0.01, 0.2]), "recess_inner_diameter": np.array([0.02, 0.03])}
    area = evaluate(cls, typed(cls, {**starting(cls), **annular}), outputs=["pad_area"]).outputs["pad_area"]
    assert np.isnan(area.value).tolist() == [False, True]
    assert area.reasons[1]


def test_a_list_of_one_value_is_as_good_as_a_number_for_what_may_be_constant():
    cls = get("engine", 1).template
    start, names = starting(cls), ["mean_torque"]
    answers = [
        evaluate(cls, typed(cls, {**start, "bore": bore}), outputs=names).outputs["mean_torque"].value
        for bore in (0.086, [0.086], [0.086, 0.086])
    ]
    assert answers == pytest.approx([answers[0]] * 3, rel=1e-12)


def test_what_is_borne_for_1000_cycles_is_below_the_ultimate_strength():
    """Shigley takes 0.9 of it below 70 ksi; his line gave 1.86 at 50 MPa. Above it nothing changes."""
    cls = get("fatigue_life", 1).template
    strengths = {"ultimate_strength": np.array([50e6, 300e6, 480e6, 800e6])}
    raw = typed(cls, {**starting(cls), **strengths})
    share = evaluate(cls, raw, outputs=["strength_share"]).outputs["strength_share"].value
    assert share == pytest.approx([0.9, 0.9, 0.9, 0.8249588882], rel=1e-9)


def test_a_point_whose_groove_is_wider_than_the_bearing_has_its_reason_at_level_supplied():
    cls = get("oil_film_cycle", 1).template
    narrow = typed(cls, {**starting(cls), "bearing_width": np.array([1e-9, 1e-12])})
    film = evaluate(cls, narrow, outputs=["supply_flow"], level="supplied").outputs["supply_flow"]
    assert np.isnan(film.value).all()
    assert all(film.reasons)


def test_a_film_without_viscosity_has_its_reason_at_level_field():
    cls = get("thermal_film", 1).template
    thin = typed(cls, {**starting(cls), "reference_density": np.array([5e-324, 5e-324])})
    film = evaluate(cls, thin, outputs=["minimum_film_thickness"], level="field")
    assert all(film.outputs["minimum_film_thickness"].reasons)
