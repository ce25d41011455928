"""Streams resume where the client stopped: `Last-Event-ID` (HTML standard, server-sent events)."""

import itertools
import json
from contextlib import closing

import httpx
import pytest
from serving import API, PATIENCE, created, moody, patched, serving
from sqlalchemy import delete
from streams import first, messages, short

from app.jobs.events import Event
from app.settings import Settings
from app.storage.tables import EventRow

DESIGNS = f"{API}/designs"
SIZES = itertools.count(501)  # of blocks that have not been built: each needs a job


@pytest.fixture
def design(http):
    """A design at its third revision, without geometry; its events have the numbers 1 to 6."""
    design = created(http, {"name": "x", "parameters": {"a": "1"}})
    for number in (2, 3):
        design = patched(http, design, {"parameters": {"a": str(number)}})
    return design


@pytest.fixture
def path(design):
    return f"{DESIGNS}/{design['id']}/events"


def test_a_new_reader_gets_the_state_with_its_number(served, path):
    (message,) = first(1, served.url, path)
    assert message == ("6", "current", {"revision": 3, "state": "current", "problem": None})


def test_a_reader_gets_what_came_after_its_last_event_then_what_comes(served, http, design, path):
    with closing(messages(served.url, path, 3)) as stream:
        missed = short(next(stream) for _ in range(3))
        patched(http, design, {"parameters": {"a": "4"}})
        live = short(next(stream) for _ in range(2))
    assert missed == [("4", "current", 2), ("5", "revision", 3), ("6", "current", 3)]
    assert live == [("7", "revision", 4), ("8", "current", 4)]


def test_who_has_everything_gets_only_what_comes(served, http, design, path):
    with closing(messages(served.url, path, 6)) as stream:
        # The stream has begun, with nothing to say, before this is saved or after: it comes first anyhow.
        patched(http, design, {"parameters": {"a": "4"}})
        assert short([next(stream)]) == [("7", "revision", 4)]


@pytest.mark.parametrize("last", ["7", "999999999999999999", "", None])
def test_a_number_that_it_has_not_come_to_gets_the_state(served, path, last):
    assert short(first(1, served.url, path, last)) == [("6", "current", 3)]


def test_beyond_what_is_kept_comes_the_state(served, design, path):
    topic = f"design:{design['id']}"
    old = delete(EventRow).where(EventRow.topic == topic, EventRow.number <= 2)
    served.app.state.services.database.write(lambda session: session.execute(old).rowcount)
    assert short(first(1, served.url, path, 1)) == [("6", "current", 3)]
    assert short(first(1, served.url, path, 2)) == [("3", "revision", 2)]


@pytest.mark.parametrize("last", ["x", "-1", "1.5", "1 2", "٣", "9" * 19, "9" * 5000])
def test_what_is_no_number_is_refused_by_name(http, path, last):
    answer = http.get(path, headers={"Last-Event-ID": last.encode()})
    assert answer.status_code == 422, answer.text
    (error,) = answer.json()["errors"]
    assert "last-event-id" in json.dumps(error).lower()


def test_progress_has_no_number(served, http):
    design = created(http, {"name": "x", "parameters": {"a": "1"}})
    events = served.app.state.services.jobs.events
    topic = f"design:{design['id']}"
    with closing(messages(served.url, f"{DESIGNS}/{design['id']}/events")) as stream:
        assert next(stream)[0] == "2"
        events.publish(Event(topic, "progress", {"progress": 0.5}))
        assert next(stream) == (None, "progress", {"event": "progress", "progress": 0.5})


class TestJobs:
    """A job is sent whole at every event."""

    @pytest.fixture
    def job(self, http):
        """A job that has ended."""
        design = created(http, moody(f"26.{next(SIZES)} mm"))
        jobs = http.get(f"{API}/jobs").json()["items"]
        return next(job for job in jobs if job["design"] == design["id"])

    def test_its_end_has_a_number_and_ends_the_stream(self, served, job):
        ((id, name, data),) = messages(served.url, f"{API}/jobs/{job['id']}/events")
        assert (id, name, data["state"]) == ("2", "done", "done")

    def test_who_missed_its_end_gets_it_once(self, served, job):
        path = f"{API}/jobs/{job['id']}/events"
        for last in (0, 1, 3):
            ((id, name, _),) = messages(served.url, path, last)
            assert (id, name) == ("2", "done")

    def test_who_has_it_gets_nothing(self, served, job):
        assert list(messages(served.url, f"{API}/jobs/{job['id']}/events", 2)) == []


@pytest.mark.slow
def test_a_reader_resumes_after_a_restart(tmp_path):
    settings = Settings(data=tmp_path / "data")
    with serving(settings) as served, httpx.Client(base_url=served.url, timeout=PATIENCE) as http:
        design = created(http, {"name": "x", "parameters": {"a": "1"}})
        path = f"{DESIGNS}/{design['id']}/events"
        with closing(messages(served.url, path)) as stream:
            last, *_ = next(stream)
        design = patched(http, design, {"parameters": {"a": "2"}})
    with serving(settings) as served, httpx.Client(base_url=served.url, timeout=PATIENCE) as http:
        patched(http, design, {"parameters": {"a": "3"}})
        received = short(first(4, served.url, path, last))
    assert received == [("3", "revision", 2), ("4", "current", 2), ("5", "revision", 3), ("6", "current", 3)]
