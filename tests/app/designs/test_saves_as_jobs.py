"""Saves and previews with slow steps run as jobs, end when the client leaves, and survive a kill."""

import json
import socket
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import httpx
import pytest
from patience import until
from serving import API, ServerProcess, alive, faults, folder_of_models, problem, serving, settled
from sleeping import folder_of_sleeper

from app.client import Client
from app.settings import Settings

DESIGNS = f"{API}/designs"
AT_ONCE = {"Prefer": "respond-async"}
FULL = "sleeping block"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return tmp_path_factory.mktemp("sleeper") / "log"


@pytest.fixture(scope="module")
def served(tmp_path_factory, log):
    folder = tmp_path_factory.mktemp("saves")
    own = folder_of_models(folder / "models")
    folder_of_sleeper(own / "sleeper")
    settings = Settings(
        data=folder / "data", template_folders=(own,), calculation_processes=1, calculation_deadline=1.5
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SLEEPER_LOG", str(log))
        with serving(settings) as server:
            server.app.state.services.calculations.submit("tests", time.monotonic).future.result(60)
            yield server


@pytest.fixture(scope="module")
def http(served):
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


@pytest.fixture(autouse=True)
def quiet(served, log):
    log.write_text("")
    yield
    pool = served.app.state.services.calculations
    until(lambda: pool.running == pool.waiting == 0)
    assert served.app.state.services.steps.left == {}, "what was left to jobs was taken, or dropped"


_durations = iter(range(1, 10**6))


def duration(seconds):
    """A duration that no test has asked for before, so that nothing remembers it."""
    return f"{seconds + next(_durations) * 1e-6} s"


def sleeping(seconds, mood="good", **more):
    inputs = {"duration": duration(seconds), "mood": mood}
    return {"name": FULL, "steps": {"s": {"template": "sleeper", "version": 1, "inputs": inputs}}, **more}


def patch_of(seconds, mood="good"):
    return {"steps": {"s": {"inputs": {"duration": duration(seconds), "mood": mood}}}}


def begun(log, count=1):
    """The processes in which the sleeper has begun, once they are so many."""
    return [int(pid) for pid in until(lambda: log.read_text().split(), lambda pids: len(pids) >= count)]


def ended(http, place):
    """A job once it has ended."""
    return until(lambda: http.get(place).json(), lambda job: job["state"] not in ("queued", "running"))


def process(http, design, number=1):
    """The process that calculated the step of a revision."""
    return http.get(f"{DESIGNS}/{design['id']}/revisions/{number}").json()["steps"]["s"]["outputs"][
        "process"
    ]["value"]


def saved(http, seconds=0.001):
    """A design that is complete."""
    answer = http.post(DESIGNS, json=sleeping(seconds), headers={"Prefer": "wait=60"})
    assert answer.status_code in (201, 202), answer.text
    return settled(http, answer.json()["id"])


@pytest.mark.slow
def test_a_save_that_takes_long_goes_on_as_a_job_in_the_same_process(http, log):
    answer = http.post(DESIGNS, json=sleeping(3))
    assert answer.status_code == 202, answer.text
    design = answer.json()
    assert (design["revision"], design["state"]) == (1, "regenerating")
    job = ended(http, answer.headers["Location"])
    assert (job["kind"], job["state"], job["design"]) == ("calculate_and_regenerate", "done", design["id"])
    assert set(job["log"]) == {"half asleep"}
    assert begun(log) == [process(http, design)], "it was begun once"
    assert settled(http, design["id"])["state"] == "current"


def test_the_job_calculates_and_then_builds(http):
    model = {"id": "moody", "version": 1, "parameters": {"size": "= 7 mm * s.process / s.process"}}
    answer = http.post(DESIGNS, json=sleeping(0.1, model=model), headers=AT_ONCE)
    assert answer.status_code == 202, answer.text
    place = f"{DESIGNS}/{answer.json()['id']}/revisions/1"
    waiting = http.get(place).json()
    if waiting["state"] == "regenerating":
        assert waiting["steps"]["s"]["pending"]
        assert waiting["models"]["model"]["build"] is None
    assert ended(http, answer.headers["Location"])["state"] == "done"
    model = http.get(place).json()["models"]["model"]
    assert model["parameters"]["size"] == {"value": 7, "unit": "mm"}
    assert http.get(f"{place}/model.step").status_code == 200


def test_who_does_not_wait_is_answered_at_once_by_every_save(http):
    def accepted(answer, number):
        assert answer.status_code == 202, answer.text
        assert answer.json()["revision"] == number
        assert ended(http, answer.headers["Location"])["state"] == "done"
        return settled(http, answer.json()["id"])

    design = accepted(http.post(DESIGNS, json=sleeping(0.1), headers=AT_ONCE), 1)
    place = f"{DESIGNS}/{design['id']}"
    change = {**AT_ONCE, "If-Match": '"1"'}
    assert accepted(http.patch(place, json=patch_of(0.1), headers=change), 2)["state"] == "current"
    copied = http.post(f"{place}/copy", headers=AT_ONCE)
    restored = http.post(f"{place}/revisions/1/restore", headers=AT_ONCE)
    assert (copied.status_code, restored.status_code) == (201, 200), "their steps are remembered"


def test_a_save_whose_steps_are_remembered_waits_for_no_job(http, log):
    design = saved(http)
    answer = http.patch(
        f"{DESIGNS}/{design['id']}", json={"name": "another"}, headers={**AT_ONCE, "If-Match": '"1"'}
    )
    assert (answer.status_code, answer.json()["state"]) == (200, "current")
    assert len(begun(log)) == 1


@pytest.mark.parametrize(
    ("part", "names"),
    [
        ({"inputs": {"duration": "-1 s"}}, ["s.duration"]),
        ({"inputs": {"duration": "1 m"}}, ["s.duration"]),
        ({"inputs": {"duration": "1 s", "mood": "odd"}}, ["s.mood"]),
        ({"inputs": {"duration": "1 s"}, "level": "finest"}, ["s.level"]),
        ({"inputs": {}}, ["s.duration"]),
    ],
)
@pytest.mark.parametrize("headers", [AT_ONCE, {}])
def test_what_can_be_refused_before_it_is_calculated_is_refused(http, part, names, headers):
    document = sleeping(1)
    document["steps"]["s"] = {"template": "sleeper", "version": 1, **part}
    assert list(faults(http.post(DESIGNS, json=document, headers=headers))) == names


def test_a_step_that_fails_in_its_job_fails_the_revision(http):
    design = saved(http)
    change = {**AT_ONCE, "If-Match": '"1"'}
    answer = http.patch(f"{DESIGNS}/{design['id']}", json=patch_of(0.1, "dies"), headers=change)
    assert answer.status_code == 202
    assert ended(http, answer.headers["Location"])["state"] == "failed"
    failed = settled(http, design["id"])
    assert (failed["revision"], failed["state"]) == (2, "failed")
    assert failed["problem"]["type"] == "/problems/crashed"


def test_a_cancelled_job_frees_its_process_and_the_revision_says_so(http, log):
    answer = http.post(DESIGNS, json=sleeping(60))
    assert answer.status_code == 202
    (pid,) = begun(log)
    http.delete(answer.headers["Location"]).raise_for_status()
    until(lambda: alive(pid), lambda living: not living)
    design = settled(http, answer.json()["id"])
    assert (design["state"], design["problem"]["type"]) == ("failed", "/problems/cancelled")


def test_what_was_left_to_a_job_that_never_began_is_ended(served, log):
    steps, pool = served.app.state.services.steps, served.app.state.services.calculations
    begun_by_save = steps.begun()
    calculation = pool.submit("tests", time.sleep, 60)
    until(lambda: pool.running == 1)
    begun_by_save.keep("question", calculation)
    begun_by_save.leave_to("a job")
    begun_by_save.close()  # the save has been answered
    assert not calculation.cancelled.is_set()
    steps.drop("a job")
    assert calculation.cancelled.is_set()


@contextmanager
def asking(url, document, headers):
    """Somebody who asks for a design and leaves at the end of the block, whether or not it is answered."""
    body = json.dumps(document).encode()
    head = {"Host": url.netloc.decode(), "Content-Type": "application/json", "Content-Length": len(body)}
    lines = [f"POST {DESIGNS} HTTP/1.1", *(f"{name}: {text}" for name, text in (head | headers).items())]
    with socket.create_connection((url.host, url.port)) as connection:
        connection.sendall("\r\n".join([*lines, "", ""]).encode() + body)
        yield


def test_who_leaves_a_save_stops_it_and_nothing_is_written(http, log):
    count = lambda: len(http.get(DESIGNS, params={"limit": 500}).json()["items"])  # noqa: E731
    before, key = count(), {"Idempotency-Key": "left"}
    with asking(http.base_url, sleeping(60), key):
        (pid,) = begun(log)
    until(lambda: alive(pid), lambda living: not living)
    assert count() == before
    answer = http.post(DESIGNS, json=sleeping(0.01), headers=key)
    assert answer.status_code == 201, "the key of the save that was stopped is free"


@pytest.mark.slow
def test_a_save_that_another_overtakes_leaves_nothing_running(http, log):
    design = saved(http)
    place, match = f"{DESIGNS}/{design['id']}", {"If-Match": '"1"'}
    with ThreadPoolExecutor(1) as threads:
        late = threads.submit(http.patch, place, json=patch_of(60), headers=match)
        pid = begun(log, 2)[1]
        assert http.patch(place, json={"name": "early"}, headers=match).status_code == 200
        problem(late.result(), 412, "stale-revision")
    until(lambda: alive(pid), lambda living: not living)
    assert http.get(place).json()["revision"] == 2


@pytest.mark.slow
def test_a_save_that_is_repeated_is_the_same_job(http, log):
    document, headers = sleeping(3), {"Idempotency-Key": "twice"}
    first = http.post(DESIGNS, json=document, headers=headers)
    again = http.post(DESIGNS, json=document, headers={**headers, **AT_ONCE})
    assert (first.status_code, again.status_code) == (202, 202)
    assert first.headers["Location"] == again.headers["Location"]
    assert first.json()["id"] == again.json()["id"]
    assert ended(http, first.headers["Location"])["state"] == "done"
    assert len(begun(log)) == 1


@pytest.mark.slow
def test_a_preview_that_takes_long_goes_on_as_a_job(http, log):
    place = f"{DESIGNS}/{saved(http)['id']}"
    before = http.get(place).json()
    patch = {**patch_of(3), "parameters": {"half": "0.5"}}
    answer = http.post(f"{place}/preview", json=patch, params={"worksheet": True})
    assert answer.status_code == 202, answer.text
    assert answer.json()["outputs"]["s.process"]["new"] is None
    assert answer.json()["steps"]["s"]["state"] == "pending"
    assert answer.json()["parameters"]["half"]["value"] == 0.5, "what is known is there"
    job = answer.headers["Location"]
    assert http.get(job.replace("/jobs/", "/evaluations/")).status_code in (200, 202)
    assert ended(http, job)["state"] == "done"
    whole = http.get(job.replace("/jobs/", "/evaluations/"))
    assert whole.json()["outputs"]["s.process"]["new"]["value"] == begun(log, 2)[1]
    assert len(begun(log)) == 2, "it was begun once"
    same = http.post(f"{place}/preview", json=patch, params={"worksheet": True})
    assert (same.status_code, same.json()) == (200, whole.json())
    assert http.get(place).json() == before, "nothing is saved"


@pytest.mark.slow
def test_a_preview_for_which_nobody_waits(http, served):
    design = saved(http)
    answer = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch_of(0.1), headers=AT_ONCE)
    assert answer.status_code == 202
    job = ended(http, answer.headers["Location"])
    assert (job["kind"], job["state"], job["design"]) == ("preview", "done", None)
    assert http.get(job["result"]).json()["revision"] == 1
    with Client(served.url) as client:
        shown = client.preview(design["id"], patch_of(2))
        assert shown.outputs["s.process"].new.value > 0


