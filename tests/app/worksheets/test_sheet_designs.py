"""A design with a worksheet: variants, studies, tolerances and solving work as with a template file."""

import pytest
from serving import API
from sheets import fresh, released
from study_helpers import done

SHEET = """# Width from load
given F [kN] "radial load" (> 0; example 25 kN)
given D [mm] "bearing diameter" (> 0; example 48 mm)
given g [bar] over cycle "gas pressure" (example [1, 2, 3] * 1 bar)
choice law = steel "shaft" (steel | cast)
W [mm] = (if law is steel then 1 else 1.2) * F / (30 MPa * D) "bearing width"
swing [bar] over cycle = g - mean(g) "pressure swing"
check W <= D "narrower than the journal" (source "rule of thumb")
test "by hand" with F = 28.8 kN, D = 48 mm gives W = 20 mm within 0.1 %
"""
WIDTH = "s.bearing_width"
VARY = {"load": {"between": ["20 kN", "35 kN"]}, "bore": {"between": ["44 mm", "55 mm"]}}


@pytest.fixture(scope="module")
def design(http):
    """A design of one worksheet, with a tolerance and two variants."""
    id = released(http, SHEET, fresh("width"))["id"]
    inputs = {"radial_load": "= load", "bearing_diameter": "= bore"}
    inputs["gas_pressure"] = {"value": [1, 2, 3], "unit": "bar"}
    document = {
        "name": "of a worksheet",
        "parameters": {"load": "25 ± 2 kN", "bore": "48 mm"},
        "steps": {"s": {"template": id, "version": 1, "inputs": inputs}},
        "criteria": {"wide": {"require": f"{WIDTH} >= 15 mm"}},
        "variants": {"heavy": {"load": "30 kN"}, "cast": {"s.shaft": "cast"}},
    }
    answer = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"})
    assert answer.status_code == 201, answer.text[:1000]
    return answer.json()


def width(load, bore, factor=1.0):
    """In mm, for kN and mm."""
    return pytest.approx(factor * load * 1e3 / (30 * bore))


def test_variants_have_values_and_curves(http, design):
    heavy, cast = (
        http.get(f"{API}/designs/{design['id']}/variants/{name}").json() for name in ("heavy", "cast")
    )
    assert heavy["outputs"][WIDTH]["value"] == width(30, 48)
    assert cast["outputs"][WIDTH]["value"] == width(25, 48, 1.2)
    assert heavy["outputs"]["s.pressure_swing"]["value"] == [-1, 0, 1]


def test_a_grid_and_its_verdicts(http, design):
    study = done(http, design, method="grid", steps=4, vary=VARY, outputs=[WIDTH])
    rows = http.get(f"{API}/studies/{study['id']}/rows").json()["items"]
    assert len(rows) == 16
    for row in rows:
        assert row["values"][WIDTH] == width(row["values"]["load"], row["values"]["bore"])
        assert (row["verdicts"]["wide"] == "met") == (row["values"][WIDTH] >= 15)


def test_slopes(http, design):
    study = done(http, design, method="sensitivity", kind="local", vary=VARY, outputs=[WIDTH])
    slopes = study["result"]["indices"][WIDTH]
    assert slopes["load"]["elasticity"] == pytest.approx(1, rel=1e-6)
    assert slopes["bore"]["elasticity"] == pytest.approx(-1, rel=1e-6)


def test_an_optimum_on_its_criterion(http, design):
    study = done(http, design, method="optimise", vary=VARY, minimise=[WIDTH], hold=["wide"])
    assert study["result"]["best"]["outputs"][WIDTH]["value"] == pytest.approx(15, rel=1e-6)
    assert study["result"]["best"]["verdicts"]["wide"] == "met"


def test_tolerances_and_solving(http, design):
    analysed = http.post(
        f"{API}/designs/{design['id']}/tolerance", json={"outputs": [WIDTH]}, timeout=90
    ).json()
    worst = analysed[WIDTH]["worst"]
    assert worst["low"]["value"] == width(23, 48)
    assert worst["high"]["value"] == width(27, 48)
    asked = {"unknown": "bore", "between": ["40 mm", "60 mm"], "target": {WIDTH: "18 mm"}}
    (root,) = http.post(f"{API}/designs/{design['id']}/solve", json=asked, timeout=90).json()["roots"]
    assert root["value"] == pytest.approx(25e3 / (30 * 18))
