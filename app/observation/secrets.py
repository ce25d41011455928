"""Remove secrets, such as keys of the interface, from log lines and responses."""

from __future__ import annotations

import re

MARK = "cw_"
PREFIX, SECRET = 10, 43  # characters of a key's name, and of 32 random bytes as base64url
LENGTH = len(MARK) + PREFIX + 1 + SECRET
_KEY = re.compile(rf"{MARK}([a-z0-9]{{{PREFIX}}})_[A-Za-z0-9_-]{{{SECRET}}}")


def key_prefix(text: str) -> str | None:
    """Return the prefix of a key; None if the text does not have the form of a key."""
    match = _KEY.fullmatch(text) if len(text) == LENGTH else None
    return match[1] if match else None


def holds_key(text: str) -> bool:
    """Return whether a text contains a key."""
    return MARK in text and _KEY.search(text) is not None


def without_keys(text: str) -> str:
    """Return a text in which each key is shortened to its prefix."""
    return _KEY.sub(rf"{MARK}\1_***", text) if MARK in text else text
