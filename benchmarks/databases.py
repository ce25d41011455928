"""Accepted revisions per second: one embedded server against two servers on one PostgreSQL, in the same run.

`python -m benchmarks.databases [SECONDS] [CLIENTS]` starts the servers as processes of their own on loopback,
a PostgreSQL that syncs every commit, and clients in processes of their own. Every client changes a design of
its own, one parameter at a time, with If-Match and an Idempotency-Key; the design has no models, so that no
job follows, and what is measured is the acceptance: reading, calculating, storing.

Embedded and shared take turns, so that a busy machine disturbs both. Trust the ratios, not the numbers: all
processes share the cores. For each the benchmark says where the time goes: processor time per revision of
servers, database and clients, how much of all cores was in use, statements and syncs of PostgreSQL, and what
its connections waited for.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from statistics import quantiles
from tempfile import TemporaryDirectory

import httpx

from app.team.postgres import Cluster
from app.team.processes import free_port
from benchmarks.postgres_work import Work, frequent, prepare, watched
from benchmarks.processor_time import Cores, used

ROUNDS = 3
PROCESSES = 4  # of clients
EMBEDDED = "embedded (SQLite)"
DATABASE = "team"
API = "/api/v1/designs"
PATIENCE = 300.0  # for a server to start [s]


@dataclass(frozen=True)
class Result:
    """The result of one round."""

    accepted: int
    seconds: float
    delays: tuple[float, ...]  # of each accepted change [s]
    servers: float  # processor time of all servers [s]
    database: float  # of PostgreSQL [s]
    clients: float  # of the clients [s]
    cores: float  # share of all cores in use, by whatever process
    elapsed: float  # with the creation of the designs, which these times and the work include [s]
    work: Work

    @property
    def rate(self) -> float:
        """Accepted revisions per second."""
        return self.accepted / self.seconds

    @property
    def p99(self) -> float:
        """The delay that one change in a hundred exceeds [s]."""
        return quantiles(self.delays, n=100)[98]


@dataclass(frozen=True)
class Serving:
    """A server process, and where it answers."""

    url: str
    pid: int


@contextmanager
def server(data: Path, environment: Mapping[str, str]) -> Iterator[Serving]:
    """A server process, as long as the block runs."""
    port = free_port()
    command = [sys.executable, "-m", "app", "serve", "--port", str(port), "--data", str(data)]
    with data.with_suffix(".log").open("wb") as log:
        process = subprocess.Popen(command, env={**os.environ, **environment}, stdout=log, stderr=log)
    url = f"http://127.0.0.1:{port}"
    try:
        _wait_for(url, process)
        yield Serving(url, process.pid)
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(60)


def _wait_for(url: str, process: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and process.poll() is None:
        try:
            if httpx.get(f"{url}/healthz", trust_env=False).status_code == 200:
                return
        except httpx.TransportError:
            time.sleep(0.1)
    raise RuntimeError("a server did not start")


def change(url: str, name: str, seconds: float) -> list[float]:
    """Change a design of one's own for some time; the delay of each accepted change [s]."""
    delays = []
    with httpx.Client(base_url=url, timeout=60, trust_env=False) as http:
        design = http.post(API, json={"name": name, "parameters": {"a": "0"}}).raise_for_status().json()
        end = time.monotonic() + seconds
        for number in count(1):
            start = time.monotonic()
            if start >= end:
                break
            headers = {"If-Match": f'"{number}"', "Idempotency-Key": f"{name} {number}"}
            patch = {"parameters": {"a": str(number)}}
            http.patch(f"{API}/{design['id']}", json=patch, headers=headers).raise_for_status()
            delays.append(time.monotonic() - start)
    return delays


def clients(urls: list[str], names: list[str], seconds: float) -> tuple[list[float], float]:
    """Several clients in the threads of one process: their delays, and the processor time of them all [s]."""
    from concurrent.futures import ThreadPoolExecutor

    before = time.process_time()
    with ThreadPoolExecutor(len(names)) as pool:
        runs = [pool.submit(change, urls[n % len(urls)], name, seconds) for n, name in enumerate(names)]
        delays = [delay for run in runs for delay in run.result()]
    return delays, time.process_time() - before


