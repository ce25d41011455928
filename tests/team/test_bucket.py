"""Artifacts in a bucket: whatever is changed, deleted or cut off, the right bytes are served, or none."""

import logging
import os
import subprocess
import sys
import time
from pathlib import Path
from textwrap import dedent

import pytest
from cutting import Cutter

from app.settings import Settings
from app.storage.copies import Copies
from app.storage.errors import ArtifactDamaged, ArtifactMissing, ArtifactsUnreachable
from app.storage.folder import DataFolder
from app.storage.stores import Figures, opened_store

obstore = pytest.importorskip("obstore", reason="the client of S3 is not installed")
buckets = pytest.importorskip("app.storage.bucket")
S3Store = pytest.importorskip("obstore.store").S3Store

BYTES = os.urandom(300_000)
OTHER = bytes([BYTES[0] ^ 1]) + BYTES[1:]


class Server:
    """A store of one server, and what it asked of its bucket."""

    def __init__(self, folder, s3, prefix, endpoint=None):
        self.asked, self.looks = [], []
        figures = Figures(lambda *one: self.asked.append(one), self.looks.append)
        data = DataFolder(folder)
        data.release()
        place = {"artifacts_url": f"{s3.url}/{prefix}", "s3_endpoint": endpoint or s3.endpoint}
        self.store = opened_store(Settings(data=folder, **place), data, figures)
        self.folder = folder

    def asking(self, call, *given):
        """What a call returns, and which operations it asked for."""
        self.asked.clear()
        return call(*given), [operation for operation, *_ in self.asked]

    def flip(self, sha):
        """Change the copy of this machine."""
        (self.folder / "copies" / sha[:2] / sha).write_bytes(OTHER)


@pytest.fixture
def server(tmp_path, s3):
    """Makes servers on the same part of the bucket."""
    return lambda name="one", endpoint=None: Server(tmp_path / name, s3, tmp_path.name, endpoint)


@pytest.fixture
def raw(tmp_path, s3):
    """The same part of the bucket, as whoever damages it sees it."""
    return S3Store(s3.name, prefix=tmp_path.name, endpoint=s3.endpoint, client_options={"allow_http": True})


def keys(raw):
    return {one["path"] for page in obstore.list(raw) for one in page} - {"crankwright"}


class TestDamage:
    @pytest.mark.slow
    def test_one_server_reads_what_another_has_put(self, server):
        sha = server().store.put(BYTES)
        two = server("two")
        assert two.asking(two.store.read, sha) == (BYTES, ["get"])
        assert two.asking(two.store.read, sha) == (BYTES, [])
        assert two.looks == [False, True]

    def test_a_flipped_copy_is_fetched_again(self, server):
        one = server()
        sha = one.store.put(BYTES)
        for read in (one.store.read, lambda sha: one.store.fetch(sha).read_bytes()):
            one.flip(sha)
            assert one.asking(read, sha) == (BYTES, ["get"])

    def test_a_flipped_object_is_set_aside_and_missed(self, server, raw):
        one, two = server(), server("two")
        sha = one.store.put(BYTES)
        obstore.put(raw, sha, OTHER)
        assert not two.store.exists(sha)
        with pytest.raises(ArtifactDamaged):
            two.store.read(sha)
        aside = [key for key in keys(raw) if key.startswith(f"quarantine/{sha}.")]
        assert [bytes(obstore.get(raw, key).bytes()) for key in aside] == [OTHER]
        two.store.put(BYTES)
        assert server("three").store.read(sha) == BYTES

    def test_a_server_with_a_good_copy_puts_it_in_place_of_a_flipped_object(self, server, raw):
        one = server()
        sha = one.store.put(BYTES)
        obstore.put(raw, sha, OTHER)
        assert one.store.exists(sha)
        assert server("two").store.read(sha) == BYTES

    def test_flipped_both_nothing_is_served(self, server, raw):
        one = server()
        sha = one.store.put(BYTES)
        obstore.put(raw, sha, OTHER)
        one.flip(sha)
        with pytest.raises(ArtifactDamaged):
            one.store.open(sha)
        assert not one.store.exists(sha)
        one.store.put(BYTES)
        assert one.store.read(sha) == server("two").store.read(sha) == BYTES

    def test_a_deleted_object_is_noticed(self, server, raw):
        one, two = server(), server("two")
        sha = one.store.put(BYTES)
        obstore.delete(raw, sha)
        assert not two.store.exists(sha)
        assert one.store.exists(sha), "this machine has a copy, and puts it back"
        assert two.store.exists(sha)

    def test_exists_hashes_an_object_once(self, server):
        sha, again = server().store.put(BYTES), server("two")
        assert again.asking(again.store.exists, sha) == (True, ["head", "get"])
        assert again.asking(again.store.exists, sha) == (True, ["head"])

    def test_an_empty_file(self, server):
        assert server("two").store.read(server().store.put(b"")) == b""


