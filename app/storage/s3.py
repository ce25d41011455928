"""Requests to an S3 bucket; each error becomes a missing object or an unavailable bucket."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from functools import cache
from typing import TYPE_CHECKING, Literal

import obstore
from obstore.exceptions import AlreadyExistsError, BaseError, PermissionDeniedError, UnauthenticatedError
from obstore.store import S3Store

from app.storage.errors import ArtifactsUnreachable

if TYPE_CHECKING:
    from obstore.store import ClientConfig, RetryConfig, S3Config

NO_KEYS = "there are no keys: set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY"
NO_BUCKET = "the bucket does not exist"
SILENT = "it does not answer"
_PROBE = "probe"  # the name of no object
_CODE = re.compile(r"<Code>(\w{1,60})</Code>")
_REFUSING = {"AccessDenied", "InvalidAccessKeyId", "SignatureDoesNotMatch", "ExpiredToken", "InvalidToken"}
_METADATA_SERVICE = "169.254.169.254"  # where the client looks for keys if the environment has none

SILENCE = 5.0  # without an answer, or without more of it, until a request ends [s]
_LONGEST = 120.0  # that a download may take, as long as bytes come [s]
_UPLOAD = 2.0**18  # that an upload must come to in each second beyond `SILENCE` [bytes]

Asked = Callable[[str, str, float], object]
"""Called with each request's operation, outcome (`good`, `missing`, `unreachable`) and time [s]."""


@dataclass(frozen=True)
class Entry:
    """The bucket's entry of an object: its tag, its size [bytes], when it was put [s since 1970]."""

    tag: str | None
    size: int
    modified: float


