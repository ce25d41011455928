"""A sheet as Mathcad wrote it: its regions in the order in which Mathcad calculates them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Literal
from xml.parsers import expat

from app.worksheets.imports.trees import Node

Kind = Literal["math", "text", "plot", "picture", "table", "solve block", "area", "page break", "other"]
Tag = Literal["", "input", "output"]

MOST_REGIONS = 2_000
MATHEMATICAL: frozenset[Kind] = frozenset({"math"})


def number_of(text: str | None) -> str:
    """Return the displayed number of a region."""
    return (text or "")[:20]


@dataclass(frozen=True)
class Original:
    """One region: its number in the sheet, its kind, its position on the page, and its content.

    `top` and `left` are in the units of the sheet's page (96 per inch in Mathcad Prime, 72 in earlier
    versions), relative to the area or solve block that contains the region. `cached` is Mathcad's own result.
    `role` is the role of a region in a solve block: guess value, constraint, or solver.
    """

    number: str
    kind: Kind
    top: float
    left: float
    math: Node | None = None
    cached: Node | None = None
    text: str = ""
    tag: Tag = ""
    alias: str = ""
    role: str = ""
    block: str = ""
    failed: bool = False


@dataclass(frozen=True)
class OriginalSheet:
    """The regions of a sheet, the first index of its lists, and the program that wrote it.

    `counted` gives how often each region number occurs in the file, found by an independent reading.
    """

    program: Literal["Mathcad Prime", "Mathcad"]
    regions: tuple[Original, ...] = ()
    counted: Counter[str] = field(default_factory=Counter)
    origin: int = 0
    results_carry_units: bool = False
    """Whether a cached result includes its whole unit; if not, it is a multiple of the requested unit."""
    notes: tuple[str, ...] = field(default=())


def count_regions(content: bytes) -> Counter[str]:
    """Count the regions in a document by their numbers, from the tags that the parser reports.

    The function shares no code with the normal reader, so that each of them checks the other.
    """
    counted = Counter[str]()

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag.rpartition(":")[2] == "region":
            counted[number_of(attributes.get("region-id"))] += 1

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    parser.Parse(content, True)
    return counted


def coordinate(text: str | None) -> float:
    """Return a coordinate on the page; 0 if it is missing or not a number."""
    try:
        value = float(text or 0)
    except ValueError:
        return 0.0
    return value if abs(value) < 1e9 else 0.0
