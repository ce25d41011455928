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
    """One region: its number in the sheet, what it is, where it stands on the page, and what it says.

    `top` and `left` are in the units of the sheet's page (96 to the inch in Mathcad Prime, 72 before it),
    within the area or solve block where it stands. `cached` is Mathcad's own result. `role` is that of a
    region of a solve block: a guess value, a constraint, or the solver.
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
    """A sheet's regions, where its indices begin, and which program wrote it.

    `counted` says how often the file has a region of each number, by another reading of the file.
    """

    program: Literal["Mathcad Prime", "Mathcad"]
    regions: tuple[Original, ...] = ()
    counted: Counter[str] = field(default_factory=Counter)
    origin: int = 0
    results_carry_units: bool = False
    """Whether a cached result names its whole unit; else it is a multiple of the unit that is asked for."""
    notes: tuple[str, ...] = field(default=())


def count_regions(content: bytes) -> Counter[str]:
    """Count the regions in a document by their numbers, as the parser meets their tags.

    It shares no code with the normal reader, so that each checks the other.
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
    """Return a place on the page; 0 where it is missing or no number."""
    try:
        value = float(text or 0)
    except ValueError:
        return 0.0
    return value if abs(value) < 1e9 else 0.0
