"""Files that the service sends, with their names."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

import httpx

_WIDE = re.compile(r"filename\*=UTF-8''([^;\s]+)", re.IGNORECASE)
_PLAIN = re.compile(r'filename="([^"]*)"')


@dataclass(frozen=True)
class File:
    """The content and the name of a file."""

    name: str
    content: bytes

    @classmethod
    def of(cls, response: httpx.Response) -> File:
        """Return the file in a response; if the service states no name, the file is named after the path."""
        said = response.headers.get("Content-Disposition", "")
        if wide := _WIDE.search(said):
            name = unquote(wide[1])
        else:
            plain = _PLAIN.search(said)
            name = plain[1] if plain else response.url.path
        return cls(Path(name).name or "file", response.content)

    def save(self, folder: str | os.PathLike[str] = ".") -> Path:
        """Write the file into a folder, completely or not at all, and return its path."""
        path = Path(folder, self.name)
        temporary = path.with_name(f".{path.name[:200]}.part")
        temporary.write_bytes(self.content)
        os.replace(temporary, path)
        return path
