"""Calculations that exceed the waiting time continue as jobs, which store their answers."""

import json
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest
from click.testing import CliRunner
from serving import API, faults, heard, problem, serving
from sleepers import FILM, FILM_PLACE, SLEEPER, begun, ended, sleep, without_time
from sleeping import folder_of_sleeper
from test_damage import delete, flip, truncate
from test_workers import alive, eventually

from app.calculations.bodies import EvaluateIn, SolveIn
from app.calculations.operations import LARGE
from app.cli.main import main
from app.client import Client, Problem
from app.imported_models.programs import assembled
from app.jobs import repository
from app.maintenance.repair import Repair
from app.maintenance.rows import NamedFile
from app.settings import Settings
from app.workers.inline import Inline


def test_what_takes_long_goes_on_as_a_job(http, log):
    accepted = sleep(http, "3 s")
    assert accepted.status_code == 202, accepted.text
    place = accepted.headers["Location"]
    job = ended(http, place)
    assert (job["kind"], job["state"]) == ("calculation", "done")
    assert set(job["log"]) == {"half asleep"}
    assert len(begun(log)) == 1  # it was not begun again
    answer = http.get(job["result"])
    assert answer.json()["outputs"]["process"]["value"] == begun(log)[0]
    assert without_time(answer.json()).keys() == without_time(sleep(http).json()).keys()


@pytest.mark.slow
def test_the_client_follows_what_takes_long(server, log):
    with Client(server.url) as client:
        answer = client.evaluate("sleeper", 1, {"duration": "3 s"})
        assert answer.outputs["process"].value == begun(log)[0]
        with pytest.raises(Problem, match="must be") as caught:
            client.evaluate("sleeper", 1, {"duration": "-1 s"})
        assert caught.value.status == 422


def test_who_prefers_so_does_not_wait(http):
    accepted = sleep(http, Prefer="respond-async")
    assert accepted.status_code == 202
    job = accepted.headers["Location"]
    waiting = http.get(job.replace("/jobs/", "/evaluations/"))
    assert waiting.status_code in (200, 202)
    assert http.get(ended(http, job)["result"]).status_code == 200


def test_a_job_that_is_cancelled_ends_its_process(http, log):
    job = sleep(http, "60 s", Prefer="wait=1").headers["Location"]
    (pid,) = begun(log)
    http.delete(job).raise_for_status()
    assert eventually(lambda: not alive(pid))
    assert http.get(job).json()["state"] == "cancelled"
    problem(http.get(job.replace("/jobs/", "/evaluations/")), 409, "cancelled")


@pytest.mark.slow
def test_a_job_ends_at_its_deadline(http):
    job = ended(http, sleep(http, "60 s", Prefer="wait=1").headers["Location"])
    assert job["state"] == "failed"
    problem(http.get(f"{API}/evaluations/{job['id']}"), 422, "deadline")


def test_a_job_that_is_refused_says_why(http):
    body = {"inputs": {"duration": "1 ms", "mood": "refuses"}}
    accepted = http.post(f"{SLEEPER}/evaluate", json=body, headers={"Prefer": "respond-async"})
    job = ended(http, accepted.headers["Location"])
    assert job["problem"]["type"] == "/problems/invalid-inputs"
    assert [fault["name"] for fault in job["problem"]["errors"]] == ["mood"]


MASS_CONSERVING = {**EvaluateIn.model_config["json_schema_extra"]["examples"][0], "level": "mass_conserving"}


SOLVING = {**SolveIn.model_config["json_schema_extra"]["examples"][0], "level": "mass_conserving"}


WRONG = [
    ("evaluate", {"inputs": {**MASS_CONSERVING["inputs"], "speed": "1 N", "sped": 1}}, {"speed", "sped"}),
    (
        "evaluate",
        {"outputs": ["thickness"], "units": {"friction_torque": "m"}},
        {"thickness", "units.friction_torque"},
    ),
    ("evaluate", {"inputs": {**MASS_CONSERVING["inputs"], "bearing_width": "-18 mm"}}, {"bearing_width"}),
    ("evaluate", {"inputs": {}, "tolerance": 2}, {"tolerance"}),
    ("worksheet", {"level": "finest"}, {"level.finest"}),
    (
        "solve",
        {"units": {"minimum_film_thickness": "s"}, "outputs": ["x"]},
        {"x", "units.minimum_film_thickness"},
    ),
    ("solve", {"unknown": "width", "target": {"y": "1 mm"}}, {"unknown", "target.y", "inputs.bearing_width"}),
    ("solve", {"between": ["80 mm", "10 mm"]}, {"between"}),
]