def measured(servers: list[Serving], cluster: Cluster, number: int, seconds: float) -> Result:
    """One round with so many clients, shared out to the servers."""
    names = [f"client {time.time_ns()} {n}" for n in range(number)]
    urls = [one.url for one in servers]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(PROCESSES, mp_context=context) as pool:
        list(pool.map(abs, range(PROCESSES)))  # they are there
        parts = [names[n::PROCESSES] for n in range(PROCESSES)]
        before = [used(one.pid) for one in servers], used(cluster.pid), Cores.now()
        start = time.monotonic()
        with watched(cluster.url(DATABASE)) as work:
            rounds = [pool.submit(clients, urls[n % len(urls) :] + urls[: n % len(urls)], part, seconds)
                      for n, part in enumerate(parts)]  # fmt: skip
            ended = [run.result() for run in rounds]
        after = [used(one.pid) for one in servers], used(cluster.pid), Cores.now()
    delays = tuple(delay for part, _ in ended for delay in part)
    return Result(
        len(delays),
        seconds,
        delays,
        servers=sum(after[0]) - sum(before[0]),
        database=after[1] - before[1],
        clients=sum(own for _, own in ended),
        cores=after[2].share_since(before[2]),
        elapsed=time.monotonic() - start,
        work=work,
    )


def show(name: str, result: Result, base: float) -> None:
    """Print the rate of a round, its ratio to the base, and where the processor time went."""
    each = [1e3 * part / result.accepted for part in (result.servers, result.database, result.clients)]
    said = f"{name:18} {result.rate:7.1f}/s  p99 {1e3 * result.p99:5.0f} ms  ratio {result.rate / base:.2f}"
    own = (result.servers + result.database + result.clients) / (result.elapsed * (os.cpu_count() or 1))
    print(f"{said}  {result.cores:.0%} of all cores in use, {own:.0%} by these processes")
    parts = zip(("servers", "PostgreSQL", "clients", "sum"), (*each, sum(each)), strict=True)
    split = ", ".join(f"{what} {time:.2f}" for what, time in parts)
    print(f"{'':18} processor time per revision [ms]: {split}")


def show_work(name: str, result: Result, number: int) -> None:
    """Print what PostgreSQL did for a revision, and where requests were while they had a transaction."""
    work = result.work
    print(
        f"{name:18} per revision {work.statements / result.accepted:.1f} statements, "
        f"{work.syncs / result.accepted:.2f} syncs of {1e3 * work.sync_seconds / max(work.syncs, 1):.2f} ms"
    )
    for what, waiting in sorted(work.waits.items(), key=lambda each: -each[1]):
        print(f"{'':18} {waiting / number:6.1%} of the requests' time: a transaction waits for {what}")


def main(seconds: float, number: int) -> None:
    """Print the rates, their ratios, and where the time goes."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(TemporaryDirectory()))
        cluster = Cluster(is_durable=True)
        stack.callback(cluster.close)
        prepare(cluster)
        team = {
            "CRANKWRIGHT_DATABASE_URL": cluster.create(DATABASE),
            "CRANKWRIGHT_ARTIFACTS_URL": f"file://{folder}/artifacts",
        }
        embedded = [stack.enter_context(server(folder / "embedded", {}))]
        one = stack.enter_context(server(folder / "one", team))
        other = stack.enter_context(server(folder / "other", team))
        settings = {EMBEDDED: embedded, "one, PostgreSQL": [one], "two, PostgreSQL": [one, other]}
        results: dict[str, list[Result]] = {name: [] for name in settings}
        for _ in range(ROUNDS):
            for name, servers in settings.items():
                results[name].append(measured(servers, cluster, number, seconds))
        best = {name: max(rounds, key=lambda result: result.rate) for name, rounds in results.items()}
        print(f"{number} clients, {ROUNDS} rounds of {seconds:g} s each; the best round of each counts")
        for name, result in best.items():
            show(name, result, best[EMBEDDED].rate)
        for name in list(best)[1:]:
            show_work(name, best[name], number)
        accepted = sum(result.accepted for name in list(best)[1:] for result in results[name])
        for calls, query in frequent(cluster.url(DATABASE)):
            if calls > accepted / 10 and "pg_stat" not in query:  # the looks of the benchmark itself
                print(f"{calls / accepted:6.2f} × {query[:140]}")


if __name__ == "__main__":
    given = [*sys.argv[1:3], *("6", "32")[len(sys.argv) - 1 :]]
    main(float(given[0]), int(given[1]))
