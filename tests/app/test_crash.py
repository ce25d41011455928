"""`kill -9` at any moment: what was accepted is there once, whole, and built, or it says why not.

Clients change designs and repeat, under the same Idempotency-Key, whatever was not answered. Meanwhile the
server is killed again and again. In the end every accepted change is one revision, no more and no less, and
no process is left of any server.
"""

import hashlib
import random
import signal
import threading
import time

import httpx
import pytest
from patience import until
from seeds import seeded
from serving import API, PATIENCE, ServerProcess, alive, folder_of_models, moody, pages, settled

from cad.stamp import is_copy

DESIGNS = f"{API}/designs"
WRITERS = 4


class Writer(threading.Thread):
    """A client with one design, which it changes again and again, each time until the change is accepted."""

    def __init__(self, url: str, number: int) -> None:
        super().__init__(name=f"writer-{number}", daemon=True)
        self.url, self.number = url, number
        self.random = random.Random(number)
        self.enough = threading.Event()
        self.accepted: list[str] = []  # the notes of accepted revisions
        self.unanswered = 0
        self.design = None
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            with httpx.Client(base_url=self.url, timeout=PATIENCE / 6, trust_env=False) as self.http:
                document = moody(f"{10 + self.number} mm", parameters={"counter": "0"}, note="change 0")
                self.design = self.send("POST", DESIGNS, document, "0", {})["id"]
                while not self.enough.wait(self.random.uniform(0, 0.1)):
                    self.change(len(self.accepted))
        except BaseException as failure:
            self.failure = failure

    def change(self, change: int) -> None:
        """A light change, one that builds, or one that cannot be built."""
        patch = {"parameters": {"counter": str(change)}, "note": f"change {change}"}
        kind = self.random.random()
        parameters = {"mood": "raises" if kind < 0.05 else "good"}
        if kind < 0.25:
            parameters["size"] = f"{10 + self.number + change / 1000} mm"
        patch["model"] = {"parameters": parameters}
        place = f"{DESIGNS}/{self.design}"
        answer = self.send("PATCH", place, patch, str(change), {"If-Match": f'"{change}"'})
        assert answer["revision"] == change + 1

    def send(self, method, path, body, key, headers) -> dict:
        """Send until there is an answer; the key makes that harmless."""
        headers = {**headers, "Idempotency-Key": f"{self.name}-{key}", "Prefer": "respond-async"}
        end = time.monotonic() + 3 * PATIENCE
        while time.monotonic() < end:
            try:
                answer = self.http.request(method, path, json=body, headers=headers)
            except httpx.TransportError:
                self.unanswered += 1
                time.sleep(0.02)
                continue
            assert answer.status_code in (200, 201, 202), answer.text
            self.accepted.append(body["note"])
            return answer.json()
        raise TimeoutError(f"{method} {path}")


def battle(data, kills: int, seed: int, changes: int) -> None:
    """Writers against a server that is killed until they have made enough changes; then look what is left."""
    chance = random.Random(seed)
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder_of_models(data.parent)}"]',
        "CRANKWRIGHT_CLIENT_QUEUE_LIMIT": "90000",  # all writers come from one address
        "CRANKWRIGHT_QUEUE_LIMIT": "100000",  # a server that is killed all the time gets behind
    }
    server = ServerProcess(data, **environment)
    family: set[int] = set()
    writers = [Writer(server.url, number) for number in range(WRITERS)]
    try:
        server.start().ready()
        for writer in writers:
            writer.start()
        for _ in range(kills):
            time.sleep(chance.uniform(0.01, 0.6))  # a moment by chance; nothing waits for it
            family |= server.kill()
            server.start()
            if chance.random() < 0.7:  # else it is killed while it starts, or resumes
                server.ready()
        server.ready()
        accepted = lambda: sum(len(writer.accepted) for writer in writers)  # noqa: E731
        until(lambda: accepted() >= changes or any(writer.failure for writer in writers), seconds=120)
        peace(writers)
        nothing_lives(family)
        with httpx.Client(base_url=server.url, timeout=30, trust_env=False) as http:
            for writer in writers:
                each_accepted_change_is_one_revision(http, writer)
            nothing_is_half_done(http, data)
    finally:
        for writer in writers:
            writer.enough.set()
        last = server.kill()
    nothing_lives(last)
    assert sum(len(writer.accepted) for writer in writers) >= changes, "too few to mean anything"
    assert all(writer.unanswered for writer in writers), "no kill met a change"


