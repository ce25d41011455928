"""Names of the solutions against which errors are measured, and the conventions that they follow."""

import numpy as np

FILM = "Swift-Stieber"
FULL_SHEAR = f"{FILM}, shear all around"
OIL_SHEAR = f"{FILM}, shear where oil is"
PAD = "finite pad"

TRUTHS = {
    FILM: "the converged film: p = 0 at the ends and along the widest gap, rupture where p = dp/dn = 0",
    FULL_SHEAR: "that film; friction is shear over the full circle, as in DIN 31652 and ISO 7902",
    OIL_SHEAR: "that film; friction is shear where there is oil, of streamers in the ruptured part",
    PAD: "the converged film of a pad of finite width, p = 0 all around it",
}
"""The meaning of each name."""

FRICTION = ("shear_torque", "friction_torque", "friction_coefficient", "power_loss")
"""Outputs of `oil_film` 2 in which the two conventions of shear differ."""


def meanings(*names: str) -> dict[str, str]:
    """The names that a table uses, with their meanings."""
    return {name: TRUTHS[name] for name in names}


COEFFICIENTS = [f"{name}_{xy}" for name in ("stiffness", "damping") for xy in ("xx", "xy", "yx", "yy")]
RELATIVE_TO: dict[str, float | list[str]] = {
    **dict.fromkeys(("attitude_angle", "maximum_pressure_angle"), np.pi / 2),
    **{name: [n for n in COEFFICIENTS if n.startswith(name[:5])] for name in COEFFICIENTS},
}
"""References of errors that are not relative to the output itself: a size [SI], or the largest of these."""


def truth_of(level: str, output: str) -> str:
    """Against which film the error of an output is measured: `mass_conserving` has a convention of shear."""
    if output not in FRICTION:
        return FILM
    return OIL_SHEAR if level == "mass_conserving" else FULL_SHEAR
