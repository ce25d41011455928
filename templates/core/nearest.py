"""The declared names nearest to an unknown one, at a bounded cost whatever the names are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from difflib import get_close_matches
from heapq import nlargest
from itertools import islice

MOST_COMPARED, SHORTLIST, LONGEST_NAME = 1000, 10, 80


def nearest(name: str, declared: Iterable[str]) -> list[str]:
    """Return at most three names that are close to `name`, the closest first.

    `difflib` takes the square of the length, so it sees only the names that share most letters with this one.
    """
    letters = Counter(name[:LONGEST_NAME])
    compared = islice(declared, MOST_COMPARED)
    likely = nlargest(SHORTLIST, compared, key=lambda other: _shared(letters, other[:LONGEST_NAME]))
    return get_close_matches(name[:LONGEST_NAME], likely, n=3)


def _shared(letters: Counter[str], other: str) -> float:
    """Return the share of letters that two names have in common, in any order."""
    return 2 * (letters & Counter(other)).total() / max(1, letters.total() + len(other))
