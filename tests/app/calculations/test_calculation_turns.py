"""The queue of expensive calculations serves clients in turn, limits admission, and cancels calculations."""

import threading
from concurrent.futures import wait

import pytest
from test_workers import eventually

from app.pool.errors import TooManyCalculations
from app.pool.pool import CalculationPool
from app.workers.base import Limits
from app.workers.errors import JobCancelled

SOON = 5  # s


class Gates:
    """A worker whose calculations end when they are let go, or are cancelled."""

    def __init__(self):
        self.started, self._gates, self._lock = [], {}, threading.Lock()

    def run(self, function, name, *, limits, on_progress, cancelled):
        with self._lock:
            self.started.append(name)
            gate = self._gates.setdefault(name, threading.Event())
        on_progress(0.5, f"{name} runs")
        while not gate.wait(0.01):
            if cancelled.is_set():
                raise JobCancelled
        return function(name)

    def release(self, name):
        assert eventually(lambda: name in self._gates)
        self._gates[name].set()

    def close(self):
        pass


@pytest.fixture
def gates():
    return Gates()


@pytest.fixture
def new_pool(gates):
    pools = []

    def make(size=1, waiting=32):
        pools.append(CalculationPool(gates, size, waiting, Limits(60, 100)))
        return pools[-1]

    yield make
    for pool in pools:
        pool.close()


def submitted(pool, client, *names):
    return [pool.submit(client, str.upper, name) for name in names]


def order(gates, count):
    """The order in which so many calculations start, each let go when it has."""
    for number in range(count):
        assert eventually(lambda: len(gates.started) > number)  # noqa: B023 - called at once
        gates.release(gates.started[number])
    return gates.started


def test_clients_take_turns(new_pool, gates):
    pool = new_pool()
    submitted(pool, "flood", *(f"f{number}" for number in range(5)))
    assert eventually(lambda: gates.started == ["f0"])
    submitted(pool, "newcomer", "n0", "n1")
    submitted(pool, "another", "a0")
    assert order(gates, 8) == ["f0", "n0", "a0", "f1", "n1", "f2", "f3", "f4"]


def test_a_newcomer_starts_next_after_those_that_run(new_pool, gates):
    pool = new_pool(size=2)
    submitted(pool, "flood", *(f"f{number}" for number in range(10)))
    assert eventually(lambda: len(gates.started) == 2)
    submitted(pool, "newcomer", "n0")
    gates.release("f0")
    assert eventually(lambda: len(gates.started) == 3)
    assert gates.started[2] == "n0"


def test_nobody_is_always_passed_over(new_pool, gates):
    """Two clients that come again and again, one at a time, do not starve a third."""
    pool = new_pool()
    submitted(pool, "a", "a0")
    assert eventually(lambda: gates.started == ["a0"])
    submitted(pool, "patient", "p0", "p1")
    submitted(pool, "b", "b0")
    for number in range(1, 8):
        gates.release(gates.started[-1])
        client = "ab"[number % 2]
        submitted(pool, client, f"{client}{number}")
        assert eventually(lambda: len(gates.started) == number + 1)  # noqa: B023
    assert {"p0", "p1"} <= set(gates.started[:7])


def test_results_and_errors_arrive(new_pool, gates):
    pool = new_pool()
    (good,) = submitted(pool, "a", "good")
    bad = pool.submit("a", int, "bad")
    gates.release("good")
    gates.release("bad")
    assert good.future.result(SOON) == "GOOD"
    assert isinstance(bad.future.exception(SOON), ValueError)


def test_progress_that_came_before_is_reported_to_who_listens_later(new_pool, gates):
    (calculation,) = submitted(new_pool(), "a", "one")
    assert eventually(lambda: gates.started)
    heard = []
    assert eventually(lambda: calculation._latest is not None)
    calculation.listen(lambda *message: heard.append(message))
    assert heard == [(0.5, "one runs")]


