"""Engines of every layout become valid designs whose engine and films are calculated without faults."""

from itertools import pairwise

import numpy as np
import pytest
from engine_fields import CATALOGUES, FOUR, calculated, gas_table, output, scaled

from app.designs.bodies import DesignIn
from app.designs.document import assumed_values
from app.web.engine_bearings.fields import Typing
from app.web.engine_bearings.gas import diagram_of
from app.web.engine_bearings.layouts import LAYOUTS
from app.web.engine_bearings.proposal import propose, proposed, proposed_values

TWENTY = [
    *(scaled(layout, bore) for layout, bore in zip(LAYOUTS, np.linspace(60, 130, len(LAYOUTS)), strict=True)),
    scaled("in_line_6", 128, "diesel", "SAE 15W-40"),
    scaled("v12_60", 165, "diesel", "SAE 40"),
    scaled("in_line_1", 50, "petrol", "ISO VG 46"),
    scaled("boxer_6", 102, "petrol", "0W-20"),
]
FEW = [TWENTY[n] for n in (0, 7, 9, 14)]


def check_engine(typed):
    """The design is valid, its cylinders fire evenly, and its pins and bearings fit between the webs."""
    layout = LAYOUTS[typed["layout"]]
    proposal = propose(typed)
    assert proposal.faults == {}
    DesignIn.model_validate(proposal.document)
    assert len(proposal.document["variants"]) == layout.mains + layout.cylinders
    result = calculated(proposal.document)
    ignitions = np.sort(output(result, "engine", "ignition_angles"))
    gaps = np.diff([*ignitions, ignitions[0] + 720])
    assert np.allclose(gaps, 720 / layout.cylinders) != layout.is_uneven
    assert np.all(output(result, "engine", "elastic_main_load_max") > 0)
    assert np.all(output(result, "engine", "mean_torque") > 0)
    sizes = {name: float(result.values[name].value) for name in proposal.offers if name != "firing_order"}
    room = sizes["throw_pitch"] - sizes["crankpin_length"] - 2 * sizes["web_thickness"]
    assert 0 < sizes["main_width"] < room
    assert layout.rods_per_throw * sizes["big_end_width"] < sizes["crankpin_length"]
    assert sizes["crankpin_diameter"] < sizes["journal_diameter"]
    return result


@pytest.mark.parametrize("typed", FEW, ids=lambda typed: typed["layout"])
def test_property_a_few_engines_are_calculated(typed):
    check_engine(typed)


@pytest.mark.slow
@pytest.mark.parametrize("typed", TWENTY, ids=lambda typed: f"{typed['layout']}-{typed['bore']}")
def test_property_twenty_engines_are_calculated(typed):
    check_engine(typed)


@pytest.mark.slow
@pytest.mark.parametrize("number", [3, 7, 9, 14, 16])
def test_property_films_of_a_handful_are_found(number):
    """The most loaded main bearing and a big end have a film, and a verdict on it."""
    document = propose(TWENTY[number]).document
    loads = output(calculated(document), "engine", "elastic_main_load_max")
    for variant in (f"main_{int(np.argmax(loads)) + 1}", "big_end_1"):
        result = calculated(document, variant, tuple(document["steps"]))
        assert result.evaluations["film"].outputs["verdict"].value in ("repeating", "wandering")
        assert 0 < output(result, "film", "minimum_film_thickness") < 50  # um
        if "heat" in document["steps"]:
            assert output(result, "heat", "film_temperature") > 100  # degC, that of the supply


def test_analytic_the_groove_of_a_cap_lies_opposite_to_the_rod():
    """The rod's direction at crank angle 0 from the positions of its two eyes, not from the formula."""
    document = propose(scaled("v6_60", 86)).document
    document["steps"]["film"]["level"] = "mobility_grooved"  # its film is found in no time
    result = calculated(document)
    pins, r, rod = np.radians(output(result, "engine", "crankpin_angles")), 1.05 * 86 / 2, 1.75 * 86
    for n, bank in enumerate(np.radians(LAYOUTS["v6_60"].banks), 1):
        pin, axis = r * np.exp(1j * pins[n - 1]), np.exp(1j * bank)
        along = (pin / axis).real + np.sqrt(rod**2 - (pin / axis).imag ** 2)
        direction = np.angle(along * axis - pin, deg=True)
        film = calculated(document, f"big_end_{n}", ("engine", "film"))
        start = float(np.degrees(film.values["film.groove_start"].value))
        assert np.exp(1j * np.radians(start + 90 - direction)) == pytest.approx(-1, abs=1e-9)


