"""Outputs as a NumPy file over HTTP have the values of the JSON answer, or are refused with a reason."""

from io import BytesIO
from types import SimpleNamespace

import httpx
import numpy as np
import pytest
from serving import API, problem, serving

from app.calculations.array_files import NPY, npy
from app.calculations.bodies import OIL_FILM
from app.calculations.errors import NoArray
from app.client import Client, Problem
from app.settings import Settings
from templates.core.language.answer import Answer

PLACE = f"{API}/templates/oil_film/versions/1/evaluate"
FILM = "minimum_film_thickness"
AS_ARRAY = {"Accept": NPY}
FEW = [20.0, 25.0, 30.0]
MANY = np.round(np.linspace(6.3, 200, 60_000), 3).tolist()  # a body that a calculation process reads


@pytest.fixture(scope="module")
def http(tmp_path_factory):
    with serving(Settings(data=tmp_path_factory.mktemp("arrays"))) as server:
        with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
            yield http


def asked(loads, *outputs, **more):
    load = loads if isinstance(loads, str) else {"value": loads, "unit": "kN"}
    return {"inputs": {**OIL_FILM, "radial_load": load}, "outputs": list(outputs or [FILM]), **more}


def loaded(answer):
    assert answer.status_code == 200, answer.text
    assert answer.headers["Content-Type"] == NPY
    return np.load(BytesIO(answer.content), allow_pickle=False)


@pytest.mark.parametrize("loads", [FEW, MANY, [[20.0, 25.0], [30.0, 35.0]]], ids=["few", "many", "grid"])
def test_the_values_are_those_of_json(http, loads):
    table = loaded(http.post(PLACE, json=asked(loads), headers=AS_ARRAY))
    json = http.post(PLACE, json=asked(loads)).json()["outputs"][FILM]
    assert table.shape == np.shape(loads)
    assert np.array_equal(table[FILM], json["value"])
    assert table.dtype.fields[FILM][2] == f"{FILM} [{json['unit']}]"


def test_units_and_several_outputs_are_fields(http):
    body = asked(FEW, FILM, "density", units={FILM: "mm"})
    table, json = loaded(http.post(PLACE, json=body, headers=AS_ARRAY)), http.post(PLACE, json=body).json()
    assert table.dtype.names == (FILM, "density")
    assert next(title for title in table.dtype.fields if "[" in title) == f"{FILM} [mm]"
    assert np.array_equal(table[FILM], json["outputs"][FILM]["value"])
    assert set(table["density"].tolist()) == {json["outputs"]["density"]["value"]}  # one value for all


def test_one_point_is_an_array_of_no_dimension(http):
    table = loaded(http.post(PLACE, json=asked("25 kN"), headers=AS_ARRAY))
    assert table.shape == ()
    assert float(table[FILM]) == pytest.approx(3.2449, abs=5e-5)


def test_a_point_without_a_value_is_refused_with_its_reason(http):
    answer = http.post(PLACE, json=asked([25.0, 1e6]), headers=AS_ARRAY)
    reasons = http.post(PLACE, json=asked([25.0, 1e6])).json()["outputs"][FILM]["reasons"]
    assert problem(answer, 406, "no-array")["detail"].startswith(
        f"{FILM} has no value at 1 of 2 points ({reasons[1]}"
    )


def test_outputs_of_two_shapes_are_refused_by_name():
    outputs = {"load": Answer(np.ones(3), "N"), "speed": Answer(1.0, "rpm"), "curve": Answer(np.ones(5), "N")}
    with pytest.raises(NoArray, match=r"load has the shape \(3,\), but curve has \(5,\)"):
        npy(SimpleNamespace(outputs=outputs))


def test_a_text_is_refused_by_name():
    with pytest.raises(NoArray, match="layout is text"):
        npy(SimpleNamespace(outputs={"layout": Answer("in-line", None)}))


def test_json_comes_where_it_is_preferred_or_nothing_is_said(http):
    for kinds in ("application/json", f"application/json, {NPY}", "*/*"):
        assert http.post(PLACE, json=asked(FEW), headers={"Accept": kinds}).json()["outputs"]


def test_faults_of_a_request_are_problems_in_json(http):
    for loads in (FEW, MANY):
        answer = http.post(PLACE, json=asked(loads, "film"), headers=AS_ARRAY)
        assert problem(answer, 422, "invalid-inputs")["errors"][0]["name"] == "film"


def test_the_client_returns_the_array_also_of_a_job(http):
    with Client(str(http.base_url)) as client:
        inputs = asked(FEW)["inputs"]
        table = client.evaluate_array("oil_film", 1, inputs, outputs=[FILM])
        json = client.evaluate("oil_film", 1, inputs, outputs=[FILM]).outputs[FILM].value
        assert table[FILM].tolist() == json
        with pytest.raises(Problem, match="no value"):
            client.evaluate_array("oil_film", 1, {**inputs, "radial_load": {"value": [1e6], "unit": "kN"}})


def test_a_job_keeps_the_form(http):
    answer = http.post(PLACE, json=asked(MANY), headers={**AS_ARRAY, "Prefer": "respond-async"})
    assert answer.status_code == 202
    job = http.get(answer.headers["Location"], params={"wait": 30}).json()
    while job["state"] in ("queued", "running"):
        job = http.get(answer.headers["Location"]).json()
    assert loaded(http.get(job["result"])).shape == (len(MANY),)