class TestPuts:
    def test_bytes_that_are_there_are_sent_again_once(self, server):
        one, two = server(), server("two")
        assert one.asking(one.store.put, BYTES)[1] == ["put"]
        assert two.asking(two.store.put, BYTES)[1] == ["put", "put"]
        assert two.asking(two.store.put, BYTES)[1] == ["head"]

    def test_an_old_object_is_young_again(self, server, monkeypatch):
        one = server()
        one.store.put(BYTES)
        monkeypatch.setattr(buckets, "YOUNG", -1e9)
        assert one.asking(one.store.put, BYTES)[1] == ["head", "put", "put"]

    def test_a_put_that_comes_while_the_sweep_deletes_loses_nothing(self, server, monkeypatch):
        """It comes after the last look at the object; S3 cannot delete on a condition."""
        one, two = server(), server("two")
        sha = one.store.put(BYTES)
        seen = next(one.store.list())
        delete = one.store._bucket.delete
        monkeypatch.setattr(one.store._bucket, "delete", lambda key: (two.store.put(BYTES), delete(key)))
        assert one.store.delete_unchanged(seen)
        assert [file.is_discarded for file in server("three").store.list()] == [True]
        assert server("four").store.read(sha) == BYTES
        assert server("five").store.exists(sha)

    def test_what_is_put_after_it_was_listed_stays(self, server, raw):
        one = server()
        sha = one.store.put(BYTES)
        seen = next(one.store.list())
        older = type(seen)(seen.sha, seen.size, seen.modified - 5)
        assert not one.store.delete_unchanged(older)
        assert keys(raw) == {sha}

    @pytest.mark.slow
    def test_two_processes_put_the_same_bytes(self, s3, server, tmp_path):
        script = dedent(f"""
            from pathlib import Path
            from app.settings import Settings
            from app.storage.folder import DataFolder
            from app.storage.stores import opened_store
            import sys
            folder = DataFolder(Path(sys.argv[1]))
            place = {{"artifacts_url": "{s3.url}/{tmp_path.name}", "s3_endpoint": "{s3.endpoint}"}}
            store = opened_store(Settings(data=folder.path, **place), folder)
            for number in range(20):
                print(store.put(b"%d" % number * 1000))
        """)
        commands = [[sys.executable, "-c", script, str(tmp_path / name)] for name in ("p", "q")]
        both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]
        said = [one.communicate()[0].split() for one in both]
        assert said[0] == said[1]
        store = server().store
        assert [store.read(sha) for sha in said[0]] == [b"%d" % number * 1000 for number in range(20)]