def test_a_preview_within_a_time_leaves_the_rest_and_queues_nothing(http, log):
    place = f"{DESIGNS}/{saved(http)['id']}/preview"
    jobs = http.get(f"{API}/jobs").json()
    answer = http.post(place, json=patch_of(60), params={"within": 0})
    assert (answer.status_code, answer.json()["outputs"]["s.process"]["new"]) == (200, None)
    assert http.get(f"{API}/jobs").json() == jobs
    assert len(begun(log)) == 1


def test_a_preview_that_is_refused_in_its_job_says_why(http):
    place = f"{DESIGNS}/{saved(http)['id']}/preview"
    job = http.post(place, json=patch_of(0.1, "dies"), headers=AT_ONCE).headers["Location"]
    assert ended(http, job)["state"] == "failed"
    problem(http.get(job.replace("/jobs/", "/evaluations/")), 422, "crashed")


def test_a_worksheet_does_not_calculate_its_steps_again(http, log):
    place = f"{DESIGNS}/{saved(http, 0.1)['id']}/worksheet"
    formulas = http.get(place).json()["steps"]["s"]["formulas"]
    assert formulas[0]["name"] == "process"
    assert len(begun(log)) == 1


def test_so_does_one_of_a_revision_that_comes_from_the_database(http, served, monkeypatch):
    film = served.app.state.services.catalogues.templates.get("oil_film", 2)
    step = {"template": "oil_film", "version": 2, "level": "mass_conserving", "inputs": dict(film.example)}
    response = http.post(
        DESIGNS, json={"name": "film", "steps": {"film": step}}, headers={"Prefer": "wait=60"}
    )
    design = settled(http, response.json()["id"])
    monkeypatch.setattr(served.app.state.services.calculations, "submit", None)  # whoever calculates fails
    written = http.get(f"{DESIGNS}/{design['id']}/worksheet")
    assert written.status_code == 200
    assert len(written.json()["steps"]["film"]["formulas"]) > 10


