"""Ownership of a file store by one database: another database's sweep would delete unknown files.

A database that several servers or a bucket use has an identity; the store contains it under the name `OWNER`.
"""

from __future__ import annotations

from app.settings import Settings
from app.storage.artifacts import OWNER, Artifacts
from app.storage.connection import opened_database
from app.storage.database import Database
from app.storage.errors import StoreRefused
from app.storage.folder import DataFolder
from app.storage.record import identity
from app.storage.stores import opened_store


def claim(database: Database, store: Artifacts) -> None:
    """Claim a store for a database if it belongs to none.

    Raises
    ------
    StoreRefused
        If it belongs to another database.
    ArtifactsUnreachable
        If it does not answer.
    """
    own = database.write(identity)
    if (owner := store.claim(own)) != own:
        raise StoreRefused(
            f"CRANKWRIGHT_ARTIFACTS_URL: these files belong to another database ({owner[:40]}; this one is "
            f"{own}). Each would delete the other's files. Name another bucket, prefix or folder. If that "
            f"database no longer exists, delete `{OWNER}` there; the files then belong to this one."
        )


def require_own_store(settings: Settings, folder: DataFolder) -> None:
    """Check that the store of the settings answers and belongs to their database, which is migrated first.

    Raises
    ------
    StorageError
        If either cannot be used, or the store belongs to another database; the text names the remedy.
    """
    store = opened_store(settings, folder)
    database = opened_database(settings, folder, lambda units, seconds, failed: None)
    try:
        claim(database, store)
    finally:
        database.close()
