"""A crank throw in torsion: the sections of its parts, and the choice of the closed form.

`crank_stiffness` uses this module. Both closed forms are fitted to tests: Carter's to throws with slender
webs, Ker Wilson's to throws whose pin overlaps the journals.

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

CARTER, WILSON = "carter", "wilson"
APART = "pin and journal do not overlap: the webs bend, which Carter's formula allows for"
OVERLAPPING = "pin and journal overlap: the webs are short and stiff, which Ker Wilson's formula allows for"
TOO_SHORT = (
    "pin and journal overlap, so Ker Wilson's formula is the nearer one; but the throw is too short even "
    "for it (its web term is negative): use finite elements"
)


@units("m", "m", returns="m**4", latex=r"\left({0}^{{4}}-{1}^{{4}}\right)")
def ring(outer: Array, inner: Array) -> Array:
    """Return the difference of the fourth powers of outer and inner diameter [m⁴].

    It is 32/π times the polar moment of area, factored so that thin walls lose no digits.
    """
    return (outer - inner) * (outer + inner) * (outer**2 + inner**2)


@units("m", returns="1")
def recommended(overlap: Array) -> Any:
    """Return the formula to use for a throw with a pin overlap [m]: carter or wilson."""
    return _selected([overlap > 0, overlap <= 0], [WILSON, CARTER])


@units("m", "m", returns="1")
def reason(overlap: Array, effective_throw: Array) -> Any:
    """Return the reason why that formula is recommended; the throw [m] is Ker Wilson's effective one."""
    cases = [(overlap > 0) & (effective_throw < 0), overlap > 0, overlap <= 0]
    return _selected(cases, [TOO_SHORT, OVERLAPPING, APART])


def _selected(cases: list[Any], words: list[str]) -> Any:
    texts = np.select(cases, words, "")
    return texts if texts.ndim else str(texts)
