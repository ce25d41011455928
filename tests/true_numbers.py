"""Finds sentences that compare two numbers, and checks whether they are true."""

import re

_NUMBER = re.compile(r"(?<![\w.])[-−]?\d[\d.]*(?:e[-+]?\d+)?(?![\w/])")  # not the 1 of the unit 1/mm³
_RELATION = re.compile(r" is (not below|below|not above|above) ")
_COUNTED = re.compile(r" \((?:worst|one) of [^)]*\)")
_PARTS = re.compile(
    r"; | \(–: |: (?=met|not met|undecided|not checked)"
)  # reasons follow points without a value
TRUE_OF = {
    "below": lambda one, other: one < other,
    "not below": lambda one, other: one >= other,
    "above": lambda one, other: one > other,
    "not above": lambda one, other: one <= other,
}


def comparisons(text):
    """Each comparison of a text: the number before, the relation in words, the number behind, its part.

    A side is a value behind its words, `0.98 · pin diameter = 47.04 mm`: its last number counts.
    """
    for part in _PARTS.split(_COUNTED.sub("", text)):
        relation = _RELATION.search(part)
        if relation is None or _RELATION.search(part, relation.end()):
            continue
        left, right = _NUMBER.findall(part[: relation.start()]), _NUMBER.findall(part[relation.end() :])
        if left and right:
            yield _float(left[-1]), relation[1], _float(right[-1]), part


def _float(text):
    return float(text.replace("−", "-").rstrip("."))


def assert_true_of_its_numbers(sentence):
    """Every comparison in a sentence is true of the numbers beside it; how many there are."""
    count = 0
    for one, relation, other, part in comparisons(sentence):
        assert TRUE_OF[relation](one, other), part
        count += 1
    return count
