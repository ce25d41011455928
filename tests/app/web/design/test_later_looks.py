"""A design page never shows outdated values, whatever is cached between two visits."""

import re

import pytest
from serving import API, created, patched

from app.calculations.bodies import OIL_FILM
from app.designs import drives, result_records
from app.web.design import sections


def films(http, count):
    step = {"template": "oil_film", "version": 1}
    steps = {
        f"film_{n}": {**step, "inputs": {**OIL_FILM, "radial_load": f"{20 + n} kN"}} for n in range(count)
    }
    return created(http, {"name": "films", "steps": steps})


@pytest.fixture
def design(http):
    return films(http, sections.MOST_IN_FULL + 1)


def page(http, design, **query):
    """The page, without what each look has of its own: tokens, and digests of the time."""
    text = http.get(f"/designs/{design['id']}", params=query).raise_for_status().text
    return re.sub(r'(name="(?:seen|token)" value=")[^"]*', r"\1", text)


def forget():
    for kept in (result_records._kept, drives._kept, sections._kept):
        kept.clear()


def test_a_later_look_shows_what_a_first_one_shows(http, design):
    looks = [page(http, design) for _ in range(2)]
    forget()
    assert looks == [page(http, design)] * 2


def test_units_are_told_apart(http, design):
    si, us = page(http, design, units="si"), page(http, design, units="us")
    assert "mil" in us
    assert us != si
    assert page(http, design, units="si") == si


def test_a_change_shows_at_once(http, design):
    before = page(http, design, step="film_2")
    patched(http, design, {"steps": {"film_2": {"inputs": {"radial_load": "61.25 kN"}}}})
    after = page(http, design, step="film_2")
    assert 'value="61.25 kN"' in after
    assert 'value="61.25 kN"' not in before
    forget()
    assert page(http, design, step="film_2") == after


def test_the_network_follows_a_relation(http, design):
    def relations():
        return http.get(f"{API}/designs/{design['id']}/network").raise_for_status().json()["relations"]

    assert relations() == []
    patched(http, design, {"steps": {"film_3": {"inputs": {"radial_load": "= film_4.radial_load"}}}})
    assert [one["source"] for one in relations()] == ["film_4.radial_load"]
    assert 'href="#step-film_4"' in page(http, design)
