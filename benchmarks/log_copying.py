"""Commits of SQLite while its log is copied into the file by the writer itself, or by another thread.

    python -m benchmarks.log_copying      a minute; prints times of commits by the clock, and the longest log

Each commit writes as much as a group of 32 saves. In the first way SQLite copies at a commit, once 1000 pages
have come. In the second a thread with its own connection copies as often, while the writer goes on.
"""

import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from statistics import mean, quantiles
from tempfile import TemporaryDirectory

TURNS, COMMITS, ROWS, BYTES = 3, 250, 32, 7000
BETWEEN = 0.02  # commits [s]
COPIED_AFTER = 11  # commits, about 1 000 pages
_TABLE = """CREATE TABLE saved (number INTEGER PRIMARY KEY, key TEXT, document TEXT);
CREATE INDEX saved_key ON saved (key)"""


def connected(file: Path) -> sqlite3.Connection:
    """A connection that syncs every commit."""
    connection = sqlite3.connect(file, isolation_level=None, check_same_thread=False)
    connection.executescript("PRAGMA journal_mode = wal; PRAGMA synchronous = full")
    return connection


@contextmanager
def copying(file: Path) -> Iterator[threading.Event]:
    """A thread that copies the log whenever the event is set."""
    wanted, stopping = threading.Event(), threading.Event()

    def work() -> None:
        with closing(connected(file)) as connection:
            while wanted.wait() and not stopping.is_set():
                wanted.clear()
                connection.execute("PRAGMA wal_checkpoint(PASSIVE)").fetchall()

    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield wanted
    finally:
        stopping.set()
        wanted.set()
        thread.join()


def commits(file: Path, *, by_thread: bool) -> tuple[list[float], int]:
    """The time of each commit [s], and the longest log [bytes]."""
    taken, longest = list[float](), 0
    with closing(connected(file)) as writer:
        writer.executescript(_TABLE)
        if by_thread:
            writer.execute("PRAGMA wal_autocheckpoint = 0")
        with copying(file) as wanted:
            for number in range(COMMITS):
                start = time.perf_counter()
                writer.execute("BEGIN IMMEDIATE")
                rows = [(f"{number} {row}", "x" * BYTES) for row in range(ROWS)]
                writer.executemany("INSERT INTO saved (key, document) VALUES (?, ?)", rows)
                writer.execute("COMMIT")
                taken.append(time.perf_counter() - start)
                longest = max(longest, file.with_name(f"{file.name}-wal").stat().st_size)
                if by_thread and number % COPIED_AFTER == COPIED_AFTER - 1:
                    wanted.set()
                time.sleep(BETWEEN)
    return taken, longest


def main() -> None:
    """Print both ways, in turns."""
    for turn in range(TURNS):
        for name, by_thread in (("by the writer", False), ("by a thread", True)):
            with TemporaryDirectory() as folder:
                taken, longest = commits(Path(folder) / "log.sqlite", by_thread=by_thread)
            parts = quantiles(taken, n=100)
            times = ", ".join(f"{p} % {1e3 * parts[p - 1]:.1f}" for p in (50, 90, 95, 99))
            about = f"mean {1e3 * mean(taken):.1f}; log {longest / 1e6:.1f} MB"
            print(f"{turn + 1} {name:14} [ms] {times}, {about}")


if __name__ == "__main__":
    main()
