r"""Mobility of a bearing with a circumferential groove in its sleeve, with two lands that carry the load.

.. math:: \vec M = (1-s)\,\vec M(b) + s\,\frac{\vec M\left(b(1-g)/2\right)}{1-g}

b is the width ratio, g the groove's width over that of the bearing, and s the fraction of the 90° sector
around the load's direction that the groove covers. M is the mobility of the finite bearing (`mobility_map`).
With s = 1 this is exact: two adjacent bearings, each as wide as a land, carry half the load each. For s
between 0 and 1 the formula is a blend.

The film is always full of oil, so starvation cannot occur. `benchmarks/film_cycle_ensemble.py` compares
level `mobility_grooved` with level `supplied`.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.physics.orbits.journal_orbit import (
    CyclicLoad,
    Orbit,
    Ring,
    node_counts,
    periodic_orbit,
    ring_of,
)
from templates.physics.orbits.mobility_law import MapLaw
from templates.physics.orbits.mobility_map import mapped_film_under_load
from templates.physics.orbits.rotation import PartRotation

SECTOR = np.pi / 4
"""Half of the sector around the load's direction in which the groove has an effect [rad]."""
_FINENESSES = 1, 4
"""Refinement factors of the finest rings of `periodic_orbit`."""
_HALVINGS = 12
"""Largest number of times that a ring may be reduced to every other node."""


@dataclass(frozen=True)
class Groove:
    """A circumferential groove in the sleeve, centred axially, for some cases."""

    share: Array
    """(C,) width of the groove over that of the bearing; 0 without a groove [-]."""
    start: Array
    """(C,) angle at which the groove begins, from the sleeve's axis in the sense x to y [rad]."""
    extent: Array
    """(C,) extent of the groove in that sense; 2 pi for a full circle [rad]."""

    def of(self, cases: Mask) -> "Groove":
        """Return the same object for a subset of the cases."""
        return Groove(self.share[cases], self.start[cases], self.extent[cases])

    def covers(self, direction: Array, half: float = SECTOR) -> Array:
        """Return the fraction of a sector around directions in the sleeve that the groove covers [-].

        The directions have the shape (C, K) [rad].
        """
        extent = self.extent[:, None]

        def up_to(angle: Array) -> Array:
            turns, part = np.divmod(angle, 2 * np.pi)
            return np.asarray(turns * extent + np.minimum(part, extent))

        along = direction - self.start[:, None]
        covered = (up_to(along + half) - up_to(along - half)) / (2 * half)
        return np.where(self.share[:, None] > 0, covered, 0.0)

    def land(self, ratio: Array) -> Array:
        """Return the width over diameter of each of the two lands, (C,) [-]."""
        return np.asarray(ratio * (1 - self.share) / 2)


