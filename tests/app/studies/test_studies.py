"""Studies over REST: rows equal single calculations, and faults are named."""

import csv
import io
import json

import numpy as np
import pytest
from openpyxl import load_workbook
from patience import patient, until
from serving import API, faults, heard, problem
from study_helpers import (
    CLEARANCE,
    FILM,
    LENGTHS,
    LOSS,
    OUT,
    THICKNESS,
    TWICE,
    asked,
    begun,
    content,
    done,
    ended,
    new_design,
    rows,
)

WORST = ["not_met", "undecided", "not_checked", "met"]


@pytest.fixture(scope="module")
def twice(http):
    return new_design(http, TWICE)


@pytest.fixture(scope="module")
def film(http):
    return new_design(http, FILM)


@pytest.fixture(scope="module")
def sampled(http, film):
    return done(
        http, film, method="sample", points=200, vary=CLEARANCE, outputs=[THICKNESS, LOSS],
        hold=["thick_enough"],
    )  # fmt: skip


def test_a_grid_has_each_combination_and_the_values_of_the_formula(http, twice):
    vary = {**LENGTHS, "double.length": {"values": ["1 mm"]}}
    assert faults(asked(http, twice, method="grid", vary=vary, steps=3, outputs=[OUT])) == {
        "double.length": "follows_from"
    }
    study = done(http, twice, method="grid", vary=LENGTHS, steps=5, outputs=[OUT])
    assert (study["rows"], study["done"], study["progress"]) == (5, 5, 1.0)
    page = rows(http, study)
    assert page["units"] == {"length": "mm", OUT: "mm"}
    assert [row["values"]["length"] for row in page["items"]] == pytest.approx([0, 2.5, 5, 7.5, 10])
    for row in page["items"]:
        assert row["values"][OUT] == pytest.approx(2 * row["values"]["length"])
        assert "reason" not in row


def test_a_row_is_what_the_template_calculates_alone(http, film, sampled):
    row = rows(http, sampled)["items"][17]
    inputs = {
        **FILM["steps"]["film"]["inputs"],
        "bearing_diameter": "48 mm",
        "bearing_width": "18 mm",
        "diametral_clearance": f"{row['values']['clearance']!r} mm",
    }
    asked_for = {"inputs": inputs, "outputs": ["power_loss"], "level": row["level"]["film"]}
    alone = http.post(f"{API}/templates/oil_film/versions/2/evaluate", json=asked_for).json()
    assert row["values"][LOSS] == pytest.approx(alone["outputs"]["power_loss"]["value"], rel=1e-12)


def test_equal_seeds_give_equal_bytes_and_other_seeds_others(http, film, sampled):
    body = {"method": "sample", "points": 200, "vary": CLEARANCE, "outputs": [THICKNESS, LOSS]}
    body["hold"] = ["thick_enough"]
    again, other = done(http, film, **body), done(http, film, **body, seed=2)
    assert content(http, again, "npz") == content(http, sampled, "npz")
    assert content(http, other, "npz") != content(http, sampled, "npz")


@pytest.mark.parametrize("sequence", ["sobol", "lhs"])
def test_samples_lie_within_the_bounds(http, twice, sequence):
    study = done(http, twice, method="sample", points=64, sequence=sequence, vary=LENGTHS, outputs=[OUT])
    values = sorted(row["values"]["length"] for row in rows(http, study)["items"])
    assert len(values) == 64
    assert 0 <= values[0] < 1
    assert 9 < values[-1] <= 10


def test_a_table_takes_columns_or_rows_in_any_unit(http, twice):
    by_column = {"length": {"value": [1, 2], "unit": "cm"}}
    by_row = [{"length": "10 mm"}, {"length": "0.02 m"}]
    for given in (by_column, by_row):
        study = done(http, twice, method="table", rows=given, outputs=[OUT])
        assert [row["values"][OUT] for row in rows(http, study)["items"]] == pytest.approx([20, 40])


def test_refused_rows_say_why_and_the_others_have_values(http, twice):
    vary = {"length": {"between": ["-10 mm", "10 mm"]}}
    study = done(http, twice, method="grid", vary=vary, steps=5, outputs=[OUT])
    assert study["refused"] == {"count": 2, "reasons": {"double.length: out_of_range": 2}}
    refused = rows(http, study, where="refused")
    assert [row["row"] for row in refused["items"]] == [0, 1]
    assert all(row["values"][OUT] is None and "double.length" in row["reason"] for row in refused["items"])
    assert rows(http, study)["items"][4]["values"][OUT] == pytest.approx(20)


