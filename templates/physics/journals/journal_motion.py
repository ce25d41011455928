"""Motion of a journal relative to its sleeve and its load, and the magnitude of its load.

References
----------
ISO 7902-1:1998, clause 5: omega_h = omega_journal + omega_sleeve − 2 omega_load.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

STANDARD_GRAVITY = 9.80665  # m/s²


@units("rad/s", "rad/s", "rad/s", returns="rad/s", latex=r"\left|{0}+{1}-2\,{2}\right|")
def hydrodynamic_speed(journal: Array, sleeve: Array, load: Array) -> Array:
    """Return the magnitude of the hydrodynamic speed [rad/s] from three angular speeds [rad/s]."""
    return np.abs(journal + sleeve - 2 * load)


@units(
    "rad/s", "rad/s", "rad/s", returns="rad/s",
    latex=r"\left({0}-{1}\right)\operatorname{{sgn}}\left({0}+{1}-2\,{2}\right)",
)  # fmt: skip
def sliding_speed(journal: Array, sleeve: Array, load: Array) -> Array:
    """Return the journal's speed relative to the sleeve, positive with the hydrodynamic speed [rad/s]."""
    return (journal - sleeve) * np.sign(journal + sleeve - 2 * load)


@units("N", returns="kg", latex=r"\frac{{{0}}}{{g}}")
def mass_of_weight(F: Array) -> Array:
    """Return the mass [kg] whose weight is F [N] at standard gravity."""
    return F / STANDARD_GRAVITY


@units("1", "N/m", "kg", returns="rad/s", latex=r"\sqrt{{\frac{{{0}\,{1}}}{{{2}}}}}")
def whirl_speed(threshold: Array, stiffness: Array, mass: Array) -> Array:
    """Return the speed [rad/s] at which a rotor of a mass [kg] begins to whirl; NaN if it never does.

    threshold is the largest stable mass M omega²/stiffness [1], infinite if every mass is stable.
    """
    whirls = np.isfinite(threshold) & (np.asarray(mass) > 0)
    squared = np.where(whirls, threshold, 1.0) * stiffness / np.where(whirls, mass, 1.0)
    return np.where(whirls, np.sqrt(squared), np.nan)[()]
