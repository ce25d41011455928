"""Arrays as an `.npz` file whose bytes depend only on its contents, not on the date."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterable, Mapping
from typing import IO

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from app.plain import JsonObject
from app.storage.tables import canonical_json
from app.workers.pieces import Pieces

AnyArray = NDArray[np.generic]
_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest date that a ZIP file can store
_ABOUT = "about"


def packed(arrays: Mapping[str, AnyArray], about: Mapping[str, object] | None = None) -> Pieces:
    """Return an archive of arrays and an optional JSON object as bytes; equal contents give equal bytes."""
    stream = io.BytesIO()
    write(stream, arrays, about)
    return Pieces.of(stream.getvalue())


def write(
    stream: IO[bytes], arrays: Mapping[str, AnyArray], about: Mapping[str, object] | None = None
) -> None:
    """Write an archive of arrays and an optional JSON object to a file."""
    write_each(stream, ((name, arrays[name]) for name in sorted(arrays)), about)


def write_each(
    stream: IO[bytes], arrays: Iterable[tuple[str, AnyArray]], about: Mapping[str, object] | None = None
) -> None:
    """Write an archive one array after another, so that not all arrays must be in memory."""
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays:
            _write_member(archive, name, np.ascontiguousarray(array))
        if about is not None:
            _write_member(archive, _ABOUT, np.frombuffer(canonical_json(about).encode(), dtype=np.uint8))


def _write_member(archive: zipfile.ZipFile, name: str, array: AnyArray) -> None:
    info = zipfile.ZipInfo(f"{name}.npy", _DATE)
    info.external_attr = 0o600 << 16
    with archive.open(info, "w", force_zip64=True) as member:
        npy.write_array(member, array, allow_pickle=False)


class Archive:
    """An archive that is read array by array, on request."""

    def __init__(self, source: IO[bytes] | bytes) -> None:
        self._source = io.BytesIO(source) if isinstance(source, bytes) else source
        self._file = zipfile.ZipFile(self._source)

    def __enter__(self) -> Archive:
        return self

    def __exit__(self, *exception: object) -> None:
        self._file.close()
        self._source.close()

    @property
    def names(self) -> list[str]:
        """Return the names of the arrays, without the JSON object."""
        members = (name.removesuffix(".npy") for name in self._file.namelist())
        return [name for name in members if name != _ABOUT]

    def __contains__(self, name: str) -> bool:
        return f"{name}.npy" in self._file.NameToInfo

    def __getitem__(self, name: str) -> AnyArray:
        with self._file.open(f"{name}.npy") as member:
            array: AnyArray = npy.read_array(member, allow_pickle=False)
        return array

    def about(self) -> JsonObject:
        """Return the JSON object stored with the arrays; empty if there is none."""
        if _ABOUT not in self:
            return {}
        about: JsonObject = json.loads(self[_ABOUT].tobytes())
        return about
