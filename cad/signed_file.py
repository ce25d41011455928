"""Claims about a STEP or GLB file within the file itself, with a signature over all of its bytes.

The claims are a JSON object, whose last member is the signature, 128 hexadecimal digits:

- of a STEP file a comment at the beginning of the header: `HEADER;`, line break, `/* Crankwright stamp {…}`;
- of a GLB file the beginning of its JSON: `{"asset":{"extras":{"crankwright":{…}}`.

What is signed is `Crankwright stamp 1`, a line break, and the SHA-256 of the file with 128 zeros in place of
the signature. So no byte of the file can change, nor can a byte be added; the signature's place is fixed by
what stands before it. This module knows no keys, and does not use the kernel.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Claims = Mapping[str, Any]
Sign = Callable[[bytes], bytes]
"""Return the signature (64 bytes) of a message."""

SIGNED = ("step", "validated.step", "glb")
"""Kinds of files that can bear a signature."""
LONGEST = 2**18  # of claims [bytes]; those of a crankshaft have 3000
STEP_TITLE, GLB_TITLE = b"/* Crankwright stamp ", b'"crankwright":'
"""The text in front of the claims."""

_DOMAIN = b"Crankwright stamp 1\n"
_DIGITS = 128
_BLANK = b"0" * _DIGITS
_CHUNK = 2**20
_STEP_START, _STEP_END = b"ISO-10303-21;\nHEADER;\n", b" */\n"
_STEP = re.compile(
    re.escape(_STEP_START + STEP_TITLE)
    + rb'(\{.*?"signature": "([0-9a-f]{128})"\n\})'
    + re.escape(_STEP_END),
    re.DOTALL,
)
_GLB_OPENS = b'{"asset":{"extras":{' + GLB_TITLE
_GLB = re.compile(re.escape(_GLB_OPENS) + rb'(\{.*?"signature":"([0-9a-f]{128})"\})\}', re.DOTALL)
_GLB_START = b'{"asset":{'
_GLB_HEAD = 20  # bytes of the header of a GLB file and of its first chunk


@dataclass(frozen=True)
class SignedPart:
    """The claims of a file, and its signature with the place at which its digits begin."""

    claims: Claims
    signature: bytes
    place: int


def signed(file: bytes, kind: str, claims: Claims, sign: Sign) -> bytes:
    """Return a STEP or GLB file of this program with claims and their signature."""
    bare = _with_claims(file, kind, claims)
    part = read_part(bare[:LONGEST])
    if part is None:
        raise ValueError(f"claims may have at most {LONGEST} bytes")
    digits = sign(message(hashlib.sha256(bare).digest())).hex().encode()
    return b"".join((bare[: part.place], digits, bare[part.place + _DIGITS :]))


def message(digest: bytes) -> bytes:
    """Return what is signed of a file, given the SHA-256 of the file with zeros as signature."""
    return _DOMAIN + digest


def _with_claims(file: bytes, kind: str, claims: Claims) -> bytes:
    """Return the file with claims, and zeros as signature."""
    whole = {**claims, "signature": _BLANK.decode()}
    if kind == "glb":
        return _glb_with(file, json.dumps(whole, separators=(",", ":")).encode())
    if not file.startswith(_STEP_START):
        raise ValueError("only a STEP file of this program can be signed")
    text = json.dumps(whole, indent=0).replace("/", "\\/").encode()  # so no text can end the comment
    return b"".join((_STEP_START, STEP_TITLE, text, _STEP_END, file[len(_STEP_START) :]))


def _glb_with(file: bytes, claims: bytes) -> bytes:
    """Return the GLB file with claims at the beginning of its JSON, which is padded to four bytes."""
    end = _GLB_HEAD + int.from_bytes(file[12:16], "little")
    text, rest = file[_GLB_HEAD:end].rstrip(b" "), file[end:]
    if not text.startswith(_GLB_START):
        raise ValueError("only a GLB file of this program can be signed")
    text = b"".join((_GLB_OPENS, claims, b"},", text[len(_GLB_START) :]))
    text += b" " * (-len(text) % 4)
    lengths = (2, _GLB_HEAD + len(text) + len(rest), len(text))
    version, whole, length = (number.to_bytes(4, "little") for number in lengths)
    return b"".join((b"glTF", version, whole, length, b"JSON", text, rest))


def read_part(head: bytes) -> SignedPart | None:
    """Return the claims and the signature at the beginning of a file; None if they are not at their place."""
    match = _GLB.match(head, _GLB_HEAD) if head.startswith(b"glTF") else _STEP.match(head)
    if match is None:
        return None
    try:
        claims = json.loads(match[1])
    except (ValueError, RecursionError):
        return None
    digits = match[2].decode()
    if not isinstance(claims, dict) or claims.pop("signature", None) != digits:
        return None
    return SignedPart(claims, bytes.fromhex(digits), match.start(2))


def digest_of(path: Path, part: SignedPart) -> bytes:
    """Return the SHA-256 of a file with zeros in place of its signature, in bounded memory."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        digest.update(file.read(part.place))
        digest.update(_BLANK)
        file.seek(part.place + _DIGITS)
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    return digest.digest()


def without_claims(step: bytes) -> bytes:
    """Return a STEP file without claims, whether or not they are signed."""
    head = _STEP_START + STEP_TITLE
    end = step.find(b"*/", len(head)) if step.startswith(head) else -1
    return step if end < 0 else _STEP_START + step[end + 3 :]
