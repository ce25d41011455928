"""`/readyz` names the part of the service that cannot work, and answers even if the writer hangs."""

import asyncio
import os
import signal
import threading
from types import SimpleNamespace

import httpx
import pytest
from patience import patient, until
from serving import problem, serving
from sqlalchemy import event

from app.observation.readiness import Processes, Readiness, Space, WriterProbe
from app.settings import Settings
from app.workers.inline import Inline
from app.workers.local import LocalProcesses


class TestWriting:
    def test_a_write_that_works(self, database):
        commits = []
        event.listen(database._writer.engine, "commit", commits.append)
        assert asyncio.run(WriterProbe(database)()) is None
        assert len(commits) == 1

    def test_a_writer_that_hangs(self, database):
        gate = threading.Event()
        hanging = database.submit(lambda session: gate.wait(30))
        writing = WriterProbe(database, patience=0.05)

        async def twice():
            return [await writing(), await writing()]

        try:
            assert all("takes longer" in said for said in asyncio.run(twice()))
            assert database._writer._waiting.qsize() <= 1, "each test waits in the queue"
        finally:
            gate.set()
        hanging.result(30)
        assert until(lambda: asyncio.run(writing()), lambda said: said is None) is None

    def test_a_write_that_fails(self, database):
        @event.listens_for(database._writer.engine, "commit")
        def full(connection):
            raise OSError("disk is full")

        assert "could not be committed" in asyncio.run(WriterProbe(database)())


class TestSpace:
    def test_enough(self, tmp_path):
        assert asyncio.run(Space(tmp_path, 0)()) is None

    def test_too_little(self, tmp_path):
        assert "CRANKWRIGHT_MINIMUM_FREE_MB" in asyncio.run(Space(tmp_path, 10**12)())

    def test_no_folder(self, tmp_path):
        assert "cannot be read" in asyncio.run(Space(tmp_path / "none", 1)())


class TestProcesses:
    def test_inline(self):
        assert asyncio.run(Processes(Inline())()) is None

    def test_a_dead_forkserver_is_started_again(self):
        worker = LocalProcesses(preload=())
        try:
            until(worker.answers, bool)
            os.kill(worker._forkserver._process.pid, signal.SIGKILL)
            until(worker.answers, lambda said: not said)
            until(worker.answers, bool)
            assert worker.run(abs, -1) == 1
        finally:
            worker.close()

    @pytest.mark.slow
    def test_a_stopped_forkserver(self):
        worker = LocalProcesses(preload=())
        try:
            until(worker.answers, bool)
            os.kill(worker._forkserver._process.pid, signal.SIGSTOP)
            until(worker.answers, lambda said: not said)
            assert "no job process answers" in asyncio.run(Processes(worker, patience=0)())
            os.kill(worker._forkserver._process.pid, signal.SIGCONT)
            until(worker.answers, bool)
        finally:
            worker.close()


def test_answers_are_kept_for_a_second(monkeypatch):
    asked = []

    async def check():
        asked.append(1)

    async def many():
        readiness = Readiness({"one": check})
        return await asyncio.gather(*(readiness.failures() for _ in range(20)))

    clock = SimpleNamespace(monotonic=lambda: 0.0)
    monkeypatch.setattr("app.observation.readiness.time", clock)
    assert asyncio.run(many()) == [{"one": None}] * 20
    assert len(asked) == 1


def test_the_answer_names_what_fails(tmp_path):
    with serving(Settings(data=tmp_path, minimum_free_mb=10**12)) as server:
        with httpx.Client(base_url=server.url, timeout=patient(60), trust_env=False) as http:
            answer = http.get("/readyz")
            assert "space" in [fault["name"] for fault in problem(answer, 503, "not-ready")["errors"]]
            assert int(answer.headers["retry-after"]) > 0


def test_ready(http):
    answer = until(lambda: http.get("/readyz"), lambda answer: answer.status_code == 200)
    assert answer.json() == {
        "status": "ready",
        "checks": {"database": "ok", "space": "ok", "processes": "ok", "calculations": "ok"},
    }


@pytest.mark.parametrize("field", ["minimum_free_mb"])
def test_the_setting_has_words(field):
    assert Settings.model_fields[field].description
