"""SIGTERM ends the server whatever hangs; accepted jobs stay in the queue; a second signal ends at once."""

import os
import re
import signal
import socket
import sqlite3
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import httpx
import pytest
from serving import (
    API,
    PATIENCE,
    ServerProcess,
    alive,
    descendants,
    folder_of_models,
    heard,
    moody,
    problem,
)

from app.calculations.bodies import OIL_FILM
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance

DESIGNS = f"{API}/designs"
CPU = re.compile("(process_cpu_seconds_total|crankwright_children_cpu_seconds) ")
EVALUATE = f"{API}/templates/oil_film/versions/2/evaluate"
CYCLE = f"{API}/templates/cycle_heat_balance/versions/1/evaluate"
MARCHED = {"inputs": CycleHeatBalance.example, "level": "supplied"}  # takes longer than a server drains


def until(condition, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while not (answer := condition()):
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)
    return answer


class Stopping(ServerProcess):
    """A server that is asked to stop while something hangs."""

    def __init__(self, tmp_path, drain: float = 3) -> None:
        folders = f'["{folder_of_models(tmp_path)}"]'
        super().__init__(
            tmp_path / "data",
            CRANKWRIGHT_TEMPLATE_FOLDERS=folders,
            CRANKWRIGHT_DRAIN_SECONDS=str(drain),
            CRANKWRIGHT_LOG_LEVEL="info",
        )

    def __exit__(self, *exception) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def stop(self) -> int:
        """Ask it to stop; its exit code, when all its processes have ended."""
        family = descendants(self.process.pid)
        code = super().stop()
        until(lambda: not any(alive(pid) for pid in family))
        return code

    def job(self, link: str) -> dict:
        return httpx.get(f"{self.url}{link}", timeout=30, trust_env=False).json()

    def running_job(self) -> str:
        """A job that never ends by itself, and its link."""
        answer = httpx.post(
            f"{self.url}{DESIGNS}",
            json=moody(mood="loops"),
            headers={"Prefer": "respond-async"},
            timeout=30,
            trust_env=False,
        )
        link = answer.headers["location"]
        until(lambda: self.job(link)["state"] == "running")
        return link

    def states(self) -> list[str]:
        """The states of all jobs, from the database of a server that has ended."""
        with sqlite3.connect(self.data / "crankwright.sqlite") as database:
            return [state for (state,) in database.execute("SELECT state FROM job")]


@pytest.fixture
def server(tmp_path):
    with Stopping(tmp_path) as server:
        yield server


@pytest.fixture
def soon(tmp_path):
    """A server that gives what hangs half a second."""
    with Stopping(tmp_path, drain=0.5) as server:
        yield server


@pytest.mark.slow
def test_a_hung_job_goes_back_into_the_queue(server):
    server.running_job()
    for pid in descendants(server.process.pid):  # now they ignore every signal but one
        os.kill(pid, signal.SIGSTOP)
    assert server.stop() == 0
    assert server.states() == ["queued"]


def forkserver_of(server, module: str) -> int:
    """The process from which those are forked for which this module is loaded first."""

    def named() -> list[int]:
        return [
            pid
            for pid in descendants(server.process.pid)
            if (Path("/proc") / str(pid) / "comm").read_text().strip() == module[:15]
        ]

    return min(until(named))  # it was there before those which it forks


@pytest.mark.slow
def test_a_stopped_forkserver_and_a_job_that_waits_for_it(server):
    os.kill(forkserver_of(server, "cad.regenerate"), signal.SIGSTOP)
    server.running_job()
    assert server.stop() == 0
    assert server.states() == ["queued"]


@pytest.mark.slow
def test_a_long_calculation_is_cut(server):
    with ThreadPoolExecutor(1) as pool:
        calculation = pool.submit(
            httpx.post, f"{server.url}{CYCLE}", json=MARCHED, timeout=PATIENCE, trust_env=False
        )
        until(lambda: calculates(server) or calculation.done())
        assert not calculation.done(), calculation.result().text[:500]
        assert server.stop() == 0
        answer = calculation.result()
    refusal = problem(answer, 503, "stopping")
    assert int(answer.headers["Retry-After"]) > 0
    assert answer.headers["X-Request-ID"] == refusal["request_id"]
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert "Traceback" not in server.log.read_text()


def figures(server) -> str:
    return httpx.get(f"{server.url}/metrics", timeout=30, trust_env=False).text


def calculates(server, seconds: float = 0.5) -> bool:
    """Whether a request is in flight beside this one, on which the processors have worked for so long [s]."""
    text = figures(server)
    used = sum(float(line.split()[-1]) for line in text.splitlines() if CPU.match(line))
    server.idle = min(getattr(server, "idle", used), used)
    return "crankwright_requests_in_flight 2.0" in text and used > server.idle + seconds


