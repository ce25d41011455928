"""Receive uploaded files of up to `CRANKWRIGHT_UPLOAD_LIMIT`: a body goes to disk, never whole into memory.

The temporary file has no name, so the kernel frees it when the upload is complete or fails, and also if the
process is killed. Where the file system needs a name for a moment, the next start empties the folder.
"""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import AsyncIterator
from mmap import ACCESS_READ, mmap
from pathlib import Path
from tempfile import TemporaryFile

from app.http.strict_requests import StrictRequest, StrictRoute
from app.storage.errors import DiskFull

BATCH = 2**20  # bytes that are written at once


class UploadFolder:
    """The folder for bodies that are being received, and the disk space that they must leave free.

    It belongs to one server; what is there at the start is left over from a killed one.
    """

    def __init__(self, folder: Path, minimum_free_mb: int) -> None:
        self.folder, self._least = folder, minimum_free_mb * 2**20
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)

    def require_room(self, size: int) -> None:
        """Check that the disk has room for a file.

        Raises
        ------
        DiskFull
            If the file would leave less space than the server needs.
        """
        free = shutil.disk_usage(self.folder).free
        if free - size < self._least:
            raise DiskFull(size, max(0, free - self._least))

    async def receive(self, pieces: AsyncIterator[bytes], size: int) -> mmap | bytes:
        """Return the content of a file that arrives in pieces, mapped from disk; `size` is as announced.

        Raises
        ------
        DiskFull
            If the disk has no room for it.
        """
        await asyncio.to_thread(self.require_room, size)
        try:
            with TemporaryFile(dir=self.folder) as file:
                async for batch in _batches(pieces):
                    await asyncio.to_thread(file.write, batch)
                await asyncio.to_thread(file.flush)
                return mmap(file.fileno(), 0, access=ACCESS_READ) if file.tell() else b""
        except OSError as error:
            raise DiskFull(size, 0) from error


async def _batches(pieces: AsyncIterator[bytes]) -> AsyncIterator[bytes]:
    batch = bytearray()
    async for piece in pieces:
        batch += piece
        if len(batch) >= BATCH:
            yield bytes(batch)
            batch.clear()
    yield bytes(batch)


class UploadRequest(StrictRequest):
    """A request whose body is received into a file."""

    async def file(self) -> mmap | bytes:
        """Return the body, mapped from disk."""
        if not hasattr(self, "_file"):
            folder: UploadFolder = self.app.state.uploads
            size = int(self.headers.get("content-length", 0))
            self._file = await folder.receive(self.pieces(), size)
        return self._file

    async def body(self) -> bytes:
        """Return the body as one object, for a form without a file."""
        return bytes(await self.file())


class UploadRoute(StrictRoute):
    """A route whose body is an uploaded file, or a form with one."""

    request_class = UploadRequest
