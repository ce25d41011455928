"""A smooth transition from Carter's to Ker Wilson's formula where pin and journal begin to overlap.

Used by `crank_stiffness` 1. The literature chooses by the sign of the overlap, without a transition. But at
overlap 0 nothing changes abruptly: the webs stiffen steadily as the throw becomes shorter. So the two
formulas are blended over a range of throws. Its middle is the published boundary, R = (D_j + D_c)/2. Its half
width is 0.1 (D_j + D_c), half of the length by which Ker Wilson shortens the throw because pin and journal
stiffen the webs. Outside this range each formula holds alone, as published. The width of the range is our
choice.

Within the range the flexibilities 1/K are blended with smooth weights: both formulas are sums of the
flexibilities of journal, pin and web, so this blends them part by part. The stiffness stays between the two.

References
----------
B. C. Carter: An empirical formula for crankshaft stiffness in torsion. Engineering 126, 1928.
W. Ker Wilson: Practical Solution of Torsional Vibration Problems, 3rd ed., vol. 1, 1956.
Punewale, Khobragade, Chaudhari, Khandre, 2015, for the choice between them by overlap.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

CARTER, BETWEEN, WILSON = "carter", "between", "wilson"
HALF_WIDTH = 0.1
"""Half the width of the transition, over D_j + D_c."""

APART = "pin and journal are well apart: the webs bend, which Carter's formula allows for"
NEITHER = (
    "pin and journal just touch, overlap little or stand little apart: the stiffness lies between Carter's "
    "and Ker Wilson's, and passes from one to the other as the throw becomes shorter"
)
OVERLAPPING = (
    "pin and journal overlap well: the webs are short and stiff, which Ker Wilson's formula allows for"
)
TOO_SHORT = (
    "pin and journal overlap, so Ker Wilson's formula is the nearer one; but the throw is too short even "
    "for it (its web term is negative): use finite elements"
)


@units("m", "m", "m", returns="1", latex=r"3x^{{2}}-2x^{{3}},\ x=\frac12+\frac{{5\,{0}}}{{{1}+{2}}}")
def share_of_wilson(overlap: Array, journal: Array, pin: Array) -> Array:
    """Return the share of Ker Wilson's formula [1] at an overlap of journal and pin diameters [m]: 0 to 1."""
    place = np.clip(0.5 + overlap / (2 * HALF_WIDTH * (journal + pin)), 0.0, 1.0)
    return place**2 * (3 - 2 * place)


@units("1", "N*m/rad", "N*m/rad", returns="N*m/rad",
       latex=r"\left(\frac{{1-{0}}}{{{1}}}+\frac{{{0}}}{{{2}}}\right)^{{-1}}")  # fmt: skip
def joined_stiffness(share: Array, carter: Array, wilson: Array) -> Array:
    """Return the stiffness [N m/rad] between those of Carter and Ker Wilson: their flexibilities are blended.

    `share` [1] is the weight of Ker Wilson's flexibility; 0 or 1 gives exactly the result of one formula.
    """
    joined = 1 / ((1 - share) / carter + share / wilson)
    return np.select([share <= 0, share >= 1], [carter, wilson], joined)[()]


@units("1", returns="1")
def recommended(share: Array) -> Any:
    """Return the formula used for a throw, from the share [1] of Ker Wilson's: carter, wilson or between."""
    return _selected([share <= 0, share >= 1, share > 0], [CARTER, WILSON, BETWEEN])


@units("1", "m", returns="1")
def reason(share: Array, effective_throw: Array) -> Any:
    """Return the reason why that formula is recommended; the throw [m] is Ker Wilson's effective one."""
    cases = [(share >= 1) & (effective_throw < 0), share >= 1, share <= 0, share > 0]
    return _selected(cases, [TOO_SHORT, OVERLAPPING, APART, NEITHER])


def _selected(cases: list[Any], words: list[str]) -> Any:
    texts = np.select(cases, words, "")
    return texts if texts.ndim else str(texts)
