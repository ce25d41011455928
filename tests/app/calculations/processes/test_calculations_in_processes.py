"""Expensive calculations over HTTP run in separate processes, with clients in turn."""

import os
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest
from patience import until
from serving import API, faults, problem, serving
from sleepers import FILM, FILM_PLACE, SLEEPER, begun, followed, sleep, without_time
from sleeping import folder_of_sleeper
from test_workers import alive, eventually

from app.calculations.bodies import EvaluateIn, SolveIn
from app.calculations.service import run_evaluate, run_solve
from app.calculations.worksheet import run_worksheet
from app.catalogue.discovery import find_templates
from app.pool.cost import EXPENSIVE, estimated_seconds
from app.settings import Settings


def test_it_is_calculated_in_another_process(http, log):
    answer = sleep(http).json()
    assert answer["outputs"]["process"]["value"] == begun(log)[0] != os.getpid()


def test_the_server_comes_first(server):
    pool = server.app.state.services.calculations
    niceness = pool.submit("tests", os.getpriority, os.PRIO_PROCESS, 0).future.result(60)
    assert niceness == min(19, os.getpriority(os.PRIO_PROCESS, 0) + 10)
    assert pool.submit("tests", os.getsid, 0).future.result(60) == os.getsid(0)  # else it would not count


def test_processes_are_used_again(http, log):
    assert {sleep(http).json()["outputs"]["process"]["value"] for _ in range(3)} == {begun(log)[0]}


LOADS = {"value": [10.0 + number for number in range(10)], "unit": "kN"}
"""So many points leave the server's process at the levels that solve."""


@pytest.mark.parametrize("level", ["reynolds", "mass_conserving"])
def test_answers_are_those_of_this_process(http, level):
    inputs = {**FILM.example, "radial_load": LOADS}
    body = {"inputs": inputs, "level": level, "outputs": ["minimum_film_thickness", "side_flow"]}
    assert estimated_seconds(FILM, inputs, level, outputs=body["outputs"]) > EXPENSIVE
    answer = followed(http, http.post(f"{FILM_PLACE}/evaluate", json=body))
    assert without_time(answer.json()) == without_time(run_evaluate(FILM, EvaluateIn(**body)))


def test_a_worksheet_is_that_of_this_process(http):
    body = {"inputs": dict(FILM.example), "level": "mass_conserving", "outputs": ["minimum_film_thickness"]}
    answer = followed(http, http.post(f"{FILM_PLACE}/worksheet", json=body, params={"units": "us"})).json()
    assert without_time(answer) == without_time(run_worksheet(FILM, EvaluateIn(**body), "us"))


def test_a_solution_is_that_of_this_process(http):
    body = {
        "inputs": {name: value for name, value in FILM.example.items() if name != "bearing_width"},
        "unknown": "bearing_width",
        "between": ["10 mm", "40 mm"],
        "target": {"minimum_film_thickness": "2 um"},
        "level": "map",
    }
    answer = followed(http, http.post(f"{FILM_PLACE}/solve", json=body)).json()
    same = run_solve(FILM, SolveIn(**body))
    assert answer["unknown"] == same["unknown"]
    assert answer["evaluation"]["outputs"] == same["evaluation"]["outputs"]


def test_a_large_body_gives_the_same_answer(http):
    cls = find_templates(()).get("oil_film", 1)
    loads = {"value": [6.0 + 0.001 * number for number in range(40_000)], "unit": "kN"}
    body = {"inputs": {**cls.example, "radial_load": loads}, "outputs": ["minimum_film_thickness"]}
    answer = http.post(f"{API}/templates/oil_film/versions/1/evaluate", json=body)
    assert int(answer.request.headers["content-length"]) > 256 * 1024
    assert without_time(answer.json()) == without_time(run_evaluate(cls, EvaluateIn(**body)))


PADDING = {"value": [1.0] * 200_000, "unit": "kN"}


@pytest.mark.parametrize("operation", ["evaluate", "worksheet"])
@pytest.mark.parametrize(
    "body",
    [
        {
            "inputs": {**FILM.example, "radial_load": {**PADDING, "unit": "furlong"}},
            "outputs": ["side_flow"],
        },
        {"inputs": {"radial_load": PADDING}, "output": []},
        {"inputs": {"radial_load": PADDING}, "outputs": "all"},
        {"inputs": {"radial_load": PADDING}, "tolerance": 2},
        [PADDING],
    ],
)
@pytest.mark.sampled(4)
def test_a_large_body_is_refused_as_a_small_one(http, body, operation):
    large = faults(http.post(f"{FILM_PLACE}/{operation}", json=body))
    small = _with_short_lists(body)
    assert large == faults(http.post(f"{FILM_PLACE}/{operation}", json=small))