class TestOutage:
    @pytest.fixture
    def cutter(self, s3):
        cutter = Cutter(s3.endpoint)
        yield cutter
        cutter.close()

    def test_a_download_that_breaks_off_is_no_damage(self, server, raw, cutter):
        sha = server().store.put(BYTES)
        two = server("two", cutter.endpoint)
        cutter.most = 100_000
        with pytest.raises(ArtifactsUnreachable, match="does not answer"):
            two.store.read(sha)
        assert cutter.cuts
        assert keys(raw) == {sha}
        assert not two.store._copies.read(sha)
        cutter.most = None
        assert two.store.read(sha) == BYTES

    @pytest.mark.slow
    def test_copies_are_served_and_nothing_is_said_to_be_missing(self, server, cutter):
        one = server(endpoint=cutter.endpoint)
        sha = one.store.put(BYTES)
        cutter.most = 0
        for ask in (one.store.exists, one.store.read, one.store.open):
            with pytest.raises(ArtifactsUnreachable):
                ask("0" * 64)
        for change in (one.store.put, lambda data: one.store.delete("0" * 64)):
            with pytest.raises(ArtifactsUnreachable):
                change(OTHER)
        assert one.store.read(sha) == BYTES
        assert one.asking(one.store.exists, sha) == (True, []), "it has just not answered"
        one.store._bucket._silent_until = 0
        assert one.asking(one.store.exists, sha) == (True, ["head"])
        cutter.most = None
        assert one.store.put(OTHER)

    def test_a_bucket_that_goes_is_no_missing_file(self, server, object_store, s3, tmp_path):
        one = server()
        gone = obstore_bucket("elsewhere", s3)
        one.store._bucket = gone
        for ask in (one.store.exists, one.store.read):
            with pytest.raises(ArtifactsUnreachable, match="bucket does not exist"):
                ask("0" * 64)

    def test_neither_texts_nor_logs_hold_keys(self, server, monkeypatch, cutter, caplog):
        caplog.set_level(logging.DEBUG)
        monkeypatch.setenv("AWS_ACCESS_KEY_ID", "AKIDSECRET")
        monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "TOPSECRET")
        one = server(endpoint=cutter.endpoint)
        cutter.most = 0
        with pytest.raises(ArtifactsUnreachable) as failure:
            one.store.put(BYTES)
        assert failure.value.__cause__ is None
        assert failure.value.__suppress_context__
        assert "SECRET" not in caplog.text + str(failure.value)
        assert "127.0.0.1" not in str(failure.value)


def obstore_bucket(name, s3):
    from app.storage.s3 import Bucket

    return Bucket(name, None, s3.endpoint)


class TestCopies:
    def test_the_least_used_make_room(self, tmp_path):
        copies = Copies(tmp_path, 10_000, in_use=0)
        blobs = [bytes([number]) * 3_000 for number in range(6)]
        hashes = []
        for blob in blobs:
            copies.put(blob)
            hashes.append(next(sha for sha in names(tmp_path) if sha not in hashes))
            assert copies.read(hashes[0]) == blobs[0], "it is used all the time"
            assert size(tmp_path) <= 10_000
        assert copies.read(hashes[-1]) == blobs[-1]
        assert copies.read(hashes[1]) is None

    def test_what_is_in_use_stays(self, tmp_path):
        copies = Copies(tmp_path, 10_000)
        for number in range(6):
            copies.put(bytes([number]) * 3_000)
        assert size(tmp_path) == 18_000

    def test_a_file_beyond_the_limit_is_kept_until_the_next(self, tmp_path):
        copies = Copies(tmp_path, 1_000, in_use=0)
        copies.put(b"a" * 20_000)
        assert size(tmp_path) == 20_000
        copies.put(b"b" * 500)
        assert size(tmp_path) == 500

    def test_a_second_process_counts_what_the_first_added(self, tmp_path):
        first, second = (Copies(tmp_path, 10_000, in_use=0) for _ in range(2))
        for number in range(20):
            (first if number % 2 else second).put(bytes([number]) * 1_000)
            assert size(tmp_path) <= 10_000 + 2 * 10_000 / 8 + 1_000

    def test_a_full_disk_is_no_reason_to_refuse(self, server, monkeypatch):
        one = server()

        def full(*parts):
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(one.store._copies, "put", full)
        sha = one.store.put(BYTES)
        assert one.store.read(sha) == BYTES
        assert one.store.exists(sha)


def names(folder: Path):
    return [path.name for path in folder.glob("??/*")]


def size(folder: Path):
    return sum(path.stat().st_size for path in folder.glob("??/*"))


def test_the_sweep_deletes_what_was_discarded_long_ago(server, raw):
    one = server()
    sha = one.store.put(BYTES)
    (live,) = one.store.list()
    assert one.store.delete_unchanged(live)
    (discarded,) = one.store.list()
    assert discarded.modified > time.time() - 600, "it is kept for another time of grace"
    assert one.store.delete_unchanged(discarded)
    assert keys(raw) == set()
    with pytest.raises(ArtifactMissing):
        one.store.read(sha)
