"""Published numbers: a file of tests/references, whose head states source, reading and uncertainty.

The head is made of comments. `# source: …`, `# opened: …`, `# read: …` and `# uncertainty: …` may continue on
the lines below. A line such as `# eps [1] ± 0.001 + 2 %: relative eccentricity` describes a column; a column
with an uncertainty is compared, one without is an input.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "tests" / "references"
KEYS = ("source", "opened", "read", "uncertainty")
COLUMN = re.compile(r"(\w+) \[([^\]]*)\](?: ± ([^:]+))?: (.+)")

Row = Mapping[str, str]


@dataclass(frozen=True)
class Uncertainty:
    """An absolute and a relative part of what is not known of a published number."""

    absolute: float
    relative: float

    @classmethod
    def read(cls, text: str) -> Uncertainty:
        """Return the uncertainty written as a sum, such as `0.001 + 2 %`."""
        parts = [part.strip() for part in text.split("+")]
        percent = [float(part.removesuffix("%")) / 100 for part in parts if part.endswith("%")]
        return cls(sum(float(part) for part in parts if not part.endswith("%")), sum(percent))

    def of(self, value: float) -> float:
        """Return the uncertainty of a value, in the unit of the value."""
        return self.absolute + self.relative * abs(value)


@dataclass(frozen=True)
class Column:
    """A column of published numbers; `uncertainty` is None for an input."""

    name: str
    unit: str
    words: str
    uncertainty: Uncertainty | None


@dataclass(frozen=True)
class Reference:
    """The content of one file."""

    file: str
    head: Mapping[str, str]
    columns: Mapping[str, Column]
    rows: tuple[Row, ...]

    @property
    def compared(self) -> list[Column]:
        """Return the columns that are compared with our results."""
        return [column for column in self.columns.values() if column.uncertainty]


@cache
def reference(file: str) -> Reference:
    """Return the published numbers of a file of tests/references."""
    lines = (FOLDER / file).read_text(encoding="utf-8").splitlines()
    comments = [line[1:].strip() for line in lines if line.startswith("#")]
    columns = {column.name: column for column in map(_column, comments) if column}
    rows = tuple(csv.DictReader(line for line in lines if line and not line.startswith("#")))
    return Reference(file, dict(_head(comments)), columns, rows)


def _column(comment: str) -> Column | None:
    """Return the column that a comment describes, or None."""
    found = COLUMN.fullmatch(comment)
    if found is None:
        return None
    name, unit, uncertainty, words = found.groups()
    return Column(name, unit, words, Uncertainty.read(uncertainty) if uncertainty else None)


def _head(comments: list[str]) -> Iterator[tuple[str, str]]:
    """Yield the entries of a head with the lines by which they continue."""
    begins = [n for n, comment in enumerate(comments) if _is_entry(comment) or COLUMN.fullmatch(comment)]
    for begin, end in zip(begins, [*begins[1:], len(comments)], strict=True):
        if _is_entry(comments[begin]):
            key, text = comments[begin].split(":", 1)
            yield key, " ".join([text.strip(), *comments[begin + 1 : end]])


def _is_entry(comment: str) -> bool:
    return comment.split(":")[0] in KEYS
