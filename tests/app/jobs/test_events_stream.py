"""Events of designs and jobs are sent at once and in order (server-sent events)."""

import threading
from contextlib import contextmanager

import httpx
import pytest
from patience import patient
from serving import API, created, heard, moody, patched

DESIGNS = f"{API}/designs"


class Listener:
    """Hears a stream in a thread, until it ends or `until` comes."""

    def __init__(self, url, path, until):
        self.events, self.until = [], until
        self.started = threading.Event()
        self.thread = threading.Thread(target=self.listen, args=(url, path))

    def listen(self, url, path):
        with httpx.stream("GET", f"{url}{path}", timeout=patient(60), trust_env=False) as stream:
            self.type = stream.headers["content-type"]
            for name, data in heard(stream):
                self.events.append((name, data))
                self.started.set()
                if self.until(name, data):
                    return

    @property
    def names(self):
        return [name for name, _ in self.events]


@contextmanager
def listening(served, path, until=lambda name, data: False):
    listener = Listener(served.url, path, until)
    listener.thread.start()
    assert listener.started.wait(patient(60))
    yield listener
    listener.thread.join(patient(60))
    assert not listener.thread.is_alive(), listener.events


def ends(revision, *names):
    return lambda name, data: name in names and data.get("revision") == revision


def test_a_job_from_start_to_end(served, http):
    answer = http.post(DESIGNS, json=moody("23.5 mm"), headers={"Prefer": "respond-async"})
    with listening(served, f"{answer.headers['location']}/events") as listener:
        pass
    assert listener.type.startswith("text/event-stream")
    assert listener.names[-1] == "done"
    assert listener.events[-1][1]["result"] == f"/api/v1/designs/{answer.json()['id']}/revisions/1"
    fractions = [data["progress"] for name, data in listener.events if name == "progress"]
    assert fractions == sorted(fractions)
    order = [name for name in dict.fromkeys(listener.names) if name != "progress"]
    assert order in (["queued", "running", "done"], ["running", "done"], ["done"])


def test_a_design_tells_revision_regenerating_progress_current(served, http):
    design = created(http, moody("24.5 mm"))
    path = f"{DESIGNS}/{design['id']}/events"
    with listening(served, path, ends(2, "current", "failed")) as listener:
        patched(http, design, {"models": {"model": {"parameters": {"size": "24.6 mm"}}}})
    assert listener.names[0] == "current", "the state comes first"
    assert listener.events[0][1]["revision"] == 1
    assert list(dict.fromkeys(listener.names[1:])) == ["revision", "regenerating", "progress", "current"]
    assert {data["revision"] for _, data in listener.events[1:]} == {2}


def test_a_design_tells_a_failure_with_its_problem(served, http):
    design = created(http, moody("25.5 mm"))
    path = f"{DESIGNS}/{design['id']}/events"
    with listening(served, path, ends(2, "current", "failed")) as listener:
        patched(http, design, {"models": {"model": {"parameters": {"mood": "raises"}}}})
    assert list(dict.fromkeys(listener.names))[-1] == "failed"
    assert listener.events[-1][1]["problem"]["type"] == "/problems/geometry"


def test_a_change_without_geometry_tells_revision_and_current(served, http):
    design = created(http, {"name": "x", "parameters": {"a": "1"}})
    path = f"{DESIGNS}/{design['id']}/events"
    with listening(served, path, ends(3, "current")) as listener:
        second = patched(http, design, {"parameters": {"a": "2"}})
        patched(http, second, {"parameters": {"a": "2"}})  # changes nothing, so nothing is sent
        patched(http, second, {"parameters": {"a": "3"}})
    events = [(name, data["revision"]) for name, data in listener.events]
    assert events == [("current", 1), ("revision", 2), ("current", 2), ("revision", 3), ("current", 3)]


@pytest.mark.parametrize("path", [f"{DESIGNS}/none/events", f"{API}/jobs/none/events"])
def test_there_is_nothing_to_hear_of_what_does_not_exist(http, path):
    answer = http.get(path)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