class Bucket:
    """A bucket, or the part of it below a prefix.

    Short failures are tried again twice. A bucket that takes connections and does not answer is given up
    after 5 s. A file that is sent has 4 to 8 s more for each MiB, as nothing can be heard meanwhile.
    Texts of the client may quote addresses and keys: only their codes go on. After a failure it `is_silent`
    for `retry_after` seconds: who has another source may ask that first.
    """

    def __init__(
        self, name: str, prefix: str | None, endpoint: str | None, on_request: Asked | None = None
    ) -> None:
        place: S3Config = {"endpoint": endpoint} if endpoint else {}
        retries, self._silence = _retries(SILENCE), SILENCE

        def store(seconds: float, silence: float) -> S3Store:
            options = _options(endpoint, seconds, silence)
            return S3Store(name, prefix=prefix, config=place, client_options=options, retry_config=retries)

        self._questions = store(SILENCE, SILENCE)
        self._downloads = store(_LONGEST, SILENCE)
        self._uploads = cache(lambda seconds: store(seconds, seconds))
        self._on_request = on_request or (lambda operation, outcome, seconds: None)
        self._silent_until = 0.0

    @property
    def is_silent(self) -> bool:
        """Return whether the bucket failed to answer a moment ago."""
        return time.monotonic() < self._silent_until

    def head(self, key: str) -> Entry | None:
        """Return the entry of a key; None if there is none."""
        with self._asked("head"):
            seen = obstore.head(self._questions, key)
            return Entry(seen["e_tag"], seen["size"], seen["last_modified"].timestamp())
        self.probe()  # to HEAD, S3 does not say whether it misses the object or the whole bucket
        return None

    def get(self, key: str) -> tuple[bytes, Entry] | None:
        """Return the bytes under a key; None if there are none."""
        with self._asked("get"):
            answer = obstore.get(self._downloads, key)
            seen = answer.meta
            entry = Entry(seen["e_tag"], seen["size"], seen["last_modified"].timestamp())
            return bytes(answer.bytes()), entry
        return None

    def create(self, key: str, data: bytes) -> str | None:
        """Put an object unless there is one, and return its tag; None if there is one."""
        return self._put(key, data, is_new=True)

    def replace(self, key: str, data: bytes) -> str | None:
        """Put an object in place of any other, and return its tag, if the server gives one."""
        return self._put(key, data, is_new=False)

    def copy(self, key: str, target: str) -> bool:
        """Copy an object within the bucket; return whether it was there."""
        with self._asked("copy"):
            obstore.copy(self._questions, key, target)
            return True
        return False

    def delete(self, key: str) -> None:
        """Delete an object, if it is there."""
        with self._asked("delete"):
            obstore.delete(self._questions, key)

    def list(self) -> Iterator[tuple[str, Entry]]:
        """Yield all objects with their keys."""
        pages = iter(obstore.list(self._downloads))
        while True:
            page = None
            with self._asked("list"):
                page = next(pages, None)
            if page is None:
                return
            for seen in page:
                yield seen["path"], Entry(seen["e_tag"], seen["size"], seen["last_modified"].timestamp())

    def probe(self) -> None:
        """Check that the bucket is there and can be read: it says that it has no object of a certain name."""
        with self._asked("probe"):
            obstore.get(self._questions, _PROBE)

    def _put(self, key: str, data: bytes, *, is_new: bool) -> str | None:
        mode: Literal["create", "overwrite"] = "create" if is_new else "overwrite"
        uploads = self._uploads(seconds_of_upload(len(data), self._silence))
        with self._asked("put"):
            try:
                return obstore.put(uploads, key, data, mode=mode, use_multipart=False)["e_tag"] or ""
            except AlreadyExistsError:
                return None
        raise ArtifactsUnreachable(NO_BUCKET)

    @contextmanager
    def _asked(self, operation: str) -> Iterator[None]:
        """Leave the block without an error if the requested object is missing.

        Raises ArtifactsUnreachable.
        """
        start, outcome = time.perf_counter(), "good"
        try:
            yield
        except FileNotFoundError as error:
            outcome = "missing"
            if "NoSuchBucket" in str(error):
                outcome = "unreachable"
                raise self._unreachable(error) from None
        except (BaseError, OSError) as error:
            outcome = "unreachable"
            raise self._unreachable(error) from None  # its text may quote keys
        finally:
            self._on_request(operation, outcome, time.perf_counter() - start)

    def _unreachable(self, error: Exception) -> ArtifactsUnreachable:
        failure = ArtifactsUnreachable(_reason(error))
        self._silent_until = time.monotonic() + failure.retry_after
        return failure


def seconds_of_upload(size: int, silence: float) -> float:
    """Return the time limit of an upload of a size [bytes] [s].

    Few different times, each of which has a client.
    """
    return silence + 2.0 ** math.ceil(math.log2(max(1.0, size / _UPLOAD))) - 1


def _options(endpoint: str | None, seconds: float, silence: float) -> ClientConfig:
    """Return options of requests: their time limits in all, and without a further byte [s]."""
    return {
        "allow_http": endpoint is not None and endpoint.startswith("http://"),
        "connect_timeout": timedelta(seconds=2),
        "read_timeout": timedelta(seconds=silence),
        "timeout": timedelta(seconds=seconds),
    }


def _retries(seconds: float) -> RetryConfig:
    """Return retry options: a request that failed after this time [s], such as a time-out, is not retried."""
    return {
        "max_retries": 2,
        "retry_timeout": timedelta(seconds=seconds),
        "backoff": {
            "init_backoff": timedelta(milliseconds=100),
            "max_backoff": timedelta(seconds=1),
            "base": 2,
        },
    }


def _reason(error: Exception) -> str:
    """Return why a bucket cannot be used, without any address or key."""
    text = str(error)
    code = match[1] if (match := _CODE.search(text)) else None
    if code == "NoSuchBucket":
        return NO_BUCKET
    if _METADATA_SERVICE in text:
        return NO_KEYS
    if code in _REFUSING or isinstance(error, (PermissionDeniedError, UnauthenticatedError)):
        return f"it refuses the keys or what they ask for ({code or type(error).__name__})"
    return f"it answers {code}" if code else SILENT
