"""Model parameters that are lists, over HTTP: the pins of a shaft come from an engine."""

import pytest
from engines import bearings_of, four_cylinders
from serving import API, created, faults, patched, problem, revision
from study_helpers import done, rows

from app.designs.gallery.gallery import GALLERY

SHAFT = f"{API}/models/crankshaft/versions/1"
PLAIN = {"journal_diameter": "40 mm", "throw": "30 mm", "fillet": "0 mm"}
WAIT = {"Prefer": "wait=60"}


def engine(**inputs):
    return four_cylinders(bore="86 mm", **inputs)


def design(relation, **more):
    parameters = {**PLAIN, "pin_angles": relation, **more}
    model = {"id": "crankshaft", "version": 1, "parameters": parameters}
    return {"name": "shaft", "steps": {"engine": engine()}, "models": {"shaft": model}}


def without_film(document):
    """An engine and its crankshaft: the film of a bearing takes seconds, and no shaft depends on it."""
    steps = {"engine": document["steps"]["engine"]}
    models = {"crankshaft": document["models"]["crankshaft"]}
    return {**document, "steps": steps, "models": models, "variants": {}}


def angles(http, saved):
    return revision(http, saved)["models"]["shaft"]["parameters"]["pin_angles"]


def test_a_shaft_follows_the_layout_of_an_engine_and_its_change(http):
    saved = created(http, design("= engine.crankpin_angles"))
    assert angles(http, saved) == {"value": pytest.approx([0, 180, 180, 360], abs=360), "unit": "deg"}
    first = revision(http, saved)["models"]["shaft"]
    assert [value % 360 for value in first["parameters"]["pin_angles"]["value"]] == [0, 180, 180, 0]
    measured = http.get(f"{API}/builds/{first['build']}").json()["measurements"]["dimensions"]
    assert measured["pin_angles"] == first["parameters"]["pin_angles"]
    assert measured["counterweight_radius"] == {"value": 0.0, "unit": "mm"}  # one for all webs
    changed = patched(http, saved, {"steps": {"engine": {"inputs": {"firing_order": [1, 2, 4, 3]}}}})
    assert changed["state"] == "current"
    assert sorted(value % 360 for value in angles(http, changed)["value"]) == [0, 0, 180, 180]


def test_pin_angles_of_an_engine_are_those_of_its_shaft(http):
    document = design("= engine.pin_angles")
    pins = {"value": [0, 90, 270, 180], "unit": "deg"}
    document["steps"]["engine"] = engine(pin_angles=pins)
    saved = created(http, document)
    assert angles(http, saved) == pins


def test_single_pins_and_numbers_mix_in_a_list(http):
    saved = created(http, design(["= engine.crankpin_angles[2]", "30 deg"]))
    assert [value % 360 for value in angles(http, saved)["value"]] == [180, 30]


@pytest.mark.parametrize(
    ("relation", "name"),
    [
        ("= engine.crankpin_load_x", "shaft.pin_angles"),
        ("= engine.speed", "shaft.pin_angles"),
        ("30 deg", "shaft.pin_angles"),
        ({"value": [[0, 90]], "unit": "deg"}, "shaft.pin_angles"),
    ],
)
def test_what_is_no_list_of_angles_is_refused_by_name(http, relation, name):
    answer = http.post(f"{API}/designs", json=design(relation))
    assert answer.status_code == 422, answer.text
    assert name in faults(answer)


def test_a_list_for_a_single_parameter_is_refused(http):
    document = design("= engine.crankpin_angles", throw="= engine.main_positions")
    answer = http.post(f"{API}/designs", json=document)
    assert faults(answer)["shaft.throw"] == "not_a_number"