def test_verdicts_stand_in_the_rows_and_filter_them(http, film, sampled):
    assert "thick_enough" in sampled["criteria"]
    everything = rows(http, sampled)["items"]
    met = rows(http, sampled, where="met")
    assert 0 < met["count"] < 200
    assert met["count"] == sum(row["verdicts"]["thick_enough"] == "met" for row in everything)
    assert sampled["result"]["share"] == pytest.approx(met["count"] / 200)
    shares = sampled["result"]["shares"]
    assert set(shares) <= set(sampled["criteria"])
    for name, share in shares.items():
        assert share == pytest.approx(sum(row["verdicts"][name] == "met" for row in everything) / 200)
    for row in met["items"]:
        assert row["verdict"] == "met"
        assert row["values"][THICKNESS] >= 1.8


def test_criteria_whose_limits_nobody_gave_hold_no_row_back(http, film):
    study = done(http, film, method="grid", steps=5, vary=CLEARANCE, outputs=[THICKNESS])
    assert {"thick_enough", "film.film_exists"} <= set(study["criteria"])
    for row in rows(http, study)["items"]:
        words = set(row["verdicts"].values())
        assert row["verdict"] == ("met" if words <= {"met", "not_checked"} else min(words, key=WORST.index))


def test_the_best_row_is_confirmed_and_meets_what_is_held(http, film):
    study = done(
        http, film, method="sample", points=256, vary=CLEARANCE, minimise=[LOSS], outputs=[THICKNESS],
        hold=["thick_enough"], explore={"tolerance": 0.05}, confirm={"tolerance": 0.001},
    )  # fmt: skip
    best, (trade,) = study["result"]["best"], study["result"]["trade"]
    assert best["confirmed"]
    assert best["verdicts"] == {"thick_enough": "met"}
    met = [row for row in rows(http, study, where="met")["items"] if row.get("confirmed")]
    assert best["row"] in [row["row"] for row in met]
    assert best["outputs"][LOSS]["value"] == pytest.approx(min(row["values"][LOSS] for row in met))
    assert trade["level"] == study["levels"]
    promised = min(
        (row for row in rows(http, study)["items"] if row.get("confirmed")),
        key=lambda row: abs(row["values"]["clearance"] - trade["at"]["clearance"]["value"]),
    )
    assert trade["confirmed"][LOSS]["value"] == promised["values"][LOSS]  # where the promise was made


def test_a_front_among_rows_has_its_promise_and_what_is_true_of_it(http, film):
    study = done(
        http, film, method="sample", points=64, vary=CLEARANCE, minimise=[LOSS], maximise=[THICKNESS],
        hold=["thick_enough"], explore={"tolerance": 0.2}, confirm={"tolerance": 1e-6},
    )  # fmt: skip
    front, (trade,) = study["result"]["front"], study["result"]["trade"]
    assert trade["level"] == study["levels"]
    assert len(trade["front"]) >= len(front) > 1
    confirmed = [place["confirmed"] for place in trade["front"]]
    assert all({name: one["outputs"][name] for name in (LOSS, THICKNESS)} in confirmed for one in front)
    assert any(place["promise"] != place["confirmed"] for place in trade["front"])
    assert all(place["at"]["clearance"]["unit"] == "mm" for place in trade["front"])


@pytest.fixture(scope="module")
def held(http):
    """Twice a length, which must be at least 5 mm; and twice what is left of 10 mm."""
    steps = {
        **TWICE["steps"],
        "rest": {"template": "double", "version": 1, "inputs": {"length": "= 10 mm - length"}},
    }
    criteria = {"long_enough": {"require": f"{OUT} >= 5 mm"}}
    return new_design(http, {**TWICE, "steps": steps, "criteria": criteria})


