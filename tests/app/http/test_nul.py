"""U+0000 and keys of the service are refused in every text, naming the field, with both kinds of database."""

import pytest
from scaling import assert_linear
from serving import API, created, faults

from app.http.strict_requests import is_forbidden

KEY = f"cw_{'a1' * 5}_{'Z-_9' * 10}abc"


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
    assert is_forbidden(text) is is_there


def test_the_search_is_linear():
    assert_linear(is_forbidden, lambda length: (b"\\" * length + b"u000") * 2, 2**18)


@pytest.mark.parametrize(
    ("document", "name"),
    [
        ({"name": KEY}, "name"),
        ({"name": "x", "note": f"my key is {KEY}."}, "note"),
        ({"name": "x", "parameters": {KEY: "1"}}, "parameters.cw_a1a1a1a1a1_***"),
        ({"name": "x", "labels": ["a", KEY]}, "labels.1"),
    ],
)
def test_a_key_in_a_text_is_refused_and_not_repeated(http, document, name):
    answer = http.post(f"{API}/designs", json=document)
    assert faults(answer) == {name: "key"}
    assert KEY not in answer.text


def test_a_key_in_a_comment_or_a_worksheet_is_refused(http, design):
    place = f"{API}/designs/{design['id']}"
    assert faults(http.post(f"{place}/revisions/1/comments", json={"text": KEY})) == {"text": "key"}
    assert faults(http.post(f"{API}/worksheets", json={"id": "b", "text": f"a := 1 {KEY}"})) == {
        "text": "key"
    }


def test_the_search_for_keys_is_linear():
    assert_linear(is_forbidden, lambda length: b"cw_a1a1a1a1a1_" * (length // 14), 2**18)


def test_what_only_begins_as_a_key_is_a_text(http):
    assert created(http, {"name": KEY[:-1]})["name"] == KEY[:-1]