class TestOnItsOwn:
    def test_text_and_object_are_one_build(self, http):
        keys = set()
        for pins in ("[0, 120] deg", {"value": [0, 120], "unit": "deg"}, ["0 deg", "120 deg"]):
            body = {"parameters": {**PLAIN, "pin_angles": pins}, "artifacts": ["step"]}
            answer = http.post(f"{SHAFT}/build", json=body, headers=WAIT)
            assert answer.status_code == 200, answer.text
            keys.add(answer.json()["build"])
            assert answer.json()["parameters"]["pin_angles"] == {"value": [0, 120], "unit": "deg"}
        assert len(keys) == 1

    @pytest.mark.parametrize(
        "parameters",
        [
            {"pin_angles": {"value": [[0], [1]], "unit": "deg"}},
            {"pin_angles": {"value": [0], "unit": "deg"}, "throw": {"value": [30, 31], "unit": "mm"}},
            {"pin_angles": {"value": [0] * 17, "unit": "deg"}},
            {"pin_angles": "[" * 3000},
        ],
        ids=["lists of lists", "points", "too many", "brackets"],
    )
    def test_what_is_no_shaft_is_refused(self, http, parameters):
        answer = http.post(f"{SHAFT}/build", json={"parameters": {**PLAIN, **parameters}}, headers=WAIT)
        problem(answer, 422, "invalid-inputs")

    @pytest.mark.parametrize("text", ["[] deg", "[a, b] deg", "[1, 2", "[1, 2] deg deg [", "[[1], [2]] deg"])
    def test_what_is_no_list_is_refused_with_a_list_for_an_example(self, http, text):
        answer = http.post(f"{SHAFT}/build", json={"parameters": {**PLAIN, "pin_angles": text}}, headers=WAIT)
        problem(answer, 422, "invalid-inputs")
        (error,) = answer.json()["errors"]
        assert error["name"] == "pin_angles"
        assert '"[1.5, 2] deg"' in error["detail"]
        assert text.split()[0][:5] in error["detail"]

    def test_a_list_that_is_too_long_a_text_is_refused_with_the_limit(self, http):
        text = f"[{', '.join(['1'] * 2000)}] deg"
        answer = http.post(f"{SHAFT}/build", json={"parameters": {**PLAIN, "pin_angles": text}}, headers=WAIT)
        assert faults(answer) == {"pin_angles": "too_long"}
        assert "2000 characters" in answer.json()["errors"][0]["detail"]

    def test_schema_says_that_it_is_a_list(self, http):
        shown = http.get(SHAFT).json()["parameters"]["properties"]["pin_angles"]
        assert shown["unit"] == "deg"
        assert "list" in str(shown) or "array" in str(shown)

    @pytest.mark.slow
    def test_page_shows_lists_and_takes_them_back(self, http):
        page = http.get("/models/crankshaft/1")
        assert page.status_code == 200
        assert "pin angles" in page.text.lower()
        answer = http.get("/models/crankshaft/1", params={
            "journal_diameter": "40 mm", "pin_angles": "[0, 120, 240] deg", "throw": "30 mm",
        })  # fmt: skip
        assert answer.status_code == 200
        assert "[0, 120, 240] deg" in answer.text
        assert http.get("/models/crankshaft/1", params={"pin_angles": "[0] mm"}).status_code == 422


def test_variants_may_have_pins_of_their_own(http):
    document = design("= engine.crankpin_angles")
    document["variants"] = {"twin": {"shaft.pin_angles": {"value": [0, 180], "unit": "deg"}}, "same": {}}
    saved = created(http, document)
    assert saved["state"] == "current", saved
    shown = http.get(f"{API}/designs/{saved['id']}/variants").json()
    assert {*shown["variants"]} >= {"twin", "same"}
    assert "failed" not in str(shown), shown


@pytest.mark.parametrize(
    ("example", "pins", "journal"),
    [
        ("engine", [0, 180, 180, 0], 26),
        pytest.param("v8", [45, 135, 315, 225], 28, marks=pytest.mark.slow),
    ],
)
def test_engines_of_the_gallery_have_their_crankshaft(http, example, pins, journal):
    saved = created(http, without_film(bearings_of(GALLERY[example].document)))
    assert saved["state"] == "current", saved
    shaft = revision(http, saved)["models"]["crankshaft"]
    angles = shaft["parameters"]["pin_angles"]["value"]
    assert [value % 360 for value in angles] == pytest.approx(pins, abs=1e-9)
    assert shaft["parameters"]["journal_length"]["value"] == pytest.approx(journal)
    answer = http.get(f"{API}/designs/{saved['id']}/models/crankshaft/model.step")
    assert answer.status_code == 200
    assert answer.content.startswith(b"ISO-10303-21;")
    changed = patched(http, saved, {"steps": {"engine": {"inputs": {"crankpin_diameter": "50 mm"}}}})
    assert changed["state"] == "current", changed
    assert revision(http, changed)["models"]["crankshaft"]["build"] != shaft["build"]


@pytest.mark.slow
def test_all_thirteen_bearings_of_the_v8_are_variants(http):
    whole = bearings_of(GALLERY["v8"].document)
    document = {name: value for name, value in whole.items() if name != "models"}
    table = http.get(f"{API}/designs/{created(http, document)['id']}/variants").json()
    assert len(table["variants"]) == 13, table
    assert table["governing"]["criterion"].startswith("film."), table["governing"]


def test_a_study_builds_shafts_whose_pins_follow_from_its_rows(http):
    """Rows vary an angle and a stroke; a list that a row changes makes another solid."""
    parameters = {**PLAIN, "pin_angles": ["0 deg", "= angle"], "throw": "= stroke / 2"}
    saved = created(http, {
        "name": "twin",
        "parameters": {"angle": "180 deg", "stroke": "60 mm"},
        "models": {"shaft": {"id": "crankshaft", "version": 1, "parameters": parameters}},
    })  # fmt: skip
    table = {"angle": {"value": [90, 180], "unit": "deg"}, "stroke": {"value": [60, 60], "unit": "mm"}}
    study = done(http, saved, method="table", rows=table, outputs=["shaft.mass", "shaft.centre_y"])
    assert study["estimate"]["solids"] == 2
    values = [row["values"] for row in rows(http, study)["items"]]
    assert values[0]["shaft.mass"] == pytest.approx(values[1]["shaft.mass"], rel=1e-9)
    assert values[0]["shaft.centre_y"] > 1
    assert abs(values[1]["shaft.centre_y"]) < 1e-6
