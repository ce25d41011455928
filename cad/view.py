"""View direction of pictures and drawings: from above and in front, to show the inside of a half shell."""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array

_SIGHT = np.array([0.55, -1.0, 0.62])
_TOWARDS = _SIGHT / np.linalg.norm(_SIGHT)
_RIGHT = np.cross([0.0, 0.0, 1.0], _TOWARDS) / np.linalg.norm(np.cross([0.0, 0.0, 1.0], _TOWARDS))
_STANDING = np.stack([_RIGHT, np.cross(_TOWARDS, _RIGHT), _TOWARDS], axis=1)
_LONG = 1.5
"""A part that is longer along z than this multiple of its other sides is shown lying, as a crankshaft is."""


def view_of(extent: Array) -> Array:
    """Return the unit vectors to the right, upwards and towards the viewer, as columns (3, 3).

    Parameters
    ----------
    extent
        Lengths of the part's box along x, y and z [mm].
    """
    if extent[2] <= _LONG * max(extent[:2]):
        return _STANDING
    return _STANDING[[1, 2, 0]]  # z of the part points to the right, y upwards