@pytest.mark.parametrize(("operation", "changes", "names"), WRONG)
@pytest.mark.parametrize("prefer", ["respond-async", "wait=0"])
def test_what_is_wrong_is_refused_before_it_becomes_a_job(http, operation, changes, names, prefer):
    body = {**(SOLVING if operation == "solve" else MASS_CONSERVING), **changes}
    before = http.get(f"{API}/jobs", params={"limit": 1}).json()["items"]
    answer = http.post(f"{FILM_PLACE}/{operation}", json=body, headers={"Prefer": prefer})
    assert faults(answer).keys() == names
    assert http.get(f"{API}/jobs", params={"limit": 1}).json()["items"] == before


def test_too_many_points_of_a_level_are_refused_before_they_become_a_job(http):
    speeds = {"value": [3000.0 + n for n in range(500)], "unit": "rpm"}
    body = {**MASS_CONSERVING, "inputs": {**MASS_CONSERVING["inputs"], "speed": speeds}}
    answer = http.post(f"{FILM_PLACE}/evaluate", json=body, headers={"Prefer": "respond-async"})
    assert faults(answer) == {"level": "too_many_points"}


def test_a_large_body_is_refused_before_it_becomes_a_job(http):
    speeds = {"value": [3000.0 + n / 8 for n in range(30_000)], "unit": "N"}
    body = {"inputs": {**MASS_CONSERVING["inputs"], "speed": speeds}, "level": "map"}
    assert len(json.dumps(body)) > LARGE
    answer = http.post(f"{FILM_PLACE}/evaluate", json=body, headers={"Prefer": "respond-async"})
    assert faults(answer) == {"speed": "wrong_unit"}


@pytest.mark.slow
def test_a_large_body_becomes_a_job_without_a_check_if_no_process_is_free(http, log):
    body = {"inputs": {"duration": {"value": [4.0] * 80_000, "unit": "s"}}}
    with ThreadPoolExecutor(1) as threads:
        first = threads.submit(sleep, http, "1.9 s", Prefer="wait=30")
        begun(log)
        accepted = http.post(f"{SLEEPER}/evaluate", json=body, headers={"Prefer": "respond-async"})
        assert accepted.status_code == 202
        http.delete(accepted.headers["Location"]).raise_for_status()
        assert first.result().status_code in (200, 202)


class TestLostAnswers:
    def done(self, http, mood="good"):
        """The row of a job that has ended, and its answer."""
        job = ended(http, sleep(http, mood=mood, Prefer="respond-async").headers["Location"])
        return job, http.get(job["result"])

    def file(self, settings, job):
        sha = job["result"].rpartition("sha256=")[2]
        return settings.data / "artifacts" / sha[:2] / sha

    def asked(self, server, job):
        with server.app.state.services.database.read() as session:
            return repository.get(session, job["id"]).payload["body"]

    @pytest.mark.parametrize("damage", [delete, flip, truncate])
    def test_a_lost_answer_is_calculated_again(self, http, settings, damage):
        job, whole = self.done(http)
        damage(self.file(settings, job))
        again = http.get(job["result"], headers={"Prefer": "wait=30"})
        assert again.status_code == 200
        assert again.json()["inputs"] == whole.json()["inputs"]
        assert again.json()["outputs"].keys() == whole.json()["outputs"].keys()
        new = http.get(f"{API}/jobs/{job['id']}").json()
        assert new["result"] != job["result"], "another time, so other bytes"
        assert http.get(new["result"]).content == again.content

    def test_who_does_not_wait_gets_503_and_the_job(self, http, settings):
        job, _ = self.done(http)
        flip(self.file(settings, job))
        answer = http.get(job["result"], headers={"Prefer": "respond-async"})
        refusal = problem(answer, 503, "rebuilding")
        assert answer.headers["Location"] == refusal["job"]
        assert ended(http, refusal["job"])["state"] == "done"
        assert http.get(job["result"]).status_code == 200
        truncate(self.file(settings, http.get(refusal["job"]).json()))  # a rebuilt answer can be lost as well
        assert http.get(
            refusal["job"].replace("jobs", "evaluations"), headers={"Prefer": "wait=30"}
        ).is_success
        assert http.get(job["result"]).status_code == 200

    def test_without_its_request_it_is_gone(self, server, http, settings):
        job, _ = self.done(http)
        delete(self.file(settings, job))
        server.app.state.services.store.delete(self.asked(server, job))
        refusal = problem(http.get(job["result"]), 410, "artifact-gone")
        assert refusal["errors"][0]["code"] == "answer_lost"

    @pytest.mark.slow
    def test_a_request_that_is_lost_before_its_turn(self, server, http, log):
        ahead = [sleep(http, "1.5 s", Prefer="respond-async").headers["Location"] for _ in range(2)]
        begun(log)
        last = http.get(sleep(http, Prefer="respond-async").headers["Location"]).json()
        assert last["state"] == "queued"
        server.app.state.services.store.delete(self.asked(server, last))
        assert [ended(http, job)["state"] for job in ahead] == ["done", "done"]
        assert ended(http, f"{API}/jobs/{last['id']}")["problem"]["errors"][0]["code"] == "answer_lost"
        problem(http.get(f"{API}/evaluations/{last['id']}"), 410, "artifact-gone")

    def test_repair_calculates_it_again(self, server, http, settings):
        job, _ = self.done(http)
        flip(self.file(settings, job))
        database, store = server.app.state.services.database, server.app.state.services.store
        damaged = NamedFile(self.file(settings, job).name, None, job["id"], "answer")
        repair = Repair(database, store, settings, Inline(), assembled(settings, store))
        assert repair.row(damaged) is None
        new = http.get(f"{API}/jobs/{job['id']}").json()
        assert new["result"] != job["result"]
        assert http.get(new["result"]).status_code == 200
        store.delete(self.asked(server, job))
        store.delete(self.file(settings, new).name)
        why = repair.row(NamedFile(self.file(settings, new).name, None, job["id"], "answer"))
        assert why == f"the request of job {job['id']} was lost. Send it again, or restore a backup"


