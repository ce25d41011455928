"""A restored backup or clone that uses the store of its original: both keep all files and report it."""

import json
import logging
from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import make_url
from test_sweep import GRACE, kept, named, swept_later

from app.observation import metrics
from app.retention.files import Sweep
from app.retention.service import Retention
from app.settings import Settings
from app.storage.copies_of_databases import NOTE, DatabaseCopied, require_only_copy
from app.storage.database import Database
from app.storage.errors import ArtifactsUnreachable
from app.storage.folder import DataFolder
from app.storage.stores import opened_store

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills


@pytest.fixture(params=["folder", "bucket"])
def store(request, tmp_path):
    """A store that servers share."""
    place = {"artifacts_url": f"file://{tmp_path}/files"}
    if request.param == "bucket":
        s3 = request.getfixturevalue("s3")
        place = {"artifacts_url": f"{s3.url}/{tmp_path.name}", "s3_endpoint": s3.endpoint}
    folder = DataFolder(tmp_path / "data")
    folder.release()
    return opened_store(Settings(data=folder.path, **place), folder)


@pytest.fixture
def original(own_postgres):
    database = Database(own_postgres)
    yield database
    database.close()


@pytest.fixture
def cloned(cluster, original):
    """Makes a copy of the database as it is, with all that it knows."""
    clones = []

    def clone():
        original.close()
        name = f"clone_{len(clones)}_{make_url(original.url).database}"
        clones.append(Database(cluster.create(name, make_url(original.url).database)))
        return Database(original.url), clones[-1]

    yield clone
    for one in clones:
        one.close()
        cluster.drop(make_url(one.url).database)


@pytest.mark.sampled(1)
def test_one_database_collects_again_and_again(original, store, monkeypatch):
    sweep = Sweep(original, store)
    for number in range(3):
        store.put(b"left %d" % number)
        assert swept_later(sweep, monkeypatch, (2 + 2 * number) * GRACE)


@pytest.mark.parametrize("first", [0, 1], ids=["the original first", "the copy first"])
@pytest.mark.sampled(1)
def test_a_copy_and_its_original_delete_nothing_more_once_both_have_collected(
    original, store, cloned, monkeypatch, first
):
    Sweep(original, store).run()
    both = cloned()
    shas = [store.put(b"of the original"), store.put(b"of the copy")]
    for database, sha in zip(both, shas, strict=True):
        named(database, sha)
    Sweep(both[first], store).run()
    for database in (both[1 - first], both[first], both[1 - first]):
        with pytest.raises(DatabaseCopied, match=r"a copy of this database.*CRANKWRIGHT_ARTIFACTS_URL"):
            swept_later(Sweep(database, store), monkeypatch)
    assert kept(store) == set(shas)
    both[0].close()


@pytest.mark.sampled(1)
def test_once_the_copy_has_gone_and_the_note_is_deleted_the_original_collects(
    original, store, cloned, monkeypatch
):
    own, copy = cloned()
    Sweep(own, store).run()
    with pytest.raises(DatabaseCopied, match=f"delete `{NOTE}`"):
        Sweep(copy, store).run()
    left = store.put(b"left")
    delete_note(store)
    assert swept_later(Sweep(own, store), monkeypatch) == 1
    assert left not in kept(store)
    with pytest.raises(DatabaseCopied):
        Sweep(copy, store).run()  # it has not gone after all
    own.close()


def delete_note(store):
    """As an operator does, by the means of the store."""
    if hasattr(store, "folder"):
        (store.folder / NOTE).unlink()
    else:
        store._bucket.delete(NOTE)


@pytest.mark.parametrize("dies", ["before the store", "after the store"])
@pytest.mark.sampled(2)
def test_a_server_that_dies_between_database_and_store_is_no_copy(original, store, dies, monkeypatch):
    require_only_copy(original, store)
    writing = store.write_note

    def dying(name, text):
        if dies == "after the store":
            writing(name, text)
        raise ArtifactsUnreachable("it died")

    for _ in range(3):
        with monkeypatch.context() as patch:
            patch.setattr(store, "write_note", dying)
            with pytest.raises(ArtifactsUnreachable):
                require_only_copy(original, store)
    require_only_copy(original, store)


@pytest.mark.parametrize(
    "text",
    [
        *("", '{"sweep": 1}'),
        *(
            pytest.param(text, marks=pytest.mark.slow)
            for text in ("{", "[]", '{"sweep": null, "copied": null}')
        ),
    ],
)
@pytest.mark.sampled(1)
def test_a_note_that_nobody_can_read_stops_the_collection(original, store, text):
    require_only_copy(original, store)
    store.write_note(NOTE, text)
    with pytest.raises(DatabaseCopied):
        require_only_copy(original, store)
    assert json.loads(store.read_note(NOTE))["copied"]


@pytest.mark.sampled(1)
def test_servers_of_one_database_are_no_copies(original, store):
    others = [Database(original.url) for _ in range(2)]
    with ThreadPoolExecutor(3) as pool:
        deleted = [
            list(pool.map(lambda database: Sweep(database, store).run(), [original, *others]))
            for _ in range(4)
        ]
    assert deleted == [[0, 0, 0]] * 4
    for database in others:
        database.close()


@pytest.mark.slow
@pytest.mark.sampled(1)
def test_the_server_says_why_it_keeps_files(original, store, cloned, caplog):
    own, copy = cloned()
    retentions = [Retention(database, store, Settings()) for database in (own, copy)]
    assert retentions[0].run()["files"] == 0
    assert metrics.COPIED._value.get() == 0
    with caplog.at_level(logging.ERROR):
        assert retentions[1].run()["files"] == 0
    (record,) = caplog.records
    assert "a copy of this database" in record.getMessage()
    assert record.exc_info is None
    assert metrics.COPIED._value.get() == 1
    own.close()
