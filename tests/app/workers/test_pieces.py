"""Large data is transferred in pieces between processes and clients; short requests come in between."""

import asyncio
import pickle
import socket
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import Pipe

import httpx
import pytest
import victims
from serving import API, problem, serving
from sleeping import folder_of_sleeper
from test_workers import eventually

from app.http.connections import Pace, PiecesResponse
from app.http.strict_requests import StrictRequest
from app.settings import Settings
from app.storage.artifacts import ArtifactStore
from app.workers.base import Limits
from app.workers.messages import pack, receive, send
from app.workers.pieces import PIECE, Pieces
from app.workers.pool import WarmProcesses

LARGE = bytes(range(256)) * (PIECE // 100)  # two and a half pieces


@pytest.mark.parametrize("size", [0, 1, PIECE, PIECE + 1, len(LARGE)])
def test_pieces_are_the_bytes(size):
    pieces = Pieces.of(LARGE[:size])
    assert pieces.joined() == b"".join(pieces) == LARGE[:size]
    assert len(pieces) == size
    assert all(len(piece) <= PIECE for piece in pieces)


def test_pieces_travel_beside_a_small_message():
    packed = pack({"body": Pieces.of(LARGE)})
    assert len(packed.message) < 500
    assert [memoryview(piece).nbytes for piece in packed.pieces] == [PIECE, PIECE, len(LARGE) - 2 * PIECE]
    assert packed.unpacked()["body"].joined() == LARGE


def test_a_message_with_pieces_is_received_whole():
    ours, theirs = Pipe()
    with ours, theirs, ThreadPoolExecutor(1) as threads:
        for data in (LARGE, b"", b"short"):
            sending = threads.submit(send, ours, pack(Pieces.of(data)))
            assert receive(theirs).unpacked().joined() == data
            sending.result()


def test_a_message_that_breaks_off_is_no_message():
    ours, theirs = Pipe()
    packed = pack(Pieces.of(b"short"))
    ours.send_bytes((1).to_bytes(4) + packed.message)
    ours.close()
    with theirs, pytest.raises(EOFError):
        receive(theirs)


def test_pieces_can_be_pickled_as_usual():
    assert pickle.loads(pickle.dumps(Pieces.of(LARGE), protocol=5)).joined() == LARGE


def test_a_process_takes_and_returns_pieces():
    worker = WarmProcesses(())
    try:
        returned = worker.run(victims.same, Pieces.of(LARGE), limits=Limits(20, 512))
        assert returned.joined() == LARGE
        assert len(returned.parts) == 3
    finally:
        worker.close()


def test_an_artifact_is_stored_from_its_pieces(tmp_path):
    store = ArtifactStore(tmp_path)
    sha = store.put(*Pieces.of(LARGE))
    assert store.read(sha) == LARGE
    assert store.put(LARGE) == sha


def test_one_step_in_a_turn_of_the_loop():
    async def all_steps():
        pace, turns, steps = Pace(), 0, []

        def turn():
            nonlocal turns
            turns += 1
            loop.call_soon(turn)

        async def mover():
            for _ in range(5):
                await pace.step()
                steps.append(turns)

        loop = asyncio.get_running_loop()
        turn()
        await asyncio.gather(*(mover() for _ in range(20)))
        return steps

    steps = asyncio.run(all_steps())
    assert len(set(steps)) == len(steps) == 100


class State:
    """As much of an app as a request looks at."""

    def __init__(self):
        self.state, self.pace = self, Pace()


def request_of(parts):
    """A request whose body comes in these parts."""
    left = [{"type": "http.request", "body": part, "more_body": True} for part in parts]
    left.append({"type": "http.request", "body": b"", "more_body": False})

    async def receive():
        return left.pop(0)

    return StrictRequest({"type": "http", "headers": [], "app": State()}, receive), left


def test_a_body_is_read_once_and_joined_once():
    async def read():
        request, _ = request_of([LARGE, b"end"])
        assert [len(part) for part in await request.parts()] == [len(LARGE), 3]
        assert await request.body() == LARGE + b"end"
        assert await request.body() is await request.body()
        assert await request.parts() is await request.parts()

    asyncio.run(read())


def test_a_discarded_body_has_been_received():
    async def discard():
        request, left = request_of([LARGE, LARGE])
        await request.discard()
        assert not left

    asyncio.run(discard())


@pytest.mark.parametrize("data", [b"", b"{}", LARGE])
def test_an_answer_is_sent_in_pieces(data):
    sent = []

    async def send(message):
        sent.append(message)

    asyncio.run(PiecesResponse(Pieces.of(data), Pace())({"type": "http"}, None, send))
    start, *bodies = sent
    assert dict(start["headers"])[b"content-length"] == str(len(data)).encode()
    assert b"".join(message["body"] for message in bodies) == data
    assert [message["more_body"] for message in bodies] == [True] * (len(bodies) - 1) + [False]
    assert max(len(message["body"]) for message in bodies) <= PIECE


# Over HTTP, with a pool that is full -----------------------------------------------------------------------

PLACE = f"{API}/templates/sleeper/versions/1/evaluate"
JSON = {"Content-Type": "application/json"}
PADDING = b'{"inputs": {"duration": "1 ms"}, "outputs": []' + b" " * 400_000 + b"}"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pieces")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SLEEPER_LOG", str(folder / "log"))
        own = (folder_of_sleeper(folder / "own"),)
        one = {"calculation_processes": 1, "calculation_waiting": 1}
        with serving(Settings(data=folder / "data", template_folders=own, **one)) as server:
            yield server


