"""Parts of a team that are killed at random moments, and a supervisor that starts whatever has ended.

The supervisor does what `Restart=always` of systemd does. A part has `lives`, `start()` and `kill()`.
"""

import hashlib
import json
import os
import threading
import time
from contextlib import suppress
from pathlib import Path

import pytest
from patience import until
from serving import descendants, folder_of_models
from sqlalchemy import text

from app.settings import Settings
from app.storage.engines import writing_engine
from app.storage.folder import DataFolder
from app.storage.stores import opened_store
from app.team.errors import DidNotStart
from app.team.object_store import AWS

MARK = "CRANKWRIGHT_CHAOS"  # a variable that all processes of a battle inherit
LATER = frozenset({503})  # while the database or the bucket is away: try again
FAST = {"LEASE_SECONDS": "8", "BEAT_SECONDS": "1", "POLL_SECONDS": "1"}
ENDED = {"done", "failed"}
PAUSE = 0.3  # before the supervisor starts what has ended [s]


def settings(folder):
    own = folder_of_models(folder / "own")
    return {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": json.dumps([str(own)]),
        "CRANKWRIGHT_CLIENT_QUEUE_LIMIT": "90000",  # all writers come from one address
        "CRANKWRIGHT_QUEUE_LIMIT": "100000",
        **{f"CRANKWRIGHT_{name}": value for name, value in FAST.items()},
    }


class Supervisor(threading.Thread):
    """Starts every part that does not live, one after another."""

    def __init__(self, parts) -> None:
        super().__init__(name="supervisor", daemon=True)
        self.parts = parts
        self.starts = 0
        self.enough = threading.Event()
        self.changing = threading.Lock()  # a part is killed or started, never both

    def run(self) -> None:
        while not self.enough.wait(PAUSE):
            for part in self.parts:
                with self.changing:
                    if not self.enough.is_set() and not part.lives:
                        self.starts += 1
                        with suppress(DidNotStart):  # tried again
                            part.start()

    def kill(self, part) -> set[int]:
        """Kill -9 a part, and return the processes that descended from it."""
        with self.changing:
            family = descendants(part.pid) if part.pid else set()
            part.kill()
        return family

    def end(self) -> None:
        self.enough.set()
        if self.is_alive():
            self.join()


class Hanging:
    """A part that cannot be killed, because it would forget all; it is stopped for a while instead."""

    def __init__(self, part, stop: int, go_on: int, seconds: float) -> None:
        self.part, self.stop, self.go_on, self.seconds = part, stop, go_on, seconds
        self.pid = 0  # it goes on: nothing of it has to end

    @property
    def lives(self) -> bool:
        return True

    def kill(self) -> None:
        self.part.send(self.stop)
        time.sleep(self.seconds)  # for as long as it hangs
        self.part.send(self.go_on)


def marked(mark: str) -> set[int]:
    """The processes with this mark, without zombies."""
    wanted, found = f"{MARK}={mark}".encode(), set()
    for place in Path("/proc").iterdir():
        with suppress(OSError):
            if place.name.isdecimal() and wanted in (place / "environ").read_bytes().split(b"\0"):
                found.add(int(place.name))
    return found - {os.getpid()}


def rows(url: str, query: str):
    """What a query of the database gives."""
    engine = writing_engine(url)
    try:
        with engine.connect() as connection:
            return connection.execute(text(query)).all()
    finally:
        engine.dispose()


def nothing_is_marked(mark: str) -> None:
    until(lambda: marked(mark), lambda left: left == set(), seconds=20)


def accepted(writers) -> int:
    return sum(len(writer.accepted) for writer in writers)


def every_job_has_ended(url) -> None:
    unfinished = "SELECT id, kind, state FROM job WHERE state NOT IN ('done', 'failed', 'cancelled')"
    until(lambda: rows(url, unfinished), lambda left: left == [], seconds=60)
    assert {state for (state,) in rows(url, "SELECT DISTINCT state FROM job")} <= ENDED


def every_file_has_its_hash(team, folder) -> None:
    given = {name.removeprefix("CRANKWRIGHT_").lower(): text for name, text in team.environment.items()}
    chosen = {name: given[name] for name in ("database_url", "artifacts_url", "s3_endpoint")}
    with pytest.MonkeyPatch.context() as patch:
        for name, value in AWS.items():
            patch.setenv(name, value)
        store = opened_store(Settings(**chosen), DataFolder(folder / "looking"))
        named = {sha for (sha,) in rows(team.url, "SELECT sha256 FROM artifact")}
        assert named
        assert named <= {one.sha for one in store.list()}
        for sha in named:
            assert hashlib.sha256(store.read(sha)).hexdigest() == sha
