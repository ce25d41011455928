"""Parse the fields and files of a form sent as `multipart/form-data` (RFC 7578), as browsers upload files.

The service's forms send one file each, and the size of the body is limited, so the whole body is split at
once.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from mmap import mmap

from fastapi import Request

from app.http.access import FORM_TOKEN
from app.http.strict_requests import FORM_TYPES, NotForm, StrictRequest, check_type
from app.web.shared.forms import fields
from app.web.shared.session import FIELD, check_form_token

MEDIA_TYPE = "multipart/form-data"
MOST_PARTS = 50
_BREAK = b"\r\n"
_BOUNDARY = re.compile(r'boundary=(?:"([^"\r\n]{1,70})"|([^\s";,]{1,70}))')
_NAME = re.compile(rb'[;\s]name="([^"\r\n]{0,200})"')
_FILE = re.compile(rb'[;\s]filename="([^"\r\n]{0,500})"')


@dataclass(frozen=True)
class Part:
    """A field of a form, or a file with its name."""

    content: memoryview
    file: str | None = None

    @property
    def text(self) -> str:
        """Return the content of a field."""
        return bytes(self.content).decode(errors="replace")


async def forms_with_files(request: Request) -> None:
    """Accept only bodies that are forms, with or without files.

    Within a session, only forms from its own pages are accepted.
    """
    check_type(request, FORM_TYPES | {MEDIA_TYPE}, NotForm)
    if request.scope.get(FORM_TOKEN):
        parts = await parts_of(request)
        texts = {FIELD: parts[FIELD].text} if FIELD in parts else await fields(request)
        check_form_token(request, texts)


async def parts_of(request: Request) -> dict[str, Part]:
    """Return the parts of a form that was sent with a file; none for a form without files."""
    body = await (request.file() if isinstance(request, StrictRequest) else request.body())
    return read_parts(body, request.headers.get("content-type", ""))


def read_parts(body: bytes | mmap, content_type: str) -> dict[str, Part]:
    """Return the parts of a form by name, in time linear in the length of the body.

    Bytes outside the parts are ignored.
    """
    boundary = _BOUNDARY.search(content_type)
    if boundary is None:
        return {}
    mark = b"--" + (boundary[1] or boundary[2]).encode("latin-1", "replace")
    parts: dict[str, Part] = {}
    for start, end in islice(_places(body, mark), MOST_PARTS):
        blank = body.find(b"\r\n\r\n", start, end)
        head = body[start:blank] if blank >= 0 else b""
        if name := _NAME.search(head):
            file = _FILE.search(head)
            content = memoryview(body)[blank + 4 : end]
            parts[name[1].decode(errors="replace")] = Part(content, file and file[1].decode(errors="replace"))
    return parts


def _places(body: bytes | mmap, mark: bytes) -> Iterator[tuple[int, int]]:
    """Yield where the parts between the marks of a form begin and end."""
    at = 0 if body[: len(mark)] == mark else _after(body, mark, 0)
    while at is not None and body[at + len(mark) : at + len(mark) + 2] != b"--":
        start, at = at + len(mark), _after(body, mark, at + len(mark))
        yield start, len(body) if at is None else at - len(_BREAK)


def _after(body: bytes | mmap, mark: bytes, start: int) -> int | None:
    """Return where the next mark begins, which follows a line break; None if there is none."""
    at = body.find(_BREAK + mark, start)
    return None if at < 0 else at + len(_BREAK)
