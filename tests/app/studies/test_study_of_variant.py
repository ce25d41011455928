"""A study of a variant: its rows, the chosen row, the new design, unknown names."""

import csv
import io
import json

import pytest
from click.testing import CliRunner
from serving import API, faults
from study_helpers import OUT, asked, content, done, new_design, rows

from app.cli.main import main

DESIGN = {
    "name": "bars",
    "parameters": {"size": "1 mm", "extra": "1 mm", "length": "= size + extra"},
    "steps": {"double": {"template": "double", "version": 1, "inputs": {"length": "= length"}}},
    "criteria": {"long_enough": {"require": f"{OUT} >= 15 mm"}},
    "variants": {"long": {"extra": "5 mm"}, "set": {"length": "4 mm", "double.length": "= 2 * length"}},
}
GRID = {
    "method": "grid",
    "vary": {"size": {"between": ["0 mm", "4 mm"]}},
    "steps": 5,
    "outputs": [OUT],
}


@pytest.fixture
def bars(http):
    return new_design(http, DESIGN)


def values(http, study):
    return [row["values"][OUT] for row in rows(http, study)["items"]]


def test_rows_are_those_of_the_variant_or_of_the_design(http, bars):
    of_variant = done(http, bars, **GRID, variant="long")
    assert of_variant["variant"] == "long"
    assert values(http, of_variant) == pytest.approx([10, 12, 14, 16, 18])
    assert [row["verdict"] for row in rows(http, of_variant)["items"]] == ["not_met"] * 3 + ["met"] * 2
    for own in (done(http, bars, **GRID), done(http, bars, **GRID, variant="base")):
        assert values(http, own) == pytest.approx([2, 4, 6, 8, 10])


def test_a_variant_has_the_rows_of_a_design_of_its_own(http, bars):
    alone = {**DESIGN, "parameters": {**DESIGN["parameters"], "extra": "5 mm"}}
    del alone["variants"]
    search = {"method": "optimise", "vary": GRID["vary"], "minimise": [OUT], "hold": ["long_enough"]}
    one, other = done(http, bars, **search, variant="long"), done(http, new_design(http, alone), **search)
    assert content(http, one, "npz") == content(http, other, "npz")
    assert one["result"]["best"]["outputs"][OUT]["value"] == pytest.approx(15, rel=1e-6)


def test_what_a_variant_sets_by_value_varies_and_what_it_sets_by_relation_does_not(http, bars):
    vary = {"length": {"between": ["1 mm", "2 mm"]}}
    study = done(http, bars, **{**GRID, "vary": vary, "steps": 2}, variant="set")
    assert values(http, study) == pytest.approx([4, 8])  # in the design itself a relation sets the length
    assert faults(asked(http, bars, **{**GRID, "vary": vary})) == {"length": "follows_from"}


def test_a_chosen_row_changes_the_variant_alone(http, bars):
    study = done(http, bars, **GRID, variant="long")
    answer = http.post(f"{API}/studies/{study['id']}/choose", json={"row": 3}, headers={"If-Match": '"1"'})
    assert answer.status_code == 200, answer.text
    saved = http.get(f"{API}/designs/{bars['id']}").json()
    assert saved["parameters"]["size"] == "1 mm"
    assert saved["variants"]["long"] == {"extra": "5 mm", "size": {"value": 3.0, "unit": "mm"}}
    assert saved["variants"]["set"] == DESIGN["variants"]["set"]
    gone = http.patch(
        f"{API}/designs/{bars['id']}",
        content=json.dumps({"variants": {"long": None}}),
        headers={"If-Match": '"2"', "Content-Type": "application/merge-patch+json"},
    )
    assert gone.status_code == 200, gone.text
    answer = http.post(f"{API}/studies/{study['id']}/choose", json={"row": 3}, headers={"If-Match": '"3"'})
    assert faults(answer) == {"variant": "unknown_name"}


def test_rows_to_build_are_variants_of_the_variant(http, bars):
    study = done(http, bars, **GRID, variant="long", build=[4])
    built = http.get(f"{API}/designs/{study['result']['design']}").json()
    assert built["parameters"]["extra"] == "5 mm"
    assert built["variants"] == {"row_4": {"size": {"value": 4.0, "unit": "mm"}}}


def test_an_unknown_variant_is_refused_with_the_names_that_exist(http, bars):
    answer = asked(http, bars, **GRID, variant="lang")
    assert faults(answer) == {"variant": "unknown_name"}
    assert "its variants are long, set" in answer.json()["detail"]
    estimate = http.post(f"{API}/studies/estimate", json={"design": bars["id"], **GRID, "variant": "lang"})
    assert faults(estimate) == {"variant": "unknown_name"}
    without = {name: value for name, value in DESIGN.items() if name != "variants"}
    assert "omit `variant`" in asked(http, new_design(http, without), **GRID, variant="x").json()["detail"]
    query = {"design": bars["id"], "outputs": OUT, "variant": "lang"}
    media = {"Content-Type": "text/csv"}
    answer = http.post(f"{API}/studies", params=query, content=b"size\nmm\n1\n", headers=media)
    assert faults(answer) == {"variant": "unknown_name"}


def test_the_commands_take_a_variant(served, http, bars, tmp_path):
    url = ["--url", served.url]
    sweep = ["sweep", bars["id"], "size=0..4mm/5", "--output", OUT, "--variant", "long", *url]
    swept = CliRunner().invoke(main, sweep)
    assert swept.exit_code == 0, swept.output
    table = list(csv.reader(io.StringIO(swept.stdout)))
    assert [float(row[table[1].index(OUT)]) for row in table[2:]] == pytest.approx([10, 12, 14, 16, 18])
    file = tmp_path / "study.json"
    file.write_text(json.dumps({"design": bars["id"], **GRID}), encoding="utf-8")
    shown = CliRunner().invoke(main, ["study", str(file), "--variant", "long", *url])
    assert json.loads(shown.stdout)["variant"] == "long"
    wrong = CliRunner().invoke(main, ["study", str(file), "--variant", "lang", *url])
    assert wrong.exit_code != 0
    assert "long, set" in wrong.output
