"""A STEP file as a fixed part is stored, checked and measured; and what is refused as a model."""

import hashlib

import pytest
from freecad_files import BINARY, ended, imported, post
from serving import API, created, paper, problem

from app.imported_models.freecad import find
from cad.errors import ProgramMissing
from cad.regenerate import regenerate


@pytest.fixture(scope="module")
def bearing():
    return regenerate("ball_bearing", 1, {"inner_diameter": 0.02})


@pytest.fixture(scope="module")
def model(http, bearing):
    return imported(http, "bought_bearing", bearing.step, file="6004 é.stp")


def build(http, model):
    return http.post(f"{model}/build", json={"parameters": {}}, headers={"Prefer": "wait=60"})


def test_a_step_file_becomes_a_part_of_the_same_measures(http, model, bearing):
    answer = build(http, model)
    assert answer.status_code == 200, answer.text
    measured = answer.json()["measurements"]
    assert measured["volume"]["value"] == pytest.approx(bearing.measures["volume"], rel=1e-9)
    high = [bearing.measures[f"high_{axis}"] for axis in "xyz"]
    assert measured["bounding_box"]["high"]["value"] == pytest.approx(high, abs=1e-6)
    assert measured["dimensions"] == {}
    assert measured["trust"].startswith("lower: the shape is that of the solids in the STEP file")


def test_it_says_where_it_comes_from(http, model, bearing):
    origin = http.get(model).json()["origin"]
    assert (origin["program"], origin["file"], origin["parameters"]) == ("step", "6004 é.stp", [])
    assert origin["sha256"] == hashlib.sha256(bearing.step).hexdigest()
    assert http.get(f"{model}/original").content == bearing.step
    assert "origin" not in http.get(f"{API}/models/ball_bearing/versions/1").json()


def test_a_design_uses_it(http, model):
    document = {**paper(), "model": {"id": "bought_bearing", "version": 1, "parameters": {}}}
    design = created(http, document)
    assert design["state"] == "current"
    measured = http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]
    assert measured["mass"]["value"] > 0


def test_it_lists_among_the_models(http, model):
    listed = http.get(f"{API}/models", params={"limit": 500}).json()["items"]
    assert [one["title"] for one in listed if one["id"] == "bought_bearing"] == ["Fixed part 6004 é"]


@pytest.mark.parametrize("content", [b"", b"solid stl", b"PK\x05\x06" + 18 * b"\0", b"%PDF-1.7"])
def test_a_file_of_another_kind_is_refused_at_once(http, content):
    answer = post(http, "nothing", content)
    problem(answer, 422, "unreadable-model")
    assert answer.json()["errors"][0]["code"] == "not_a_model"


@pytest.mark.parametrize("content", [b"ISO-10303-21;\nHEADER;\n", b"ISO-10303-21;" + bytes(1000)])
def test_a_damaged_step_file_is_a_problem_of_its_job(http, content):
    job = ended(http, post(http, "damaged", content))
    assert (job["state"], job["problem"]["status"]) == ("failed", 422)


@pytest.mark.parametrize("id", ["ball_bearing", "oil_film"])
def test_an_id_of_this_program_is_taken(http, id, bearing):
    problem(post(http, id, bearing.step), 409, "model-id-taken")


@pytest.mark.parametrize("id", ["import", "cap_v2", "Cap", "1cap", "a__b", ""])
def test_an_id_that_means_something_else_is_refused(http, id, bearing):
    problem(post(http, id, bearing.step), 422, "invalid-inputs")


def test_a_key_of_another_import_is_refused(http, bearing):
    headers = {**BINARY, "Idempotency-Key": "one import"}

    def sent(id):
        return http.post(f"{API}/models/import", params={"id": id}, content=bearing.step, headers=headers)

    first = sent("keyed_bearing")
    assert sent("keyed_bearing").headers["Location"] == first.headers["Location"]
    problem(sent("other_bearing"), 422, "idempotency-key-reused")


def test_a_body_of_another_type_is_refused(http):
    answer = http.post(f"{API}/models/import", params={"id": "some"}, json={})
    problem(answer, 415, "not-model")
    assert BINARY["Content-Type"] in answer.json()["detail"]


def test_without_freecad_it_is_said_how_to_install_it(tmp_path):
    with pytest.raises(ProgramMissing, match="apt install freecad-python3") as caught:
        find(tmp_path)
    assert caught.value.code == "program_missing"


def test_a_service_without_freecad_says_on_the_page_how_to_install_it(http, served, monkeypatch, tmp_path):
    warm = served.app.state.services.model_imports.programs.freecad.warm
    monkeypatch.setattr(warm, "find", lambda: find(tmp_path))
    answer = post(http, "no_program", b"PK\x03\x04 of FreeCAD")
    problem(answer, 503, "program-missing")
    assert "apt install freecad-python3" in answer.json()["detail"]
    page = http.get("/models/import")
    assert page.status_code == 200
    assert "apt install freecad-python3" in page.text
    (freecad, _, fixed) = http.get(f"{API}/models/import").json()["items"]
    assert (freecad["available"], fixed["available"]) == (False, True)
