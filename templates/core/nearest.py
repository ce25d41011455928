"""Find the declared names nearest to an unknown name, at a bounded cost for any names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache
from heapq import nlargest
from itertools import islice

MOST_COMPARED, SHORTLIST, LONGEST_NAME = 1000, 10, 80


def nearest(name: str, declared: Iterable[str]) -> list[str]:
    """Return at most three names similar to `name`, the most similar first.

    The cost of `difflib` grows with the square of the length, so it compares only the names that share most
    letters with `name`.
    """
    letters = Counter(name[:LONGEST_NAME])
    compared = islice(declared, MOST_COMPARED)
    likely = nlargest(SHORTLIST, compared, key=lambda other: _shared(letters, other[:LONGEST_NAME]))
    return get_close_matches(name[:LONGEST_NAME], likely, n=3)


def _shared(letters: Counter[str], other: str) -> float:
    """Return the fraction of letters that two names have in common, in any order."""
    return 2 * (letters & _letters(other)).total() / max(1, letters.total() + len(other))


@lru_cache(maxsize=4 * MOST_COMPARED)
def _letters(name: str) -> Counter[str]:
    return Counter(name)
