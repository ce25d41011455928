"""Several servers sweep one store one at a time, by the age of files, and delete no file still needed."""

import threading
import time

import pytest
from sqlalchemy.orm import Session

from app.retention.files import Sweep
from app.settings import Settings
from app.solids import rows
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.locks import alone
from app.storage.stores import opened_store

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills

GRACE = 24 * 3600.0


@pytest.fixture
def databases(own_postgres):
    """One database, as two servers use it."""
    both = Database(own_postgres), Database(own_postgres)
    yield both
    for database in both:
        database.close()


@pytest.fixture(params=["shared", "bucket"])
def stores(request, tmp_path):
    """One store, as two servers use it."""
    place = {"artifacts_url": f"file://{tmp_path}/files"}
    if request.param == "bucket":
        s3 = request.getfixturevalue("s3")
        place = {"artifacts_url": f"{s3.url}/{tmp_path.name}", "s3_endpoint": s3.endpoint}

    def opened(name):
        folder = DataFolder(tmp_path / name)
        folder.release()
        return opened_store(Settings(data=folder.path, **place), folder)

    return opened("one"), opened("two")


def named(database, sha, key="build"):
    """Let a row name a file."""

    def unit(session: Session) -> None:
        rows.add_build(session, key, "moody", 1, {}, {}, "recipe 1")
        rows.add_artifact(session, key, "step", sha, 1)

    database.write(unit)


def swept_later(sweep, monkeypatch, seconds=2 * GRACE):
    """Sweep as if so much time had passed [s]."""
    now = time.time()
    with monkeypatch.context() as patch:
        patch.setattr("app.retention.files.time.time", lambda: now + seconds)
        return sweep.run()


def kept(store):
    return {file.sha for file in store.list() if not file.is_discarded}


@pytest.mark.sampled(1)
def test_only_old_files_without_a_row_go(databases, stores, monkeypatch):
    wanted, left = stores[0].put(b"wanted"), stores[0].put(b"left")
    named(databases[0], wanted)
    sweep = Sweep(databases[1], stores[1])
    assert [sweep.run(), sweep.run()] == [0, 0], "both are young"
    assert swept_later(sweep, monkeypatch)
    swept_later(sweep, monkeypatch, 4 * GRACE)
    assert wanted in kept(stores[1])
    assert not stores[1].exists(left)
    assert stores[0].read(wanted) == b"wanted"


@pytest.mark.sampled(1)
def test_one_server_sweeps_at_a_time(databases, stores, monkeypatch):
    stores[0].put(b"left")
    sweep = Sweep(databases[0], stores[0])
    with alone(databases[1], "sweep of files") as is_alone:
        assert is_alone
        assert swept_later(sweep, monkeypatch) == 0
    assert swept_later(sweep, monkeypatch)


@pytest.mark.sampled(1)
def test_a_file_that_is_put_while_another_server_sweeps_is_not_lost(databases, stores, monkeypatch):
    """The put ends before its old file is deleted, and the row is written after."""
    sha = stores[1].put(b"wanted again")
    one, listing = stores[0], stores[0].list
    monkeypatch.setattr(one, "list", lambda: iter([*listing()]))
    threads = []
    deleting = one.delete_unchanged

    def delete(seen):
        thread = threading.Thread(target=stores[1].put, args=[b"wanted again"])
        threads.append(thread)
        thread.start()
        return deleting(seen)

    monkeypatch.setattr(one, "delete_unchanged", delete)
    swept_later(Sweep(databases[0], one), monkeypatch)
    for thread in threads:
        thread.join()
    assert threads
    named(databases[1], sha)
    assert stores[1].read(sha) == b"wanted again"
    assert stores[0].exists(sha)


@pytest.mark.parametrize("stores", ["bucket"], indirect=True)  # a folder deletes on a condition
def test_a_discarded_file_that_a_row_names_after_all_comes_back(databases, stores, monkeypatch):
    sha = stores[0].put(b"named late")
    (seen,) = (file for file in stores[0].list() if file.sha == sha)
    assert stores[0].delete_unchanged(seen)
    named(databases[0], sha)
    sweep = Sweep(databases[1], stores[1])
    sweep.run()
    assert sha in kept(stores[1])
    swept_later(sweep, monkeypatch)
    assert [file.sha for file in stores[1].list()] == [sha]
