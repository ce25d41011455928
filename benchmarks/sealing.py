"""Cost of sealing the audit: processor time of one unit of work, and of one row in it.

    python -m benchmarks.sealing      a few seconds; prints medians

While the sealer's unit runs, the writer of SQLite serves nobody else: the time of one unit is what a save may
wait for it. Rows of 2 000 changes are recorded, then sealed unit by unit, as the server does each second.
"""

from statistics import median
from tempfile import TemporaryDirectory
from time import thread_time

from sqlalchemy.orm import Session

from app.identity.audit import record
from app.identity.chain import seal
from app.storage.database import Database
from app.storage.migrations import migrate

ROWS = 2000


def main() -> None:
    """Print the time of a unit and of a row."""
    with TemporaryDirectory() as folder:
        migrate(url := f"sqlite:///{folder}/sealing.sqlite")
        database = Database(url)
        try:
            database.write(recorded)
            units = []
            while (unit := database.write(timed))[0]:
                units.append(unit)
        finally:
            database.close()
    unit = 1e3 * median(seconds for _, seconds in units)
    row = 1e6 * median(seconds / rows for rows, seconds in units)
    print(f"{len(units)} units, each {unit:.1f} ms; a row {row:.0f} us")


def recorded(session: Session) -> None:
    """Record changes."""
    for number in range(ROWS):
        record(session, "design.change", f"designs/sealed/revisions/{number}", "0" * 64)


def timed(session: Session) -> tuple[int, float]:
    """Seal in this unit; the number of rows, and the processor time [s]."""
    start = thread_time()
    rows = seal(session)
    session.flush()
    return rows, thread_time() - start


if __name__ == "__main__":
    main()
