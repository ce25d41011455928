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
_PROBE = "probe"  # a name that no object has
_CODE = re.compile(r"<Code>(\w{1,60})</Code>")
_REFUSING = {"AccessDenied", "InvalidAccessKeyId", "SignatureDoesNotMatch", "ExpiredToken", "InvalidToken"}
_METADATA_SERVICE = (
    "169.254.169.254"  # address at which the client looks for keys if the environment has none
)

SILENCE = 5.0  # time without an answer, or without a further byte, after which a request ends [s]
_LONGEST = 120.0  # time limit of a download that keeps receiving bytes [s]
_UPLOAD = 2.0**18  # smallest size of an upload for each second beyond `SILENCE` [bytes]

Asked = Callable[[str, str, float], object]
"""Called with each request's operation, outcome (`good`, `missing`, `unreachable`) and time [s]."""


@dataclass(frozen=True)
class Entry:
    """The bucket's entry for an object: its tag, its size [bytes], and when it was put [s since 1970]."""

    tag: str | None
    size: int
    modified: float


class Bucket:
    """A bucket, or the part of it below a prefix.

    A request that fails quickly is repeated twice. If a bucket accepts connections but does not answer, a
    request ends after 5 s. An upload has 4 to 8 s more for each MiB, because the bucket sends nothing until
    it is complete. Texts of the client may quote addresses and keys, so messages contain only their codes.
    After a failure the bucket `is_silent` for `retry_after` seconds, during which a caller may prefer another
    source.
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
        """Return whether the bucket recently failed to answer."""
        return time.monotonic() < self._silent_until

    def head(self, key: str) -> Entry | None:
        """Return the entry for a key; None if there is none."""
        with self._asked("head"):
            seen = obstore.head(self._questions, key)
            return Entry(seen["e_tag"], seen["size"], seen["last_modified"].timestamp())
        self.probe()  # the answer to HEAD does not tell a missing object from a missing bucket
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
        """Put an object unless it exists, and return its tag; None if it exists."""
        return self._put(key, data, is_new=True)

    def replace(self, key: str, data: bytes) -> str | None:
        """Put an object in place of any existing one, and return its tag if the server gives one."""
        return self._put(key, data, is_new=False)

    def copy(self, key: str, target: str) -> bool:
        """Copy an object within the bucket; return whether it existed."""
        with self._asked("copy"):
            obstore.copy(self._questions, key, target)
            return True
        return False

    def delete(self, key: str) -> None:
        """Delete an object if it exists."""
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
        """Check that the bucket exists and can be read, by a request for an object that does not exist."""
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
        """Record a request; an error for a missing object ends the block without an exception.

        Raises
        ------
        ArtifactsUnreachable
            For any other error.
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
            raise self._unreachable(error) from None  # the text of the error may quote keys
        finally:
            self._on_request(operation, outcome, time.perf_counter() - start)

    def _unreachable(self, error: Exception) -> ArtifactsUnreachable:
        failure = ArtifactsUnreachable(_reason(error))
        self._silent_until = time.monotonic() + failure.retry_after
        return failure


def seconds_of_upload(size: int, silence: float) -> float:
    """Return the time limit [s] for an upload of a size [bytes].

    There are few different limits, because each needs its own client.
    """
    return silence + 2.0 ** math.ceil(math.log2(max(1.0, size / _UPLOAD))) - 1


def _options(endpoint: str | None, seconds: float, silence: float) -> ClientConfig:
    """Return the time limits of requests: in total, and without a further byte [s]."""
    return {
        "allow_http": endpoint is not None and endpoint.startswith("http://"),
        "connect_timeout": timedelta(seconds=2),
        "read_timeout": timedelta(seconds=silence),
        "timeout": timedelta(seconds=seconds),
    }


def _retries(seconds: float) -> RetryConfig:
    """Return retry options: a request that fails after this time [s], such as a time-out, is not repeated."""
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
        return f"it refuses the keys or the operation ({code or type(error).__name__})"
    return f"it answers {code}" if code else SILENT
