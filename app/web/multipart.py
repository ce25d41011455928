"""The fields and files of a form that was sent as `multipart/form-data` (RFC 7578): how a browser uploads.

Our forms send one file each, so that the whole body, which the service bounds, is split at once.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

MEDIA_TYPE = "multipart/form-data"
MOST_PARTS = 50
_BOUNDARY = re.compile(r'boundary=(?:"([^"\r\n]{1,70})"|([^\s";,]{1,70}))')
_NAME = re.compile(rb'[;\s]name="([^"\r\n]{0,200})"')
_FILE = re.compile(rb'[;\s]filename="([^"\r\n]{0,500})"')


@dataclass(frozen=True)
class Part:
    """A field of a form, or a file with its name."""

    content: bytes
    file: str | None = None

    @property
    def text(self) -> str:
        """The content of a field."""
        return self.content.decode(errors="replace")


def read_parts(body: bytes, content_type: str) -> dict[str, Part]:
    """The parts of a form by name; linear in the length of the body. What is no part is left out."""
    boundary = _BOUNDARY.search(content_type)
    if boundary is None:
        return {}
    mark = b"\r\n--" + (boundary[1] or boundary[2]).encode("latin-1", "replace")
    parts: dict[str, Part] = {}
    for piece in (b"\r\n" + body).split(mark, MOST_PARTS)[1:]:
        if piece.startswith(b"--"):
            break
        head, blank, content = piece.partition(b"\r\n\r\n")
        if blank and (name := _NAME.search(head)):
            file = _FILE.search(head)
            parts[name[1].decode(errors="replace")] = Part(content, file and file[1].decode(errors="replace"))
    return parts