@dataclass(frozen=True)
class GroovePassage:
    """A load that passes a groove: the loads of some cases, the groove, and the rotation of the sleeve."""

    load: CyclicLoad
    sleeve: PartRotation
    groove: Groove

    def of(self, cases: Mask) -> "GroovePassage":
        """Return the same object for a subset of the cases."""
        return GroovePassage(self.load.of(cases), self.sleeve.of(cases), self.groove.of(cases))

    def with_distinct_rings(self) -> tuple["GroovePassage", NDArray[np.intp]]:
        """Return the same at angles whose rings differ in their number of nodes.

        The second result contains the indices of the old angles. Equal steps need no change. Otherwise the
        angles are divided until the finest ring is the only one.
        """
        steps = np.diff(self.load.angle, append=self.load.angle[0] + self.load.period)
        if np.ptp(steps) < 1e-9:
            return self, np.arange(steps.size)
        ring, own = self.ring(max(_FINENESSES))
        divided = CyclicLoad(ring.place, ring.period, ring.S[:2], ring.w)
        return GroovePassage(divided, replace(self.sleeve, swing=ring.S[2]), self.groove), own

    def ring(self, finer: int) -> tuple[Ring, NDArray[np.intp]]:
        """Return the finest nodes; the swing of the sleeve is the third row of their load.

        The second result marks the load's own angles.
        """
        rows = np.concatenate([self.load.S, self.sleeve.swing[None]])
        return ring_of(replace(self.load, S=rows), finer)

    def covered(self, nodes: int) -> Array:
        """Return the fraction s on the ring of `periodic_orbit` with this number of nodes, (C, nodes) [-].

        Raises
        ------
        ValueError
            If there is no such ring.
        """
        for finer in _FINENESSES:
            finest = int(node_counts(self.load, finer).sum())
            for stride in (1 << k for k in range(_HALVINGS)):
                if -(-finest // stride) == nodes:
                    ring = self.ring(finer)[0].every(stride)
                    x, y, swing = ring.S
                    return self.groove.covers(np.arctan2(y, x) - self.sleeve.at(ring.place, swing))
        raise ValueError(f"no ring of the orbit has {nodes} nodes")


class GroovedLaw:
    """The mobility with a groove; a `MobilityLaw`.

    It identifies the ring of nodes of a call by the number of nodes: see `GroovePassage.with_distinct_rings`.
    """

    def __init__(self, ratio: Array, passing: GroovePassage) -> None:
        """Store the widths B/D of the cases, (C,), whose lands must be within the map [-]."""
        self.ratio, self.passing = ratio, passing
        self.whole, self.lands = MapLaw(ratio), MapLaw(passing.groove.land(ratio))
        self._covered: dict[int, Array] = {}

    def of(self, cases: Mask) -> "GroovedLaw":
        """Return the same law for a subset of the cases."""
        fewer = GroovedLaw(self.ratio[cases], self.passing.of(cases))
        fewer._covered = {nodes: covered[cases] for nodes, covered in self._covered.items()}
        return fewer

    def covered(self, nodes: int) -> Array:
        """Return the fraction s on a ring; it is cached."""
        if nodes not in self._covered:
            self._covered[nodes] = self.passing.covered(nodes)
        return self._covered[nodes]

    def __call__(self, xi: Array, eta: Array) -> tuple[Array, Array]:
        """Return M and its derivatives on a ring of the orbit."""
        s, left = self.covered(xi.shape[-1]), 1 - self.passing.groove.share[:, None]
        (M, slopes), (M_land, slopes_land) = self.whole(xi, eta), self.lands(xi, eta)
        return (1 - s) * M + s / left * M_land, (1 - s) * slopes + s / left * slopes_land


def lift_of(share: Array, extent: Array, pressure: Array) -> Array:
    """Return the load number that the supply pressure in a groove and over its lands supports at rest.

    It is 0 without a groove. Over the lands the pressure falls linearly to that of the ends, so the groove
    counts with its width and half that of the lands. For an arc only the component along its middle remains,
    P (1 + g)/2 sin(extent/2).

    Parameters
    ----------
    share
        Width of the groove over that of the bearing, g, 0 without a groove [-].
    extent
        Circumferential extent of the groove [rad].
    pressure
        P = p psi²/(eta Omega) [-].

    Examples
    --------
    >>> round(float(lift_of(np.array(0.2), np.array(np.pi), np.array(0.5))), 3)
    0.3
    """
    grooved = np.asarray(share) > 0
    return np.asarray(np.where(grooved, pressure * (1 + share) / 2 * np.sin(extent / 2), 0.0))[()]


def lifting(lift: Array, sleeve: PartRotation, groove: Groove, angle: Array) -> Array:
    """Return the force of the supply pressure on the journal, against the load, (2, C, N) [-].

    Parameters
    ----------
    lift
        (C,) magnitude of the force, a load number [-].
    sleeve
        Rotation of the sleeve.
    groove
        The groove; the force comes from its middle.
    angle
        (N,) crank angles [rad].
    """
    middle = sleeve.at(angle, sleeve.swing) + (groove.start + groove.extent / 2)[:, None]
    force = np.where(lift > 0, lift, 0.0)[:, None]
    middle = np.where(force > 0, np.nan_to_num(middle), 0.0)
    return np.stack([force * np.cos(middle), force * np.sin(middle)])


def grooved_orbit(passing: GroovePassage, ratio: Array) -> Orbit:
    """Return the periodic orbit of each case by the mobility with its groove; NaN if it has none.

    Parameters
    ----------
    passing
        Load, groove and sleeve.
    ratio
        (C,) width over diameter B/D, which must be 0.02 … 10, also for the lands [-].
    """
    divided, own = passing.with_distinct_rings()
    orbit = periodic_orbit(divided.load, GroovedLaw(ratio, divided))
    return replace(orbit, eps=orbit.eps[..., own])


def grooved_film_under_load(
    xi: Array, eta: Array, ratio: Array, passing: GroovePassage
) -> tuple[Array, Array]:
    """Return the results of the film with a groove at the load's angles (C, N), in Booker's frame [-].

    Parameters
    ----------
    xi, eta
        Relative eccentricity along the load and ahead of it [-].
    ratio
        (C,) width over diameter B/D [-].
    passing
        Load, groove and sleeve.

    Returns
    -------
    Mobility M, (2, C, N), and as in `mapped_film_under_load` largest pressure p_max B D/F and side flow
    Q/(B D v), (2, C, N); the flow from the groove itself is excluded.
    """
    x, y = passing.load.S
    turned = passing.sleeve.at(passing.load.angle, passing.sleeve.swing)
    s, left = passing.groove.covers(np.arctan2(y, x) - turned), 1 - passing.groove.share[:, None]
    land = passing.groove.land(ratio)
    M, M_land = MapLaw(ratio)(xi, eta)[0], MapLaw(land)(xi, eta)[0]
    P, leak = mapped_film_under_load(xi, eta, ratio[:, None])
    P_land, leak_land = mapped_film_under_load(xi, eta, land[:, None])
    film = np.stack([(1 - s) * P + s * P_land / left, (1 - s) * leak + s * leak_land * left])
    return (1 - s) * M + s / left * M_land, film
