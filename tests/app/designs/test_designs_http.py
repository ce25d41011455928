"""Designs and their jobs follow HTTP rules: preconditions, repeated requests, waiting, full queues."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import count as count_up
from threading import Barrier
from uuid import uuid4

import httpx
import pytest
from patience import until as wait_until
from serving import API, HANG, created, moody, paper, patched, problem, revision, settled

DESIGNS = f"{API}/designs"


@pytest.fixture
def plain(http):
    """A design without geometry."""
    return created(http, {"name": "plain", "parameters": {"a": "1", "b": "2 mm"}})


def place(design):
    return f"{DESIGNS}/{design['id']}"


def count(http):
    return len(http.get(DESIGNS, params={"limit": 500}).json()["items"])


LOOPS = count_up(1)  # every loop is a build of its own


def looping(http):
    """A design whose job loops for ever, and the link to the job."""
    size = f"{10 + next(LOOPS) / 1000} mm"
    answer = http.post(DESIGNS, json=moody(size, "loops"), headers={"Prefer": "wait=0"})
    assert answer.status_code == 202, answer.text
    return answer.json(), answer.headers["location"]


def until(http, job, state, seconds=60.0):
    return wait_until(lambda: http.get(job).json(), lambda job: job["state"] == state, seconds)


class TestPreconditions:
    def test_the_etag_is_the_revision_and_strong(self, http, plain):
        answer = http.get(place(plain))
        assert answer.headers["etag"] == '"1"'
        changed = http.patch(place(plain), json={"parameters": {"a": "3"}}, headers={"If-Match": '"1"'})
        assert changed.headers["etag"] == '"2"'

    def test_the_etag_does_not_tell_the_state_of_the_regeneration(self, http):
        answer = http.post(DESIGNS, json=moody("15.5 mm"), headers={"Prefer": "respond-async"})
        settled(http, answer.json()["id"])
        assert http.get(place(answer.json())).headers["etag"] == answer.headers["etag"] == '"1"'

    @pytest.mark.parametrize(
        ("content", "media"),
        [(b"{}", "application/json"), (b"{", "application/json"), (b"x", "text/plain"), (b"", "")],
    )
    def test_428_comes_first(self, http, plain, content, media):
        answer = http.patch(place(plain), content=content, headers={"Content-Type": media})
        assert "If-Match" in problem(answer, 428, "precondition-required")["detail"]

    def test_then_415_then_422(self, http, plain):
        headers = {"If-Match": '"1"', "Content-Type": "text/plain"}
        problem(http.patch(place(plain), content=b"{", headers=headers), 415, "unsupported-media-type")
        headers["Content-Type"] = "application/json"
        problem(http.patch(place(plain), content=b"{", headers=headers), 422, "invalid-inputs")

    @pytest.mark.parametrize("stale", ['"0"', '"2"', '"1', "1", 'W/"1"', "nonsense", '""'])
    def test_412_for_anything_but_the_newest(self, http, plain, stale):
        answer = http.patch(place(plain), json={"parameters": {"a": "3"}}, headers={"If-Match": stale})
        assert '"1"' in problem(answer, 412, "stale-revision")["detail"]
        assert http.get(place(plain)).json()["revision"] == 1

    def test_of_two_who_read_the_same_one_is_refused(self, http, plain):
        answers = [
            http.patch(place(plain), json={"parameters": {"a": value}}, headers={"If-Match": '"1"'})
            for value in ("3", "4")
        ]
        assert [answer.status_code for answer in answers] == [200, 412]
        assert http.get(place(plain)).json()["parameters"]["a"] == "3"


class TestIdempotency:
    def test_a_repeated_post_makes_one_design(self, http):
        key = {"Idempotency-Key": uuid4().hex}
        document = {"name": "once", "parameters": {"a": "1"}}
        before = count(http)
        answers = [http.post(DESIGNS, json=document, headers=key) for _ in range(3)]
        assert {answer.status_code for answer in answers} == {201}
        assert answers[0].json() == answers[1].json() == answers[2].json()
        assert count(http) == before + 1

    def test_a_repeated_patch_makes_one_revision(self, http, plain):
        headers = {"Idempotency-Key": uuid4().hex, "If-Match": '"1"'}
        answers = [
            http.patch(place(plain), json={"parameters": {"a": "9"}}, headers=headers) for _ in range(3)
        ]
        assert {answer.status_code for answer in answers} == {200}
        assert answers[0].json() == answers[1].json() == answers[2].json()
        assert http.get(place(plain)).json()["revision"] == 2

    def test_a_repeat_answers_as_before_though_the_design_went_on(self, http, plain):
        headers = {"Idempotency-Key": uuid4().hex, "If-Match": '"1"'}
        first = http.patch(place(plain), json={"parameters": {"a": "9"}}, headers=headers)
        patched(http, first.json(), {"parameters": {"a": "10"}})
        again = http.patch(place(plain), json={"parameters": {"a": "9"}}, headers=headers)
        assert again.json()["revision"] == 2
        assert again.json()["parameters"] == first.json()["parameters"]

    def test_a_repeat_of_what_changed_nothing_changes_nothing_later(self, http, plain):
        headers = {"Idempotency-Key": uuid4().hex, "If-Match": "*"}
        same = {"parameters": {"a": "1"}}
        assert http.patch(place(plain), json=same, headers=headers).json()["revision"] == 1
        patched(http, plain, {"parameters": {"a": "2"}})
        assert http.patch(place(plain), json=same, headers=headers).json()["revision"] == 1
        assert http.get(place(plain)).json()["parameters"]["a"] == "2"

    def test_another_body_with_the_key_is_refused(self, http, plain):
        key = {"Idempotency-Key": uuid4().hex}
        assert http.post(DESIGNS, json={"name": "one"}, headers=key).status_code == 201
        problem(http.post(DESIGNS, json={"name": "two"}, headers=key), 422, "idempotency-key-reused")
        headers = {**key, "If-Match": "*"}
        assert http.patch(place(plain), json={"parameters": {"a": "5"}}, headers=headers).status_code == 200
        other = http.patch(place(plain), json={"parameters": {"a": "6"}}, headers=headers)
        problem(other, 422, "idempotency-key-reused")
        assert http.get(place(plain)).json()["parameters"]["a"] == "5"

    def test_a_refused_request_leaves_its_key_free(self, http):
        key = {"Idempotency-Key": uuid4().hex}
        problem(http.post(DESIGNS, json={"name": ""}, headers=key), 422, "invalid-inputs")
        assert http.post(DESIGNS, json={"name": "x"}, headers=key).status_code == 201

    @pytest.mark.parametrize("action", ["copy", "revisions/1/restore"])
    def test_copy_and_restore_are_done_once(self, http, plain, action):
        patched(http, plain, {"parameters": {"a": "5"}})
        key = {"Idempotency-Key": uuid4().hex}
        answers = [http.post(f"{place(plain)}/{action}", headers=key).json() for _ in range(2)]
        assert answers[0] == answers[1]

    @pytest.mark.parametrize("key", ["", "x" * 201])
    def test_a_key_has_a_length(self, http, key):
        answer = http.post(DESIGNS, json={"name": "x"}, headers={"Idempotency-Key": key})
        problem(answer, 422, "invalid-inputs")


class TestManyAtOnce:
    def at_once(self, served, send, times=8):
        """The answers to several clients that send in the same moment."""
        gate = Barrier(times)

        def one(number):
            with httpx.Client(base_url=served.url, timeout=60, trust_env=False) as own:
                gate.wait()
                return send(own, number)

        with ThreadPoolExecutor(times) as clients:
            return list(clients.map(one, range(times)))

    def test_one_of_many_changes_of_a_revision_is_accepted(self, served, http, plain):
        def send(own, number):
            patch = {"parameters": {"a": str(100 + number)}}
            return own.patch(place(plain), json=patch, headers={"If-Match": '"1"'})

        answers = self.at_once(served, send)
        assert sorted(answer.status_code for answer in answers) == [200] + [412] * 7
        (accepted,) = [answer.json() for answer in answers if answer.status_code == 200]
        assert http.get(place(plain)).json() == accepted

    def test_one_key_is_one_design(self, served, http):
        before, key = count(http), uuid4().hex
        answers = self.at_once(
            served, lambda own, _: own.post(DESIGNS, json={"name": "x"}, headers={"Idempotency-Key": key})
        )
        assert {answer.status_code for answer in answers} == {201}
        assert len({answer.json()["id"] for answer in answers}) == 1
        assert count(http) == before + 1

    def test_the_same_solid_asked_for_by_many_is_one_build(self, served):
        answers = self.at_once(
            served, lambda own, _: own.post(DESIGNS, json=moody("20.5 mm"), headers={"Prefer": "wait=60"})
        )
        assert {answer.json()["state"] for answer in answers} == {"current"}
        assert len({answer.json()["id"] for answer in answers}) == 8


class TestWaiting:
    def test_respond_async_answers_202_with_the_job(self, http):
        headers = {"Prefer": "respond-async"}
        answer = http.post(DESIGNS, json=moody("16.25 mm"), headers=headers)
        assert answer.status_code == 202
        assert answer.json()["state"] == "regenerating"
        assert answer.json()["models"]["model"]["id"] == "moody"
        job = until(http, answer.headers["location"], "done")
        assert (job["kind"], job["design"], job["revision"]) == ("regenerate", answer.json()["id"], 1)
        assert job["progress"] == 1
        assert job["log"]
        assert job["problem"] is None
        assert http.get(job["result"]).json()["number"] == 1
        assert http.get(place(answer.json())).json()["state"] == "current"

    def test_a_finished_change_answers_201_and_200_with_the_design(self, http):
        answer = http.post(DESIGNS, json=moody("16.5 mm"), headers={"Prefer": "wait=30"})
        assert answer.status_code == 201
        assert answer.headers["location"] == place(answer.json())
        headers = {"If-Match": answer.headers["etag"], "Prefer": "respond-async"}
        renamed = http.patch(place(answer.json()), json={"name": "renamed"}, headers=headers)
        assert renamed.status_code == 200, "nothing has to be built, so there is nothing to wait for"

    @pytest.mark.parametrize(
        "prefer", ["wait=-1", "wait=x", "wait=1e9", "", "nonsense", "handling=lenient, wait=30"]
    )
    def test_odd_preferences_are_no_error(self, http, prefer):
        assert http.post(DESIGNS, json=paper(), headers={"Prefer": prefer}).status_code == 201


class TestJobs:
    def test_a_running_job_is_cancelled(self, http):
        design, job = looping(http)
        until(http, job, "running")
        assert http.delete(job).json()["state"] == "cancelled"
        answer = settled(http, design["id"])
        assert answer["state"] == "failed"
        assert answer["problem"]["type"] == "/problems/cancelled"
        assert http.get(job).json()["problem"]["type"] == "/problems/cancelled"
        problem(http.delete(job), 409, "job-finished")

    def test_a_queued_job_is_cancelled_and_the_next_one_runs(self, http):
        _, running = looping(http)
        until(http, running, "running")
        queued = http.post(DESIGNS, json=moody("17.5 mm"), headers={"Prefer": "respond-async"})
        next_one = http.post(DESIGNS, json=moody("17.75 mm"), headers={"Prefer": "respond-async"})
        assert http.get(queued.headers["location"]).json()["state"] == "queued"
        assert http.delete(queued.headers["location"]).json()["state"] == "cancelled"
        http.delete(running)
        assert settled(http, next_one.json()["id"])["state"] == "current"
        assert settled(http, queued.json()["id"])["state"] == "failed"

    def test_jobs_are_listed_newest_first(self, http):
        listed = http.get(f"{API}/jobs", params={"limit": 2}).json()
        assert len(listed["items"]) == 2
        assert listed["items"][0]["id"] > listed["items"][1]["id"]
        after = http.get(f"{API}/jobs", params={"limit": 2, "cursor": listed["next"]}).json()
        assert after["items"][0]["id"] < listed["items"][1]["id"]

    def test_an_unknown_job(self, http):
        for answer in (http.get(f"{API}/jobs/none"), http.delete(f"{API}/jobs/none")):
            problem(answer, 404, "no-such-job")

    def test_a_full_queue_is_429_with_retry_after_and_saves_nothing(self, http, served, monkeypatch):
        tiny = served.jobs.settings.model_copy(update={"queue_limit": 1})
        monkeypatch.setattr(served.jobs, "settings", tiny)
        _, running = looping(http)
        until(http, running, "running")
        queued = http.post(DESIGNS, json=moody("18.5 mm"), headers={"Prefer": "respond-async"})
        assert queued.status_code == 202
        before = count(http)
        refused = http.post(DESIGNS, json=moody("18.75 mm"))
        problem(refused, 429, "queue-full")
        assert int(refused.headers["retry-after"]) > 0
        built = f"{API}/models/moody/versions/1/build"
        problem(http.post(built, json={"parameters": {"size": "18.76 mm"}}), 429, "queue-full")
        assert count(http) == before
        light = created(http, {"name": "no geometry"})
        assert light["state"] == "current", "what needs no job is not refused"
        for job in (running, queued.headers["location"]):
            http.delete(job)


class TestWhileAJobLoops:
    @pytest.mark.slow
    def test_the_service_answers_and_the_deadline_ends_it(self, http, served, monkeypatch):
        dispatcher = served.jobs._dispatcher
        monkeypatch.setattr(dispatcher, "_limits", replace(dispatcher._limits, deadline=3.0))
        design, job = looping(http)
        until(http, job, "running")
        for _ in range(40):
            assert http.get("/healthz", timeout=HANG).json() == {"status": "ok"}
        assert http.get(job).json()["state"] == "running", "healthz was not asked during the loop"
        answer = http.post(
            f"{API}/templates/oil_film/versions/1/evaluate",
            json={"inputs": paper()["steps"]["film"]["inputs"] | {"bearing_diameter": "48 mm"}},
        )
        assert answer.status_code == 200
        content = settled(http, design["id"], 23)
        assert content["state"] == "failed"
        assert content["problem"]["type"] == "/problems/deadline"
        assert "3 s" in content["problem"]["detail"]
        assert content["problem"]["changed"] == ["model.mood", "model.size"]
        assert until(http, job, "failed")["problem"]["detail"] == content["problem"]["detail"]
        assert revision(http, content)["problem"] == content["problem"]

    @pytest.mark.slow
    def test_a_job_that_eats_memory_is_ended_by_its_limit(self, http):
        design = created(http, moody("19.5 mm", "eats"))
        assert design["state"] == "failed"
        assert design["problem"]["type"] == "/problems/memory"
        assert created(http, moody("19.75 mm"))["state"] == "current"
