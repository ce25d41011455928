"""A tolerance that no file can state is refused unless it is marked; answers and pages tell where it is."""

import json
from html import unescape

import pytest
from serving import API, created, faults, paper, patched, revision

from app.solids.stated_tolerances import NOWHERE, UNRECORDED
from app.storage.tables import BuildRow, RevisionRow

SPREAD = "0.5 mm ± 0.1 mm"
MARKED = {"value": 0.5, "unit": "mm", "plus": 0.1, "minus": 0.1, "state_in_table": True}
WAIT = {"Prefer": "wait=60"}
NEWEST = {"If-Match": "*"}


def shells(spread, **more):
    """A half shell with limits of its bore."""
    given = {"inner_diameter": "= bore", "wall": "2.4 mm ± 5 um", "free_spread": spread}
    model = {"id": "plain_bearing", "version": 1, "parameters": given}
    return {"name": "shell", "parameters": {"bore": "48 mm H7"}, "models": {"shell": model}, **more}


def model_of(http, design, name="shell"):
    return revision(http, design)["models"][name]


@pytest.fixture(scope="module")
def design(http):
    return created(http, shells(MARKED))


def test_a_save_a_preview_and_a_build_refuse_it_by_name(http, design):
    refused = {"shell.free_spread": "tolerance_not_stated"}
    answer = http.post(f"{API}/designs", json=shells(SPREAD))
    assert faults(answer) == refused
    (fault,) = answer.json()["errors"]
    assert "not the size of a face" in fault["detail"]
    assert "`state_in_table`" in fault["detail"]
    patch = {"models": {"shell": {"parameters": {"free_spread": SPREAD}}}}
    path = f"{API}/designs/{design['id']}"
    assert faults(http.patch(path, json=patch, headers=NEWEST)) == refused
    assert faults(http.post(f"{path}/preview", json=patch)) == refused
    body = {"parameters": {"inner_diameter": "48 mm", "free_spread": SPREAD}}
    answer = http.post(f"{API}/models/plain_bearing/versions/1/build", json=body)
    assert faults(answer) == {"free_spread": "tolerance_not_stated"}


def test_a_variant_refuses_it_by_name(http, design):
    variants = {"wide": {"shell.free_spread": SPREAD}, "fine": {"bore": "50 mm H7"}}
    answer = http.patch(f"{API}/designs/{design['id']}", json={"variants": variants}, headers=NEWEST)
    assert faults(answer) == {"variants.wide.shell.free_spread": "tolerance_not_stated"}


def test_the_remedy_is_accepted_and_the_answer_tells_where_each_tolerance_stands(http, design):
    assert design["state"] == "current", design["problem"]
    model = model_of(http, design)
    assert model["parameters"]["free_spread"] == {
        "value": 0.5, "unit": "mm", "upper": 0.1, "lower": -0.1, "state_in_table": True,
    }  # fmt: skip
    stated = model["tolerances"]
    assert {name: (one["where"], one["drawing"]) for name, one in stated.items()} == {
        "inner_diameter": ("faces", "dimension"),
        "wall": ("faces", "dimension"),
        "free_spread": ("table", "table"),
    }
    assert {face["part"] for face in stated["wall"]["faces"]} == {"upper_back", "upper_lining"}
    assert all(face["face"] >= 1 for face in stated["wall"]["faces"])
    assert "faces" not in stated["free_spread"]
    assert stated["free_spread"]["detail"].startswith("STEP among its attributes; drawing in its table (")
    assert stated["inner_diameter"]["detail"].endswith("drawing at its dimension")
    build = http.get(f"{API}/builds/{model['build']}").json()
    assert build["tolerances"] == stated
    assert "0.5 mm +0.1/-0.1 mm, in table" in http.get(f"{API}/builds/{model['build']}/model.step").text


