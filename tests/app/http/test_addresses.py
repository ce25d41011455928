"""One address may have a limited number of connections, or of requests behind a trusted proxy."""

import socket
from contextlib import ExitStack, closing

import httpx
import pytest
from patience import until
from serving import API, HANG, problem, serving

from app.http.connections import AddressLimit
from app.settings import Settings

MOST = 4
ELSEWHERE = "127.0.0.9"  # an address of this machine that is no trusted proxy


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    data = tmp_path_factory.mktemp("addresses") / "data"
    with serving(Settings(data=data, connections_per_address=MOST)) as served:
        yield served


def client(server, address):
    transport = httpx.HTTPTransport(local_address=address)
    return httpx.Client(base_url=server.url, timeout=HANG, transport=transport, trust_env=False)


def held(server, address):
    """A connection from an address that sends nothing."""
    port = int(server.url.rpartition(":")[2])
    return closing(socket.create_connection(("127.0.0.1", port), timeout=HANG, source_address=(address, 0)))


def status(server, address):
    with client(server, address) as http:
        return http.get("/healthz").status_code


def test_an_address_has_a_limited_number_of_connections_and_others_are_served(server):
    with ExitStack() as stack:
        for _ in range(MOST):
            stack.enter_context(held(server, ELSEWHERE))
        with client(server, ELSEWHERE) as http:
            problem(http.get("/healthz"), 503, "too-many-connections")
        assert status(server, "127.0.0.10") == 200
        assert status(server, "127.0.0.1") == 200
    until(lambda: status(server, ELSEWHERE) == 200)


def test_a_trusted_proxy_may_have_more(server):
    with ExitStack() as stack:
        for _ in range(3 * MOST):
            stack.enter_context(held(server, "127.0.0.1"))
        assert status(server, "127.0.0.1") == 200


def test_behind_a_proxy_the_requests_of_each_forwarded_address_are_counted(server):
    with client(server, "127.0.0.1") as http, ExitStack() as stack:
        design = http.post(f"{API}/designs", json={"name": "x"}).json()["id"]
        for number in range(MOST):
            headers = {"X-Forwarded-For": "203.0.113.7", "Crankwright-Client": f"c{number}"}
            stream = http.stream("GET", f"{API}/designs/{design}/events", headers=headers)
            assert stack.enter_context(stream).status_code == 200
        refused = http.get("/healthz", headers={"X-Forwarded-For": "203.0.113.7"})
        assert f"at most {MOST} requests" in problem(refused, 503, "too-many-connections")["detail"]
        assert refused.headers["retry-after"] == "5"
        assert http.get("/healthz", headers={"X-Forwarded-For": "203.0.113.8"}).status_code == 200
        assert http.get("/healthz").status_code == 200
    with client(server, "127.0.0.1") as http:
        forwarded = {"X-Forwarded-For": "203.0.113.7"}
        until(lambda: http.get("/healthz", headers=forwarded).status_code == 200)


@pytest.mark.parametrize("host", ["10.0.0.7", "10.0.0.255", "::ffff:10.0.0.7", "2001:db8::1"])
def test_proxies_are_named_by_networks_of_both_kinds(host):
    limit = AddressLimit(1, ("10.0.0.0/24", "2001:db8::/64"))
    assert [limit.enter((host, 1)) for _ in range(3)] == [0, 0, 0]
    limit.leave((host, 1))
    assert not limit.open


def test_what_an_address_closes_makes_room_and_leaves_nothing():
    limit = AddressLimit(1, ())
    other = ("10.0.1.1", 9)
    assert [limit.enter(other), limit.enter(other)] == [0, 1]
    limit.leave(other)
    limit.leave(other)
    limit.leave(other)
    assert not limit.open
    assert limit.enter(None) == 0
