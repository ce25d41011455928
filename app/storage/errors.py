"""Errors of storage.

StorageError
 ├── DataFolderInUse       another process holds the data folder
 ├── DatabaseBeforeRelease the database was written by a program before the first release
 ├── DatabaseNewer         the database was written by a newer program
 ├── DatabaseClosed        a unit of work came after `close`
 ├── CommitFailed          a unit of work ran, but it could not be made durable
 │    └── CommitUnknown    it is unknown whether the unit was made durable
 ├── DatabaseUnavailable   the database server cannot be reached, or refuses work at present
 ├── NotForTeams           the settings do not let several servers share the data
 ├── DatabaseDamaged       pages or rows of the database cannot be read as they were written
 ├── DatabaseLost          the database of a data folder is missing, or is not the one it had
 ├── DiskFull              the disk has no room for an uploaded file
 ├── ArtifactMissing       no artifact has this hash
 ├── ArtifactDamaged       the bytes of an artifact no longer have its hash
 ├── ArtifactsUnreachable  the store of the artifacts does not answer now
 └── StoreRefused          the settings name a store that cannot be used
"""

from collections.abc import Sequence
from pathlib import Path


class StorageError(Exception):
    """Base class of the errors of storage."""


class DataFolderInUse(StorageError):
    """Another process holds the data folder."""

    def __init__(self, folder: Path, owner: str) -> None:
        super().__init__(folder, owner)
        self.folder = folder
        self.owner = owner

    def __str__(self) -> str:
        return (
            f"The data folder {self.folder} is in use by process {self.owner or 'unknown'}. "
            "Stop that server, or set another folder in CRANKWRIGHT_DATA."
        )


class DatabaseBeforeRelease(StorageError):
    """The database has a schema from before the first release, which this program cannot read."""

    def __init__(self, version: str) -> None:
        super().__init__(version)
        self.version = version

    def __str__(self) -> str:
        return (
            f"The database has schema {self.version}, from before the first release, which this program does "
            "not read: start with a new data folder or an empty database."
        )


class DatabaseNewer(StorageError):
    """The database has a schema that this program does not know."""

    def __init__(self, version: str) -> None:
        super().__init__(version)
        self.version = version

    def __str__(self) -> str:
        return (
            f"The database has schema {self.version}, which is newer than this program. Upgrade the program."
        )


class DatabaseClosed(StorageError):
    """A unit of work came after the database was closed."""


class CommitFailed(StorageError):
    """A unit of work could not be committed; nothing of it is stored. `__cause__` is the original error."""


class CommitUnknown(CommitFailed):
    """The connection was lost during the commit, and the unit has no Idempotency-Key to decide."""

    def __str__(self) -> str:
        return (
            "The connection to the database was lost while the change was being stored: it may be stored, or "
            "not. Read what you changed again; with an Idempotency-Key you may send the request again."
        )


class DatabaseUnavailable(StorageError):
    """The database server cannot be reached, or refuses work at present; nothing was stored."""

    retry_after = 5  # s

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason

    def __str__(self) -> str:
        return f"The database is not available: {self.reason}. Nothing was stored; try again."


class NotForTeams(StorageError):
    """The settings do not let several servers share the data."""


class DiskFull(StorageError):
    """The disk has no room for an uploaded file [bytes]."""

    def __init__(self, size: int, room: int) -> None:
        super().__init__(size, room)
        self.size, self.room = size, room

    def __str__(self) -> str:
        return (
            f"The disk of the service has room for {self.room / 2**20:.0f} MiB, and this file needs "
            f"{self.size / 2**20:.0f} MiB. Nothing was stored; ask the operator to free disk space."
        )


class DatabaseDamaged(StorageError):
    """Pages or rows of the database cannot be read as they were written."""

    def __init__(self, database: str, faults: Sequence[str]) -> None:
        super().__init__(database, faults)
        self.database = database
        self.faults = tuple(faults)

    def __str__(self) -> str:
        return (
            f"The database {self.database} is damaged: {'; '.join(self.faults)}. Nothing is written to it. "
            "Stop the service, keep a copy of the data folder, then restore the last backup with "
            "`crankwright restore FILE --data NEW_FOLDER`, or save what is readable with "
            "`sqlite3 crankwright.sqlite .recover | sqlite3 recovered.sqlite`."
        )


class DatabaseLost(StorageError):
    """The database of a data folder is missing, is another one, or lacks what it contained."""

    def __init__(self, file: Path, fault: str, is_gone: bool = False) -> None:
        super().__init__(file, fault, is_gone)
        self.file, self.fault, self.is_gone = file, fault, is_gone

    def __str__(self) -> str:
        wish = "start with a new, empty database" if self.is_gone else "accept the database as it is"
        return (
            f"{self.file.parent} does not contain its database: {self.fault}. Nothing was changed. Keep a "
            "copy of the folder. Restore the last backup with `crankwright restore FILE --data NEW_FOLDER`; "
            f"or, to {wish}, run `crankwright accept --data {self.file.parent}`."
        )


class NotFound(StorageError):
    """There is no row with this name or number, such as a design, a revision or a build."""


class KeyReused(StorageError):
    """An Idempotency-Key was used again for another request."""

    def __init__(self, key: str) -> None:
        super().__init__(f"the Idempotency-Key {key[:80]!r} was used for a different request; use a new one")


class ArtifactMissing(StorageError):
    """No artifact has this hash."""

    def __init__(self, sha: str) -> None:
        super().__init__(sha)
        self.sha = sha

    def __str__(self) -> str:
        return f"There is no artifact {self.sha}."


class ArtifactDamaged(StorageError):
    """The bytes of an artifact no longer have its hash; the file has been set aside."""

    def __init__(self, sha: str, reason: str) -> None:
        super().__init__(sha, reason)
        self.sha = sha
        self.reason = reason

    def __str__(self) -> str:
        return f"Artifact {self.sha} is damaged: {self.reason}. The file has been set aside."


class ArtifactsUnreachable(StorageError):
    """The store of the artifacts does not answer, so it is unknown whether a file exists.

    A client may try again after `retry_after` [s].
    """

    retry_after = 2

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason

    def __str__(self) -> str:
        return f"The file store cannot be used now: {self.reason}. Try again in {self.retry_after} s."


class StoreRefused(StorageError):
    """The settings name a store of artifacts that cannot be used; the text says what to change."""


class CannotRebuild(Exception):
    """A damaged or missing file cannot be made again with its hash; the response links to what exists.

    Its code is one of:

    other_recipe    another kernel or recipe made it: this program makes another build of the same row
    model_changed   the model's file makes other bytes now, or refuses the parameters
    model_gone      the model is no longer in the catalogue
    other_bytes     it was rebuilt, and is another artifact now
    answer_lost     the request that it answers is lost as well
    """

    def __init__(self, code: str, detail: str, links: dict[str, str] | None = None) -> None:
        super().__init__(code, detail, links)
        self.code = code
        self.detail = detail
        self.links = links or {}

    def __str__(self) -> str:
        return self.detail
