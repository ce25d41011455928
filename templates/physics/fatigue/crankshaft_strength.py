"""Fatigue strength of a crankshaft by the rules of the classification societies (IACS UR M53).

References
----------
IACS Unified Requirement M53, Calculation of crankshafts for I.C. engines, section 6, as the Indian Register
of Shipping prints it: Classification Notes, Calculation of Crankshafts for Internal Combustion Engines,
section 6.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

MPA, MM = 1e6, 1e-3

MANUFACTURES = {"continuous_grain_flow": 1.05, "free_form_forged": 1.0, "cast_rolled": 0.93}
"""Manufacturing factor K of shafts without surface treatment; cast steel with cold-rolled fillets, by an
approved process.
"""


@units(
    None, returns="1",
    latex=r"1.05\ \text{{(grain flow)}},\ 1\ \text{{(free form)}},\ 0.93\ \text{{(cast, rolled)}}",
)  # fmt: skip
def manufacture_factor(manufacture: str) -> Array:
    """Return the manufacturing factor K of a fillet [1]."""
    return np.float64(MANUFACTURES[manufacture])  # type: ignore[return-value]


@units("1", returns="1", latex=r"\min\left({0},1\right)")
def factor_at_bore(K: Array) -> Array:
    """Return the manufacturing factor K at an oil bore [1]: values above 1 apply only to fillets."""
    return np.minimum(K, 1.0)


@units(
    "1", "Pa", "m", "m", returns="Pa",
    latex=r"{0}\left(0.42\,{1}+39.3\right)\left(0.264+1.073\,{2}^{{-0.2}}+\frac{{785-{1}}}{{4900}}"
    r"+\frac{{196}}{{{1}}}\sqrt{{\frac{{1}}{{{3}}}}}\right)",
)  # fmt: skip
def fatigue_strength_IACS_M53(K: Array, ultimate: Array, diameter: Array, radius: Array) -> Array:
    """Return the alternating von Mises stress [Pa] that a crankshaft withstands permanently.

    The formula uses the ultimate strength [Pa] in MPa; the diameter of pin or journal [m] and the radius of
    the fillet, or half the diameter of the oil bore, [m] in mm.
    """
    B, D, R = ultimate / MPA, diameter / MM, radius / MM
    support = 0.264 + 1.073 * D**-0.2 + (785 - B) / 4900 + 196 / B * np.sqrt(1 / R)
    return K * (0.42 * B + 39.3) * support * MPA
