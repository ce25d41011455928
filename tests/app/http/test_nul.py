"""U+0000 is refused in every text, naming the field, with both kinds of database."""

import pytest
from scaling import assert_linear
from serving import API, created, faults

from app.http.strict_requests import has_nul


@pytest.fixture(scope="module")
def design(http):
    return created(http, {"name": "any"})


@pytest.mark.parametrize(
    ("document", "name"),
    [
        ({"name": "a\0"}, "name"),
        ({"name": "x", "note": "a\0b"}, "note"),
        ({"name": "x", "parameters": {"a": "1 mm\0"}}, "parameters.a"),
        ({"name": "x", "parameters": {"a\0": "1"}}, "parameters.a\\0"),
        ({"name": "x", "steps": {"film": {"inputs": {"a": ["1", "\0"]}}}}, "steps.film.inputs.a.1"),
    ],
)
def test_a_document_names_its_field(http, document, name):
    assert faults(http.post(f"{API}/designs", json=document)) == {name: "nul"}


def test_a_change_a_study_and_a_worksheet_do_as_well(http, design):
    place = f"{API}/designs/{design['id']}"
    answer = http.patch(place, json={"note": "\0"}, headers={"If-Match": "*"})
    assert faults(answer) == {"note": "nul"}
    assert faults(http.post(f"{place}/labels", json={"add_tags": ["a\0"]})) == {"add_tags.0": "nul"}
    assert faults(http.post(f"{API}/worksheets", json={"id": "b", "text": "a\0"})) == {"text": "nul"}
    assert faults(http.post(f"{API}/templates/oil_film/versions/1/evaluate", json={"inputs": "\0"}))


def test_a_query_names_its_parameter_and_a_path_leads_nowhere(http, design):
    assert faults(http.get(f"{API}/designs?cursor=%00")) == {"cursor": "nul"}
    assert faults(http.get(f"{API}/designs?tag=a%00")) == {"tag": "nul"}
    for path in ("designs/%00", "jobs/%00", "builds/a%00", f"designs/{design['id']}/explain/%00"):
        assert http.get(f"{API}/{path}").status_code == 404


def test_a_backslash_before_the_escape_is_a_text(http):
    assert created(http, {"name": "a\\u0000"})["name"] == "a\\u0000"


@pytest.mark.parametrize(
    ("text", "is_there"),
    [
        (rb'"\u0000"', True),
        (rb'"\\u0000"', False),
        (rb'"\\\u0000"', True),
        (rb'"\\\\u0000"', False),
        (b'"u0000"', False),
    ],
)
def test_the_character_is_no_other_that_looks_like_it(text, is_there):
    assert has_nul(text) is is_there


def test_the_search_is_linear():
    assert_linear(has_nul, lambda length: (b"\\" * length + b"u000") * 2, 2**18)
