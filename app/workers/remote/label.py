"""The label of a program version: jobs go only to machines that run the same program.

During an upgrade, servers and machines of both versions can share one scheduler.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator
from functools import cache
from importlib.metadata import version
from pathlib import Path

import cad
import templates
from app.workers.base import Lane

LIBRARIES = ("distributed", "cadquery", "cadquery-ocp", "netgen-mesher", "ngsolve", "numpy", "scipy")
"""Packages that transport jobs, and packages on which results depend."""
_PACKAGES = (Path(__file__).parents[2], Path(cad.__file__).parent, Path(templates.__file__).parent)


@cache
def program() -> str:
    """Return a digest of this program's files, including the recipe of solids, and of its libraries."""
    libraries = [(name, version(name)) for name in LIBRARIES]
    digest = hashlib.sha256(json.dumps([sys.version_info[:2], libraries]).encode())
    for name, file in _files():
        content = file.read_bytes()
        digest.update(f"{name} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def label(lane: Lane, of: str) -> str:
    """Return the Dask resource of a lane and a program's digest, which machines offer and jobs require."""
    return f"{lane}-{of[:12]}"


def _files() -> Iterator[tuple[str, Path]]:
    for package in _PACKAGES:
        for file in sorted(package.rglob("*")):
            if file.is_file() and "__pycache__" not in file.parts:
                yield str(file.relative_to(package.parent)), file
