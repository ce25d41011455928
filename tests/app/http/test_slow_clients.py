"""Clients that send or read slowly, or send too much, do not block the server; each gets an answer."""

import json
import socket
import threading
import time
from contextlib import suppress

import httpx
import pytest
from patience import GLANCE
from serving import API, HANG, PATIENCE, problem, serving

from app.calculations.bodies import OIL_FILM as FILM
from app.http.connections import LONGEST_HEAD
from app.http.streams import Streams, TooManyStreams
from app.settings import Settings

EVALUATE = f"{API}/templates/oil_film/versions/1/evaluate"
JSON = "Content-Type: application/json"


@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    """A server of short patience."""
    settings = Settings(
        data=tmp_path_factory.mktemp("slow") / "data",
        header_seconds=0.5,
        body_seconds=0.5,
        write_seconds=0.5,
        connections=12,
        streams=3,
        streams_per_client=2,
    )
    with serving(settings) as server:
        yield server


def connected(slow, start: bytes = b"") -> socket.socket:
    address = slow.url.removeprefix("http://").split(":")
    connection = socket.create_connection((address[0], int(address[1])), timeout=HANG)
    connection.sendall(start)
    return connection


def head(line: str, *headers: str) -> bytes:
    return "\r\n".join([f"{line} HTTP/1.1", "Host: 127.0.0.1", *headers, "", ""]).encode()


def dripped(slow, start: bytes, piece: bytes) -> bytes:
    """The answer, until the server closes, to a client that sends 2 kB/s for ever."""
    answer = b""
    with connected(slow, start) as connection:
        connection.settimeout(len(piece) / 2000)
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                if not (more := connection.recv(65536)):
                    return answer
                answer += more
            except TimeoutError:
                with suppress(ConnectionResetError, BrokenPipeError):  # the next recv says so
                    connection.sendall(piece)
            except ConnectionResetError:
                return answer
    raise AssertionError(f"the connection is held; answered was {answer!r}")


def problem_in(answer: bytes) -> dict:
    """The one problem in raw bytes, which carries the id in its header."""
    top, _, body = answer.partition(b"\r\n\r\n")
    lines = top.decode().lower().split("\r\n")
    content = json.loads(body)
    assert "content-type: application/problem+json" in lines
    assert f"x-request-id: {content['request_id']}" in lines
    assert "connection: close" in lines
    assert int(lines[0].split()[1]) == content["status"]
    return content