def test_the_text_of_the_remedy_gives_the_same_build(http, design):
    other = created(http, shells(f"{SPREAD}, in table"))
    assert model_of(http, other)["build"] == model_of(http, design)["build"]


def test_a_tolerance_that_a_relation_brings_is_not_refused_and_is_told_to_be_nowhere(http):
    """The clearance of a film is toleranced for an analysis; an assembly takes it over."""
    document = paper()
    document["steps"]["film"]["inputs"]["diametral_clearance"] = "55 ± 5 um"
    given = {"journal_diameter": "48 mm h6", "diametral_clearance": "= film.diametral_clearance"}
    document["model"] = {"id": "bearing_assembly", "version": 1, "parameters": given}
    design = created(http, document)
    stated = model_of(http, design, "model")["tolerances"]
    assert stated["journal_diameter"]["where"] == "faces"
    assert stated["diametral_clearance"] == NOWHERE.plain()
    outputs = {"outputs": ["film.minimum_film_thickness"], "criteria": [], "points": 1024}
    answer = http.post(f"{API}/designs/{design['id']}/tolerance", json=outputs, headers=WAIT)
    assert answer.status_code == 200, answer.text
    marked = {"steps": {"film": {"inputs": {"diametral_clearance": "55 ± 5 um, in table"}}}}
    stated = model_of(http, patched(http, design, marked), "model")["tolerances"]
    assert (stated["diametral_clearance"]["where"], stated["diametral_clearance"]["drawing"]) == (
        "table",
        "table",
    )


@pytest.fixture(scope="module")
def old(http, served):
    """A revision as an older program stored it: it kept a tolerance that no file stated, and no record."""
    design = created(http, shells("0.5 mm", name="old"))
    model = model_of(http, design)

    def older(session):
        row = session.get(RevisionRow, (design["id"], 1))
        document = json.loads(json.dumps(row.document))
        document["models"]["shell"]["parameters"]["free_spread"] = SPREAD
        row.document = document
        build = session.get(BuildRow, model["build"])
        build.measurements = {n: one for n, one in build.measurements.items() if n != "tolerances"}

    served.app.state.services.database.write(older)
    return design


def test_a_saved_revision_with_such_a_tolerance_stays_readable(http, old):
    stated = model_of(http, old)["tolerances"]
    assert stated["inner_diameter"] == stated["wall"] == UNRECORDED.plain()
    assert stated["free_spread"] == NOWHERE.plain()
    path = f"{API}/designs/{old['id']}"
    assert http.post(f"{path}/preview", json={}).status_code == 200
    assert http.get(f"{path}/report.html", headers=WAIT).status_code == 200


def test_a_saved_tolerance_is_no_reason_to_refuse_another_change_or_a_copy(http, old):
    changed = patched(http, old, {"parameters": {"bore": "49 mm H7"}})
    assert model_of(http, changed)["tolerances"]["free_spread"] == NOWHERE.plain()
    copy = http.post(f"{API}/designs/{old['id']}/copy", json={}, headers=WAIT)
    assert copy.status_code == 201, copy.text
    patch = {"models": {"shell": {"parameters": {"free_spread": "0.5 mm ± 0.2 mm"}}}}
    answer = http.patch(f"{API}/designs/{old['id']}", json=patch, headers=NEWEST)
    assert faults(answer) == {"shell.free_spread": "tolerance_not_stated"}


def test_pages_and_the_report_show_the_sentences_of_the_answer(http, design):
    stated = model_of(http, design)["tolerances"]
    path = f"designs/{design['id']}"
    for page in (path, f"{path}/revisions/1"):
        text = http.get(f"/{page}").text
        for one in stated.values():
            assert one["detail"] in unescape(text).replace("<bdi>", "").replace("</bdi>", ""), page
    report = http.get(f"{API}/{path}/report.html", headers=WAIT)
    assert report.status_code == 200, report.text
    assert "Tolerances in the files" in report.text
    assert stated["free_spread"]["detail"] in unescape(report.text)