def peace(writers: list[Writer]) -> None:
    """Let all writers finish what they are at."""
    for writer in writers:
        writer.enough.set()
    for writer in writers:
        writer.join(4 * PATIENCE)
    assert [writer.failure for writer in writers] == [None] * WRITERS
    assert not any(writer.is_alive() for writer in writers)


def each_accepted_change_is_one_revision(http, writer: Writer) -> None:
    design = settled(http, writer.design, seconds=120)
    revisions = list(pages(http, f"{DESIGNS}/{writer.design}/revisions", 100, len(writer.accepted) + 1))
    assert [one["note"] for one in reversed(revisions)] == writer.accepted
    assert [one["number"] for one in reversed(revisions)] == list(range(1, len(revisions) + 1))
    assert design["revision"] == len(writer.accepted)
    for one in revisions:
        each_revision_is_whole(http, one)


def each_revision_is_whole(http, one: dict) -> None:
    place = f"{DESIGNS}/{one['design']}/revisions/{one['number']}"
    if one["state"] == "regenerating":
        one = until(lambda: http.get(place).json(), lambda one: one["state"] != "regenerating")
    assert one["parameters"]["counter"] == str(one["number"] - 1)
    mood = one["models"]["model"]["parameters"]["mood"]["value"]
    if mood == "raises":
        assert one["state"] == "failed"
        assert one["problem"]["type"] == "/problems/geometry"
        return
    assert one["state"] == "current", one["problem"]
    sha = one["models"]["model"]["artifacts"]["step"]
    stored = http.get(f"{API}/artifacts/{sha}").content
    assert hashlib.sha256(stored).hexdigest() == sha
    assert is_copy(http.get(f"{place}/model.step").content, stored)


def nothing_is_half_done(http, data) -> None:
    jobs = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
    assert {job["state"] for job in jobs} <= {"done", "failed"}
    assert len(http.get(DESIGNS, params={"limit": 500}).json()["items"]) == WRITERS
    files = [file for file in (data / "artifacts").rglob("*") if file.is_file()]
    whole = [file for file in files if len(file.name) == 64]
    assert whole
    assert all(hashlib.sha256(file.read_bytes()).hexdigest() == file.name for file in whole)


def nothing_lives(family: set[int]) -> None:
    until(lambda: {pid for pid in family if alive(pid)}, lambda left: left == set(), seconds=20)


def test_a_kill(tmp_path):
    battle(tmp_path / "data", kills=1, seed=1, changes=12)


@pytest.mark.slow
def test_a_few_kills(tmp_path):
    battle(tmp_path / "data", kills=4, seed=1, changes=20)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [seeded(2), seeded(3)])
def test_dozens_of_kills_during_200_accepted_changes(tmp_path, seed):
    battle(tmp_path / "data", kills=36, seed=seed, changes=200)


@pytest.mark.slow
def test_a_killed_servers_loop_is_ended_with_it_and_resumed(tmp_path):
    """A job that loops for ever neither outlives its server nor is forgotten by the next one."""
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder_of_models(tmp_path)}"]',
        "CRANKWRIGHT_JOB_DEADLINE": "2",
    }
    server = ServerProcess(tmp_path / "data", **environment).start().ready()
    with httpx.Client(base_url=server.url, timeout=30, trust_env=False) as http:
        answer = http.post(DESIGNS, json=moody(mood="loops"), headers={"Prefer": "respond-async"})
        job = answer.headers["location"]
        until(lambda: http.get(job).json()["state"], lambda state: state == "running")
        family = server.kill()
        assert family, "the forkserver and the job"
        nothing_lives(family)
        server.start().ready()
        try:
            content = settled(http, answer.json()["id"])
            assert content["problem"]["type"] == "/problems/deadline"
            assert content["revision"] == 1
        finally:
            assert server.stop() in (0, -signal.SIGTERM)  # uvicorn ends by the signal itself
