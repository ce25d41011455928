"""A scheduler that accepts connections and does not answer: no wait is endless."""

import asyncio
import threading

import pytest
from dask_processes import commanded
from patience import until
from silence import Silence

from app.observation.readiness import Processes
from app.settings import Settings

pytest.importorskip("distributed", reason="Dask is not installed")
clients = pytest.importorskip("app.workers.remote.client")
network = pytest.importorskip("app.workers.remote.network")
DaskWorker = pytest.importorskip("app.workers.remote.engine").DaskWorker


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    network.configure()
    monkeypatch.setattr(clients, "_CONNECT", 0.3)
    monkeypatch.setattr(clients, "_START", 1.0)


@pytest.fixture
def silence():
    silence = Silence()
    yield silence
    silence.end()


def loops():
    return {thread for thread in threading.enumerate() if thread.name == "IO loop"}


def test_a_client_raises_and_leaves_no_thread(silence):
    before = loops()
    with pytest.raises((OSError, TimeoutError)):
        clients.BoundedClient(f"tcp://127.0.0.1:{silence.port}", network.security(Settings()))
    assert silence.held
    until(lambda: loops() - before, lambda left: left == set())


@pytest.mark.slow
def test_a_server_finds_the_scheduler_that_takes_the_place_of_a_silent_one(silence, tmp_path):
    address = f"tcp://127.0.0.1:{silence.port}"
    engine = DaskWorker.of(Settings(engine=address))
    worker = commanded(
        "worker", tmp_path, "worker", "--scheduler", address, "--lanes", '{"geometry": 1, "analysis": 1}'
    )
    scheduler = None
    try:
        until(lambda: len(silence.held), lambda count: count > 3)  # it and the worker have tried again
        assert not engine.answers()
        assert f"no connection to the scheduler {address}" in engine.why_silent()
        silence.end()
        scheduler = commanded("scheduler", tmp_path, "scheduler", "--port", str(silence.port))
        until(lambda: engine.capacity("geometry"), lambda count: count == 1, seconds=120)
    finally:
        engine.close()
        for process in filter(None, (worker, scheduler)):
            process.stop()


def test_readiness_names_the_reason(silence):
    engine = DaskWorker.of(Settings(engine=f"tcp://127.0.0.1:{silence.port}"))
    try:
        said = asyncio.run(Processes(engine, engine.why_silent, patience=0)())
    finally:
        engine.close()
    assert f"no job process answers: no connection to the scheduler tcp://127.0.0.1:{silence.port}" in said
