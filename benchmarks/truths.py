"""Names of the solutions against which errors are measured, and the conventions that they follow."""

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
"""What each name means."""

FRICTION = ("shear_torque", "friction_torque", "friction_coefficient", "power_loss")
"""Outputs of `oil_film` 2 in which the two conventions of shear differ."""


def meanings(*names: str) -> dict[str, str]:
    """The names that a table uses, with their meanings."""
    return {name: TRUTHS[name] for name in names}
