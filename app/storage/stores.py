"""Open the file store of the settings: a folder of this server, a shared folder, or a bucket."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import SplitResult, unquote, urlsplit

from app.settings import Settings
from app.storage.artifacts import Artifacts, ArtifactStore
from app.storage.errors import ArtifactsUnreachable, StoreRefused
from app.storage.folder import DataFolder

if TYPE_CHECKING:
    from app.storage.s3 import Bucket

FORMS = "s3://bucket, s3://bucket/prefix, or file:///folder"
_BUCKET = re.compile(r"[a-z0-9][a-z0-9.-]{1,61}[a-z0-9]")
_PREFIX = re.compile(r"[A-Za-z0-9/._-]{0,500}")
_ENDPOINT = re.compile(r"https?://([A-Za-z0-9.-]+|\[[0-9a-fA-F:.]+\])(:[0-9]{1,5})?/?")
_NAME = "crankwright"  # name of the object that marks a bucket
_NOTE = b"Files of Crankwright, named by the SHA-256 of their bytes. One database refers to them.\n"


@dataclass(frozen=True)
class Figures:
    """Callbacks for requests to a bucket (operation, outcome, time [s]) and for searches of local copies."""

    on_request: Callable[[str, str, float], object] = lambda operation, outcome, seconds: None
    on_look: Callable[[bool], object] = lambda is_there: None


NO_FIGURES = Figures()


def opened_store(settings: Settings, folder: DataFolder, figures: Figures = NO_FIGURES) -> Artifacts:
    """Return the store of the settings once it has answered.

    Raises
    ------
    StoreRefused
        If it cannot be used; the text names the setting and how to correct it.
    """
    if settings.artifacts_url is None:
        return ArtifactStore(folder.artifacts)
    if path := shared_folder(settings):
        return _shared_store(path)
    asked = opened_bucket(settings, figures)
    from app.storage.bucket import BucketStore
    from app.storage.copies import Copies

    copies = Copies(folder.path / "copies", settings.artifact_cache_mb * 2**20)
    return BucketStore(asked, copies, figures.on_look)


def is_bucket(settings: Settings) -> bool:
    """Return whether the files are in a bucket; raise StoreRefused for an invalid URL."""
    return settings.artifacts_url is not None and _parsed(settings.artifacts_url).scheme == "s3"


def shared_folder(settings: Settings) -> Path | None:
    """Return the folder that servers share, or None; raise StoreRefused for an invalid URL."""
    if settings.artifacts_url is None or (place := _parsed(settings.artifacts_url)).scheme != "file":
        return None
    path = Path(unquote(place.path))
    if place.netloc not in ("", "localhost") or path == Path("/") or not path.is_absolute():
        raise _refused(f"it is not a folder of this machine; write {FORMS}")
    if not path.parent.is_dir():
        raise _refused(f"there is no folder {path.parent}; mount the folder that the servers share")
    return path


def _parsed(url: str) -> SplitResult:
    try:
        place = urlsplit(url)
        has_more = bool(place.query or place.fragment or place.username or place.port)
    except ValueError:
        raise _refused(f"it is not a URL; write {FORMS}") from None
    if place.scheme not in ("s3", "file"):
        raise _refused(f"its scheme is {place.scheme[:20]!r}; write {FORMS}")
    if has_more:  # it may contain keys, so the message does not quote it
        raise _refused(
            f"it contains more than a location: write {FORMS}, and put keys into AWS environment variables"
        )
    return place


def _shared_store(path: Path) -> Artifacts:
    try:
        return ArtifactStore(path, is_shared=True)
    except OSError as error:
        raise _refused(f"the folder {path} cannot be written ({error.strerror})") from None


def opened_bucket(settings: Settings, figures: Figures = NO_FIGURES) -> Bucket:
    """Return the bucket of the settings once it has answered; raise StoreRefused if it cannot be used."""
    try:
        from app.storage.s3 import Bucket
    except ImportError:
        raise _refused("files in S3 need the extra `team`: pip install 'crankwright[team]'") from None
    place = _parsed(settings.artifacts_url or "")
    if not _BUCKET.fullmatch(place.netloc):
        raise _refused(f"{place.netloc[:63]!r} is not the name of a bucket; write {FORMS}")
    if not _PREFIX.fullmatch(place.path):
        raise _refused("a prefix may contain only ASCII letters, digits and / . _ -")
    endpoint = _endpoint(settings.s3_endpoint)
    where = f"bucket {place.netloc} at {endpoint or 'Amazon'}"
    try:
        bucket = Bucket(place.netloc, place.path.strip("/") or None, endpoint, figures.on_request)
        bucket.probe()
        bucket.create(_NAME, _NOTE)
    except ArtifactsUnreachable as error:
        raise _refused(f"{where}: {error.reason}. {_remedy(error.reason)}") from None
    except Exception as error:  # the client refuses the name, the address or the environment variables
        raise _refused(
            f"{where} was refused by the S3 client ({type(error).__name__}); write {FORMS}"
        ) from None
    return bucket


def _endpoint(endpoint: str | None) -> str | None:
    if endpoint is None:
        return None
    if not _ENDPOINT.fullmatch(endpoint):  # it may contain keys, so the message does not quote it
        address = "write an address such as https://s3.example.com:9000"
        raise StoreRefused(
            f"CRANKWRIGHT_S3_ENDPOINT: {address}, and set keys in the environment variables of AWS."
        )
    return endpoint.rstrip("/")


def _remedy(reason: str) -> str:
    if "not exist" in reason:
        return "Create it, or correct CRANKWRIGHT_ARTIFACTS_URL"
    if "keys" in reason:
        return (
            "Correct AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_REGION, and let the keys list the "
            "bucket, and read, put and delete its objects"
        )
    return "Correct CRANKWRIGHT_S3_ENDPOINT, or start that server first"


def _refused(why: str) -> StoreRefused:
    return StoreRefused(f"CRANKWRIGHT_ARTIFACTS_URL: {why}.")
