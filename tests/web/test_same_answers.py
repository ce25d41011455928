"""Models of equal answers are shared, and what follows from them is made once; no page shows old values."""

import re

import pytest
from pydantic import BaseModel
from serving import API, created, patched

from app.calculations.bodies import OIL_FILM
from app.designs import drives, stored_results
from app.web import same_answers, sections
from app.web.same_answers import KEPT, same


class Length(BaseModel):
    value: float = 0.0
    note: str = ""


class Other(BaseModel):
    value: float = 0.0


class TestModels:
    def test_equal_bytes_are_one_model(self):
        first = same(b'{"value": 1.5}', Length)
        assert same(b'{"value": 1.5}', Length) is first
        assert first.model == Length(value=1.5)

    def test_other_bytes_and_other_kinds_are_not(self):
        first = same(b'{"value": 1.25}', Length)
        assert same(b'{"value": 1.75}', Length).model.value == 1.75
        assert isinstance(same(b'{"value": 1.25}', Other).model, Other)
        assert isinstance(first.model, Length)

    def test_a_long_answer_is_not_kept(self):
        content = b'{"note": "%s"}' % (b"x" * (KEPT // 4))
        assert same(content, Length).model == same(content, Length).model
        assert (Length, content) not in same_answers._kept
        assert same_answers._kept.currsize <= KEPT

    def test_a_function_is_called_once_for_equal_others(self):
        calls = []

        def times(length, factor, *, shift=0.0):
            calls.append(factor)
            return length.value * factor + shift

        length = same(b'{"value": 3}', Length)
        assert [length.once(times, 2), length.once(times, 2), length.once(times, 4)] == [6, 6, 12]
        assert length.once(times, 4, shift=1.0) == 13
        assert length.once(times, 2) == 6
        assert calls == [2, 4, 4, 2]


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
    for kept in (
        same_answers._kept,
        stored_results._kept,
        drives._kept,
        sections._kept,
        sections._kept_beside,
    ):
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
