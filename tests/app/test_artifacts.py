"""Artifacts are whole or absent, and their names are the hashes of their bytes."""

import hashlib
from pathlib import Path

import pytest

from app.storage.artifacts import ArtifactStore
from app.storage.errors import ArtifactMissing

BYTES = b"ISO-10303-21;" * 1000


@pytest.fixture
def store(tmp_path):
    return ArtifactStore(tmp_path / "artifacts")


def files(store):
    return [path for path in store.folder.rglob("*") if path.is_file()]


def test_bytes_come_back_under_their_hash(store):
    sha = store.put(BYTES)
    assert sha == hashlib.sha256(BYTES).hexdigest()
    assert store.read(sha) == BYTES
    assert store.fetch(sha).name == sha


def test_the_same_bytes_are_stored_once(store):
    assert store.put(BYTES) == store.put(BYTES)
    assert len(files(store)) == 1


def test_a_torn_file_is_found_and_mended(store):
    sha = store.put(BYTES)
    store.fetch(sha).write_bytes(BYTES[:100])
    assert not store.exists(sha)
    store.put(BYTES)
    assert store.exists(sha)


def test_changed_bytes_are_found(store):
    sha = store.put(BYTES)
    store.fetch(sha).write_bytes(BYTES.replace(b"3", b"4"))
    assert not store.exists(sha)


def test_a_failed_write_leaves_nothing(store, monkeypatch):
    def full(descriptor):
        raise OSError("disk is full")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="disk is full"):
        store.put(BYTES)
    assert files(store) == []


def test_a_file_is_synced_before_it_is_renamed(store, monkeypatch):
    calls = []
    monkeypatch.setattr("os.fsync", lambda descriptor: calls.append("sync"))
    rename = __import__("os").replace
    monkeypatch.setattr("os.replace", lambda *paths: (calls.append("rename"), rename(*paths)))
    store.put(BYTES)
    assert calls == ["sync", "rename", "sync", "sync"]


def test_a_folder_that_takes_the_place_meanwhile_is_set_aside(store, monkeypatch):
    """To sync takes long, and what stands in the way then is no file that can be replaced."""
    location = store.folder / hashlib.sha256(BYTES).hexdigest()[:2] / hashlib.sha256(BYTES).hexdigest()
    monkeypatch.setattr("os.fsync", lambda descriptor: None if location.exists() else location.mkdir())
    assert store.read(store.put(BYTES)) == BYTES


def test_a_folder_in_place_of_a_file_that_was_there_is_a_missing_artifact(store, monkeypatch):
    """It is replaced between the look at it and its opening."""
    sha = store.put(BYTES)
    location, look = store.fetch(sha), Path.lstat

    def replacing(path):
        seen = look(path)
        location.unlink()
        location.mkdir()
        return seen

    monkeypatch.setattr(Path, "lstat", replacing)
    with pytest.raises(ArtifactMissing):
        store.read(sha)


def test_a_half_written_file_is_removed_at_the_start(store):
    sha = store.put(BYTES)
    torn = store.fetch(sha).parent / ".tmp-torn"
    torn.write_bytes(BYTES[:10])
    ArtifactStore(store.folder)
    assert not torn.exists()
    assert store.exists(sha)


@pytest.mark.parametrize("name", ["", "../../etc/passwd", "a" * 63, "A" * 64, "g" * 64, "a" * 64 + "\n"])
def test_only_a_hash_is_a_name(store, name):
    with pytest.raises(ArtifactMissing):
        store.fetch(name)
    assert not store.exists(name)


def test_an_unknown_hash_is_missing(store):
    with pytest.raises(ArtifactMissing, match="0000"):
        store.read("0" * 64)