def test_a_proposal_is_assumed_until_its_value_changes():
    document = propose(FOUR).document
    assert set(document["assumed"]) == set(proposed(LAYOUTS["in_line_4"], "petrol"))
    assert all(one["source"] for one in document["assumed"].values())
    given = propose({**FOUR, "journal_diameter": "58", "firing_order": "1-2-4-3"}).document
    assert set(document["assumed"]) - set(given["assumed"]) == {"journal_diameter", "firing_order"}
    assert given["parameters"]["journal_diameter"] == "58 mm"
    assert given["parameters"]["firing_order"] == [1, 2, 4, 3]
    changed = {**document, "parameters": {**document["parameters"], "main_clearance": "60 um"}}
    assert set(document["assumed"]) - set(assumed_values(changed)) == {"main_clearance"}


@pytest.mark.parametrize(
    ("field", "text", "words"),
    [
        ("layout", "", "choose the layout"),
        ("bore", "", "give the bore"),
        ("stroke", "86 kg", "length is wanted"),
        ("speed", "4,500 rpm", "4500 rpm if thousands are meant"),
        ("oil", "5W-3O", "name a grade, such as SAE 5W-30"),
        ("oil", "12 mm**2/s", "name a grade"),
        ("firing_order", "1-3-3-2", "each of the 4 cylinders once"),
        ("main_clearance", "0.05 MPa", "length is wanted"),
        ("gas", "diagram", "choose the file"),
    ],
)
def test_a_wrong_field_is_refused_with_its_remedy(field, text, words):
    faults = propose({**FOUR, field: text}).faults
    assert set(faults) == {"diagram" if field == "gas" else field}
    assert words in "".join(faults.values())


def test_analytic_values_of_the_proposals_follow_the_bore():
    proposal = propose({**FOUR, "bore": "100"})
    values = proposed_values(proposal.parameters, proposal.offers, CATALOGUES)
    assert values["journal_diameter"] == "= 65 mm"
    assert values["main_clearance"] == "= 0.065 mm"
    partly = propose({"layout": "in_line_4", "bore": "100"})
    assert "rod_centre" not in proposed_values(partly.parameters, partly.offers, CATALOGUES)


def test_analytic_bare_numbers_are_in_the_units_of_the_page():
    """The same engine typed in inches, pounds and pound-inches, by the definitions of inch and pound."""
    inch, pound = 25.4, 0.45359237  # mm, kg
    factors = {"bore": inch, "stroke": inch, "rod_length": inch, "piston_mass": pound, "rod_mass": pound}
    us = dict.fromkeys(factors, 3.0) | {"crank_unbalance": -0.7, "permissible_film": 0.05, "speed": 4500}
    factors |= {"crank_unbalance": pound * inch, "permissible_film": inch, "speed": 1}
    si = {name: f"{number * factors[name]:.12g}" for name, number in us.items()}
    own, other = (
        propose({**FOUR, **{name: str(text) for name, text in typed.items()}}, typing=typing)
        for typed, typing in ((us, Typing("us")), (si, Typing()))
    )
    loads = [output(calculated(one.document), "engine", "elastic_main_load_max") for one in (own, other)]
    assert loads[0] == pytest.approx(loads[1], rel=1e-9)
    assert own.parameters["bore"] == "3.0 inch"
    assert own.parameters["speed"] == "4500 rpm"
    values = proposed_values(own.parameters, own.offers, CATALOGUES, "us")
    assert values["journal_diameter"] == "= 1.95 in"
    assert values["supply_pressure"] == "= 58.015 psi"


def test_a_comma_is_a_decimal_sign_on_a_page_with_decimal_commas():
    typed = {**FOUR, "speed": "4,500 rpm", "piston_mass": "0,58"}
    assert set(propose(typed).faults) == {"speed"}
    proposal = propose(typed, typing=Typing(has_comma=True))
    assert proposal.faults == {}
    assert proposal.parameters["speed"] == "4.500 rpm"
    assert proposal.parameters["piston_mass"] == "0.58 kg"


def test_analytic_a_diagram_counted_from_combustion_loads_the_engine_alike():
    """The same cycle from 0 to 720° and from −360 to 360°, absolute and gauge, gives the same torque."""
    heads = ("crank angle [deg];pressure [bar(a)]", "crank angle [deg];pressure [bar(g)]")
    tables = (
        gas_table(head=heads[0], lowest=1.0),
        gas_table(first=-360, last=355, peak_at=10, head=heads[0], lowest=1.0),
        gas_table(first=-360, last=355, peak_at=10, head=heads[1], lowest=0.0),
    )
    torques = [
        output(
            calculated(propose({**FOUR, "gas": "diagram"}, diagram_of(table)).document),
            "engine",
            "mean_torque",
        )
        for table in tables
    ]
    for one, other in pairwise(torques):
        assert one == pytest.approx(other, rel=1e-9)