@pytest.mark.parametrize(
    "stopped",
    [pytest.param(one, marks=pytest.mark.slow) for one in ("fork server", "its children", "all")],
)
def test_calculations_of_stopped_processes_are_cut(server, stopped):
    """Some are calculated and some wait for a process, all of which ignore every signal but one."""
    ask = partial(httpx.post, timeout=PATIENCE, trust_env=False)
    mass_conserving = {"inputs": OIL_FILM, "level": "mass_conserving"}
    first = ask(f"{server.url}{EVALUATE}", json=mass_conserving)  # now there are processes
    assert first.status_code == 200, first.text
    forkserver = forkserver_of(server, "app.calculations.warm")
    if stopped == "fork server":
        until(lambda: len(descendants(forkserver)) > 0)
        os.kill(forkserver, signal.SIGSTOP)
    with ThreadPoolExecutor(4) as pool:
        answers = [pool.submit(ask, f"{server.url}{CYCLE}", json=MARCHED) for _ in range(4)]
        until(lambda: "crankwright_requests_in_flight 5.0" in figures(server))
        if stopped != "fork server":
            until(lambda: len(descendants(forkserver)) > 0)
            for pid in {*descendants(forkserver), *([forkserver] if stopped == "all" else [])}:
                os.kill(pid, signal.SIGSTOP)
        assert server.stop() == 0
        for answer in answers:
            problem(answer.result(), 503, "stopping")


@pytest.mark.slow
def test_streams_end_and_slow_downloads_are_cut(server):
    with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
        design = http.post(DESIGNS, json={"name": "x", "parameters": {"a": "1"}}).json()["id"]
        with http.stream("GET", f"{DESIGNS}/{design}/events") as stream, socket.socket() as download:
            events = heard(stream)
            next(events)
            download.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            download.connect(("127.0.0.1", server.port))
            request = b"GET /openapi.json HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
            download.sendall(request * 20)  # answers of megabytes in all, of which none is read
            until(lambda: download.recv(1, socket.MSG_PEEK))
            assert server.stop() == 0
            assert list(events) == [], "the stream has ended, and not by a broken connection"


def test_a_request_that_waits_for_a_job_is_answered(server):
    answers = []
    url, document = f"{server.url}{DESIGNS}", moody(mood="loops")
    headers = {"Prefer": "wait=60"}

    def ask():
        answers.append(httpx.post(url, json=document, headers=headers, timeout=90, trust_env=False))

    thread = threading.Thread(target=ask)
    thread.start()
    until(lambda: [job["state"] for job in server.job(f"{API}/jobs")["items"]] == ["running"])
    assert server.stop() == 0
    thread.join(PATIENCE)
    assert answers[0].status_code in (201, 202)
    assert answers[0].json()["state"] == "regenerating"


def test_what_hangs_beyond_the_time_is_ended_hard(soon):
    """A transaction that waits for another program's lock cannot be hurried."""
    server = soon
    with sqlite3.connect(server.data / "crankwright.sqlite", isolation_level=None) as other:
        other.execute("BEGIN IMMEDIATE")
        with ThreadPoolExecutor(1) as pool:
            post = pool.submit(
                httpx.post, f"{server.url}{DESIGNS}", json={"name": "x"}, timeout=PATIENCE, trust_env=False
            )
            until(lambda: "crankwright_requests_in_flight 2.0" in figures(server))
            assert server.stop() == 1
            assert post.exception() or post.result().status_code >= 500
    log = server.log.read_text()
    assert "did not stop in time, ended hard" in log
    assert "still ran: thread database-writer" in log


@pytest.mark.slow
def test_a_second_signal_ends_at_once(tmp_path):
    with Stopping(tmp_path, drain=3600) as server:
        server.running_job()
        family = descendants(server.process.pid)
        with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
            body = {"inputs": {**OIL_FILM, "speed": {"value": [3e3] * 20_000, "unit": "rpm"}}}
            with socket.create_connection(("127.0.0.1", server.port)) as half:
                head = f"POST {EVALUATE} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                half.sendall(f"{head}Content-Length: 100000\r\n\r\n{str(body)[:100]}".encode())
                assert http.get("/healthz").is_success  # so the half request has come in
                server.process.send_signal(signal.SIGTERM)
                until(lambda: "stopping:" in server.log.read_text())
                server.process.send_signal(signal.SIGTERM)
                assert server.process.wait(PATIENCE) == 1
        until(lambda: not any(alive(pid) for pid in family))
        assert "ended at once by a second signal" in server.log.read_text()


SIGNALS = """
import signal, sys, time
from itertools import count
import uvicorn
from app.http.server import Server

server, counted = Server(uvicorn.Config(None), 5.0, lambda: None), count()

def come(number, frame):
    if next(counted) < 9:
        server.handle_exit(number, frame)

signal.signal(signal.SIGALRM, come)
signal.setitimer(signal.ITIMER_REAL, 0.01, float(sys.argv[1]))
while True:
    time.sleep(0.01)
"""


@pytest.mark.slow
@pytest.mark.parametrize("interval", ["1e-5", "2e-5", "3e-5", "5e-5"])
def test_signals_that_meet_in_the_handler_end_the_server(interval):
    """One signal interrupts the handler of another, wherever that is: a lock in it hung one run in three."""
    command = [sys.executable, "-c", SIGNALS, interval]
    done = subprocess.run(command, stderr=subprocess.DEVNULL, timeout=PATIENCE)
    assert done.returncode == 1  # by the second signal, at once
