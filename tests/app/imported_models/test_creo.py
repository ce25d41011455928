"""A running Creo through CREOSON, replayed: one session, its failures by name, the last good model."""

import json
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from creoson import RECORDED, creoson
from freecad_files import ended, imported, post
from serving import API, created, paper, patched, problem

from app.imported_models.creo.manifest import read
from app.imported_models.creo.session import CreoDrawing, Creoson
from app.imported_models.programs import CreoModels
from app.workers.errors import DeadlineExceeded, JobCancelled
from cad.errors import GeometryError, ProgramMissing, UnreadableModel

MANIFEST = {
    "program": "creo",
    "title": "Bearing of the paper",
    "file": "bearing.prt",
    "parameters": [
        {"name": "bearing_diameter", "dimension": "BORE", "unit": "mm", "value": 50.0, "low": 10.0,
         "high": 200, "check": "diameter"},
        {"name": "scale", "parameter": "SCALE", "unit": "1", "value": 1.0, "low": 0.1, "high": 9.0},
    ],
}  # fmt: skip
CONTENT = json.dumps(MANIFEST).encode()
REFUSED = json.dumps({"status": {"error": True, "message": "as Creo says"}})
NOT_RUNNING = json.dumps({"status": {"error": False}, "data": {"running": False}})
NONE = ["", "<html>", "[]", "{}", '{"status": {}}', '{"status": {"error": false}, "data": 3}']
FAILURES = {
    "connect": (REFUSED, "creo_unreachable"),
    "is_creo_running": (NOT_RUNNING, "creo_unreachable"),
    "open": (REFUSED, "creo_open"),
    "set": (REFUSED, "creo_dimension"),
    "regenerate": (REFUSED, "creo_regenerate"),
    "massprops": (REFUSED, "creo_mass_properties"),
    "export_file": (REFUSED, "creo_export"),
}


@pytest.fixture
def replay(tmp_path):
    with creoson(tmp_path) as replay:
        yield replay


def drawing(replay, seconds=20.0):
    return CreoDrawing(Creoson(replay.url, "C:/exports", replay.folder), seconds)


def draw(drawing, cancelled=None, **values):
    manifest = read(CONTENT)
    described = manifest.described("sha", "bearing.json")
    return drawing.draw_manifest(manifest, described, values, cancelled or threading.Event())


def test_the_recorded_session_sets_regenerates_measures_and_exports(replay):
    drawn = draw(drawing(replay), bearing_diameter=48.0)
    assert replay.calls == [(one["request"]["command"], one["request"]["function"]) for one in RECORDED]
    assert replay.strange == []
    assert replay.values["BORE"] == 48.0
    assert drawn.mass_volume == pytest.approx(replay.volume())
    assert drawn.step.startswith(b"ISO-10303-21;")
    assert not list(replay.folder.glob("crankwright_*"))  # nothing is left in the folder for exports


def test_the_version_of_creo_is_said_where_the_operator_sets_it(replay):
    newer = CreoDrawing(Creoson(replay.url, "C:/exports", replay.folder, version=9), 20.0)
    replay.wrong["set_creo_version"] = json.dumps({"status": {"error": False}, "data": None})
    draw(newer)
    assert replay.calls[2] == ("creo", "set_creo_version")
    assert replay.strange[0]["data"] == {"version": 9}


def test_the_dimension_may_be_called_d_as_in_the_paper():
    """CREOSON 3.0.1 fails to set it; what it answers is said then, and not before."""
    named = {**MANIFEST, "parameters": [{**MANIFEST["parameters"][0], "dimension": "D"}]}
    assert read(json.dumps(named).encode()).parameters[0].dimension == "D"


@pytest.mark.parametrize("function", FAILURES)
def test_each_failure_of_a_session_has_its_name(replay, function):
    replay.wrong[function], code = FAILURES[function]
    with pytest.raises(GeometryError) as caught:
        draw(drawing(replay))
    assert caught.value.code == code
    assert isinstance(caught.value, ProgramMissing) == (code == "creo_unreachable")
    if function not in ("connect", "is_creo_running"):
        assert "as Creo says" in caught.value.detail
        assert replay.calls[-1] == ("connection", "disconnect")
    if function == "set":
        assert caught.value.parameters == ("bearing_diameter",)


@pytest.mark.parametrize("text", NONE)
def test_an_answer_that_is_none_has_its_name(replay, text):
    replay.wrong["open"] = text
    with pytest.raises(GeometryError) as caught:
        draw(drawing(replay))
    assert caught.value.code == "creo_answer"


@pytest.mark.parametrize("volume", [None, True, "19981", -1, 0])
def test_mass_properties_without_a_volume_are_refused(replay, volume):
    replay.wrong["massprops"] = json.dumps({"status": {"error": False}, "data": {"volume": volume}})
    with pytest.raises(GeometryError) as caught:
        draw(drawing(replay))
    assert caught.value.code == "creo_mass_properties"


