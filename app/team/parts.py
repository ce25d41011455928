"""Start all parts of a team on loopback: PostgreSQL, an S3 server, Dask with workers, two servers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from app.storage.postgres_programs import postgres_program
from app.team import object_store, postgres
from app.team.commands import Command, Scheduler, Server
from app.team.errors import Missing
from app.team.object_store import AWS, ObjectStore
from app.team.postgres import Cluster

BUCKET = "crankwright-trial"
DATABASE = "crankwright"
LANES = '{"geometry": 1, "analysis": 1}'
EXTRA = {"psycopg": "the driver of PostgreSQL", "obstore": "the client of S3", "distributed": "Dask"}
"""Modules of the extra `team`."""

Say = Callable[[str], object]


@dataclass(frozen=True)
class Team:
    """The running parts; `environment` has the settings that the servers share."""

    database: Cluster
    store: ObjectStore
    scheduler: Scheduler
    workers: tuple[Command, ...]
    servers: tuple[Server, ...]
    environment: dict[str, str]

    @property
    def url(self) -> str:
        """Return the URL of the team's database."""
        return self.environment["CRANKWRIGHT_DATABASE_URL"]


def missing() -> list[str]:
    """Return a sentence for each part that is not installed, with the command that installs it."""
    lacking = [] if postgres_program("initdb") else [postgres.MISSING]
    if absent := [what for module, what in EXTRA.items() if find_spec(module) is None]:
        lacking.append(f"{', '.join(absent)}: pip install 'crankwright[team]'")
    return lacking if object_store.is_installed() else [*lacking, object_store.MISSING]


@contextmanager
def running(
    folder: Path, say: Say, settings: dict[str, str] | None = None, workers: int = 2
) -> Iterator[Team]:
    """Start all parts, and end them in reverse order; `folder` has their logs and files.

    Raises
    ------
    Missing
        If parts are not installed; the text names all of them.
    DidNotStart
        If a part has ended, or does not answer in time.
    """
    if lacking := missing():
        raise Missing("\n".join(lacking))
    with ExitStack() as stack:
        database = Cluster()
        stack.callback(database.close)
        say(f"PostgreSQL on port {database.port}, as a separate server for this trial")
        store = ObjectStore(folder)
        stack.callback(store.close)
        say(f"S3 server on port {store.port}: moto, which keeps files only in memory")
        environment = {
            "DASK_TEMPORARY_DIRECTORY": str(folder),  # where Dask keeps its lock files
            **AWS,
            "CRANKWRIGHT_DATABASE_URL": database.create(DATABASE),
            "CRANKWRIGHT_ARTIFACTS_URL": store.create(BUCKET),
            "CRANKWRIGHT_S3_ENDPOINT": store.endpoint,
            "CRANKWRIGHT_STAMP_KEYS": str(folder / "stamp-keys"),
            **(settings or {}),
        }
        scheduler = Scheduler(folder, environment)
        environment["CRANKWRIGHT_ENGINE"] = scheduler.address
        work = ["worker", "--scheduler", scheduler.address, "--lanes", LANES]
        hands = tuple(Command(f"worker {n}", work, folder, environment) for n in range(1, workers + 1))
        servers = tuple(Server(name, folder, environment) for name in ("A", "B"))
        for part in (scheduler, *hands, *servers):
            stack.callback(part.stop)
            part.start()
        scheduler.ready()
        say(f"Dask's scheduler at {scheduler.address} with {workers} workers")
        for server in servers:
            server.ready((scheduler, *hands))
            say(f"{server.name} at {server.url}")
        yield Team(database, store, scheduler, hands, servers, environment)
