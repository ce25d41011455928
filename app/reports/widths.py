"""Upper bounds of the widths of formulas on paper, so that the typesetter measures only wide formulas.

To find whether a formula fits its line, the typesetter sets it once to measure it and once to print it. A
bound needs no typesetting: it counts every character with at least the widest advance of its class in New
Computer Modern Math, and every operator with the widest space on both sides. Lengths are in em. An unknown
character may come from any system font; then there is no bound, and the typesetter measures the formula.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from html import escape
from itertools import zip_longest
from math import inf
from string import ascii_lowercase, ascii_uppercase, digits, punctuation
from xml.etree.ElementTree import Element, ParseError, fromstring

LINE = 51.0
"""Width of a formula in the calculation: 210 mm of paper minus 35 mm of margins and 4 mm of inset, at 9.5
pt."""
CELL = 10.0
"""Width of a formula in a table: its narrowest column is wider than this if the others leave 80 mm."""

_SPACE = 0.56  # 5/18 em on either side of a relation, the widest of all classes
_COLUMN = 1.0  # twice the gap between two columns
_FENCE, _RADICAL, _FRACTION, _SCRIPT, _BESIDE = 1.0, 1.3, 0.3, 0.75, 0.15
_LEAVES = frozenset({"mi", "mn", "mtext", "mo", "mspace"})
_SIGNS = {
    **dict.fromkeys(punctuation, 1.0),
    **dict.fromkeys(digits, 0.53),
    **dict.fromkeys(ascii_lowercase, 0.8),
    **dict.fromkeys(ascii_uppercase, 1.2),
    **dict.fromkeys("mw", 1.1),
    **dict.fromkeys(".,", 0.46),
    " ": 0.4,
    "\u00a0": 0.4,
    "\u2009": 0.4,
    **dict.fromkeys("αβγδεζηθικλμνξοπρςστυφχψωϑϕϵµ", 0.9),
    **dict.fromkeys("ΓΔΘΛΞΠΣΦΨΩ", 1.1),
    **dict.fromkeys("°′″²³¹", 0.7),
    **dict.fromkeys("·×−±≤≥≠≈→⋅∞∂", 1.1),
}
_TEXT = re.compile(">[^<>]+<")
_DIGIT = re.compile("[0-9]")
_REFERENCE = re.compile("&#x([0-9A-Fa-f]+);")


def fits(mathml: Iterable[str], width: float) -> bool:
    """Return whether formulas side by side are certainly no wider than a given width [em]."""
    return sum(_bound(_alike(one)) for one in mathml if one) <= width


def _alike(mathml: str) -> str:
    """Return a formula with a zero for each digit in its texts, because all digits have the same width."""
    return _TEXT.sub(_with_zeros, mathml)


def _with_zeros(text: re.Match[str]) -> str:
    return _DIGIT.sub("0", _REFERENCE.sub(_plain, text[0]))


def _plain(reference: re.Match[str]) -> str:
    return escape(chr(int(reference[1], 16)))


@lru_cache(4096)
def _bound(mathml: str) -> float:
    """Return an upper bound of the width of a formula [em]."""
    try:
        return _of(fromstring(mathml))
    except ParseError:
        return inf


def _of(node: Element) -> float:
    tag = node.tag.rpartition("}")[2]
    return _leaf(node, tag) if tag in _LEAVES else _built([_of(child) for child in node], node, tag)


def _leaf(node: Element, tag: str) -> float:
    match tag:
        case "mo":
            return _text(node) + (_FENCE if node.get("fence") == "true" else _SPACE)
        case "mspace":
            return _space(node)
    is_word = tag == "mi" and len(node.text or "") > 1
    return _text(node) + (_SPACE if is_word else 0.0)


def _built(inside: list[float], node: Element, tag: str) -> float:
    match tag:
        case "mfrac":
            return max(inside) + _FRACTION
        case "msqrt":
            return sum(inside) + _RADICAL
        case "msub" | "msup" | "munder" | "msubsup":
            return inside[0] + _SCRIPT * max(inside[1:]) + _BESIDE
        case "mtable":
            rows = [[_of(cell) for cell in row] for row in node]
            return sum(max(column) + _COLUMN for column in zip_longest(*rows, fillvalue=0.0))
        case "math" | "mrow" | "mover" | "mstyle" | "mtd":
            return sum(inside) + _text(node)
    return inf


def _text(node: Element) -> float:
    return sum(_SIGNS.get(sign, inf) for sign in node.text or "")


def _space(node: Element) -> float:
    try:
        return max(float(node.get("width", "0em").removesuffix("em")), 0.0)
    except ValueError:
        return inf
