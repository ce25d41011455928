"""Artifacts in an S3 bucket, served from verified copies on this machine.

The bucket contains `<sha>`, the files; `database`, the identity of their database; `sweeps`, the last
collections; `quarantine/<sha>.<tag>`, copies of files whose bytes do not match their name; `discarded/<sha>`,
unreferenced files, kept until the next sweep.

A copy is trusted once its bytes have been hashed, as long as its inode, size and times do not change
(`ArtifactStore`). An object is trusted once this process has hashed or sent its bytes, as long as its ETag
does not change.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from app.storage.artifacts import OWNER, QUARANTINE, SHA256, StoredFile, hashed, require_name
from app.storage.copies import Copies
from app.storage.errors import ArtifactDamaged, ArtifactMissing, ArtifactsUnreachable
from app.storage.s3 import Bucket, Entry
from app.storage.verification import Newest, OpenFile

logger = logging.getLogger(__name__)

YOUNG = 3600.0  # a younger object is not renewed, because every sweep waits longer than this [s]
DISCARDED = "discarded/"
_TRIES = 2  # attempts at a download whose bytes do not match the name


class BucketStore:
    """Artifacts in a bucket. `on_look` is called at each read with whether a local copy was found."""

    is_shared = True

    def __init__(
        self, bucket: Bucket, copies: Copies, on_look: Callable[[bool], object] | None = None
    ) -> None:
        self._bucket, self._copies = bucket, copies
        self._tags: Newest[str] = Newest()  # tags of objects whose bytes this process has hashed or sent
        self._on_look = on_look or (lambda is_there: None)
        self._fetching = [threading.Lock() for _ in range(16)]  # one download at a time for each first digit

    def put(self, *parts: bytes | memoryview) -> str:
        """Store bytes in the bucket, and return their SHA-256; a copy stays on this machine.

        If-None-Match separates simultaneous puts. An existing object is replaced by the same bytes, which
        renews its age and repairs it, unless this process knows that it is good and young.
        """
        sha, data = hashed(parts), b"".join(parts)
        if not self._is_good_and_young(sha):
            tag = self._bucket.create(sha, data)
            if tag is None:
                tag = self._bucket.replace(sha, data)
            self._note(sha, tag)
        self._keep(data)
        return sha

    def fetch(self, sha: str) -> Path:
        """Return the path of a verified copy, which exists for at least a minute; raise as `open` does."""
        with self.open(sha):
            return self._copies.path(sha)

    def read(self, sha: str) -> bytes:
        """Return the verified bytes; raise the same errors as `open`."""
        require_name(sha)
        data = self._copies.read(sha)
        self._on_look(data is not None)
        if data is None:
            data = self._download(sha)
            self._keep(data)
        return data

    def open(self, sha: str) -> OpenFile:
        """Open a verified copy for reading; download it if this machine has none.

        Raises
        ------
        ArtifactMissing
            If the bucket has no such object, or the name is not a SHA-256.
        ArtifactDamaged
            If its bytes do not match the hash; a copy of it is stored under `quarantine/`.
        ArtifactsUnreachable
            If there is no copy, and the bucket does not answer.
        """
        require_name(sha)
        opened = self._copies.open(sha)
        self._on_look(opened is not None)
        if opened:
            return opened
        with self._fetching[int(sha[0], 16)]:
            if opened := self._copies.open(sha):
                return opened
            self._copies.put(self._download(sha))
            if opened := self._copies.open(sha):
                return opened
        raise ArtifactDamaged(sha, "its copy on this machine changed right after it was written")

    def exists(self, sha: str) -> bool:
        """Return whether the bucket has the bytes, and they are good.

        The method asks the bucket, so that it notices a deleted object. If the bucket has lost an object of
        which this machine has a copy, the object is put back. If the bucket does not answer, a copy is
        enough.
        """
        if not SHA256.fullmatch(sha):
            return False
        if self._bucket.is_silent and self._has_copy(sha):
            return True
        try:
            return self._is_good(sha) or self._is_put_back(sha)
        except ArtifactsUnreachable:
            if self._has_copy(sha):
                return True
            raise

    def delete(self, sha: str) -> None:
        """Delete an object and its copy on this machine if they exist."""
        require_name(sha)
        for key in (sha, DISCARDED + sha):
            self._bucket.delete(key)
        self._copies.delete(sha)
        self._tags.forget(sha)

    def delete_unchanged(self, seen: StoredFile) -> bool:
        """Move an object to `discarded/` unless it was put again since; delete it for good from there.

        S3 cannot delete conditionally: a put between the last check and the deletion would lose its bytes. In
        `discarded/` readers and the next sweep still find them, so nothing is lost.
        """
        key = DISCARDED + seen.sha if seen.is_discarded else seen.sha
        if not _is_same(self._bucket.head(key), seen):
            return False
        if not seen.is_discarded:
            self._bucket.copy(key, DISCARDED + seen.sha)
            if not _is_same(self._bucket.head(key), seen):
                return False
            self._copies.delete(seen.sha)
            self._tags.forget(seen.sha)
        self._bucket.delete(key)
        return True

    def list(self) -> Iterator[StoredFile]:
        """Yield every object, verified or not, and the discarded ones, except those that were set aside."""
        for key, entry in self._bucket.list():
            sha = key.removeprefix(DISCARDED)
            if SHA256.fullmatch(sha):
                yield StoredFile(sha, entry.size, entry.modified, is_discarded=sha != key)

    def claim(self, owner: str) -> str:
        """Claim the bucket for an owner if it has none; return its owner."""
        while self._bucket.create(OWNER, owner.encode()) is None:
            if answer := self._bucket.get(OWNER):  # it still exists
                return answer[0].decode(errors="replace").strip()
        return owner

    def read_note(self, name: str) -> str | None:
        """Return the note with this name; None if there is none."""
        answer = self._bucket.get(name)
        return None if answer is None else answer[0].decode(errors="replace")

    def write_note(self, name: str, text: str) -> None:
        """Write a note under a name in the bucket."""
        self._bucket.replace(name, text.encode())

    def probe(self) -> None:
        """Check that the bucket answers; raise ArtifactsUnreachable if not."""
        self._bucket.probe()

    def _download(self, sha: str) -> bytes:
        """Return the verified bytes from the bucket; raise the same errors as `open`."""
        for _ in range(_TRIES):  # a second attempt, because a connection may break off unnoticed
            answer = self._bucket.get(sha) or self._brought_back(sha)
            if answer is None:
                self._tags.forget(sha)
                raise ArtifactMissing(sha)
            data, entry = answer
            if hashed([data]) == sha:
                self._note(sha, entry.tag)
                return data
        self._tags.forget(sha)
        logger.error("object %s in the bucket has bytes that do not match its name; it is set aside", sha)
        self._bucket.copy(sha, f"{QUARANTINE}/{sha}.{(entry.tag or '').strip(chr(34))}")
        raise ArtifactDamaged(sha, f"its {len(data)} bytes in the bucket have another hash")

    def _brought_back(self, sha: str) -> tuple[bytes, Entry] | None:
        """Restore an object that a sweep has discarded, and return it; None if there is none."""
        return self._bucket.get(sha) if self._bucket.copy(DISCARDED + sha, sha) else None

    def _is_good(self, sha: str) -> bool:
        """Return whether the object has the tag of verified bytes, or is right when downloaded."""
        entry = self._bucket.head(sha)
        if self._is_known_good(sha, entry):
            return True
        try:
            self._keep(self._download(sha))
        except (ArtifactMissing, ArtifactDamaged):
            return False
        return True

    def _is_put_back(self, sha: str) -> bool:
        """Put back an object that the bucket has lost, from a good local copy; return whether it worked."""
        data = self._copies.read(sha)
        if data is None:
            return False
        logger.warning("object %s was lost or damaged; it is replaced by the copy on this machine", sha)
        self._note(sha, self._bucket.replace(sha, data))
        return True

    def _is_good_and_young(self, sha: str) -> bool:
        entry = self._bucket.head(sha) if self._tags.knows(sha) else None
        return entry is not None and self._is_known_good(sha, entry) and time.time() - entry.modified < YOUNG

    def _is_known_good(self, sha: str, entry: Entry | None) -> bool:
        """Return whether an object still has the tag that it had when its bytes were verified."""
        return entry is not None and entry.tag is not None and self._tags.has(sha, entry.tag)

    def _note(self, sha: str, tag: str | None) -> None:
        """Remember the tag of an object whose bytes are right; without a tag, remember nothing."""
        if tag:
            self._tags.add(sha, tag)

    def _has_copy(self, sha: str) -> bool:
        opened = self._copies.open(sha)
        if opened:
            opened.file.close()
        return opened is not None

    def _keep(self, data: bytes) -> None:
        """Keep a copy if the disk has room for it; the bucket has the bytes in any case."""
        try:
            self._copies.put(data)
        except OSError as error:
            logger.warning("a copy of a file of the bucket cannot be kept: %s", error.strerror)


def _is_same(entry: Entry | None, seen: StoredFile) -> bool:
    return entry is not None and entry.modified == seen.modified
