"""Physical plausibility of a film over HTTP: impossible values are named; limits from the library."""

import pytest
from serving import API, problem

FILM = f"{API}/templates/oil_film/versions/2"
BEARING = {
    "radial_load": "25 kN",
    "diametral_clearance": "0.055 mm",
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "speed": "5000 rpm",
    "oil_inlet_temperature": "80 degC",
    "oil_outlet_temperature": "87.762 degC",
    "journal_roughness": "0.2 um",
    "bearing_roughness": "0.4 um",
}
IMPOSSIBLE = {
    "film_below_roughness", "mixed_friction", "pressure_deforms_bearing", "pressure_thickens_oil",
}  # fmt: skip


def evaluated(http, path=FILM, limits=None, **changes):
    body = {"inputs": {**BEARING, **changes}, **({"limits": limits} if limits else {})}
    answer = http.post(f"{path}/evaluate", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def criteria(answer):
    return {criterion["name"]: criterion for criterion in answer["criteria"]}


def test_a_pressure_of_59_gigapascals_is_named_and_not_met(http):
    answer = evaluated(http, radial_load="2500 kN")
    assert answer["outputs"]["maximum_pressure"]["value"] == pytest.approx(59550.28, rel=1e-5)
    assert {warning["code"] for warning in answer["warnings"]} >= IMPOSSIBLE
    assert (answer["verdict"]["verdict"], answer["verdict"]["green"]) == ("not_met", False)
    assert answer["verdict"]["governing"] == "rigid"
    judged = criteria(answer)
    assert {judged[name]["verdict"] for name in ("rigid", "isoviscous", "roughness", "film")} == {"not_met"}
    assert judged["isoviscous"]["utilisation"] == pytest.approx(59550.28 / 500, rel=1e-5)


def test_a_film_of_a_tenth_of_a_nanometre_is_named_and_not_met(http):
    answer = evaluated(http, radial_load="2e6 kN")
    assert answer["outputs"]["minimum_film_thickness"]["value"] == pytest.approx(1e-4, rel=0.1)
    assert {warning["code"] for warning in answer["warnings"]} >= IMPOSSIBLE | {"film_too_thin"}
    film = criteria(answer)["film_exists"]
    assert (film["verdict"], film["limit"]) == ("not_met", {"value": pytest.approx(0.05), "unit": "um"})
    assert answer["verdict"]["verdict"] == "not_met"


def test_a_sound_film_has_none_of_these_warnings(http):
    answer = evaluated(http)
    assert answer["warnings"] == []
    assert {c["name"] for c in answer["criteria"] if c["verdict"] == "met"} == {
        "film_exists", "roughness", "full_film", "rigid", "isoviscous", "hot_oil", "laminar", "whirl",
    }  # fmt: skip
    film = criteria(answer)["film"]
    assert film["verdict"] == "not_met"
    assert "ISO 7902-3" in film["unverified"]
    assert criteria(answer)["pressure"]["give"] == ["permissible_pressure"]


def test_a_row_of_the_library_gives_limits_with_their_source(http):
    judged = criteria(evaluated(http, limits={"bearing_material": "tin_babbitt_b23_2"}))
    assert (judged["pressure"]["verdict"], judged["pressure"]["limit"]["value"]) == ("not_met", 20.6)
    assert "ASTM B23" in judged["pressure"]["source"]
    assert (judged["specific_load"]["verdict"], judged["temperature"]["verdict"]) == ("not_met", "met")
    assert "Carvill" in judged["specific_load"]["source"]


def test_a_limit_by_hand_wins_over_the_row(http):
    limits = {"bearing_material": "tin_babbitt_b23_2", "permissible_pressure": "200 MPa"}
    judged = criteria(evaluated(http, limits=limits))
    assert judged["pressure"]["verdict"] == "met"
    assert "source" not in judged["pressure"]
    assert judged["specific_load"]["limit"]["value"] == 5.5


@pytest.mark.parametrize(("limits", "name", "words"), [
    ({"bearing_material": "tin_bronse"}, "limits.bearing_material", "tin_bronze"),
    ({"bearing_material": ["tin_bronze"]}, "limits.bearing_material", "row"),
    ({"permissible_pressure": "20 mm"}, "limits.permissible_pressure", "pressure"),
    ({"permissable_pressure": "20 MPa"}, "limits.permissable_pressure", "permissible_pressure"),
])  # fmt: skip
def test_a_wrong_limit_is_refused_by_name(http, limits, name, words):
    answer = problem(
        http.post(f"{FILM}/evaluate", json={"inputs": BEARING, "limits": limits}), 422, "invalid-inputs"
    )
    assert [error["name"] for error in answer["errors"]] == [name]
    assert words in answer["errors"][0]["detail"]


def test_compression_beyond_the_strength_is_named_and_not_met(http):
    inputs = {
        "stress_amplitude": "100 MPa", "mean_stress": "-5000 MPa", "ultimate_strength": "800 MPa",
        "fatigue_strength_coefficient": "1150 MPa", "fatigue_strength_exponent": -0.09, "design_life": 1e7,
        "mean_stress_correction": "morrow",
    }  # fmt: skip
    path = f"{API}/templates/stress_life/versions/1/evaluate"
    answer = http.post(path, json={"inputs": inputs}).json()
    assert answer["outputs"]["cycles"]["value"] > 1e12
    assert [w["code"] for w in answer["warnings"] if w["code"] == "static_overload"] == ["static_overload"]
    assert answer["verdict"]["governing"] == "strength"
    assert criteria(answer)["strength"]["value"] == {"value": pytest.approx(5100), "unit": "MPa"}


def test_the_description_lists_criteria_and_limits(http):
    declared = {c["name"]: c for c in http.get(FILM).json()["criteria"]}
    assert declared["film"]["unverified"]
    assert declared["pressure"]["limits"] == [
        {
            "name": "permissible_pressure",
            "unit": "MPa",
            "words": "largest pressure of the film that the bearing material bears",
            "library": "bearing_material",
            "default": None,
        }
    ]
    assert http.get(f"{API}/models/plain_bearing/versions/1").json()["criteria"] == []


def test_steps_of_a_design_are_judged_with_a_row_and_with_the_ends_of_a_list(http):
    chain = {
        "inertias": {"value": [0.012, 0.0046, 0.35, 0.1], "unit": "kg*m**2"},
        "stiffnesses": {"value": [60, 188.2, 20], "unit": "kN*m/rad"},
        "engine_orders": [2, 4, 6],
        "speed_range": {"value": [1000, 4000], "unit": "rpm"},
    }
    steps = {
        "film": {
            "template": "oil_film", "version": 2, "inputs": BEARING,
            "limits": {"bearing_material": "tin_bronze"},
        },
        "chain": {"template": "torsional_vibration", "version": 1, "inputs": chain},
    }  # fmt: skip
    design = http.post(f"{API}/designs", json={"name": "row", "steps": steps}, headers={"Prefer": "wait=30"})
    assert design.status_code == 201, design.text
    judged = criteria(http.get(f"{API}/designs/{design.json()['id']}/revisions/1").json())
    assert judged["film.specific_load"]["verdict"] == "met"
    assert "Carvill" in judged["film.specific_load"]["source"]
    separation = judged["chain.separation"]
    assert separation["verdict"] == "not_met"
    assert separation["limit"] == {"value": pytest.approx((1.1 * 4000 - 0.9 * 1000) / 2), "unit": "rpm"}