def test_the_search_ends_at_the_limit_that_it_holds(http, held):
    search = {"method": "optimise", "vary": LENGTHS, "minimise": [OUT], "hold": ["long_enough"]}
    study = done(http, held, **search, build="best")
    result, best = study["result"], study["result"]["best"]
    assert (result["settled"], result["global"]) == (True, "not proven")
    assert best["at"]["length"]["value"] == pytest.approx(2.5, rel=1e-6)
    assert best["verdicts"] == {"long_enough": "met"}
    assert (best["error_unknown"], best["confirmed"]) == (["long_enough"], False)  # nobody measured `double`
    assert "error of its confirmation is unknown" in result["notes"][0]
    assert result["notes"][1:] == ["the optimum sits on the limit of long_enough"]
    assert result["trade"][0]["confirmed"][OUT]["value"] == pytest.approx(5, rel=1e-6)
    row = rows(http, study, sort=OUT, where="met", limit=1)["items"][0]
    assert row["values"][OUT] == pytest.approx(best["outputs"][OUT]["value"])
    assert list(http.get(f"{API}/designs/{result['design']}").json()["variants"]) == ["best"]


def test_a_search_that_needs_too_many_rows_says_so(http, held):
    search = {"method": "optimise", "vary": LENGTHS, "minimise": [OUT], "points": 4100}
    study = ended(http, begun(http, held, **search))
    assert study["state"] == "failed"
    assert study["problem"]["errors"][0]["code"] == "too_many_rows"


@pytest.mark.slow
def test_the_front_of_two_objectives(http, held):
    pytest.importorskip("pymoo")
    other = "rest.twice_the_length"
    search = {"method": "optimise", "vary": LENGTHS, "minimise": [OUT, other], "hold": ["long_enough"]}
    result = done(http, held, **search)["result"]
    front, (trade,) = result["front"], result["trade"]
    assert len(front) > 5
    for place, best in zip(trade["front"], front, strict=True):  # promises are of criteria too
        assert place["promise"].keys() == {*best["outputs"], "long_enough"}
        assert {name: place["promise"][name] for name in best["outputs"]} == best["outputs"]
    for best in front:
        assert best["outputs"][OUT]["value"] + best["outputs"][other]["value"] == pytest.approx(20)
        assert best["verdicts"] == {"long_enough": "met"}


def test_local_slopes_of_an_exact_formula(http, twice):
    study = done(http, twice, method="sensitivity", kind="local", vary=LENGTHS, outputs=[OUT])
    index = study["result"]["indices"][OUT]["length"]
    assert index["slope"]["value"] == pytest.approx(2)
    assert index["slope"]["unit"] == "mm/mm"
    assert index["elasticity"] == pytest.approx(1)


@pytest.mark.parametrize("kind", ["morris", "sobol"])
@pytest.mark.sampled(1)
def test_global_sensitivities(http, film, kind):
    pytest.importorskip("SALib")
    vary = {**CLEARANCE, "width": {"between": ["17.9 mm", "18.1 mm"]}}
    points = {"morris": 10, "sobol": 64}[kind]
    study = done(http, film, method="sensitivity", kind=kind, points=points, vary=vary, outputs=[LOSS])
    clearance, width = (study["result"]["indices"][LOSS][name] for name in ("clearance", "width"))
    if kind == "sobol":
        assert clearance["first"] > 0.8 > 0.2 > width["first"]
    else:
        assert clearance["mu_star"]["unit"] == "W"
        assert clearance["mu_star"]["value"] > 3 * width["mu_star"]["value"]


def test_refused_rows_make_no_sensitivities(http, twice):
    pytest.importorskip("SALib")
    vary = {"length": {"between": ["-10 mm", "10 mm"]}}
    study = ended(
        http, begun(http, twice, method="sensitivity", kind="sobol", points=16, vary=vary, outputs=[OUT])
    )
    assert study["state"] == "failed"
    assert study["problem"]["errors"][0]["code"] == "refused_rows"


def test_unknown_designs_and_studies(http):
    assert asked(http, {"id": "none"}, method="grid", vary=LENGTHS, steps=3, outputs=[OUT]).status_code == 404
    for path in ("", "/rows", "/rows.csv", "/rows.xlsx", "/rows.npz", "/events"):
        problem(http.get(f"{API}/studies/none{path}"), 404, "not-found")


def test_one_key_makes_one_study(http, twice):
    body = {"design": twice["id"], "method": "grid", "vary": LENGTHS, "steps": 3, "outputs": [OUT]}
    answers = [
        http.post(f"{API}/studies", json=body, headers={"Idempotency-Key": f"study-{twice['id']}"})
        for _ in range(2)
    ]
    assert [answer.status_code for answer in answers] == [202, 202]
    assert answers[0].json()["id"] == answers[1].json()["id"]
    other = http.post(
        f"{API}/studies", json={**body, "steps": 4}, headers={"Idempotency-Key": f"study-{twice['id']}"}
    )
    problem(other, 422, "idempotency-key-reused")


