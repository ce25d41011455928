"""The Ed25519 keys with which the service signs the stamps of STEP and GLB files.

The folder of the keys contains the private key in use, `key.pem`, which only its owner may read, and
`public.json`, all public keys with the dates from and until which they were in use. A public key is written
`ed25519:` with 64 hexadecimal digits; its id is the first 16 digits of its SHA-256.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    load_pem_private_key,
)

from app.settings import Settings
from app.storage.clock import now
from app.storage.engines import sqlite_file
from app.storage.errors import StorageError

FOLDER = "stamp-keys"
PRIVATE, PUBLIC = "key.pem", "public.json"
_WRITTEN = re.compile(r"ed25519:([0-9a-f]{64})")


class UnusableKey(StorageError):
    """A file of the keys cannot be read."""

    def __init__(self, path: Path, error: Exception) -> None:
        remedy = f"restore your copy of it, or move the folder {path.parent.name} aside to get a new key"
        super().__init__(f"the stamp keys in {path} cannot be used ({error}): {remedy}")


@dataclass(frozen=True)
class PublicKey:
    """A public key, and from when until when the service signed with it (UTC); no end while it does."""

    public: str
    since: str | None = None
    until: str | None = None

    @staticmethod
    def of(private: Ed25519PrivateKey) -> PublicKey:
        """Return the public key of a private one."""
        return PublicKey(f"ed25519:{private.public_key().public_bytes_raw().hex()}")

    @property
    def raw(self) -> bytes:
        """Return the 32 bytes of the key."""
        return bytes.fromhex(self.public.removeprefix("ed25519:"))

    @property
    def id(self) -> str:
        """Return the short name by which a stamp names its key."""
        return hashlib.sha256(self.raw).hexdigest()[:16]

    def accepts(self, signature: bytes, message: bytes) -> bool:
        """Return whether this key made the signature."""
        try:
            Ed25519PublicKey.from_public_bytes(self.raw).verify(signature, message)
        except (InvalidSignature, ValueError):
            return False
        return True


def public_keys_in(text: str) -> list[PublicKey]:
    """Return the public keys in a text, such as the answer of `/stamp-keys`, each once."""
    return [PublicKey(f"ed25519:{digits}") for digits in dict.fromkeys(_WRITTEN.findall(text))]


class StampKeys:
    """The keys in a folder. Several servers may share it; a rotation takes effect at the next signature."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._loaded: tuple[tuple[int, int], Ed25519PrivateKey] | None = None

    def exist(self) -> bool:
        """Return whether there is a private key."""
        return (self.folder / PRIVATE).exists()

    def create(self) -> None:
        """Create the first key if there is none; of several servers that do so, one wins.

        Raises
        ------
        OSError
            If the folder cannot hold it.
        """
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not self.exist():
            self._take(self._written(_pem(Ed25519PrivateKey.generate())))
        with suppress(OSError):  # a folder that is mounted for reading only
            self._record(self.current)

    def _take(self, new: Path) -> None:
        """Give a new key its name, unless there is a key meanwhile."""
        try:
            os.link(new, self.folder / PRIVATE)
        except OSError:  # there is a key, or the file system has no links
            if not self.exist():
                os.replace(new, self.folder / PRIVATE)
        finally:
            new.unlink(missing_ok=True)

    def rotate(self) -> PublicKey:
        """Replace the private key by a new one, and return its public key; the old public key is kept."""
        self.create()
        private = Ed25519PrivateKey.generate()
        new = self._written(_pem(private))
        self._record(PublicKey.of(private))
        os.replace(new, self.folder / PRIVATE)
        return self.current

    def sign(self, message: bytes) -> bytes:
        """Return the signature of a message by the key in use."""
        return self._private().sign(message)

    @property
    def current(self) -> PublicKey:
        """Return the public key in use, without its dates; raises UnusableKey."""
        return PublicKey.of(self._private())

    def public(self) -> list[PublicKey]:
        """Return all public keys, the one in use first; raises UnusableKey."""
        stored, current = self._stored(), self.current
        recorded = next((key for key in stored if key.public == current.public), current)
        return [replace(recorded, until=None), *(key for key in stored if key.public != current.public)]

    def _private(self) -> Ed25519PrivateKey:
        """Return the private key; it is read again if the file has changed, and kept if that fails."""
        path = self.folder / PRIVATE
        try:
            stat = path.stat()
            seen = stat.st_mtime_ns, stat.st_ino
            if self._loaded is None or self._loaded[0] != seen:
                self._loaded = seen, _private_in(path.read_bytes())
        except (OSError, ValueError) as error:
            if self._loaded is None:
                raise UnusableKey(path, error) from None
        return self._loaded[1]

    def _stored(self) -> list[PublicKey]:
        try:
            listed = json.loads((self.folder / PUBLIC).read_text(encoding="ascii"))
            return [PublicKey(one["public"], one["since"], one["until"]) for one in listed]
        except FileNotFoundError:
            return []
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise UnusableKey(self.folder / PUBLIC, error) from None

    def _record(self, current: PublicKey) -> None:
        """Record the public key in use from now on, and the end of those before it."""
        stored, time = self._stored(), now()
        if stored and stored[0].public == current.public:
            return
        ended = [replace(key, until=key.until or time) for key in stored if key.public != current.public]
        text = json.dumps([asdict(key) for key in (replace(current, since=time), *ended)], indent=1)
        os.replace(self._written(text.encode()), self.folder / PUBLIC)

    def _written(self, data: bytes) -> Path:
        """Write a file of the folder under a name of its own, which only its owner may read; sync it."""
        descriptor, name = tempfile.mkstemp(dir=self.folder, prefix=".new-")
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        return Path(name)


def folder_of(settings: Settings) -> Path | None:
    """Return the folder of the keys; None if servers share a database and no folder of keys is set."""
    if settings.stamp_keys is not None:
        return settings.stamp_keys
    url = settings.database_url
    return settings.data / FOLDER if url is None or sqlite_file(url) is not None else None


def opened_keys(settings: Settings) -> StampKeys | None:
    """Return the keys of a service, and create the first one; None if its files stay unsigned.

    Raises
    ------
    OSError, UnusableKey
        If there is a folder of keys that cannot be used.
    """
    if (folder := folder_of(settings)) is None:
        return None
    keys = StampKeys(folder)
    keys.create()
    return keys


def _pem(private: Ed25519PrivateKey) -> bytes:
    return private.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())


def _private_in(pem: bytes) -> Ed25519PrivateKey:
    private = load_pem_private_key(pem, None)
    if not isinstance(private, Ed25519PrivateKey):
        raise ValueError("it is not an Ed25519 key")
    return private


def joined(keys: Iterable[PublicKey]) -> dict[str, PublicKey]:
    """Return public keys by their ids."""
    return {key.id: key for key in keys}
