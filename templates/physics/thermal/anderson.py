"""Anderson acceleration of a fixed-point iteration: the next guess from the last few changes."""

import numpy as np

from templates.core.arrays import Array

_KEPT = 6
_SHARE = 0.7
"""Fraction of the change that is applied while no earlier changes are known."""


class Anderson:
    """Successive guesses for the solution of x = g(x), from the recent values of g.

    References
    ----------
    D. G. Anderson: J. ACM 12, 1965, p. 547; H. F. Walker, P. Ni: SIAM J. Numer. Anal. 49, 2011, p. 1715.
    """

    def __init__(self) -> None:
        self.places: list[Array] = []
        self.changes: list[Array] = []

    def after(self, place: Array, change: Array) -> Array:
        """Return the next guess after g(place) = place + change."""
        if self.changes and np.abs(change).max() > 3 * np.abs(self.changes[-1]).max():
            self.places, self.changes = [], []
        self.places = [*self.places, place][-_KEPT:]
        self.changes = [*self.changes, change][-_KEPT:]
        if len(self.places) == 1:
            return np.asarray(place + _SHARE * change)
        moves = np.diff(np.stack([x.ravel() for x in self.places]), axis=0)
        turns = np.diff(np.stack([f.ravel() for f in self.changes]), axis=0)
        weights = np.linalg.lstsq(turns.T, change.ravel(), rcond=1e-10)[0]
        guess = place.ravel() + _SHARE * change.ravel() - weights @ (moves + _SHARE * turns)
        return np.asarray(guess.reshape(place.shape))
