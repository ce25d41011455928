"""`kill -9` of every part of a team at random moments: what was accepted is there once, and whole.

Two servers, PostgreSQL, an S3 server, Dask's scheduler and two workers. Writers send each change to either
server, and repeat it under the same Idempotency-Key until it is accepted. A supervisor starts what has
ended, as systemd does. In the end every accepted change is one revision, every job has ended, every file
has its hash, and nothing is left of any process.

`CRANKWRIGHT_TEST_TEAM_KILLS` says how many kills, 15 if not set; the seed is printed with a failure.
"""

import os
import random
import secrets
import signal
import sys
import time

import httpx
import pytest
from chaos import (
    LATER,
    MARK,
    Hanging,
    Supervisor,
    accepted,
    every_file_has_its_hash,
    every_job_has_ended,
    nothing_is_marked,
    settings,
)
from patience import patient, until
from seeds import SEED
from serving import PATIENCE, alive
from writers import Writer, each_accepted_change_is_one_revision, peace

from app.team.errors import Missing
from app.team.parts import running

KILLS = int(os.environ.get("CRANKWRIGHT_TEST_TEAM_KILLS", "15"))
WRITERS = 4
PAUSE = 2.0  # at most, between two changes of a writer: in the end each change is looked at [s]


@pytest.fixture
def mark(monkeypatch):
    """What all processes of the battle inherit."""
    mark = secrets.token_hex(8)
    monkeypatch.setenv(MARK, mark)
    return mark


@pytest.fixture
def team(mark, tmp_path):
    """All parts, which live."""
    try:
        with running(tmp_path, lambda text: None, settings(tmp_path)) as team:
            yield team
    except Missing as missing:
        pytest.skip(str(missing))
    nothing_is_marked(mark)


@pytest.mark.slow
@pytest.mark.timeout(patient(900 + 30 * KILLS))
def test_parts_of_a_team_are_killed_at_random_moments(team, tmp_path):
    parts = [team.database, team.scheduler, *team.workers, *team.servers]
    hanging = Hanging(team.store, signal.SIGSTOP, signal.SIGCONT, 2.0)
    supervisor = Supervisor(parts)
    urls = [server.url for server in team.servers]
    writers = [Writer(urls, number, LATER, PAUSE) for number in range(WRITERS)]
    try:
        for thread in (supervisor, *writers):
            thread.start()
        family = killed(supervisor, [*parts, hanging], random.Random(SEED))
        for server in team.servers:
            until(lambda server=server: readiness(server), lambda said: said == "ready", seconds=60)
        before = accepted(writers)
        until(lambda: accepted(writers) >= before + 20 or any(one.failure for one in writers), seconds=120)
        peace(writers)
        for server in team.servers:
            with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
                each_accepted_change_is_one_revision(http, writers[0])
        with httpx.Client(base_url=team.servers[0].url, timeout=PATIENCE, trust_env=False) as http:
            for writer in writers[1:]:
                each_accepted_change_is_one_revision(http, writer)
        every_job_has_ended(team.url)
        every_file_has_its_hash(team, tmp_path)
        nothing_lives(family)
    finally:
        for writer in writers:
            writer.enough.set()
        supervisor.end()
    assert accepted(writers) > KILLS, "too few to mean anything"
    assert sum(writer.unanswered for writer in writers), "no kill met a change"
    sys.stdout.write(f"seed {SEED}: {KILLS} kills, {accepted(writers)} changes, {supervisor.starts} starts\n")


def killed(supervisor, victims, chance) -> set[int]:
    """Kill parts at random moments, and return the processes that descended from them."""
    family: set[int] = set()
    for _ in range(KILLS):
        time.sleep(chance.uniform(0.2, 6.0))  # a moment by chance; nothing waits for it
        family |= supervisor.kill(chance.choice(victims))
    return family


def readiness(server) -> str:
    """`ready`, or what the server or the connection to it says instead."""
    try:
        answer = httpx.get(f"{server.url}/readyz", timeout=10, trust_env=False)
    except httpx.TransportError as error:
        return repr(error)
    return "ready" if answer.status_code == 200 else f"{server.name}: {answer.text}"


def nothing_lives(family: set[int]) -> None:
    until(lambda: {pid for pid in family if alive(pid)}, lambda left: left == set(), seconds=20)
