"""Functions on the machines of a Dask scheduler behave as in local processes."""

import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import victims
from bare_shells import BUSH
from dask_processes import Network, process_in, until_gone
from patience import patient, until

from app.pool.sources import source_of
from app.settings import Settings
from app.solids.builds import build_in_worker
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded, RemoteError
from app.workers.inline import Inline
from app.workers.remote import wire
from app.workers.remote.cluster import Cluster
from app.workers.remote.engine import DaskWorker
from app.workers.remote.network import security
from cad.catalogue import models
from cad.regenerate import as_text

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills

USUAL = Limits(deadline=patient(20), memory_mb=512)
LONG = Limits(deadline=patient(100), memory_mb=512)


@pytest.fixture(scope="module")
def network(tmp_path_factory):
    network = Network(tmp_path_factory.mktemp("dask"), workers=1, places=2)  # each worker imports for seconds
    yield network
    network.stop()


@pytest.fixture(scope="module")
def engine(network):
    engine = network.engine()
    yield engine
    engine.close()


@pytest.fixture
def batch(engine):
    batch = engine.batch()
    yield batch
    batch.close()


def test_what_a_function_returns_comes_back(engine):
    heard = []
    assert engine.run(victims.double, 21, limits=USUAL) == 42
    assert engine.run(victims.count_to, 2, on_progress=lambda *message: heard.append(message)) == 2
    assert heard == [(0.0, "step 0"), (0.5, "step 1")]


def test_a_solid_has_the_bytes_that_it_has_here(engine):
    shape = models().get("plain_bearing", 1).from_quantities({**BUSH, "inner_diameter": "45 mm"})
    task = build_in_worker, source_of(type(shape)), as_text(shape)
    assert engine.run(*task) == Inline().run(*task)


def test_dasks_own_process_never_loads_the_geometry_kernel(engine, network):
    assert engine.run(victims.loaded, "OCP")
    for worker in network.workers:
        loaded = Path(f"/proc/{worker.pid}/maps").read_text()
        assert "numpy" in loaded
        assert "OCP" not in loaded
        assert "TKernel" not in loaded


@pytest.mark.parametrize(
    ("function", "args", "error"),
    [
        (victims.segfault, (), JobCrashed),
        (victims.leave, (3,), JobCrashed),
        (victims.memory_bomb, (), MemoryExceeded),
        (victims.bad_value, ("no such bore",), ValueError),
        (victims.awkward, (), RemoteError),
        (victims.unpicklable, (), RemoteError),
    ],
    ids=["signal", "exit", "memory", "exception", "no exception", "no result"],
)
@pytest.mark.sampled(2)
def test_what_fails_fails_alone_and_the_rest_goes_on_in_a_new_process(batch, function, args, error):
    before = batch.run(victims.process_id, limits=USUAL)
    with pytest.raises(error):
        batch.run(function, *args, limits=USUAL)
    after = [batch.run(victims.process_id, limits=USUAL) for _ in range(2)]
    assert after[0] == after[1] != before


def test_what_takes_too_long_is_killed(engine, tmp_path):
    with pytest.raises(DeadlineExceeded):
        engine.run(victims.tell_and_sleep, tmp_path / "pid", limits=Limits(1.0, 512))
    until_gone(process_in(tmp_path / "pid"))


def test_what_is_cancelled_is_killed(batch, tmp_path):
    cancelled = threading.Event()
    with ThreadPoolExecutor() as threads:
        job = threads.submit(
            batch.run, victims.tell_and_sleep, tmp_path / "pid", limits=LONG, cancelled=cancelled
        )
        child = process_in(tmp_path / "pid")
        cancelled.set()
        with pytest.raises(JobCancelled):
            job.result()
    until_gone(child)


@pytest.mark.slow
def test_a_process_that_waits_for_its_batch_in_vain_ends(engine):
    batch = engine.batch()
    until_gone(batch.run(victims.process_id, limits=USUAL))


def test_a_place_is_held_while_a_function_runs_and_others_see_it(engine, network, tmp_path):
    other, cancelled = network.engine(), threading.Event()
    with ThreadPoolExecutor() as threads:
        job = threads.submit(
            engine.run, victims.tell_and_sleep, tmp_path / "pid", limits=LONG, cancelled=cancelled
        )
        process_in(tmp_path / "pid")
        assert engine.capacity("geometry") == 1
        assert engine.capacity("analysis") == 2
        until(lambda: other.capacity("geometry"), lambda count: count == 1)
        cancelled.set()
        assert isinstance(job.exception(), JobCancelled)
    assert engine.capacity("geometry") == 2
    until(lambda: other.capacity("geometry"), lambda count: count == 2)
    other.close()


def test_what_finds_no_place_waits_here_and_not_in_dask(engine, tmp_path):
    files, cancelled = [tmp_path / name for name in "abc"], threading.Event()
    with ThreadPoolExecutor() as threads:
        jobs = [
            threads.submit(engine.run, victims.tell_and_sleep, file, limits=LONG, cancelled=cancelled)
            for file in files
        ]
        until(lambda: sum(file.exists() for file in files), lambda count: count == 2)
        assert engine.capacity("geometry") == 0
        assert engine._cluster._client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)) == 2
        cancelled.set()
        assert all(isinstance(job.exception(), JobCancelled) for job in jobs)
    assert sum(file.exists() for file in files) == 2


def test_a_server_of_another_program_finds_no_place_and_sends_nothing(network):
    settings = Settings(engine=network.address)
    other = DaskWorker(Cluster(network.address, security(settings), "of another program"))
    cancelled = threading.Event()
    until(lambda: other._cluster._client)
    with ThreadPoolExecutor() as threads:
        job = threads.submit(other.run, victims.process_id, cancelled=cancelled)
        other._cluster._look_around(other._cluster._client)
        assert other.capacity("geometry") == other.capacity("analysis") == 0
        assert not other.answers()
        cancelled.set()
        assert isinstance(job.exception(), JobCancelled)
    other.close()


def test_a_large_result_comes_as_it_is_and_a_too_large_one_is_refused(engine, monkeypatch):
    assert engine.run(victims.large, 40 * 2**20) == b"x" * (40 * 2**20)
    assert len(engine.run(victims.same, b"y" * (20 * 2**20))) == 20 * 2**20
    monkeypatch.setattr(wire, "MOST_BYTES", 1000)
    with pytest.raises(RemoteError, match="at most"):
        engine.run(victims.same, b"y" * 1001)


def test_closing_ends_what_runs(network, tmp_path):
    engine = network.engine()
    with ThreadPoolExecutor() as threads:
        job = threads.submit(engine.run, victims.tell_and_sleep, tmp_path / "pid", limits=LONG)
        child = process_in(tmp_path / "pid")
        engine.close()
        assert isinstance(job.exception(), JobCancelled)
    until_gone(child)
