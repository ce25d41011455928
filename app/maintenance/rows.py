"""Find the files that database rows name, and rows with broken references, by SQL on a snapshot."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class NamedFile:
    """A file that a row names: of a build, an analysis, a calculation, a study, or an imported worksheet."""

    sha: str
    size: int | None  # bytes; None if the row does not state it
    owner: str  # the key of the build or the analysis, or the id of the job, the study or the worksheet
    kind: str  # step, png, …; or surface, body, answer, rows, import, model


class Rows(Protocol):
    """The interface to the rows of a database."""

    def execute(self, query: str, /) -> Iterable[tuple[str, ...]]:
        """Return the rows of a query without parameters; most values are texts."""
        ...


def named_files(connection: Rows) -> Iterator[NamedFile]:
    """Yield every file that a row names, once for each row that names it."""
    for sha, size, key, kind in connection.execute("SELECT sha256, size, build_key, kind FROM artifact"):
        yield NamedFile(sha, int(size), key, kind)
    if _has_table(connection, "analysis"):
        surfaces = "SELECT key, found FROM analysis WHERE output = 'surface'"
        for key, output in connection.execute(surfaces):
            surface = json.loads(output)
            yield NamedFile(surface["sha256"], surface["size"], key, "surface")
    for id, payload, result in connection.execute("SELECT id, payload, result FROM job"):
        yield from _files_of_question(id, json.loads(payload), result)
    if _has_table(connection, "study"):
        for id, sha in connection.execute(STUDIES):
            yield NamedFile(sha, None, id, "rows")
    yield from _files_that_were_sent(connection)


def _files_that_were_sent(connection: Rows) -> Iterator[NamedFile]:
    for table, query, kind in SENT:
        if _has_table(connection, table):
            yield from (NamedFile(sha, None, id, kind) for id, sha in connection.execute(query))


STUDIES = """
    SELECT id, table_sha256 FROM study WHERE table_sha256 IS NOT NULL
    UNION ALL SELECT study_id, sha256 FROM study_chunk"""


IMPORTED_MODELS = """
    SELECT id, file_sha256 FROM imported_model UNION SELECT id, sent_sha256 FROM imported_model"""

IMPORTED_WORKSHEETS = "SELECT id, import_sha256 FROM worksheet_version WHERE import_sha256 IS NOT NULL"

SENT = (("worksheet_version", IMPORTED_WORKSHEETS, "import"), ("imported_model", IMPORTED_MODELS, "model"))
"""Files that users sent: the table that names them, its query, and their kind."""


def _files_of_question(id: str, payload: dict[str, str], result: str | None) -> Iterator[NamedFile]:
    """Yield the request and the answer of a job, for every kind of job that stores them as files."""
    if "body" not in payload:
        return
    yield NamedFile(payload["body"], None, id, "body")
    if result is not None:
        yield NamedFile(result.rpartition("sha256=")[2], None, id, "answer")


LEADING_NOWHERE = {
    "job {} belongs to a revision that does not exist": """
        SELECT job.id FROM job LEFT JOIN revision
        ON revision.design_id = job.design_id AND revision.number = job.revision
        WHERE job.design_id IS NOT NULL AND job.revision IS NOT NULL AND revision.number IS NULL""",
    "design {} lacks the revision that it names as its newest": """
        SELECT design.id FROM design LEFT JOIN revision
        ON revision.design_id = design.id AND revision.number = design.head
        WHERE revision.number IS NULL""",
    "revision {} belongs to a design that does not exist": """
        SELECT revision.design_id || '/' || revision.number FROM revision LEFT JOIN design
        ON design.id = revision.design_id WHERE design.id IS NULL""",
    "revision {} is current, and the build of its model is not recorded": """
        SELECT m.design_id || '/' || m.number || ' ' || m.name FROM revision_model AS m
        JOIN revision ON revision.design_id = m.design_id AND revision.number = m.number
        LEFT JOIN build ON build.key = m.build_key
        WHERE revision.state = 'current' AND m.build_key IS NOT NULL AND build.key IS NULL""",
    "build {} has no STEP file recorded": """
        SELECT build.key FROM build LEFT JOIN artifact
        ON artifact.build_key = build.key AND artifact.kind = 'step' WHERE artifact.kind IS NULL""",
}
"""Messages about rows that refer to missing objects, each with the query that finds these rows."""


RELEASES = """
    SELECT id, number, text, withdrawn, digest, record FROM worksheet_version
    WHERE state IN ('released', 'withdrawn') ORDER BY id, number"""


def broken_worksheets(connection: sqlite3.Connection) -> Iterator[str]:
    """Yield a sentence for each released worksheet whose text or results differ from its release."""
    from app.pool.sources import SheetSource  # imports templates, which other checks do not need
    from app.worksheets.examination import as_released

    if not _has_table(connection, "worksheet_version"):
        return
    for id, number, text, withdrawn, digest, record in connection.execute(RELEASES):
        golden = json.loads(record) if record else None
        released = as_released(SheetSource(id, number, text, withdrawn), digest, golden)
        if isinstance(released, str):
            yield f"{id} version {number} is broken: {released}"


def broken_references(connection: sqlite3.Connection) -> Iterator[str]:
    """Yield a sentence for each row that refers to a missing row."""
    for table, row, parent, _ in connection.execute("PRAGMA foreign_key_check"):
        yield f"row {row} of table {table} refers to a row of {parent} that does not exist"
    for sentence, query in LEADING_NOWHERE.items():
        for (name,) in connection.execute(query):
            yield sentence.format(name)


def _has_table(connection: Rows, name: str) -> bool:
    """Return whether a database has a table; an old SQLite database may lack some."""
    if not isinstance(connection, sqlite3.Connection):
        return True
    query = "SELECT 1 FROM sqlite_schema WHERE type = 'table' AND name = ?"
    return connection.execute(query, (name,)).fetchone() is not None
