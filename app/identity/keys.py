"""Keys of the interface: `cw_<prefix>_<secret>`. The database stores only their SHA-256.

A secret has 256 random bits, so a fast hash is sufficient. A slow hash only protects secrets that can be
guessed, and would let anyone keep the server busy.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
import string
from dataclasses import dataclass

from app.observation.secrets import MARK, PREFIX, SECRET, key_prefix

_LETTERS = string.ascii_lowercase + string.digits
_BYTES = 32
NO_HASH = "0" * 64
"""The hash that is compared if no key has the prefix. No text with this SHA-256 is known."""


@dataclass(frozen=True)
class NewKey:
    """A newly created key; `text` is shown once and never stored."""

    prefix: str
    text: str

    @property
    def hash(self) -> str:
        """Return the hash of the key that is stored."""
        return digest(self.text)


def new_key() -> NewKey:
    """Return a new random key."""
    prefix = "".join(secrets.choice(_LETTERS) for _ in range(PREFIX))
    secret = secrets.token_urlsafe(_BYTES)
    assert len(secret) == SECRET
    return NewKey(prefix, f"{MARK}{prefix}_{secret}")


def digest(text: str) -> str:
    """Return the SHA-256 of a key or of a session's cookie, in hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()


def is_same(text: str, stored: str) -> bool:
    """Return whether a text has a given stored hash; the comparison takes constant time."""
    return hmac.compare_digest(digest(text), stored)


__all__ = ["NO_HASH", "NewKey", "digest", "is_same", "key_prefix", "new_key"]
