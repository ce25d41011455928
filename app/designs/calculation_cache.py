"""Calculations of saves, for the jobs that continue them: a design is calculated once."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from typing import NamedTuple

from app.calculations.cache import Cache
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.plain import Json
from app.storage.tables import canonical_json

MEGABYTES = 32
BYTES = 128
"""Taken for one character of a document: of the designs in the gallery 36 to 104 bytes of its calculation."""


class Prepared(NamedTuple):
    """A document as it was read, and what could be calculated of it."""

    document: Document
    calculation: Calculation


class CalculationCache:
    """The latest calculations that wait for a solid, by their documents.

    It belongs to one application: it counts on the catalogues and on the database of that. A calculation that
    is not here any more, or that another process did, is done again from the document.
    """

    def __init__(self, cache: Cache | None = None) -> None:
        self._cache = cache or Cache(MEGABYTES)

    def keep(self, plain: Mapping[str, Json], prepared: Prepared) -> None:
        """Keep the calculation of a document, which is given as JSON too."""
        text = canonical_json(plain).encode()
        self._cache.keep(_digest(text), prepared, BYTES * len(text))

    def find(self, plain: Mapping[str, Json]) -> Prepared | None:
        """Return the calculation of a document that was saved lately."""
        prepared: Prepared | None = self._cache.get(_digest(canonical_json(plain).encode()))
        return prepared


def _digest(text: bytes) -> bytes:
    return sha256(text).digest()
