"""Sections of a design's page are rendered once for equal content, formulas once for equal values."""

import re

import pytest
from serving import API, created

from app.calculations.bodies import OIL_FILM
from app.designs import worksheet
from app.web.design import sections


@pytest.fixture
def films(http):
    step = {"template": "oil_film", "version": 1}
    loads = {"left": "21.5 kN", "right": "22.5 kN"}
    steps = {name: {**step, "inputs": {**OIL_FILM, "radial_load": load}} for name, load in loads.items()}
    return f"/designs/{created(http, {'name': 'two films', 'steps': steps})['id']}"


def shown(http, place, **query):
    """The sections of a page by their steps."""
    page = http.get(place, params=query).raise_for_status().text
    parts = re.split(r'(?=<section class="sheet step")', page)[1:]
    return {re.search('data-step="([^"]*)"', part)[1]: part.partition("</section>")[0] for part in parts}


def change(http, place, load):
    patch = {"steps": {"right": {"inputs": {"radial_load": load}}}}
    headers = {"If-Match": "*"}
    http.patch(f"{API}{place}", json=patch, headers=headers).raise_for_status()


def test_a_second_look_writes_nothing(http, films):
    first, kept, written = shown(http, films), len(sections._kept), len(worksheet._written)
    assert shown(http, films) == first
    assert (len(sections._kept), len(worksheet._written)) == (kept, written)


def test_a_change_shows_in_its_own_step_alone(http, films):
    before, kept = shown(http, films), len(sections._kept)
    change(http, films, "33 kN")
    after = shown(http, films)
    assert after["left"] == before["left"]
    assert after["right"] != before["right"]
    assert 'value="33 kN"' in after["right"]
    assert len(sections._kept) == kept + 1


def test_units_have_sections_of_their_own(http, films):
    us = shown(http, films, units="us")
    assert us != shown(http, films, units="si")
    assert "mil" in us["left"]


def test_what_is_kept_is_what_is_written(http, films):
    kept = shown(http, films)
    sections._kept.clear()
    worksheet._written.clear()
    assert shown(http, films) == kept


def test_values_that_differ_have_formulas_of_their_own(http, films):
    def results():
        answer = http.get(f"{API}{films}/revisions/{number}/worksheet").json()
        rows = answer["steps"]["right"]["formulas"]
        return {row["name"]: row["result"] for row in rows}

    number = 1
    first = results()
    change(http, films, "41 kN")
    number = 2
    assert results()["minimum_film_thickness"] != first["minimum_film_thickness"]
    number = 1
    assert results() == first
