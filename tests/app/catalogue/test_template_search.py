"""The search finds templates by standards, authors, symbols and names of textbooks."""

import numpy as np
import pytest
from click.testing import CliRunner
from serving import API

from app.catalogue.discovery import find_templates
from app.catalogue.search import matching
from app.cli.main import main
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm

FILMS = {"oil_film", "elastic_film", "thermal_film"}


def found(query):
    kept, notes = matching(find_templates(()), query)
    return {cls.id for cls in kept}, notes


@pytest.mark.parametrize(
    ("query", "ids"),
    [
        ("Sommerfeld", FILMS), ("sommerfeld number", FILMS), ("Raimondi", FILMS), ("Raimondi, Boyd", FILMS),
        ("Shigley", FILMS), ("ISO 7902", FILMS | {"mixed_friction"}), ("iso7902", FILMS),
        ("DIN 31652", FILMS), ("DIN ISO 7902", FILMS), ("Holzer", {"forced_torsion", "torsional_vibration"}),
        ("SAE J300", {"oil_film"}), ("Findley", {"fatigue_life"}), ("Rayleigh", {"slider_bearing"}),
        ("h_min", {"oil_film", "thrust_bearing"}), ("η", {"oil_film"}), ("ψ", {"oil_film"}),
        ("Petroff", {"journal_friction"}), ("Hersey number", {"oil_film"}), ("DuBois", {"oil_film"}),
        ("Kingsbury", {"thrust_bearing"}), ("ball bearing", {"rolling_bearing_life"}),
        ("Palmgren", {"fatigue_life", "rolling_bearing_life"}), ("Wöhler curve", {"stress_life"}),
        ("Haigh diagram", {"stress_life"}),
    ],
)  # fmt: skip
def test_a_template_is_found_by_what_an_engineer_calls_it(query, ids):
    assert ids <= found(query)[0]


def test_a_word_that_no_template_has_finds_none():
    assert found("xyzzy") == (set(), [])


@pytest.mark.parametrize("name", ["Sommerfeld", "Raimondi", "Shigley", "sommerfeld number"])
def test_both_definitions_are_told_with_their_factor_which_is_right(name):
    (note,) = found(name)[1]
    assert "S = 1/(2 pi So)" in note
    case = {
        **OilFilm.example, "radial_load": "10 kN", "diametral_clearance": "0.1 mm",
        "bearing_diameter": "100 mm", "bearing_width": "50 mm", "speed": "3000 rpm",
        "dynamic_viscosity": "10 mPa*s",
    }  # fmt: skip
    outputs = evaluate(OilFilm, case, outputs=["sommerfeld_number"]).outputs
    # Shigley 12-1 by hand: r 50 mm, c 0.05 mm, 50 rev/s, P = 10 kN / (100 mm · 50 mm) = 2 MPa
    shigley = (50 / 0.05) ** 2 * 0.01 * 50 / 2e6
    assert shigley == pytest.approx(1 / (2 * np.pi * outputs["sommerfeld_number"].value), rel=1e-9)


def test_the_note_on_hersey_has_the_factor_which_is_right():
    (note,) = found("Hersey")[1]
    assert "2 pi times as large" in note
    outputs = evaluate(
        OilFilm, OilFilm.example, outputs=["stribeck_duty_parameter", "dynamic_viscosity"]
    ).outputs
    hersey = outputs["dynamic_viscosity"].value * 1e-3 * (5000 / 60) / (25e3 / (0.048 * 0.018))
    assert outputs["stribeck_duty_parameter"].value == pytest.approx(2 * np.pi * hersey, rel=1e-9)


def test_over_http_on_the_page_and_on_the_command_line(http):
    answer = http.get(f"{API}/templates", params={"search": "Holzer"}).json()
    assert {item["id"] for item in answer["items"]} == {"forced_torsion", "torsional_vibration"}
    assert http.get(f"{API}/templates", params={"search": "Shigley"}).json()["notes"]
    assert http.get(f"{API}/templates", params={"search": "a" * 201}).status_code == 422
    page = http.get("/", params={"template": "Sommerfeld"}).text
    assert "1/(2 pi So)" in page
    assert "/templates/torsional_vibration/1" not in page
    ran = CliRunner().invoke(main, ["template", "list", "--search", "Holzer"])
    assert "torsional_vibration 1" in ran.output
    assert "oil_film" not in ran.output