@pytest.mark.parametrize("name", ["missing.stp", "../../etc/passwd", "a\0b", ""])
def test_a_file_that_is_not_there_is_named(replay, name):
    replay.wrong["export_file"] = json.dumps({"status": {"error": False}, "data": {"filename": name}})
    with pytest.raises(GeometryError) as caught:
        draw(drawing(replay))
    assert caught.value.code == "creo_export"


def test_nobody_answering_is_said(tmp_path):
    closed = CreoDrawing(Creoson("http://127.0.0.1:9/creoson", "C:/", tmp_path), 5.0)
    with pytest.raises(ProgramMissing, match="Start Creo and CREOSON"):
        draw(closed)


def test_one_session_at_a_time(replay):
    creo = drawing(replay)
    with ThreadPoolExecutor(4) as pool:
        drawn = list(pool.map(lambda bore: draw(creo, bearing_diameter=bore), (40.0, 44.0, 48.0, 52.0)))
    assert replay.most == 1
    assert len({one.mass_volume for one in drawn}) == 4


def test_who_waits_for_a_session_may_give_up(replay):
    creo = drawing(replay, seconds=0.2)
    gone = threading.Event()
    gone.set()
    with creo._turn:
        with pytest.raises(DeadlineExceeded):
            draw(creo)
        with pytest.raises(JobCancelled):
            draw(creo, gone)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"file": "../secret.prt"}, "file"),
        ({"parameters": []}, "parameters"),
        ({"title": " ... "}, "title"),
        ({"title": "two\nlines"}, "title"),
        ({"parameters": [{**MANIFEST["parameters"][0], "words": "two\nlines"}]}, "parameters.0.words"),
        ({"parameters": [{**MANIFEST["parameters"][0], "dimension": "D\0"}]}, "parameters.0.dimension"),
        ({"url": "http://elsewhere"}, "url"),
        ({"file": f"{32 * 'a'}.prt"}, "file"),
        ({"parameters": [{**MANIFEST["parameters"][1], "parameter": "two words"}]}, "parameters.0.parameter"),
        ({"parameters": [{**MANIFEST["parameters"][0], "value": 5.0}]}, "not between 10 and 200"),
        ({"parameters": [{**MANIFEST["parameters"][0], "parameter": "X"}]}, "either the dimension"),
        ({"parameters": 2 * MANIFEST["parameters"][:1]}, "two parameters are called bearing_diameter"),
        ({"parameters": [{**MANIFEST["parameters"][1], "check": "radius"}]}, "only a length"),
    ],
)
def test_a_wrong_manifest_names_what_is_wrong(change, said):
    with pytest.raises(UnreadableModel, match=said) as caught:
        read(json.dumps({**MANIFEST, **change}).encode())
    assert caught.value.code == "manifest"


@pytest.fixture
def driven(served, replay, monkeypatch):
    """The service with a Creo."""
    programs = served.app.state.services.model_imports.programs
    monkeypatch.setitem(programs.by_name, "creo", CreoModels(programs.freecad._store, drawing(replay, 30.0)))
    return replay


def test_a_design_drives_creo_and_keeps_its_last_good_model(http, driven):
    model = imported(http, "creo_bearing", CONTENT, file="bearing.json")
    assert http.get(model).json()["origin"]["program"] == "creo"
    document = paper()
    document["model"] = {
        "id": "creo_bearing", "version": 1, "parameters": {"bearing_diameter": "= film.bearing_diameter"},
    }  # fmt: skip
    design = created(http, document)
    assert design["state"] == "current"
    place = f"{API}/designs/{design['id']}"
    measured = http.get(f"{place}/measurements").json()["model"]
    assert measured["dimensions"]["bearing_diameter"]["value"] == driven.values["BORE"] == 48
    assert measured["volume"]["value"] == pytest.approx(driven.volume(), rel=1e-9)
    assert "lower: Creo drew the shape" in measured["trust"]
    good = http.get(f"{place}/model.step")
    driven.wrong["regenerate"] = REFUSED
    failed = patched(http, design, {"steps": {"film": {"inputs": {"bearing_diameter": "52 mm"}}}})
    assert failed["state"] == "failed"
    assert failed["problem"]["errors"][0]["code"] == "creo_regenerate"
    last = http.get(f"{place}/model.step")
    assert last.headers["Design-Revision"] == good.headers["Design-Revision"] == "1"
    assert last.status_code == 200


def test_a_volume_other_than_creo_says_is_refused(http, driven):
    driven.wrong["massprops"] = json.dumps({"status": {"error": False}, "data": {"volume": 1000.0}})
    job = ended(http, post(http, "creo_other", CONTENT))
    assert job["state"] == "failed"
    assert (job["problem"]["status"], job["problem"]["errors"][0]["code"]) == (422, "volume")


def test_without_creo_it_is_said_what_to_set(http):
    job = ended(http, post(http, "no_creo", CONTENT))
    assert job["problem"]["status"] == 503
    assert "CRANKWRIGHT_CREOSON_URL" in job["problem"]["detail"]


def test_a_manifest_that_is_wrong_is_refused_at_once(http):
    answer = post(http, "wrong_manifest", b'{"program": "creo"}')
    problem(answer, 422, "unreadable-model")
    assert "title" in answer.json()["detail"]
