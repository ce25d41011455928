"""Array types shared by templates, physics and geometry."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Real numbers [SI], for any number of points."""
Mask = NDArray[np.bool_]
"""A mask that selects some of several points."""
Truth = bool | Mask
"""Whether a rule is satisfied: at one point, or at each of several."""
Integers = NDArray[np.int64]
"""Numbers of nodes, corners or faces."""