def test_proposals_calculate_nothing(http, log):
    answer = http.post(DESIGNS, json=sleeping(60), headers=AT_ONCE)
    proposed = http.post(f"{DESIGNS}/{answer.json()['id']}/auto-map")
    assert (proposed.status_code, proposed.json()) == (200, {"proposals": []})
    http.delete(answer.headers["Location"]).raise_for_status()


def test_a_long_save_does_not_hold_up_the_designs_of_others(http, log):
    slow = http.post(DESIGNS, json=sleeping(60), headers=AT_ONCE)
    begun(log)
    block = {"name": "b", "model": {"id": "moody", "version": 1, "parameters": {"size": "8.125 mm"}}}
    quick = http.post(DESIGNS, json=block, headers={"Prefer": "wait=60"})
    assert (quick.status_code, quick.json()["state"]) == (201, "current")
    assert http.get(slow.headers["Location"]).json()["state"] == "running"
    http.delete(slow.headers["Location"]).raise_for_status()


@pytest.mark.slow
def test_a_kill_loses_no_accepted_save(tmp_path, log):
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": json.dumps([str(folder_of_sleeper(tmp_path / "own"))]),
        "CRANKWRIGHT_CALCULATION_DEADLINE": "1",
        "SLEEPER_LOG": str(log),
    }
    server = ServerProcess(tmp_path / "data", **environment).start().ready()
    with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        running = http.post(DESIGNS, json=sleeping(4))  # becomes a job while it runs
        queued = [http.post(DESIGNS, json=sleeping(0.01), headers=AT_ONCE) for _ in range(3)]
        assert {answer.status_code for answer in (running, *queued)} == {202}
        begun(log)
        family = server.kill()
        until(lambda: {pid for pid in family if alive(pid)}, lambda left: left == set())
        server.start().ready()
        try:
            for answer in (running, *queued):
                design = settled(http, answer.json()["id"])
                assert (design["state"], design["revision"]) == ("current", 1), design
                assert process(http, design) not in family
        finally:
            server.stop()
