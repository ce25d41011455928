"""Requests begin one per turn of the event loop, so `/healthz` waits for one of them, not for all."""

import asyncio
import time
from types import SimpleNamespace

from app.api.responses import THREADS
from app.http import problems
from app.http.connections import AddressLimit
from app.http.gate import Gate
from app.http.limits import BodyLimits
from app.settings import Settings
from app.settings.hosts import Hosts

CLIENTS, WORK = 48, 2e-3
APPLICATION = SimpleNamespace(state=SimpleNamespace(services=None))


def scope(path):
    return {
        "type": "http",
        "method": "GET",
        "scheme": "http",
        "path": path,
        "raw_path": path.encode(),
        "query_string": b"",
        "headers": [(b"host", b"localhost")],
        "client": ("127.0.0.1", 1),
        "server": ("127.0.0.1", 8000),
        "app": APPLICATION,
    }


async def order_of_answers():
    answered = []

    async def app(asked, receive, send):
        if asked["path"] != "/healthz":
            end = time.perf_counter() + WORK
            while time.perf_counter() < end:
                pass
        answered.append(asked["path"])

    addresses, body = AddressLimit(2 * CLIENTS, ()), BodyLimits(2**20, 10.0, 1000.0)
    gate = Gate(app, Hosts(), body, addresses, problems.refusal)
    paths = ["/busy"] * CLIENTS + ["/healthz"]
    await asyncio.gather(*[gate(scope(path), None, None) for path in paths])
    return answered


def test_health_overtakes_the_requests_that_wait_for_their_turn():
    answered = asyncio.run(order_of_answers())
    assert len(answered) == CLIENTS + 1
    assert answered.index("/healthz") <= 2


def test_one_address_cannot_fill_the_queue_of_calculations():
    """A refusal with 429 is the last resort: one address has fewer connections than places in the queue."""
    settings = Settings()
    assert settings.connections_per_address <= settings.calculation_waiting < THREADS
