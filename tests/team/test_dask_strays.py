"""Functions for machines that left before they arrived: the server does not wait for them for ever."""

import threading
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest
import victims
from dask_processes import Network
from distributed import Future
from patience import patient, until

from app.workers.base import Limits
from app.workers.errors import WorkerLost
from app.workers.remote import strays, wire

LONG = Limits(deadline=patient(100), memory_mb=512)
GONE = "tcp://127.0.0.1:9"  # nobody listens there


@pytest.fixture
def network(tmp_path):
    network = Network(tmp_path, workers=1)
    yield network
    network.stop()


@pytest.fixture
def engine(network):
    engine = network.engine()
    yield engine
    engine.close()


def test_a_machine_that_says_farewell_has_no_place():
    machine, leaving = (
        SimpleNamespace(address=address, resources={"label": 2.0}, processing={}) for address in ("a", "b")
    )
    scheduler = SimpleNamespace(workers={"a": machine, "b": leaving}, running=[machine])
    assert wire.places({"geometry": "label"}, "own", scheduler) == {"geometry": {"a": wire.Places(2, 0)}}


@pytest.mark.slow
def test_a_function_for_a_machine_that_has_gone_runs_on_another(engine, monkeypatch):
    cluster, asked = engine._cluster, []
    best = cluster._best

    def first_gone(lane, preferred):
        asked.append(GONE if not asked else best(lane, preferred))
        return asked[-1]

    monkeypatch.setattr(cluster, "_best", first_gone)
    assert engine.run(victims.double, 21, limits=LONG) == 42
    assert asked[0] == GONE
    assert asked[-1] != GONE


@pytest.mark.slow
def test_a_function_that_never_comes_to_the_scheduler_is_lost(engine, monkeypatch):
    monkeypatch.setattr(strays, "_ON_ITS_WAY", 1.0)
    monkeypatch.setattr(engine._cluster, "_submit", lambda client, lane, key, *_: Future(key, client))
    with pytest.raises(WorkerLost, match="the scheduler does not know the task"):
        engine.run(victims.process_id, limits=LONG)


@pytest.mark.slow
def test_a_scheduler_that_is_back_before_anybody_looked_gets_nothing_for_the_machines_of_the_old_one(
    network, engine, monkeypatch
):
    cluster, client = engine._cluster, engine._cluster._client
    looking, looked, cancelled = (threading.Event() for _ in range(3))

    def look(client):
        looking.set()
        looked.wait(patient(60))

    with monkeypatch.context() as patch:
        patch.setattr(cluster, "_look_around", look)
        assert looking.wait(patient(10))
        network.workers[0].kill()
        network.scheduler.kill()
        until(lambda: client.status, lambda status: status != "running")
        network.start_scheduler()
        network.until_listening()
        until(lambda: client.status, lambda status: status in ("running", "closed"))
        with ThreadPoolExecutor(1) as threads:
            answer = threads.submit(engine.run, victims.double, 21, limits=LONG, cancelled=cancelled)
            network.workers[0] = network.start_worker("another")
            patch.undo()
            looked.set()
            try:
                assert answer.result(patient(100)) == 42
            finally:
                cancelled.set()  # if it waits, so does the end of its thread
    assert client.status == "closed"
