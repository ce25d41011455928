"""Headers and responses of downloads: the file name, the ETag, and bytes sent as a file."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Mapping
from datetime import UTC, datetime
from email.utils import format_datetime
from urllib.parse import quote

from fastapi import Response
from fastapi.responses import FileResponse
from starlette.types import Receive, Scope, Send

from cad.file_names import name as wide_name
from cad.file_names import plain_name


def disposition(plain: str, wide: str, how: str = "attachment") -> str:
    """Return the Content-Disposition with the name in ASCII and in Unicode (RFC 6266, RFC 8187)."""
    return f"{how}; filename=\"{plain}\"; filename*=UTF-8''{quote(wide, safe='')}"


def named(design: str, revision: int, kind: str, how: str) -> str:
    """Return the Content-Disposition of a file for a whole design: `{design}_r{revision}.{kind}`."""
    tail = f"_r{revision}.{kind}"
    return disposition(plain_name(design) + tail, wide_name(design) + tail, how)


def tag(file: bytes) -> str:
    """Return a strong ETag; equal bytes have equal tags."""
    return f'"{hashlib.sha256(file).hexdigest()}"'


def is_at_hand(if_none_match: str | None, etag: str) -> bool:
    """Return whether the client already has a file, judged by the ETags that the client sent."""
    tags = (one.strip().removeprefix("W/") for one in (if_none_match or "").split(","))
    return any(one in (etag, "*") for one in tags)


def unchanged(headers: Mapping[str, str]) -> Response:
    """Return a 304 response with the headers of a 200, except those that describe its body."""
    kept = {name: value for name, value in headers.items() if name != "Content-Disposition"}
    return Response(status_code=304, headers=kept)


def http_time(date: str) -> str:
    """Return a UTC time (ISO 8601, without a zone) in the format of HTTP."""
    return format_datetime(datetime.fromisoformat(date).replace(tzinfo=UTC), usegmt=True)


class MemoryFile(FileResponse):
    """Bytes in memory that are sent like a file, whole or in ranges."""

    def __init__(self, content: bytes, media_type: str, headers: Mapping[str, str]) -> None:
        super().__init__("", media_type=media_type, headers=headers)
        self._content = content

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the content from an unnamed temporary file, which is deleted when it is closed."""
        with tempfile.TemporaryFile() as file:
            file.write(self._content)
            file.flush()
            self.path = f"/dev/fd/{file.fileno()}"
            self.stat_result = os.fstat(file.fileno())
            self.set_stat_headers(self.stat_result)
            await super().__call__(scope, receive, send)