def test_studies_of_a_design_are_listed_newest_first(http):
    design = new_design(http, TWICE)
    ids = [begun(http, design, method="grid", vary=LENGTHS, steps=3, outputs=[OUT])["id"] for _ in range(3)]
    first = http.get(f"{API}/studies", params={"design": design["id"], "limit": 2}).json()
    rest = http.get(f"{API}/studies", params={"design": design["id"], "cursor": first["next"]}).json()
    assert [one["id"] for one in (*first["items"], *rest["items"])] == ids[::-1]


def test_pages_of_rows_sorted_by_a_column(http, sampled):
    collected, cursor = [], None
    while True:
        query = {"sort": f"-{LOSS}", "columns": LOSS, "limit": 90, **({"cursor": cursor} if cursor else {})}
        page = rows(http, sampled, **query)
        collected += [row["values"][LOSS] for row in page["items"]]
        if not (cursor := page["next"]):
            break
    assert len(collected) == 200
    assert collected == sorted(collected, reverse=True)
    assert list(page["items"][0]["values"]) == [LOSS]
    assert faults(http.get(f"{API}/studies/{sampled['id']}/rows", params={"sort": "x"})) == {
        "columns.x": "unknown_name"
    }


def test_us_units(http, sampled):
    page, us = rows(http, sampled), rows(http, sampled, units="us")
    assert us["units"]["clearance"] == "inch"
    one, other = page["items"][3]["values"]["clearance"], us["items"][3]["values"]["clearance"]
    assert one == pytest.approx(25.4 * other)
    assert http.get(f"{API}/studies/{sampled['id']}", params={"units": "us"}).json()["units"][LOSS] == "hp"


def test_files_hold_the_rows(http, sampled):
    items = rows(http, sampled)["items"]
    expected = [row["values"][LOSS] for row in items]
    table = list(csv.reader(io.StringIO(content(http, sampled, "csv").decode())))
    of_verdicts = ["thick_enough", "verdict", "error unknown"]
    assert table[0][:4] == ["Row", "Clearance [mm]", "Minimum film thickness [µm]", "Power loss [W]"]
    assert table[1] == ["row", "clearance", THICKNESS, LOSS, *of_verdicts, "level", "reason"]
    assert [float(line[3]) for line in table[2:]] == expected
    sheet = load_workbook(io.BytesIO(content(http, sampled, "xlsx"))).active
    assert [cell.value for cell in sheet["D"][2:]] == pytest.approx(expected)
    arrays = np.load(io.BytesIO(content(http, sampled, "npz")))
    assert arrays[LOSS].tolist() == expected
    assert json.loads(arrays["about"].tobytes())["units"][LOSS] == "W"
    met = len(content(http, sampled, "csv", where="met").splitlines()) - 2
    assert met == rows(http, sampled, where="met")["count"]


def test_a_study_is_watched_to_its_end(http, twice):
    study = begun(http, twice, method="sample", points=20_000, vary=LENGTHS, outputs=[OUT])
    with http.stream("GET", f"{API}/studies/{study['id']}/events") as stream:
        events = list(heard(stream))
    assert events[-1][0] == "done"
    assert events[-1][1]["id"] == study["id"]
    assert {name for name, _ in events} <= {"queued", "running", "progress", "done"}


def test_a_cancelled_study_stops_and_is_removed(http, served, twice):
    study = begun(http, twice, method="sample", points=10**6, vary=LENGTHS, outputs=[OUT])
    until(lambda: rows(http, study, limit=1)["items"], bool, patient(60))
    cancelled = http.delete(f"{API}/studies/{study['id']}")
    assert (cancelled.status_code, cancelled.json()["state"]) == (200, "cancelled")
    pool = served.app.state.services.calculations
    until(lambda: pool.running + pool.waiting, lambda count: count == 0, patient(30))
    now = http.get(f"{API}/studies/{study['id']}").json()
    assert 0 < now["done"] < 10**6
    assert http.delete(f"{API}/studies/{study['id']}").status_code == 204
    problem(http.get(f"{API}/studies/{study['id']}"), 404, "not-found")
