"""Clients that change designs while servers are killed, and the state that must remain.

A client repeats, under the same Idempotency-Key, whatever was not answered, at any of the servers.
"""

import hashlib
import random
import threading
import time

import httpx
from patience import until
from serving import API, PATIENCE, moody, pages, settled

from cad.stamp import is_copy

DESIGNS = f"{API}/designs"


class Writer(threading.Thread):
    """A client with one design, which it changes again and again, each time until the change is accepted.

    `busy` are the statuses after which it tries again: a server of a team may be without its database. It
    waits up to `pause` seconds between two changes.
    """

    def __init__(self, urls, number: int, busy=frozenset(), pause=0.1) -> None:
        super().__init__(name=f"writer-{number}", daemon=True)
        self.urls, self.number, self.busy, self.pause = urls, number, busy, pause
        self.random = random.Random(number)
        self.enough = threading.Event()
        self.accepted: list[str] = []  # the notes of accepted revisions
        self.unanswered = 0
        self.design = None
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            with httpx.Client(timeout=PATIENCE / 6, trust_env=False) as self.http:
                document = moody(f"{10 + self.number} mm", parameters={"counter": "0"}, note="change 0")
                self.design = self.send("POST", DESIGNS, document, "0", {})["id"]
                while not self.enough.wait(self.random.uniform(0, self.pause)):
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
        """Send until there is an answer, to whichever server; the key makes that harmless."""
        headers = {**headers, "Idempotency-Key": f"{self.name}-{key}", "Prefer": "respond-async"}
        end = time.monotonic() + 3 * PATIENCE
        while time.monotonic() < end:
            try:
                url = self.random.choice(self.urls) + path
                answer = self.http.request(method, url, json=body, headers=headers)
            except httpx.TransportError:
                self.unanswered += 1
                time.sleep(0.02)
                continue
            if answer.status_code in self.busy:
                self.unanswered += 1
                time.sleep(0.1)
                continue
            assert answer.status_code in (200, 201, 202), (answer.status_code, answer.text)
            self.accepted.append(body["note"])
            return answer.json()
        raise TimeoutError(f"{method} {path}")


def peace(writers: list[Writer]) -> None:
    """Let all writers finish what they are at."""
    for writer in writers:
        writer.enough.set()
    for writer in writers:
        writer.join(4 * PATIENCE)
    assert [writer.failure for writer in writers] == [None] * len(writers)
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
