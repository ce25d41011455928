"""The page that adds a bought part to a model of a design, and shows the measurements."""

import json

import pytest
from freecad_files import imported
from serving import API, created, settled
from test_assemblies import bolt_step

MODEL = {"id": "bearing_assembly", "version": 1, "parameters": {"journal_diameter": "48 mm"}}


@pytest.fixture(scope="module")
def bolt(http):
    return imported(http, "page_bolt", bolt_step(), file="bolt.stp")


@pytest.fixture(scope="module")
def design(http, bolt):
    return created(http, {"name": "with a bolt", "models": {"main": MODEL}})


def sent(http, into, **typed):
    form = {
        "source": "page_bolt:1",
        "component": "bolt",
        "datum": "cap.low_y",
        "id": "page_assembly",
        **typed,
    }
    return http.post(f"/designs/{into['id']}/models/main/beside", data=form)


def test_the_page_of_a_design_leads_to_the_form_that_offers_what_was_brought(http, design):
    assert f"/designs/{design['id']}/models/main/beside" in http.get(f"/designs/{design['id']}").text
    form = http.get(f"/designs/{design['id']}/models/main/beside")
    assert form.status_code == 200
    assert '<option value="page_bolt:1">' in form.text
    assert "bearing_assembly_with_parts" in form.text
    assert "deep_groove_bearing" not in form.text


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ({"x": "much"}, "x: "),
        ({"source": ""}, "give either"),
        ({"source": "page_bolt:77"}, "it has versions 1"),
        ({"source": "page_bolt:" + 5000 * "9"}, "version"),
        ({"component": ""}, "components.0.name"),
        ({"id": "ball_bearing"}, "ball_bearing is already the id of"),
        ({"id": ""}, "id"),
        ({"design": "x" * 3000}, "design"),
    ],
)
def test_what_is_not_taken_is_explained_beside_what_was_typed(http, design, typed, said):
    answer = sent(http, design, **typed)
    assert answer.status_code in (409, 422)
    assert 'role="alert"' in answer.text
    assert said in answer.text
    assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == 1


def test_a_model_that_is_not_there_is_not_found(http, design):
    assert http.get(f"/designs/{design['id']}/models/other/beside").status_code == 404


@pytest.mark.slow
def test_a_part_is_put_beside_and_measured_then_another_and_their_interference_is_named(http, bolt):
    design = created(http, {"name": "two bolts", "models": {"main": MODEL}})
    assert sent(http, design, z="2 mm").status_code == 303
    after = settled(http, design["id"])
    assert (after["state"], after["models"]["main"]["id"]) == ("current", "page_assembly")
    assert after["models"]["main"]["parameters"] == {"journal_diameter": "48 mm"}
    page = http.get(f"/designs/{design['id']}").text
    assert "Clearances" in page
    assert "cap, bolt" in page
    assert sent(http, after, component="second", datum="bolt.centre", x="5 mm").status_code == 303
    failed = settled(http, design["id"])
    assert failed["state"] == "failed"
    assert "bolt and second overlap by" in failed["problem"]["detail"]
    assert "bolt and second overlap by" in http.get(f"/designs/{design['id']}").text
    version = failed["models"]["main"]["version"]
    original = http.get(f"{API}/models/page_assembly/versions/{version}/original")
    assert [one["name"] for one in json.loads(original.content)["components"]] == ["bolt", "second"]
