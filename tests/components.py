"""External components for tests of the team mode: PostgreSQL and S3, started once per pytest worker.

`tests/conftest.py` offers these fixtures to all folders of tests. A test skips, with the reason, where a
component is not installed.
"""

import atexit
import itertools
import os
import shutil
import tempfile
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import pytest

MIGRATED = "migrated"  # the database that others are copies of

ON_POSTGRESQL = os.environ.get("CRANKWRIGHT_TEST_DATABASE") == "postgresql"
"""Whether tests that are about no kind of database run on PostgreSQL; see tests/team/lanes.py."""

_numbers = itertools.count(1)


@dataclass(frozen=True)
class Bucket:
    """A fresh bucket of the S3 server."""

    endpoint: str
    name: str
    environment: dict = field(repr=False)

    @property
    def url(self):
        return f"s3://{self.name}"

    @property
    def settings(self):
        """Arguments of `Settings`."""
        return {"artifacts_url": self.url, "s3_endpoint": self.endpoint}


@cache
def running_cluster():
    """One PostgreSQL of this process, with a database to be copied; it ends with the process."""
    from app.storage.migrations import migrate
    from app.team.errors import Missing
    from app.team.postgres import Cluster

    try:
        cluster = Cluster()
    except Missing as missing:
        pytest.skip(str(missing))
    atexit.register(cluster.close)
    migrate(cluster.create(MIGRATED))
    return cluster


@cache
def migrated_file():
    """A migrated and empty SQLite file, to be copied: a migration takes longer than most tests."""
    from app.storage.migrations import migrate

    folder = tempfile.mkdtemp(prefix="crankwright-tests-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    migrate(f"sqlite:///{folder}/migrated.sqlite")
    (file,) = Path(folder).iterdir()  # nothing is left in a journal beside it
    return file


@cache
def database_of(folder):
    """The URL of the one database that belongs to a data folder, as a SQLite file would lie in it."""
    return running_cluster().create(f"test_{next(_numbers)}", MIGRATED)


def shared(folder):
    """Environment of a server with this data folder and a database on PostgreSQL; leases are short."""
    folder.mkdir(parents=True, exist_ok=True)
    return {
        "CRANKWRIGHT_DATABASE_URL": database_of(folder),
        "CRANKWRIGHT_ARTIFACTS_URL": f"file://{folder}/artifacts",
        "CRANKWRIGHT_LEASE_SECONDS": "3",
        "CRANKWRIGHT_BEAT_SECONDS": "0.5",
        "CRANKWRIGHT_POLL_SECONDS": "0.5",
    }


@pytest.fixture(scope="session")
def cluster():
    """One PostgreSQL (`app.team.postgres.Cluster`); commits are not synced to the disk."""
    return running_cluster()


@pytest.fixture(scope="module")
def postgres(cluster):
    """The URL of a database for this file of tests, migrated and empty."""
    yield from fresh_database(cluster)


@pytest.fixture
def own_postgres(cluster):
    """The URL of a database for this test alone, migrated and empty."""
    yield from fresh_database(cluster)


def fresh_database(cluster):
    """The URL of a new database, which is dropped in the end."""
    name = f"test_{next(_numbers)}"
    yield cluster.create(name, MIGRATED)
    cluster.drop(name)


@pytest.fixture(scope="session")
def object_store(tmp_path_factory):
    """One S3 server (`app.team.object_store.ObjectStore`)."""
    from app.team.errors import Missing
    from app.team.object_store import ObjectStore

    try:
        store = ObjectStore(tmp_path_factory.mktemp("s3"))
    except Missing as missing:
        pytest.skip(str(missing))
    yield store
    store.close()


@pytest.fixture(scope="module")
def s3(object_store):
    """A bucket for this file of tests, and the AWS environment as long as it runs."""
    from app.team.object_store import AWS

    name = f"bucket-{next(_numbers)}"
    object_store.create(name)
    with pytest.MonkeyPatch.context() as patch:
        for variable, value in AWS.items():
            patch.setenv(variable, value)
        yield Bucket(object_store.endpoint, name, AWS)