def _with_short_lists(raw):
    if isinstance(raw, dict):
        return {name: _with_short_lists(part) for name, part in raw.items()}
    return [_with_short_lists(part) for part in raw[:2]] if isinstance(raw, list) else raw


def test_a_large_body_that_is_no_json_is_refused(http):
    answer = http.post(
        f"{FILM_PLACE}/evaluate", content="[" + "1," * 200_000, headers={"Content-Type": "application/json"}
    )
    assert faults(answer) == {"body": "json_invalid"}


def test_a_large_body_for_no_template_is_refused(http):
    place = f"{API}/templates/nothing/versions/1/evaluate"
    problem(http.post(place, json={"inputs": {"x": PADDING}}), 404, "unknown-template")


@pytest.mark.parametrize(("mood", "slug"), [("dies", "crashed"), ("eats", "memory")])
def test_a_process_that_dies_harms_nobody_else(http, mood, slug):
    problem(sleep(http, mood=mood), 422, slug)
    assert sleep(http).status_code == 200


def test_who_leaves_frees_the_process(http, log):
    with pytest.raises(httpx.ReadTimeout):
        http.post(f"{SLEEPER}/evaluate", json={"inputs": {"duration": "60 s"}}, timeout=1.0)
    assert eventually(lambda: not alive(begun(log)[0]))


def test_too_many_are_asked_to_come_again_and_a_flood_gives_way(http, log):
    def ask(client):
        return sleep(http, "0.5 s", **{"Crankwright-Client": client})

    with ThreadPoolExecutor(6) as threads:
        first = threads.submit(ask, "flood")
        begun(log)
        flood = [threads.submit(ask, "flood") for _ in range(3)]
        refused = next(f for f in _done_first(flood))
        newcomer = threads.submit(ask, "newcomer")
        assert newcomer.result().status_code == 200
        statuses = sorted(f.result().status_code for f in (first, *flood))
    refusal = problem(refused.result(), 429, "queue-full")
    assert "calculations are waiting" in refusal["detail"]
    assert refused.result().headers["Retry-After"] == "5"
    assert statuses == [200, 200, 429, 429]


def _done_first(futures):
    assert eventually(lambda: any(f.done() for f in futures), 20)
    return [f for f in futures if f.done()]


def design(duration):
    return {
        "name": "sleep",
        "steps": {"s": {"template": "sleeper", "version": 1, "inputs": {"duration": duration}}},
    }


def test_a_step_of_a_design_is_calculated_in_another_process(http, log):
    response = http.post(f"{API}/designs", json=design("11 ms"))
    assert response.status_code == 201, response.text
    steps = http.get(f"{API}/designs/{response.json()['id']}/revisions/1").json()["steps"]
    assert steps["s"]["outputs"]["process"]["value"] == begun(log)[0] != os.getpid()


def test_a_step_that_is_refused_or_crashes_says_so(http):
    problem(http.post(f"{API}/designs", json=design("-1 s")), 422, "invalid-inputs")
    wrong = design("1 ms")
    wrong["steps"]["s"]["inputs"]["mood"] = "dies"
    problem(http.post(f"{API}/designs", json=wrong), 422, "crashed")


@pytest.mark.slow
def test_a_preview_that_nobody_waits_for_ends(http, log):
    place = f"{API}/designs/{http.post(f'{API}/designs', json=design('12 ms')).json()['id']}"
    (process,) = begun(log)
    patch = {"steps": {"s": {"inputs": {"duration": "60 s"}}}}
    with pytest.raises(httpx.ReadTimeout):
        http.post(f"{place}/preview", json=patch, timeout=1.0)
    assert eventually(lambda: not alive(begun(log, 2)[1]))
    assert http.get(place).status_code == 200
    assert process


def test_a_page_waits_for_its_calculation_within_the_process(server, http):
    page = http.get(f"/designs/{http.post(f'{API}/designs', json=design('13 ms')).json()['id']}")
    assert page.status_code == 200


def test_a_file_that_changed_is_calculated_as_it_is_now(tmp_path, monkeypatch, log):
    monkeypatch.setenv("SLEEPER_LOG", str(log))
    own = folder_of_sleeper(tmp_path / "own")
    chosen = Settings(data=tmp_path / "data", template_folders=(own,), calculation_processes=1)
    with serving(chosen) as server, httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        file = own / "sleeper_v1.py"
        assert sleep(http).json()["outputs"]["process"]["value"] > 0
        file.write_text(file.read_text().replace("return np.float64(os.getpid())", "return np.float64(-1)"))
        until(lambda: sleep(http).json()["outputs"]["process"]["value"] == -1)
