"""A study may vary a value that a relation sets only on request, and always says so."""

import pytest
from serving import API, faults
from study_helpers import OUT, TWICE, asked, content, done, new_design, rows

INPUT = "double.length"
VARIED = {"vary": {INPUT: {"between": ["1 mm", "3 mm"]}}, "outputs": [OUT]}
ASIDE = {**VARIED, "set_aside": [INPUT]}
CHAIN = {**TWICE, "parameters": {"base": "1 mm", "length": "= 2 * base"}}


@pytest.fixture
def twice(http):
    return new_design(http, TWICE)


@pytest.fixture
def swept(http, twice):
    return done(http, twice, method="grid", steps=3, **ASIDE)


def test_a_relation_is_refused_with_both_remedies(http, twice):
    answer = asked(http, twice, method="grid", steps=3, **VARIED)
    assert faults(answer) == {INPUT: "follows_from"}
    assert "vary length instead" in answer.text
    assert "set_aside" in answer.text


def test_rows_replace_the_relation_and_the_study_says_so(http, swept):
    assert swept["set_aside"] == {INPUT: "= length"}
    got = [(row["values"][INPUT], row["values"][OUT]) for row in rows(http, swept)["items"]]
    assert got == [pytest.approx(pair) for pair in ((1, 2), (2, 4), (3, 6))]


def test_a_row_that_is_chosen_replaces_the_relation_in_the_design_and_its_report(http, twice, swept):
    place = f"{API}/designs/{twice['id']}"
    saved = http.post(f"{API}/studies/{swept['id']}/choose", json={"row": 2}, headers={"If-Match": '"1"'})
    assert saved.status_code == 200, saved.text
    assert saved.json()["steps"]["double"]["inputs"] == {"length": {"value": 3.0, "unit": "mm"}}
    note = http.get(f"{place}/revisions/2").json()["note"]
    assert note.endswith(f"replaces the relation of {INPUT} (= length)")
    assert note in http.get(f"{place}/report.html").text


def test_a_note_of_the_user_is_kept_beside_it(http, twice, swept):
    body = {"row": 0, "note": "the smallest"}
    http.post(f"{API}/studies/{swept['id']}/choose", json=body, headers={"If-Match": '"1"'})
    note = http.get(f"{API}/designs/{twice['id']}/revisions/2").json()["note"]
    assert note == f"the smallest; replaces the relation of {INPUT} (= length)"


def test_the_rows_of_a_table_replace_a_relation_too(http, twice):
    body = {"rows": {INPUT: {"value": [1, 5], "unit": "mm"}}, "outputs": [OUT], "set_aside": [INPUT]}
    study = done(http, twice, method="table", **body)
    assert [row["values"][OUT] for row in rows(http, study)["items"]] == pytest.approx([2, 10])


def test_a_parameter_that_follows_from_another_is_set_aside_in_its_own_unit(http):
    design = new_design(http, CHAIN)
    vary = {"length": {"values": ["0.5 cm"]}, "base": {"values": ["7 mm"]}}
    study = done(http, design, method="grid", vary=vary, outputs=[OUT], set_aside=["length"])
    assert study["set_aside"] == {"length": "= 2 * base"}
    assert [row["values"][OUT] for row in rows(http, study)["items"]] == pytest.approx([10])


def test_what_is_not_varied_or_has_no_relation_cannot_be_set_aside(http, twice):
    body = {"method": "grid", "steps": 3, "outputs": [OUT], "vary": {"length": {"between": ["1 mm", "2 mm"]}}}
    assert faults(asked(http, twice, **body, set_aside=["length"])) == {"length": "no_relation"}
    assert faults(asked(http, twice, **body, set_aside=[INPUT])) == {INPUT: "not_varied"}


def test_variants_that_are_built_say_which_relation_they_replace(http, twice):
    study = done(http, twice, method="grid", steps=3, build=[1], **ASIDE)
    built = study["result"]["design"]
    assert http.get(f"{API}/designs/{built}").json()["variants"]["row_1"][INPUT] == {
        "value": 2.0,
        "unit": "mm",
    }
    note = http.get(f"{API}/designs/{built}/revisions/1").json()["note"]
    assert note.endswith(f"its variants replace the relation of {INPUT} (= length)")


def test_equal_studies_with_a_relation_set_aside_have_equal_bytes(http, twice, swept):
    again = done(http, twice, method="grid", steps=3, **ASIDE)
    assert content(http, again, "npz") == content(http, swept, "npz")


def test_an_estimate_says_what_would_be_done_and_begins_nothing(http, twice):
    before = http.get(f"{API}/studies", params={"design": twice["id"]}).json()["items"]
    body = {"design": twice["id"], "method": "grid", "steps": 3, **ASIDE}
    estimate = http.post(f"{API}/studies/estimate", json=body)
    assert estimate.status_code == 200, estimate.text
    assert estimate.json()["rows"] == 3
    assert estimate.json()["set_aside"] == {INPUT: "= length"}
    assert estimate.json()["estimate"]["seconds"] > 0
    assert http.get(f"{API}/studies", params={"design": twice["id"]}).json()["items"] == before