@pytest.fixture
def http(server):
    with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        yield http


@pytest.fixture
def full(server):
    """The server while one calculation runs and one waits, both of the client `flood`."""
    pool = server.app.state.services.calculations
    busy = [pool.submit("name:flood", victims.sleep, 60.0) for _ in range(2)]
    assert eventually(lambda: pool.running == 1 and pool.waiting == 1)
    yield server
    for calculation in busy:
        pool.cancel(calculation)
    assert eventually(lambda: pool.running == pool.waiting == 0)


def test_a_large_body_is_refused_as_a_small_one_when_the_pool_is_full(full, http):
    flood = {**JSON, "Crankwright-Client": "flood"}
    large = http.post(PLACE, content=PADDING, headers=flood)
    small = http.post(PLACE, content=b'{"inputs": {"duration": "1 ms"}}', headers=flood)
    refusals = [problem(answer, 429, "queue-full") for answer in (large, small)]
    assert refusals[0]["detail"] == refusals[1]["detail"]
    assert large.headers["Retry-After"] == small.headers["Retry-After"]


def test_it_is_refused_without_being_kept(full, http, monkeypatch):
    async def kept(self):
        raise AssertionError("the body was kept")

    monkeypatch.setattr(StrictRequest, "parts", kept)
    answer = http.post(PLACE, content=PADDING, headers={**JSON, "Crankwright-Client": "flood"})
    problem(answer, 429, "queue-full")


def test_a_connection_is_used_again_after_a_large_body_was_refused(full, http):
    flood = {**JSON, "Crankwright-Client": "flood"}
    for _ in range(3):
        assert http.post(PLACE, content=PADDING, headers=flood).status_code == 429
    assert http.get("/healthz").status_code == 200


def test_errors_come_before_the_refusal(full, http):
    flood = {**JSON, "Crankwright-Client": "flood"}
    nowhere = http.post(f"{API}/templates/nothing/versions/1/evaluate", content=PADDING, headers=flood)
    problem(nowhere, 404, "unknown-template")
    problem(http.post(PLACE, content=PADDING, headers={**flood, "Content-Type": "text/plain"}), 415,
            "unsupported-media-type")  # fmt: skip


def test_who_prefers_a_job_is_not_refused(full, http):
    flood = {**JSON, "Crankwright-Client": "flood", "Prefer": "respond-async"}
    assert http.post(PLACE, content=PADDING, headers=flood).status_code == 202


def test_a_client_that_leaves_while_it_sends_is_no_fault_of_the_service(server, http):
    before = http.get("/metrics").text.count('status="500"')
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port))) as leaving:
        head = f"POST {PLACE} HTTP/1.1\r\nHost: {host}:{port}\r\nContent-Type: application/json\r\n"
        leaving.sendall(f"{head}Content-Length: 500000\r\n\r\n{{".encode())
    gone = 'status="499"'
    assert eventually(lambda: gone in http.get("/metrics").text)
    assert http.get("/metrics").text.count('status="500"') == before
