"""The clients wait while the service is busy, and send the request again."""

import asyncio
from types import SimpleNamespace

import httpx
import pytest

from app.client import AsyncClient, Client, Problem
from app.client.connections import Patience
from app.client.exchange import Request, get, post

ME = {
    "id": "p", "name": "Ada", "kind": "person", "roles": [],
    "usage": {
        "requests": 1, "jobs": 0, "calculation_seconds": 0, "storage_mb": 0, "queued_jobs": 0, "limits": None,
    },
}  # fmt: skip


def busy(times, status=429, wait="7"):
    """A transport that refuses some requests, then answers; it notes the paths."""
    asked = []

    def serve(request):
        asked.append(request.url.path)
        if len(asked) <= times:
            return httpx.Response(status, headers={"Retry-After": wait}, json={"title": "busy"})
        return httpx.Response(200, json=ME)

    return asked, httpx.MockTransport(serve)


@pytest.fixture
def slept(monkeypatch):
    waits = []

    async def sleep(seconds):
        waits.append(seconds)

    monkeypatch.setattr("app.client.connections.time", SimpleNamespace(sleep=waits.append))
    monkeypatch.setattr("app.client.connections.asyncio", SimpleNamespace(sleep=sleep))
    return waits


@pytest.mark.parametrize("status", [429, 503])
def test_the_client_waits_for_the_stated_time_and_repeats(slept, status):
    asked, transport = busy(2, status)
    with Client("http://test") as client:
        client._http = httpx.Client(base_url="http://test", transport=transport)
        assert client.me().name == "Ada"
    assert (len(asked), slept) == (3, [7.0, 7.0])


def test_the_asynchronous_client_does_the_same(slept):
    asked, transport = busy(2)

    async def run():
        async with AsyncClient("http://test") as client:
            client._http = httpx.AsyncClient(base_url="http://test", transport=transport)
            return await client.me()

    assert asyncio.run(run()).name == "Ada"
    assert (len(asked), slept) == (3, [7.0, 7.0])


def test_the_total_wait_has_a_cap(slept):
    asked, transport = busy(99)
    with Client("http://test", patience=20) as client:
        client._http = httpx.Client(base_url="http://test", transport=transport)
        with pytest.raises(Problem, match="429"):
            client.me()
    assert (len(asked), slept) == (3, [7.0, 7.0])


CHANGE = post("/designs", {})
BUSY = httpx.Response(503, headers={"Retry-After": "5"})


@pytest.mark.parametrize(
    ("request_", "response", "wait"),
    [
        (get("/me"), BUSY, 5.0),
        (CHANGE, BUSY, None),
        (post("/designs", {}, {"Idempotency-Key": "a"}), BUSY, 5.0),
        (Request("POST", "/evaluate", is_safe=True), BUSY, 5.0),
        (CHANGE, httpx.Response(429, headers={"Retry-After": "5"}), 5.0),
        (CHANGE, httpx.Response(429, headers={"Retry-After": "0"}), 0.1),
        (CHANGE, httpx.Response(429), None),
        (CHANGE, httpx.Response(429, headers={"Retry-After": "43200"}), None),
        (get("/me"), httpx.Response(503, headers={"Retry-After": "Mon, 30 Nov 2026 23:00:00 GMT"}), None),
        (get("/f"), httpx.Response(503, headers={"Retry-After": "5", "Location": "/api/v1/jobs/j"}), None),
        (get("/me"), httpx.Response(200, headers={"Retry-After": "5"}), None),
    ],
)
def test_what_is_sent_again(request_, response, wait):
    assert Patience(60).wait(request_, response) == wait
