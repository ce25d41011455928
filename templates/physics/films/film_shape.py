r"""Shape of the gap of a journal bearing: lobes, bell mouth, and the position and tilt of the journal.

.. math::
    H(\varphi,\zeta) = 1 + \delta(\varphi) + \mu(\zeta)
        - (\mathbf e + \zeta\,\mathbf t)\cdot\mathbf n(\varphi)

phi is measured from the load in the sense of the hydrodynamic speed, n = (cos phi, sin phi), zeta = 2z/B from
−1 to 1. All lengths are divided by the assembled clearance c_b, the radial clearance of the largest cylinder
that fits into the bore. A centred, aligned journal therefore has H ≥ 1 everywhere, for any shape.

Lobes are arcs of the same radius, which exceeds that of the journal by c_p, the machined clearance. Their
preload is 1 − c_b/c_p. With the least gap at psi_k, delta = (c_p/c_b − 1)(1 − cos(phi − psi_k)) on lobe k.

References
----------
T. Someya (ed.), Journal-Bearing Databook, Springer 1989, for lobes and preload.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array

_ALONG = np.linspace(-1, 1, 401)
"""Number of axial places at which the narrowest gap is sought; with a tilt alone it is at an end."""

_SAME = 1e-11
"""Angles closer than this [rad] are equal, because rounding does not determine the side of a joint."""


@dataclass(frozen=True)
class Bore:
    """Shape of a bore; by default a plain cylinder."""

    lobes: int = 1
    """Number of arcs; 1 with a preload of 0 is a cylinder."""
    preload: float = 0.0
    """1 − c_b/c_p of each lobe, 0 to below 1 [-]."""
    angle: float = 0.0
    """Angle of the middle of the first lobe from the load [rad]."""
    offset: float = 0.5
    """Fraction of a lobe's arc before its least gap: ½ centred, 1 at its end [-]."""
    mouth: float = 0.0
    """Opening of the bell mouth at the ends over the radial clearance [-]."""
    mouth_length: float = 0.0
    """Axial length of each of the two mouths over half the bearing's width, 0 to 1 [-]."""

    @property
    def is_lobed(self) -> bool:
        """Return whether the gap of a centred journal varies circumferentially."""
        return self.preload > 0

    @property
    def is_plain(self) -> bool:
        """Return whether the bore is a cylinder."""
        return not self.is_lobed and not (self.mouth > 0 and self.mouth_length > 0)

    @property
    def excess(self) -> float:
        """Return the distance of a lobe's centre from that of the bearing: c_p/c_b − 1 [-]."""
        return self.preload / (1 - self.preload)

    def joints(self) -> Array:
        """Return the angles at which lobes meet, from the load [rad], (lobes,); empty without lobes."""
        arc = 2 * np.pi / self.lobes
        joints = self.angle + arc * (np.arange(self.lobes) - 0.5)
        return np.asarray(joints, float) if self.is_lobed else np.zeros(0)

    def arcs(self) -> tuple[Array, Array, Array]:
        """Return the beginning, the end, and the direction of the least gap of each lobe, (lobes,) [rad]."""
        arc = 2 * np.pi / self.lobes
        begin = np.asarray(self.angle + arc * (np.arange(self.lobes) - 0.5), float)
        return begin, begin + arc, begin + arc * self.offset

    def around(self, phi: Array, side: int = 1) -> Array:
        """Return the contribution of lobes to the gap of a centred journal, at angles from the load [-].

        Where lobes meet, a side of 1 selects the lobe ahead, and −1 the lobe behind.
        """
        if not self.is_lobed:
            return np.zeros_like(phi)
        arc, past = 2 * np.pi / self.lobes, side * _SAME
        within = (phi - self.angle + arc / 2 + past) % arc - past
        return np.asarray(2 * self.excess * np.sin((within - arc * self.offset) / 2) ** 2)

    def along(self, zeta: Array) -> Array:
        """Return the contribution of the bell mouth, a parabola from its beginning to the end [-]."""
        if self.mouth_length <= 0:
            return np.zeros_like(zeta)
        depth = np.maximum(np.abs(zeta) - (1 - self.mouth_length), 0.0) / self.mouth_length
        return np.asarray(self.mouth * depth**2)


@dataclass(frozen=True)
class Lie:
    """Position and tilt of the journal; axes x along the load, y ahead of it in the sense of rotation."""

    e: Array
    """(2,) displacement of the journal's middle over the radial clearance [-]."""
    tilt: Array
    """(2,) further displacement at the end zeta = 1, the opposite one at zeta = −1 [-]."""

    @property
    def is_tilted(self) -> bool:
        """Return whether the journal's axis is not parallel to that of the bearing."""
        return bool(np.any(self.tilt != 0))

    @property
    def eps(self) -> float:
        """Return the relative eccentricity at mid-width; it may exceed 1 in a lobed bore [-]."""
        return float(np.hypot(*self.e))

    @property
    def attitude(self) -> float:
        """Return the angle of the displacement at mid-width from the load [rad]."""
        return float(np.arctan2(self.e[1], self.e[0]))


def directions(phi: Array) -> Array:
    """Return the outward unit normals [-] at angles from the load, (2, ...)."""
    return np.stack([np.cos(phi), np.sin(phi)])


def gap(bore: Bore, lie: Lie, phi: Array, zeta: Array, side: int = 1) -> Array:
    """Return the film thickness divided by the radial clearance, at all angles and places, (angles, places).

    `Bore.around` explains which lobe counts where lobes meet.
    """
    x, y = directions(phi)
    e, t = lie.e, lie.tilt
    aligned = (1 + bore.around(phi, side) - e[0] * x - e[1] * y)[:, None] + bore.along(zeta)
    return np.asarray(aligned - np.outer(t[0] * x + t[1] * y, zeta))


def narrowest(bore: Bore, lie: Lie) -> tuple[float, float]:
    """Return the least gap [-] and its angle from the load [rad].

    On each lobe, at each axial place, the gap is least in the direction of the journal's displacement from
    the lobe's centre, or at the nearer end of the lobe.
    """
    begin, end, least = bore.arcs()
    zeta = _ALONG if lie.is_tilted or not bore.is_plain else np.zeros(1)
    x, y = (lie.e[k] + zeta * lie.tilt[k] for k in (0, 1))
    excess = bore.excess if bore.is_lobed else 0.0
    x, y = (own[:, None] + excess * axis for own, axis in zip((x, y), directions(least), strict=True))
    past = (np.arctan2(y, x) - begin) % (2 * np.pi)
    arc = end - begin
    beyond = past > arc
    past = np.where(beyond, np.where(past - arc < 2 * np.pi - past, arc, 0.0), past)
    phi = begin + past
    H = 1 + excess + bore.along(zeta)[:, None] - x * np.cos(phi) - y * np.sin(phi)
    place = np.unravel_index(H.argmin(), H.shape)
    return float(H[place]), float(phi[place])
