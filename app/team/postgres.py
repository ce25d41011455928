"""A temporary PostgreSQL on loopback, for trials and tests only.

PostgreSQL refuses to run as root. If root starts this module, PostgreSQL runs as `nobody`, who then owns its
folder.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from tempfile import mkdtemp

from app.storage.postgres_programs import postgres_program
from app.team.errors import DidNotStart, Missing
from app.team.processes import LOOPBACK, START, ChildProgram, free_port

USER = "crankwright"
MISSING = "PostgreSQL is not installed: apt-get install postgresql"
NO_DRIVER = "the driver of PostgreSQL is not installed: pip install 'crankwright[team]'"
_NOBODY = "nobody" if os.geteuid() == 0 else None
_PAUSE = 0.2  # between two attempts to start [s]


class Cluster:
    """A database server on its own port; `close` removes it with all its data.

    Parameters
    ----------
    is_durable
        Whether commits are synced to the disk; if not, they survive the end of the server, but not of the
        machine.

    Raises
    ------
    Missing
        If PostgreSQL or its driver is not installed.
    """

    def __init__(self, *, is_durable: bool = False) -> None:
        self._postgres, initdb = _required("postgres"), _required("initdb")
        _require_driver()
        self.port = free_port()
        self.folder = Path(mkdtemp(prefix="crankwright-postgres-"))
        self._process: ChildProgram | None = None
        self._options = ["fsync=on" if is_durable else "fsync=off", f"listen_addresses={LOOPBACK}"]
        self._options += ["unix_socket_directories=", "max_connections=200", "shared_buffers=64MB"]
        if _NOBODY:
            shutil.chown(self.folder, _NOBODY)
        try:
            self._make(initdb)
            self.start()
        except BaseException:
            self.close()
            raise

    @property
    def pid(self) -> int:
        """Return the id of the server's first process; 0 if it is not running."""
        return self._process.pid if self._process else 0

    @property
    def lives(self) -> bool:
        """Return whether the server's first process is still running."""
        return self._process is not None and self._process.lives

    def url(self, database: str = "postgres") -> str:
        """Return the SQLAlchemy URL of a database."""
        return f"postgresql+psycopg://{USER}@{LOOPBACK}:{self.port}/{database}"

    def create(self, database: str, template: str = "template1") -> str:
        """Create a database as a copy of another one without connections, and return its URL."""
        self.execute(f'CREATE DATABASE "{database}" TEMPLATE "{template}"')
        return self.url(database)

    def drop(self, database: str) -> None:
        """Delete a database, and end the connections to it."""
        self.execute(f'DROP DATABASE IF EXISTS "{database}" WITH (FORCE)')

    def execute(self, statement: str) -> None:
        """Execute a statement outside any transaction."""
        import psycopg

        with psycopg.connect(self._connection, autocommit=True) as connection:
            connection.execute(statement.encode())

    def start(self) -> None:
        """Start the server, and wait until it accepts connections.

        After a crash the start is retried, because the server refuses to start while one of its old
        processes is alive.
        """
        end = time.monotonic() + START
        while True:
            try:
                self._start()
            except DidNotStart:
                if time.monotonic() > end:
                    raise
                time.sleep(_PAUSE)
            else:
                return

    def _start(self) -> None:
        options = [argument for option in self._options for argument in ("-c", option)]
        command = [str(self._postgres), "-D", str(self.folder / "data"), "-p", str(self.port), *options]
        self._process = ChildProgram("PostgreSQL", command, self.folder / "log", user=_NOBODY)
        self._process.until(self._answers)

    def stop(self) -> None:
        """Shut the server down at once, in order."""
        if self._process:
            self._process.stop(signal.SIGINT)
            self._process = None

    def kill(self) -> None:
        """Kill the server's first process by `kill -9`; the other processes notice it and end."""
        if self._process:
            self._process.kill()
            self._process.stop()
            self._process = None

    def close(self) -> None:
        """Stop the server and remove its folder."""
        try:
            self.stop()
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

    @property
    def _connection(self) -> str:
        return f"host={LOOPBACK} port={self.port} user={USER} dbname=postgres connect_timeout=5"

    def _make(self, initdb: Path) -> None:
        command = [str(initdb), "-D", str(self.folder / "data"), "-U", USER, "-A", "trust", "-E", "UTF8"]
        locale = ["--locale=C.UTF-8", "--no-sync"]  # in locale C only A to Z have upper and lower case
        done = subprocess.run(
            [*command, *locale], cwd=self.folder, user=_NOBODY, capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise DidNotStart(f"initdb of PostgreSQL failed: {done.stderr.strip()}")

    def _answers(self) -> bool:
        import psycopg

        with suppress(psycopg.OperationalError):
            self.execute("SELECT 1")
            return True
        return False


def _required(name: str) -> Path:
    program = postgres_program(name)
    if program is None:
        raise Missing(MISSING)
    return program


def _require_driver() -> None:
    try:
        import psycopg  # noqa: F401
    except ImportError:
        raise Missing(NO_DRIVER) from None
