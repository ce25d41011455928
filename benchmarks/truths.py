"""Reference solutions for errors: their names, their conventions, and the converged films."""

from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_map import _DAMPING_SCALE, _STIFFNESS_SCALE, decode
from templates.physics.journals.static_journal import JournalFilm

CHECKS = Path("benchmarks/film_map_checks.npz")

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
    """Return the names of references in a table, with their meanings."""
    return {name: TRUTHS[name] for name in names}


COEFFICIENTS = [f"{name}_{xy}" for name in ("stiffness", "damping") for xy in ("xx", "xy", "yx", "yy")]
RELATIVE_TO: dict[str, float | list[str]] = {
    **dict.fromkeys(("attitude_angle", "maximum_pressure_angle"), np.pi / 2),
    **{name: [n for n in COEFFICIENTS if n.startswith(name[:5])] for name in COEFFICIENTS},
}
"""References of errors that are not relative to the output itself: a size [SI], or the largest of these."""


def truth_of(level: str, output: str) -> str:
    """Return the reference film for the error of an output.

    `mass_conserving` has its own convention of shear.
    """
    if output not in FRICTION:
        return FILM
    return OIL_SHEAR if level == "mass_conserving" else FULL_SHEAR


def converged(*, streamers: bool) -> tuple[Array, Array, JournalFilm, tuple[Array, Array]]:
    """Return points x = atanh(eps), y = ln(B/D), with films and coefficients of the converged solutions."""
    with np.load(CHECKS) as checks:
        x, y, truth = checks["x"], checks["y"], checks["truth"]
    return x, y, *decoded(np.tanh(x), np.exp(y), truth, streamers=streamers)


def decoded(
    eps: Array, ratio: Array, truth: Array, *, streamers: bool
) -> tuple[JournalFilm, tuple[Array, Array]]:
    """Return films and coefficients of solutions as `benchmarks.film_map` encodes them, (points, 16).

    Shear acts over the full circle, as in the standards, or with `streamers` as there is oil.
    """
    film = decode(eps, ratio, truth[:, :8].T)
    shear = np.pi / np.sqrt((1 - eps) * (1 + eps))
    if streamers:
        shear = film["friction_streamers"] - eps * film["So"] * np.sin(film["attitude"]) / 2
    names = ("So", "attitude", "P_max", "peak", "side_flow")
    cos, sin = np.cos(film["attitude"]), np.sin(film["attitude"])
    turn = np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)
    thin = np.sqrt((1 - eps) / (1 + eps))[:, None, None]
    scale = (film["So"] / eps)[:, None, None]
    matrices = [
        turn @ (scale * truth[:, part].reshape(-1, 2, 2) / thin**power) @ turn.swapaxes(-1, -2)
        for part, power in ((slice(8, 12), _STIFFNESS_SCALE), (slice(12, 16), _DAMPING_SCALE))
    ]
    film_of = JournalFilm(eps=eps, shear=shear, **{name: film[name] for name in names})
    return film_of, (matrices[0], matrices[1])