@pytest.mark.parametrize("piece", [b"X-Filler: aaaaaaaaaaaaaaaaaaaaaaaaaaaa\r\n", b"a" * 40])
@pytest.mark.sampled(1)
def test_a_head_at_a_trickle(slow, piece):
    refusal = problem_in(dripped(slow, b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n", piece))
    assert refusal["type"] == "/problems/too-slow"
    assert refusal["status"] == 408


def test_a_second_head_at_a_trickle(slow):
    answer = dripped(slow, head("GET /healthz") + b"GET /healthz HTTP/1.1\r\n", b"X-A: aaaaaaaaaaaaaaaa\r\n")
    first, _, second = answer.partition(b'{"status":"ok"}')
    assert first.startswith(b"HTTP/1.1 200")
    assert problem_in(second)["status"] == 408


@pytest.mark.parametrize("start", [b"", head("GET /healthz")])
@pytest.mark.sampled(1)
def test_empty_lines_are_no_request(slow, start):
    assert b"408" not in dripped(slow, start, b"\r\n\r\n\r\n\r\n")


@pytest.mark.parametrize(
    ("framing", "piece"),
    [
        ("Content-Length: 1000000", b"a" * 100),
        ("Transfer-Encoding: chunked", b"5c\r\n" + b"a" * 92 + b"\r\n"),
    ],
)
@pytest.mark.sampled(1)
def test_a_body_at_a_trickle(slow, framing, piece):
    refusal = problem_in(dripped(slow, head(f"POST {EVALUATE}", JSON, framing), piece))
    assert refusal["type"] == "/problems/too-slow"
    assert "bytes/s" in refusal["detail"]


def test_a_body_that_stops(slow):
    with connected(slow, head(f"POST {EVALUATE}", JSON, "Content-Length: 100") + b"{") as connection:
        answer = b"".join(iter(lambda: connection.recv(65536), b""))
    assert problem_in(answer)["type"] == "/problems/too-slow"


def test_the_rest_of_a_body_that_was_refused(slow):
    answer = dripped(slow, head("POST /nowhere", JSON, "Content-Length: 1000000"), b"a" * 100)
    assert answer.startswith(b"HTTP/1.1 404")


def test_a_body_in_pieces_that_comes_fast_enough(slow):
    def pieces():
        yield b'{"inputs": {'
        time.sleep(0.2)
        yield b'"nonsense": 1}}'

    answer = httpx.post(
        f"{slow.url}{EVALUATE}", content=pieces(), headers={"Content-Type": "application/json"},
        timeout=HANG, trust_env=False,
    )  # fmt: skip
    assert problem(answer, 422, "invalid-inputs")["errors"]


@pytest.mark.slow
def test_an_answer_that_nobody_reads(slow):
    """The server gives up the connection instead of keeping its answers for ever."""
    with connected(slow) as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.settimeout(0.1)
        with pytest.raises(OSError, match=r"reset|[Bb]roken pipe"):
            asked_for_ever(connection)
    assert cut_readers(slow) > 0


def asked_for_ever(connection: socket.socket) -> None:
    """Send requests; while the server does not read them, because it cannot write, try again."""
    waiting, end = b"", time.monotonic() + PATIENCE
    while time.monotonic() < end:
        waiting = waiting or head("GET /openapi.json")
        with suppress(TimeoutError):
            waiting = waiting[connection.send(waiting) :]


def read_to_the_end(connection: socket.socket) -> None:
    """Read until the server closes."""
    while connection.recv(2**20):
        pass


def cut_readers(slow) -> float:
    """How many connections the server has cut because nobody read from them."""
    text = httpx.get(f"{slow.url}/metrics", timeout=PATIENCE, trust_env=False).text
    counts = [line.split()[-1] for line in text.splitlines() if 'cut_total{why="unread"}' in line]
    return float(counts[0]) if counts else 0.0


@pytest.mark.slow
def test_the_kernel_keeps_nothing_for_who_does_not_read(slow):
    """A connection that is cut is reset: its buffers, up to some megabytes, are not delivered for hours."""
    speeds = ", ".join(str(1000 + number % 4000) for number in range(50_000))
    body = json.dumps({"inputs": FILM | {"speed": {"value": [], "unit": "rpm"}}}).replace("[]", f"[{speeds}]")
    before, end = cut_readers(slow), time.monotonic() + PATIENCE
    with connected(slow, head(f"POST {EVALUATE}", JSON, f"Content-Length: {len(body)}")) as connection:
        connection.sendall(body.encode())
        while cut_readers(slow) == before:
            assert time.monotonic() < end, "nobody was cut"
            time.sleep(GLANCE)
        with pytest.raises(ConnectionResetError):
            read_to_the_end(connection)


def test_a_head_without_end(slow):
    refusal = problem_in(dripped(slow, b"GET / HTTP/1.1\r\nX-A: " + b"a" * (LONGEST_HEAD - 100), b"a" * 200))
    assert refusal["type"] == "/problems/head-too-large"
    assert f"{LONGEST_HEAD} bytes" in refusal["detail"]


def test_what_is_no_http(slow):
    assert problem_in(dripped(slow, b"BOGUS\r\n\r\n", b"a" * 100))["type"] == "/problems/not-http"


def test_an_upgrade_is_ignored(slow):
    upgrade = ("Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13")
    answer = dripped(slow, head("GET /healthz", *upgrade), b"\r\n")
    assert answer.startswith(b"HTTP/1.1 200")


def test_too_many_connections(slow):
    """The first ones are served, the ones beyond get a problem, and later there is room again."""
    with httpx.Client(base_url=slow.url, timeout=HANG, trust_env=False) as first:
        assert first.get("/healthz").is_success
        held = [connected(slow, b"GET") for _ in range(12)]
        with httpx.Client(base_url=slow.url, timeout=HANG, trust_env=False) as late:
            answer = late.get("/healthz")
            problem(answer, 503, "too-many-connections")
            assert answer.headers["retry-after"] == "5"
        for connection in held:
            connection.close()
        end = time.monotonic() + PATIENCE
        while httpx.get(f"{slow.url}/healthz", timeout=PATIENCE, trust_env=False).status_code != 200:
            assert time.monotonic() < end


def test_too_many_streams_of_one_client(slow):
    place = f"{API}/designs"
    with httpx.Client(base_url=slow.url, timeout=HANG, trust_env=False) as http:
        design = http.post(place, json={"name": "x"}).json()["id"]
        watched = f"{place}/{design}/events"
        with http.stream("GET", watched) as one, http.stream("GET", watched) as two:
            assert one.is_success
            assert two.is_success
            refused = http.get(watched)
            assert "at most 2 event streams" in problem(refused, 429, "too-many-streams")["detail"]
            assert refused.headers["retry-after"]
            other = {"Crankwright-Client": "other"}
            with http.stream("GET", watched, headers=other) as third:
                assert third.is_success
                problem(http.get(watched, headers=other), 429, "too-many-streams")
        streams, end = slow.app.state.services.streams, time.monotonic() + PATIENCE
        while streams.open:
            assert time.monotonic() < end, "the places are free again"
            time.sleep(0.01)


def test_places_for_streams_are_counted_exactly():
    streams, refused = Streams(most=5, most_of_client=3), []

    def enter(client):
        try:
            streams.enter(client)
        except TooManyStreams:
            refused.append(client)

    threads = [threading.Thread(target=enter, args=[f"client {number % 2}"]) for number in range(20)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert streams.open.total() == 5
    assert max(streams.open.values()) == 3
    assert len(refused) == 15


@pytest.mark.parametrize("slug", ["too-slow", "head-too-large", "not-http", "too-many-connections"])
def test_each_problem_is_explained(slow, slug):
    assert httpx.get(f"{slow.url}/problems/{slug}", timeout=PATIENCE, trust_env=False).json()["remedy"]
