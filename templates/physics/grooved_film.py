"""Cavitating film of a bearing whose grooves stand still relative to the load: its attitude is found.

`cavitating_film` takes grooves from the narrowest gap; a bearing has them from the load, so the
attitude that the film answers must be the one that placed the grooves.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from templates.physics.cavitating_film import CavitatingFilm, Groove, cavitating_film

_SCAN = np.linspace(0.0, np.pi, 7)
_ACCURACY = 5e-4
"""Of the attitude; moving a groove past a node of the mesh makes steps of this size [rad]."""


def grooved_film(
    eps: float, ratio: float, grooves: list[Groove], ambient: float = 0.0, around: int = 128, across: int = 16
) -> CavitatingFilm:
    """Solve the film and its attitude.

    Args:
        eps: relative eccentricity, above 0 to 1 − 1e-7 [-].
        ratio: width over diameter B/D [-].
        grooves: where oil is fed, with centres from the direction of the load in the sense of rotation.
        ambient: pressure at the ends above that of the cavity, 0 or more [-].
        around: intervals around.
        across: intervals across half the width.

    Raises:
        ValueError: if an argument lies outside its range, or no attitude from 0 to pi balances the load:
            supply pressure alone may lift the journal elsewhere.
        ArithmeticError: if a film does not settle.
    """

    def film(attitude: float) -> CavitatingFilm:
        placed = [replace(groove, centre=groove.centre - attitude) for groove in grooves]
        return cavitating_film(eps, ratio, placed, ambient, around, across)

    def excess(attitude: float) -> float:
        return float((film(attitude).attitude - attitude + np.pi) % (2 * np.pi) - np.pi)

    before = excess(_SCAN[0])
    for low, high in pairwise(_SCAN):
        after = excess(high)
        if before >= 0 > after:
            return film(brentq(excess, low, high, xtol=_ACCURACY))
        before = after
    raise ValueError("grooves: no attitude from 0 to 180 degrees balances the load")
