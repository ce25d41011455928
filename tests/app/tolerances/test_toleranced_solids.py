"""Tolerances of a design arrive in the STEP files of its solids, and `/verify` reads them back."""

import re

import pytest
from bare_shells import BUSH
from serving import API, created, patched, revision

SHELL = f"{API}/models/plain_bearing/versions/1"
SENT = {"Content-Type": "model/step"}
WAIT = {"Prefer": "wait=60"}


def verified(http, step):
    answer = http.post(f"{API}/verify", content=step, headers=SENT)
    assert answer.status_code == 200, answer.text
    return answer.json()


def stated(answer, kind):
    return {s["name"]: s["stated"] for s in answer.get("statements", []) if s["kind"] == kind}


def step_of(http, design):
    answer = http.get(f"{API}/designs/{design['id']}/models/shell/model.step", headers=WAIT)
    assert answer.status_code == 200, answer.text
    return answer.content


def fitted(**parameters):
    return {
        "name": "fitted shell",
        "parameters": {"bore": "48 mm H7", "width": "24 mm"},
        "models": {
            "shell": {
                "id": "plain_bearing",
                "version": 1,
                "parameters": {**BUSH, "inner_diameter": "= bore", "width": "= width", **parameters},
            }
        },
    }


@pytest.fixture(scope="module")
def design(http):
    return created(http, fitted(wall="2.4 mm ± 5 um"))


@pytest.fixture(scope="module")
def step(http, design):
    return step_of(http, design)


def test_a_stamped_download_states_its_limits_and_they_agree(http, step):
    answer = verified(http, step)
    assert answer["intact"] is True
    assert stated(answer, "dimension") == {"inner_diameter": [48.0, 0.0, 0.025], "wall": [2.4, -0.005, 0.005]}
    assert stated(answer, "cylindricity") == {"inner_diameter": [0.0125]}
    assert list(stated(answer, "material").values()) == [["steel"]]
    assert {s["unit"] for s in answer["statements"] if s["kind"] == "volume"} == {"mm**3"}
    assert all(s["agrees"] for s in answer["statements"])


def test_a_changed_limit_is_named(http, step):
    changed, count = re.subn(rb"LENGTH_MEASURE\(2\.5E-02\)", b"LENGTH_MEASURE(3.5E-02)", step)
    answer = verified(http, changed)
    wrong = [s for s in answer["statements"] if not s["agrees"]]
    assert count == 1
    assert answer["intact"] is False
    assert [(s["name"], s["expected"], s["stated"]) for s in wrong] == [
        ("inner_diameter", [48.0, 0.0, 0.025], [48.0, 0.0, 0.035])
    ]


def test_statements_beyond_those_of_the_build_are_counted_no_further(http, step):
    head, end, tail = step.rpartition(b"ENDSEC;")
    more = b"".join(b"#%d = DATUM('','',#4,.F.,'%s');\n" % (10**6 + n, b"Q" * 999) for n in range(5000))
    answer = verified(http, head + more + end + tail)
    extra = [s for s in answer["statements"] if not s["agrees"]]
    assert len(extra) == 10
    assert {len(s["name"]) for s in extra} == {200}
    assert all(s["expected"] is None for s in extra)


@pytest.mark.parametrize("number", [b"1.E9999", b"-1.E9999", b"1" * 5000 + b".", b".", b"''"])
def test_a_number_that_is_none_is_no_statement(http, step, number):
    changed = re.sub(rb"VOLUME_MEASURE\([^)]*", b"VOLUME_MEASURE(" + number, step)
    answer = verified(http, changed)
    assert changed != step
    assert [s["kind"] for s in answer["statements"] if not s["agrees"]] == ["volume"]


def test_a_model_of_its_own_takes_a_tolerance_and_shows_it(http):
    body = {"parameters": {**BUSH, "inner_diameter": "48 mm H7"}, "artifacts": ["step"]}
    build = http.post(f"{SHELL}/build", json=body, headers=WAIT).json()
    plain = http.post(
        f"{SHELL}/build", json={**body, "parameters": {**BUSH, "inner_diameter": "48 mm"}}, headers=WAIT
    ).json()
    bore = {"value": 48.0, "unit": "mm", "upper": 0.025, "lower": 0.0, "zone": "H7"}
    assert build["parameters"]["inner_diameter"] == bore
    assert build["build"] != plain["build"]
    assert build["measurements"] == plain["measurements"]
    assert plain["parameters"]["inner_diameter"] == {"value": 48.0, "unit": "mm"}
    file = http.get(f"{API}/artifacts/{plain['artifacts']['step']}").content
    assert "statements" not in verified(http, file)


@pytest.mark.parametrize(
    ("relation", "limits"),
    [
        ("= bore", [48.0, 0.0, 0.025]),
        ("= bore + 50 um", [48.05, 0.0, 0.025]),
        ("= 2 mm + bore", [50.0, 0.0, 0.025]),
        ("= bore - (1 mm + 1 mm)", [46.0, 0.0, 0.025]),
        ("= 2 * bore", None),
        ("= 100 mm - bore", None),
        ("= bore + width", None),
    ],
)
def test_a_parameter_has_the_limits_of_the_value_that_it_is_or_of_that_plus_a_constant(
    http, relation, limits
):
    answer = verified(http, step_of(http, created(http, fitted(inner_diameter=relation))))
    assert stated(answer, "dimension").get("inner_diameter") == limits


def test_another_tolerance_is_another_revision_with_another_file(http):
    design = created(http, fitted())
    first = step_of(http, design)
    changed = patched(http, design, {"parameters": {"bore": "48 mm H6"}})
    second = step_of(http, design)
    assert stated(verified(http, second), "dimension") == {"inner_diameter": [48.0, 0.0, 0.016]}
    assert stated(verified(http, first), "dimension") == {"inner_diameter": [48.0, 0.0, 0.025]}
    assert revision(http, changed)["models"]["shell"]["parameters"]["inner_diameter"]["zone"] == "H6"


def test_a_dimension_that_the_solid_lacks_is_refused_by_name(http):
    body = {
        "parameters": {**BUSH, "inner_diameter": "48 mm", "oil_hole_diameter": "0 +0.1/0 mm"},
        "artifacts": ["step"],
    }
    answer = http.post(f"{SHELL}/build", json=body, headers=WAIT)
    assert answer.status_code == 422, answer.text
    assert "oil_hole_diameter has a tolerance, but no face shows its 0 mm" in answer.text
