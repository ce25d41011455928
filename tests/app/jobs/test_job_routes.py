"""Jobs are available over HTTP, and a server stops even if a client watches."""

import asyncio
import json
import os
import signal
import socket
import threading
from types import SimpleNamespace

import httpx
import pytest
from fastapi import FastAPI
from forked import Forked
from patience import GLANCE, patient

from app.catalogue.catalogues import Catalogues
from app.http.streams import Streams
from app.jobs.errors import JobFinished, JobNotFound
from app.jobs.routes import router
from app.jobs.service import Jobs
from app.settings import Settings
from app.workers.inline import Inline
from cad.catalogue import models
from templates.door import built_in


def describe(error):
    kind = type(error).__name__
    return {"type": kind, "title": kind, "status": 422, "detail": str(error)}


def handler(job, context):
    context.progress(0.5, "half way")
    return lambda session: "/api/v1/designs/1"


@pytest.fixture
def jobs(database):
    jobs = Jobs(database, Inline(), Settings(), describe)
    jobs.register("regenerate", handler)
    yield jobs
    jobs.stop()


@pytest.fixture
def app(jobs):
    app = FastAPI()
    app.include_router(router)
    app.state.services = SimpleNamespace(
        jobs=jobs, streams=Streams(most=5, most_of_client=5), catalogues=Catalogues(built_in(), models())
    )
    return app


class Client:
    """Calls an app from outside of any event loop."""

    def __init__(self, app):
        self.app = app

    async def send(self, method, path, **more):
        async with httpx.AsyncClient(
            transport=httpx.ASGITransport(self.app), base_url="http://test"
        ) as client:
            return await client.request(method, path, **more)

    def get(self, path, **more):
        return asyncio.run(self.send("GET", path, **more))

    def delete(self, path):
        return asyncio.run(self.send("DELETE", path))


class Overheard:
    """An app, and all bytes of bodies that it has sent."""

    def __init__(self, app):
        self.app, self.body = app, b""

    async def __call__(self, scope, receive, send):
        async def overhear(message):
            self.body += message.get("body", b"")
            await send(message)

        await self.app(scope, receive, overhear)

    async def sent(self, text):
        """Wait until the app has sent this text."""
        async with asyncio.timeout(patient(60)):
            while text not in self.body:
                await asyncio.sleep(GLANCE)


@pytest.fixture
def client(app):
    return Client(app)


def put(jobs, database):
    return database.write(lambda session: jobs.enqueue(session, "regenerate", {"secret": 1}))


def test_a_job_is_shown(client, jobs, database):
    id = put(jobs, database)
    shown = client.get(f"/api/v1/jobs/{id}").json()
    assert shown | {"created": "", "updated": ""} == {
        "id": id,
        "kind": "regenerate",
        "state": "queued",
        "design": None,
        "revision": None,
        "progress": 0.0,
        "log": [],
        "problem": None,
        "result": None,
        "created": "",
        "updated": "",
    }
    assert shown["created"].endswith("Z")


def test_jobs_are_listed_in_pages(client, jobs, database):
    ids = [put(jobs, database) for _ in range(3)]
    first = client.get("/api/v1/jobs", params={"limit": 2}).json()
    second = client.get("/api/v1/jobs", params={"limit": 2, "cursor": first["next"]}).json()
    assert [job["id"] for job in first["items"] + second["items"]] == sorted(ids, reverse=True)
    assert second["next"] is None


def test_a_job_is_cancelled_once(client, jobs, database):
    id = put(jobs, database)
    assert client.delete(f"/api/v1/jobs/{id}").json()["state"] == "cancelled"
    with pytest.raises(JobFinished):
        client.delete(f"/api/v1/jobs/{id}")


@pytest.mark.parametrize("path", ["/api/v1/jobs/nobody", "/api/v1/jobs/nobody/events"])
def test_an_unknown_job_is_a_domain_error(client, path):
    with pytest.raises(JobNotFound):
        client.get(path)


def events_of(stream):
    """Names and data of server-sent events, comments left out."""
    blocks = [block.split("\n") for block in stream.strip().split("\n\n")]
    fields = [dict(line.split(": ", 1) for line in block) for block in blocks]
    return [(field["event"], json.loads(field["data"])) for field in fields if "event" in field]


def test_a_job_is_watched_to_its_end(client, jobs, database):
    gate = threading.Event()

    def gated(job, context):
        assert gate.wait(patient(60))
        return handler(job, context)

    jobs.register("regenerate", gated)
    id = put(jobs, database)

    overheard = Overheard(client.app)

    async def scene():
        watching = asyncio.create_task(Client(overheard).send("GET", f"/api/v1/jobs/{id}/events"))
        for event, step in ((b"event: queued", jobs.start), (b"event: running", gate.set)):
            await overheard.sent(event)
            step()
        return await watching

    response = asyncio.run(scene())
    assert response.headers["content-type"].startswith("text/event-stream")
    events = events_of(response.text)
    assert [name for name, _ in events] == ["queued", "running", "progress", "done"]
    assert events[2][1]["text"] == "half way"
    assert events[3][1]["result"] == "/api/v1/designs/1"


def test_a_finished_job_tells_its_state_and_ends(client, jobs, database):
    id = put(jobs, database)
    jobs.start()
    asyncio.run(jobs.wait(id, 10))
    events = events_of(client.get(f"/api/v1/jobs/{id}/events").text)
    assert [(name, data["state"]) for name, data in events] == [("done", "done")]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_watcher_does_not_keep_the_server_from_stopping(jobs, database, url, tmp_path, number):
    id, log = put(jobs, database), tmp_path / "log"
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port, descriptors = listener.getsockname()[1], [listener.fileno()]
        server = Forked([url], dict(os.environ), log, call="watched:serve_jobs", descriptors=descriptors)
        try:
            with httpx.stream(
                "GET", f"http://127.0.0.1:{port}/api/v1/jobs/{id}/events", timeout=patient(60)
            ) as watched:
                lines = watched.iter_lines()
                assert next(lines) == "event: queued"
                server.send_signal(number)
                assert list(lines)[-1] == ""
            server.wait(patient(20))
        finally:
            server.kill()
    assert "stopped in order" in log.read_text()
