"""A chosen row of a study becomes a revision; several rows become variants of a new design."""

import pytest
from serving import API, faults, problem
from study_helpers import LENGTHS, OUT, TWICE, done, new_design


def test_a_chosen_row_becomes_a_revision(http):
    design = new_design(http, TWICE)
    study = done(http, design, method="grid", vary=LENGTHS, steps=5, outputs=[OUT])
    path, body = f"{API}/studies/{study['id']}/choose", {"row": 3}
    problem(http.post(path, json=body), 428, "precondition-required")
    problem(http.post(path, json=body, headers={"If-Match": '"7"'}), 412, "stale-revision")
    answer = http.post(path, json={"row": 5}, headers={"If-Match": '"1"'})
    assert faults(answer) == {"row": "unknown_row"}
    chosen = http.post(path, json=body, headers={"If-Match": '"1"'})
    assert chosen.status_code == 200, chosen.text
    assert chosen.json()["parameters"]["length"] == {"value": 7.5, "unit": "mm"}
    revision = http.get(f"{API}/designs/{design['id']}/revisions/2").json()
    assert study["id"] in revision["note"]
    assert revision["steps"]["double"]["outputs"]["twice_the_length"]["value"] == pytest.approx(15)


def test_inputs_of_steps_vary_and_are_chosen(http):
    document = {
        **TWICE,
        "steps": {"double": {"template": "double", "version": 1, "inputs": {"length": "1 mm"}}},
    }
    design = new_design(http, document)
    vary = {"double.length": {"values": ["3 mm", "4 mm"]}}
    study = done(http, design, method="grid", vary=vary, outputs=[OUT])
    chosen = http.post(
        f"{API}/studies/{study['id']}/choose", json={"row": 1, "note": "thicker"}, headers={"If-Match": '"1"'}
    ).json()
    assert chosen["steps"]["double"]["inputs"]["length"] == {"value": 4.0, "unit": "mm"}


def test_rows_become_variants_of_a_new_design(http):
    study = done(
        http, new_design(http, TWICE), method="grid", vary=LENGTHS, steps=5, outputs=[OUT], build=[1, 3]
    )
    built = http.get(f"{API}/designs/{study['result']['design']}").json()
    assert built["name"] == "twice (study)"
    assert built["variants"] == {
        "row_1": {"length": {"value": 2.5, "unit": "mm"}},
        "row_3": {"length": {"value": 7.5, "unit": "mm"}},
    }
