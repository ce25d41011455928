"""View direction of pictures and drawings: from above and in front, to show the inside of a half shell."""

from __future__ import annotations

import numpy as np

_SIGHT = np.array([0.55, -1.0, 0.62])

TOWARDS = _SIGHT / np.linalg.norm(_SIGHT)
"""Unit vector from the model to the eye."""

RIGHT = np.cross([0.0, 0.0, 1.0], TOWARDS) / np.linalg.norm(np.cross([0.0, 0.0, 1.0], TOWARDS))
"""Unit vector to the right in the picture."""

UP = np.cross(TOWARDS, RIGHT)
"""Unit vector upwards in the picture."""
