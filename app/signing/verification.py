"""Verify the signed stamp of a STEP or GLB file, without a service and in time linear in its size.

A file is accepted only if a given public key signed exactly these bytes. All other verdicts are refusals;
they tell the usual causes apart, but a forger can choose among them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import dropwhile
from pathlib import Path
from typing import Literal

from app.signing.keys import PublicKey, joined
from cad.header import read_header
from cad.part21 import plain, tokens
from cad.signed_file import (
    GLB_TITLE,
    LONGEST,
    STEP_TITLE,
    Claims,
    SignedPart,
    digest_of,
    message,
    read_part,
)

Kind = Literal["valid", "tampered", "other_key", "unsigned", "re_exported", "unreadable"]
EXIT_CODES: dict[Kind, int] = {
    "valid": 0, "tampered": 1, "other_key": 3, "unsigned": 4, "re_exported": 5, "unreadable": 6,
}  # fmt: skip
"""Exit codes of `crankwright verify`; 2 is a wrong command line."""

_CHUNK = 2**20
_TRACE = b"crankwright"
_ISO, _GLTF = b"ISO-10303-21", b"glTF"


@dataclass(frozen=True)
class Verdict:
    """The verdict on a file, in a sentence; its claims are proven only if it is valid."""

    kind: Kind
    words: str
    claims: Claims | None = None
    key: PublicKey | None = None


def verify(path: Path, keys: Iterable[PublicKey]) -> Verdict:
    """Return the verdict on a file, for which these public keys may sign.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(LONGEST)
    if not head.startswith(_GLTF) and not head.lstrip().startswith(_ISO):
        return Verdict("unreadable", "this is neither a STEP nor a GLB file")
    if (part := read_part(head)) is not None:
        return _of_signature(part, message(digest_of(path, part)), joined(keys))
    return _without_signature(path, head)


def _of_signature(part: SignedPart, signed: bytes, keys: dict[str, PublicKey]) -> Verdict:
    for key in keys.values():
        if key.accepts(part.signature, signed):
            return Verdict("valid", f"every byte is as key {key.id} signed it", part.claims, key)
    named = str(part.claims.get("key"))[:16]
    if named in keys:
        return Verdict("tampered", f"the file has changed since key {named} signed it", part.claims)
    given = ", ".join(keys) or "no key"
    words = f"its stamp names key {named}, you trust {given}; so nothing in it is proven"
    return Verdict("other_key", words, part.claims)


def _without_signature(path: Path, head: bytes) -> Verdict:
    """Return the verdict on a file without a signature at its place."""
    if _is_own(head):
        if STEP_TITLE in head or GLB_TITLE in head:
            return Verdict("tampered", "its stamp is damaged, so its signature cannot be read")
        return Verdict("unsigned", "Crankwright wrote this file, but it bears no signed stamp")
    program = _program(head)
    if _has_trace(path):
        words = "another program wrote this file from one of Crankwright; the signature did not survive"
        return Verdict("re_exported", f"{words} ({program})")
    return Verdict("unsigned", f"the file bears neither a stamp nor another trace of Crankwright ({program})")


def _is_own(head: bytes) -> bool:
    """Return whether the header of a file is one that this program writes."""
    if head.startswith(_GLTF):
        return b'"generator":"Crankwright"' in head
    return read_header(head) is not None


def _program(head: bytes) -> str:
    """Return the program that the header of a file names, in words."""
    if head.startswith(_GLTF):
        named = re.search(rb'"generator"\s*:\s*"([^"\\]{1,80})"', head)
        return f"written by {named[1].decode('utf-8', 'replace')}" if named else "its program is not named"
    programs = [text[:80] for text in _file_name(head)[2:4] if text.strip()]
    return f"written by {', '.join(programs)}" if programs else "its program is not named"


def _file_name(head: bytes) -> list[str]:
    """Return the texts of FILE_NAME that are in no list: name, time, preprocessor, originating system."""
    scan = tokens(head.decode("latin-1"))
    texts, depth = list[str](), 0
    for token in dropwhile(lambda token: token not in ("FILE_NAME", "ENDSEC"), scan):
        depth += {"(": 1, ")": -1}.get(token, 0)
        if token.startswith("'") and depth == 1:
            texts.append(plain(token))
        if token == ";":
            break
    return texts


def _has_trace(path: Path) -> bool:
    """Return whether a file mentions this program anywhere."""
    with path.open("rb") as file:
        last = b""
        while chunk := file.read(_CHUNK):
            if _TRACE in (last + chunk).lower():
                return True
            last = chunk[-len(_TRACE) :]
    return False