def test_too_many_are_refused(new_pool, gates):
    pool = new_pool(waiting=2)
    submitted(pool, "flood", "f0")
    assert eventually(lambda: gates.started)
    submitted(pool, "flood", "f1", "f2")
    with pytest.raises(TooManyCalculations, match="Try again in 5 s") as caught:
        submitted(pool, "flood", "f3")
    assert caught.value.retry_after == 5
    assert (pool.running, pool.waiting) == (1, 2)


def test_a_flood_gives_way_to_a_newcomer(new_pool, gates):
    pool = new_pool(waiting=2)
    submitted(pool, "flood", "f0")
    assert eventually(lambda: gates.started)
    _, last = submitted(pool, "flood", "f1", "f2")
    submitted(pool, "newcomer", "n0")
    assert isinstance(last.future.exception(SOON), TooManyCalculations)
    with pytest.raises(TooManyCalculations):
        submitted(pool, "newcomer", "n1")
    assert order(gates, 3) == ["f0", "n0", "f1"]


def test_what_finds_free_processes_does_not_count_as_waiting(new_pool, gates):
    pool = new_pool(size=4, waiting=1)
    assert len(submitted(pool, "a", *map(str, range(5)))) == 5


def test_what_waits_is_cancelled_at_once(new_pool, gates):
    pool = new_pool()
    first, second = submitted(pool, "a", "one", "two")
    assert eventually(lambda: gates.started == ["one"])
    pool.cancel(second)
    assert isinstance(second.future.exception(SOON), JobCancelled)
    gates.release("one")
    assert first.future.result(SOON) == "ONE"
    assert eventually(lambda: pool.running == pool.waiting == 0)
    assert gates.started == ["one"]


def test_what_runs_is_cancelled(new_pool, gates):
    pool = new_pool()
    (calculation,) = submitted(pool, "a", "one")
    assert eventually(lambda: gates.started)
    pool.cancel(calculation)
    assert isinstance(calculation.future.exception(SOON), JobCancelled)


def test_what_became_a_job_frees_its_place(new_pool, gates):
    pool = new_pool()
    first, second = submitted(pool, "a", "one", "two")
    assert eventually(lambda: gates.started == ["one"])
    assert not pool.keep(second)  # it has not begun
    assert pool.keep(first)
    assert eventually(lambda: gates.started == ["one", "two"])
    assert not pool.keep(second)  # the lane of jobs is full
    gates.release("one")
    assert first.future.result(SOON) == "ONE"
    assert pool.keep(second)


def test_jobs_wait_in_a_lane_of_their_own(new_pool, gates):
    pool = new_pool()
    for name in ("job0", "job1"):
        pool.submit("jobs", str.upper, name, lane="jobs")
    submitted(pool, "a", "one")
    assert eventually(lambda: set(gates.started) == {"job0", "one"})
    gates.release("one")
    assert not eventually(lambda: "job1" in gates.started, 0.2)
    gates.release("job0")
    assert eventually(lambda: "job1" in gates.started)


def test_closing_ends_everything(new_pool, gates):
    pool = new_pool()
    calculations = submitted(pool, "a", "one", "two", "three")
    assert eventually(lambda: gates.started)
    pool.close()
    assert not wait([c.future for c in calculations], SOON).not_done
    assert all(isinstance(c.future.exception(), JobCancelled) for c in calculations)
    with pytest.raises(JobCancelled):
        submitted(pool, "a", "four")
    assert not any(thread.is_alive() for thread in pool._threads)


def test_who_would_be_refused_is_refused_before_the_body_comes(new_pool, gates):
    pool = new_pool(waiting=2)
    submitted(pool, "flood", "a")
    assert eventually(lambda: gates.started == ["a"])
    submitted(pool, "flood", "b", "c")
    with pytest.raises(TooManyCalculations):
        pool.admit("flood")
    pool.admit("newcomer")
    assert (pool.running, pool.waiting) == (1, 2)  # nobody has given way yet
