"""Each random Mathcad sheet becomes a readable draft or is refused.

`CRANKWRIGHT_TEST_FUZZ` says how many, 10⁵ at night.
"""

import os
import random

import pytest
from mathcad_files import (
    Region,
    apply,
    call,
    define,
    define_function,
    legacy,
    legacy_math,
    name,
    packed,
    parts_of,
    real,
    scale,
    shown,
    tag,
    text,
    united,
    vector,
    words,
)
from seeds import seeded

from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.job import imported
from templates.core.sheets import read

COUNT = int(os.environ.get("CRANKWRIGHT_TEST_FUZZ", "2000"))
STATES = {"verified", "differs", "unverified", "shown", "refused", "blocked"}
NAMES = ["x", "y_1", "F", "σ", "if", "Sum", "level", "m", "a.b", "\u202ex", "T"]
UNITS = ["mm", "kN", "MPa", "degC", "nonsense", "m"]
OPERATORS = [
    "plus",
    "minus",
    "mult",
    "div",
    "pow",
    "equal",
    "lessThan",
    "and",
    "indexer",
    "vectorize",
    "nthRoot",
]
FUNCTIONS = ["sin", "if", "linterp", "max", "rows", "mean", "f", "Find", "augment", "exp", "root"]
NUMBERS = ["0", "1", "-2.5", "1e308", "1e-320", "NaN", "2", "10", "3,5", ""]


def expression(chance, depth):
    """A random tree of Mathcad's elements."""
    if depth == 0 or chance.random() < 0.25:
        leaves = (
            lambda: real(chance.choice(NUMBERS)),
            lambda: name(chance.choice(NAMES)),
            lambda: scale(chance.choice(NUMBERS), chance.choice(UNITS)),
            lambda: text(chance.choice(NAMES)),
        )
        return chance.choice(leaves)()
    parts = [expression(chance, depth - 1) for _ in range(chance.choice([1, 2, 2, 3]))]
    trees = (
        lambda: apply(chance.choice(OPERATORS), *parts),
        lambda: call(chance.choice(FUNCTIONS), *parts),
        lambda: vector(*parts),
        lambda: tag(chance.choice(["program", "range", "parens", "summation", "integral", "ifThen"]), *parts),
    )
    return chance.choice(trees)()


def body(chance):
    """The contents of a region."""
    value = expression(chance, chance.randint(0, 4))
    kinds = (
        lambda: define(chance.choice(NAMES), value),
        lambda: define_function("f", chance.sample(NAMES, 2), value),
        lambda: shown(value),
        lambda: value,
    )
    return chance.choice(kinds)()


def region(chance):
    if chance.random() < 0.1:
        return words(chance.choice(NAMES))
    result = real(chance.choice(NUMBERS))
    results = ["", result, united(result, meter=chance.randint(-3, 3))]
    return Region(body(chance), chance.choice(results), chance.choice(["", "", "input", "output"]))


def changed(content, chance):
    """A text with some of its pieces taken out, doubled or put elsewhere."""
    for _ in range(chance.choice([0, 0, 1, 3])):
        first, last = sorted(chance.randrange(len(content) + 1) for _ in range(2))
        last = min(last, first + 60)
        piece, place = content[first:last], chance.randrange(len(content) + 1)
        rest = content[:first] + content[last:]
        content = chance.choice([rest, content[:place] + piece + content[place:]])
    return content


def sheet(chance):
    """A file, mostly of Mathcad Prime."""
    count = chance.randint(1, 6)
    if chance.random() < 0.2:
        bodies = [legacy_math(body(chance)) for _ in range(count)]
        return changed(legacy(*bodies).decode(), chance).encode()
    parts = parts_of(*(region(chance) for _ in range(count)), origin=chance.choice([0, 1]))
    return packed(
        {key: changed(part, chance) if isinstance(part, str) else part for key, part in parts.items()}
    )


def is_accepted(content):
    try:
        sheet = imported(content, "Sheet")
    except SheetNotRead:
        return False
    read(sheet.text)
    assert {one["state"] for one in sheet.record["regions"]} <= STATES
    return True


def fuzz(count, number):
    chance = random.Random(seeded(number))
    accepted = sum(is_accepted(sheet(chance)) for _ in range(count))
    assert accepted >= count // 10, "hardly any file is a sheet"


def test_random_sheets_of_mathcad():
    fuzz(50, 1)


@pytest.mark.slow
def test_many_random_sheets_of_mathcad():
    fuzz(COUNT, 2)