@pytest.mark.slow
def test_progress_of_a_job_is_streamed(http):
    job = sleep(http, "2 s", Prefer="respond-async").headers["Location"]
    with http.stream("GET", f"{job}/events") as stream:
        events = list(heard(stream))
    assert [name for name, _ in events][-1] == "done"
    assert any(data.get("text") == "half asleep" for name, data in events if name == "progress")


@pytest.mark.slow
def test_a_second_long_job_waits_for_the_first(http, log):
    places = [sleep(http, "1 s", Prefer="respond-async").headers["Location"] for _ in range(2)]
    assert [ended(http, place)["state"] for place in places] == ["done", "done"]


@pytest.mark.slow
def test_a_job_runs_again_after_a_restart(tmp_path, monkeypatch, log):
    monkeypatch.setenv("SLEEPER_LOG", str(log))
    own = folder_of_sleeper(tmp_path / "own")
    chosen = Settings(data=tmp_path / "data", template_folders=(own,), calculation_processes=1)
    with serving(chosen) as server, httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        job = sleep(http, "3 s", Prefer="respond-async").headers["Location"]
        begun(log)
    with serving(chosen) as server, httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        assert ended(http, job)["state"] == "done"
        assert len(begun(log)) == 2


@pytest.mark.slow
def test_the_files_of_a_job_are_checked_and_backed_up(tmp_path, settings):
    data = tmp_path / "data"
    with serving(settings.model_copy(update={"data": data})) as server:
        with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
            body = {"inputs": FILM.example, "level": "reynolds"}
            later = http.post(f"{FILM_PLACE}/evaluate", json=body, headers={"Prefer": "respond-async"})
            assert later.status_code == 202
            place = later.headers["Location"]
            eventually(lambda: http.get(place).json()["state"] == "done", 60)
            link = http.get(place).json()["result"]
            answer = http.get(link)
            assert answer.json()["level"] == "reynolds"
            assert run("backup", tmp_path / "all.tar", "--data", data).exit_code == 0
            assert run("check", "--data", data).exit_code == 0, "its files have rows"
            sha = link.rpartition("sha256=")[2]
            (data / "artifacts" / sha[:2] / sha).unlink()
            checked = run("check", "--data", data)
            assert (checked.exit_code, f"{sha}, answer of" in checked.output) == (1, True), checked.output
            again = http.get(link, headers={"Prefer": "wait=60"})
            assert again.json() | {"seconds": 0} == answer.json() | {"seconds": 0}
    assert run("restore", tmp_path / "all.tar", "--data", tmp_path / "new").exit_code == 0
    assert (tmp_path / "new" / "artifacts" / sha[:2] / sha).read_bytes() == answer.content


def run(*words):
    return CliRunner().invoke(main, [str(word) for word in words])
