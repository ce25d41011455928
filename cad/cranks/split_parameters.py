"""Parameters and rules of split pins: the angle between the two pins of a throw, and the middle web."""

from __future__ import annotations

from math import radians

import numpy as np

from cad.cranks.rules import CrankRules
from templates.core.language.template import Array, Truth, curve, derived, given, require, units

_LEAST = radians(0.999)
_ROUNDING = 1e-9  # [rad]


@units("rad", returns="rad", latex=r"{0} \bmod 2\pi")
def shortest(angle: Array) -> Array:
    """Return the equivalent angle [rad] between -180° and 180°."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@units("rad", returns="1")
def are_split(split: Array) -> Truth:
    """Return whether pins are split by an angle [rad]; the rounding error of a sine does not count."""
    return np.asarray(np.abs(shortest(split)) > _ROUNDING, dtype=bool)


@units("rad", returns="1")
def undivided(split: Array) -> Truth:
    """Return whether pins are not split by an angle [rad]."""
    return np.logical_not(are_split(split))


@units("rad", "m", returns="m", latex=r"{1}\ \text{{if split}}")
def where_split(split: Array, length: Array) -> Array:
    """Return a length [m] if pins are split, else 0."""
    return np.where(are_split(split), length, 0 * length)[()]


@units("rad", "rad", "m", "m", "m", returns="m")
def least_gap(pins: Array, split: Array, far: Array, journal: Array, rise: Array) -> Array:
    """Return the smallest distance [m] between the axes of the two drillings that end in one journal.

    The result is infinite if no journal has two drillings.

    One drilling comes from the rear pin in front of the journal, the other from the front pin behind it. Both
    run from `far` across to the other side of the journal, and by `rise` along the shaft, to the same
    section. They are mirror images, so they are closest at corresponding points: the distance is 2 s r h /
    sqrt(s² X² + h²), where s is the sine of half the angle between them, r the radius of the journal, h the
    rise, and X the distance across.
    """
    if np.ndim(pins) == 0 or np.shape(pins)[-1] < 2:
        return np.asarray(np.inf)
    between = pins[..., 1:] - pins[..., :-1] - np.expand_dims(split, -1)
    sine = np.abs(np.sin(between / 2))
    r, h = np.expand_dims(journal, -1), np.expand_dims(rise, -1)
    across = np.expand_dims(far, -1) + r
    return np.asarray(np.min(2 * sine * r * h / np.sqrt(sine**2 * across**2 + h**2), axis=-1))


class SplitParameters(CrankRules):
    """Parameters of the pin angles and of split pins."""

    psi: Array = curve(
        "deg", "pin angles", along="throws", symbol=r"\psi", ge=-720, le=720, also=("crankpin angles",)
    )
    delta: Array = given(
        "deg", "pin split", symbol=r"\delta", default="0 deg", ge=-360, le=360, also=("split of pins",)
    )

    @derived("mm", "middle web thickness", symbol="L_m", ge=0.025, le=5000)
    def L_m(self) -> Array:
        """Return the default: half the thickness of a web."""
        return 0.5 * self.L_w

    @derived("mm", "middle web width", symbol="W_m", ge=0.1, le=10000)
    def W_m(self) -> Array:
        """Return the default: slightly wider than a pin with its fillets."""
        return 1.1 * (self.D_c + 2 * self.r_f)

    @require("pin_split", remedy="use 0 for pins that are not split")
    def split_is_drawable(self) -> Truth:
        """Split pins are at least 1° apart."""
        return undivided(self.delta) | (np.abs(shortest(self.delta)) >= _LEAST)

    @require("middle_web_width", "pin_diameter", "fillet",
             remedy="make the middle web wider or the fillet smaller")  # fmt: skip
    def middle_web_holds_pins(self) -> Truth:
        """The middle web is at least 2 % wider than a pin with its fillet."""
        return undivided(self.delta) | (self.W_m >= 1.02 * (self.D_c + 2 * self.r_f))

    @require("middle_web_width", "journal_bore", "pin_split", "throw",
             remedy="make the journal's bore smaller, or 0 for none, or the middle web narrower")  # fmt: skip
    def middle_web_clears_bore(self) -> Truth:
        """The journal's bore clears the middle web by 2 % of its radius."""
        clear = self.R * np.abs(np.cos(self.delta / 2)) - self.W_m / 2
        return undivided(self.delta) | (self.d_j <= 0) | (clear >= 0.51 * self.d_j)

    @require("oil_drilling_diameter", "pin_angles", "pin_split",
             remedy="make the oil drillings narrower, or 0 for none, or the pins further apart")  # fmt: skip
    def drillings_keep_apart(self) -> Truth:
        """Two oil drillings that end in one journal are at least a tenth of their diameter apart."""
        gap = least_gap(self.psi, self.delta, self.R + self.D_c / 2, self.D_j / 2, self.h_o)
        return undivided(self.delta) | (self.d_o <= 0) | (gap >= 1.1 * self.d_o)
