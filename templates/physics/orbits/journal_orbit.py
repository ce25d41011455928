r"""The orbit of a journal under a periodic load, by the mobility method; many cases at once.

.. math:: d\vec\epsilon/d\theta = S\,\vec M(\vec\epsilon, \vec S) + w\,\hat z\times\vec\epsilon,
    \quad S = \frac{F\psi^2}{B D\eta\,\Omega},\quad w = \bar\omega/\Omega

theta is the crank angle, which increases with Omega; the load on the journal is linear between its points.
The film is massless and always full where it carries load, so it has no memory. All nodes of the cycle are
solved at once, from a coarse ring of nodes to the finest, so the orbit is periodic to the tolerance of
Newton's method, without run-in cycles. The method is of second order in the step, which is 1° or less, and a
quarter of that if the error bound of the smallest gap exceeds 0.2 per cent. The intervals of the load are
halved until they are short enough, so nodes, result and bound do not change if the same load is given at
twice as many angles.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; J. Lubr. Technol. 93, 1971, p. 168.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.physics.numerics.periodic_steps import differences, imbalance, newton_step
from templates.physics.orbits.mobility_law import MobilityLaw
from templates.physics.orbits.step_bound import least_between, step_bound

LARGEST_STEP = np.radians(1.0)
"""The largest step of the finest ring of nodes [rad]."""
TOLERANCE = 1e-5
"""Largest change over the gap by the last Newton step; by quadratic convergence about 1e-9 is left [-]."""
_ROUGH = 1e-3
"""The same limit on coarser rings, which only give an initial guess [-]."""
THINNEST = 2e-6
"""Gap 1 − eps below which a film counts as carrying no load: the mobility map ends at half of it [-]."""

_COARSEST = 64
_LAST = 2
"""Stride up to which a case that has not converged on a coarser ring is tried again from the start."""
_MOST_STEPS = 60
_THINNER, _LONGEST = 0.25, 0.7
"""Fraction of the gap that a Newton step must leave, and its largest length in eccentricity."""
_STUCK = 0.1
"""A journal at the wall that moves by less than this, relative to its gap, is stuck."""
ROUGHEST = 2e-3
"""Bound of the relative error of the smallest gap above which the steps are shortened [-]."""
UNKNOWN = 0.1
"""The same bound above which there is no orbit: its film may be an artefact of the steps [-]."""
_FINER = 4
"""Factor on the number of steps where the film is thin."""
_BLOCK = 1 << 16
"""Most nodes of all cases that are solved together."""


@dataclass(frozen=True)
class CyclicLoad:
    """A load on the journal over one cycle, in a frame that may rotate."""

    angle: Array
    """(N,) rising crank angles [rad]."""
    period: float
    """The cycle [rad]."""
    S: Array
    """(2, C, N) load F psi²/(B D eta Omega) along the axes of the frame [-]."""
    w: Array
    """(C, N) mean speed of journal and sleeve relative to the frame, over Omega [-]."""

    def of(self, cases: Mask) -> "CyclicLoad":
        """Return the same object for a subset of the cases."""
        return CyclicLoad(self.angle, self.period, self.S[:, cases], self.w[cases])


@dataclass(frozen=True)
class Orbit:
    """A periodic orbit; NaN where there is none."""

    eps: Array
    """(2, C, N) relative eccentricity along the axes of the frame, at the load's angles [-]."""
    least_gap: Array
    """(C,) smallest 1 − |eps| over the cycle, between the load's angles too [-]."""
    least_angle: Array
    """(C,) crank angle of the smallest gap [rad]."""
    step_error: Array
    """(C,) relative error of the smallest gap due to the step, from its change at the nodes that two rings
    share; not a bound, see `step_bound`; NaN if not measured [-].
    """
    between: Array
    """(C,) smallest gap between the nodes, by a parabola through three of them [-]."""
    step_bound: Array
    """(C,) bound of the relative error of `between` due to the step, see `step_bound`; NaN if unknown [-]."""


@dataclass(frozen=True)
class Ring:
    """Nodes over the cycle, with the load and speed at each."""

    place: Array
    """(K,) crank angles [rad]."""
    period: float
    S: Array
    """(2, C, K)."""
    w: Array
    """(C, K)."""

    def steps(self) -> Array:
        """Return the step that leads to each node, (K,) [rad]."""
        return np.diff(self.place, prepend=self.place[-1] - self.period)

    def every(self, stride: int) -> "Ring":
        """Return the ring that consists of every stride-th node."""
        part = slice(None, None, stride)
        return Ring(self.place[part], self.period, self.S[..., part], self.w[..., part])

    def of(self, cases: Mask) -> "Ring":
        """Return the same nodes for a subset of the cases."""
        return Ring(self.place, self.period, self.S[:, cases], self.w[cases])


def periodic_orbit(load: CyclicLoad, law: MobilityLaw) -> Orbit:
    """Return the orbit of every case, by the mobility of a law; NaN for a case without a periodic orbit.

    Parameters
    ----------
    load
        The cycle; a case with zero load has no unique orbit and gives NaN.
    law
        Mobility of the same cases.
    """
    cases, size = load.w.shape[0], max(1, _BLOCK // node_counts(load).sum())
    borne = np.isfinite(load.w).all(axis=-1) & np.isfinite(load.S).all(axis=(0, 2)) & load.S.any(axis=(0, 2))
    whole = Orbit(np.full(load.S.shape, np.nan), *np.full((5, cases), np.nan))
    for start in range(0, cases, size):
        part = borne & (np.arange(cases) // size == start // size)
        _fill(whole, load, law, part, finer=1)
        if node_counts(load, _FINER).sum() > node_counts(load).sum():
            _fill(whole, load, law, part & ~(whole.step_bound < ROUGHEST), finer=_FINER)
    unknown = ~(whole.step_error < UNKNOWN)
    whole.eps[:, unknown] = np.nan
    for values in (
        whole.least_gap,
        whole.least_angle,
        whole.step_error,
        whole.between,
        whole.step_bound,
    ):
        values[unknown] = np.nan
    return whole


def node_counts(load: CyclicLoad, finer: int = 1) -> NDArray[np.intp]:
    """Return the number of steps into which each interval between the load's angles is divided, (N,)."""
    widths = np.diff(load.angle, append=load.angle[0] + load.period)
    halvings = np.ceil(np.log2(finer * widths / LARGEST_STEP) - 1e-6)
    return (1 << np.maximum(0, halvings).astype(np.intp)).astype(np.intp)


def ring_of(load: CyclicLoad, finer: int = 1) -> tuple[Ring, NDArray[np.intp]]:
    """Return the finest nodes, and a mask of those at the load's own angles."""
    counts = node_counts(load, finer)
    own = np.cumsum(counts) - counts
    interval = np.repeat(np.arange(counts.size), counts)
    part = (np.arange(interval.size) - own[interval]) / counts[interval]
    after = (interval + 1) % counts.size

    def between(values: Array) -> Array:
        return np.asarray(values[..., interval] * (1 - part) + values[..., after] * part)

    angle = np.append(load.angle, load.angle[0] + load.period)
    place = angle[interval] * (1 - part) + angle[interval + 1] * part
    return Ring(place, load.period, between(load.S), between(load.w)), own


def _fill(whole: Orbit, load: CyclicLoad, law: MobilityLaw, part: Mask, finer: int) -> None:
    """Store the orbits of those cases in a part that converge."""
    if not part.any():
        return
    ring, own = ring_of(load.of(part), finer)
    e, settled, error, films = _nested(ring, law.of(part))
    cases = np.flatnonzero(part)[settled]
    gap = 1 - np.hypot(*e[:, settled])
    place = gap.argmin(axis=-1)
    whole.eps[:, cases] = e[:, settled][..., own]
    whole.least_gap[cases] = gap[np.arange(cases.size), place]
    whole.least_angle[cases] = ring.place[place]
    whole.step_error[cases] = error[settled]
    whole.between[cases] = films[-1][settled]
    whole.step_bound[cases] = step_bound(films)[settled]


def _nested(ring: Ring, law: MobilityLaw) -> tuple[Array, Mask, Array, list[Array]]:
    """Return the orbits on the finest ring, started from coarser rings, and further results.

    These are a mask of converged cases, the error of the gap at the nodes, and for every ring the smallest
    gap between its nodes, the finest ring last; NaN where a ring did not converge.
    """
    stride = 1 << max(0, int(np.log2(ring.place.size / _COARSEST)))
    tolerance = _ROUGH if stride > 1 else TOLERANCE
    every = np.ones(ring.w.shape[0], bool)
    e, settled = _settled(ring.every(stride), law, np.zeros_like(ring.S[..., ::stride]), tolerance, every)
    error = np.full(settled.shape, np.nan)
    films = [_between(ring.every(stride), e, settled)]
    while stride > 1:
        stride //= 2
        coarse, settled_before = e, settled
        finer, tolerance = ring.every(stride), _ROUGH if stride > 1 else TOLERANCE
        start = np.where(settled_before[:, None], _halved(coarse, finer.place.size), 0.0)
        e, settled = _settled(finer, law, start, tolerance, settled_before | (stride <= _LAST))
        shared = 1 - np.hypot(*e[..., ::2]).max(axis=-1)
        change = shared - (1 - np.hypot(*coarse).max(axis=-1))
        error = np.where(settled_before, np.abs(change) / (3 * shared), np.nan)
        films.append(_between(finer, e, settled))
    return e, settled, error, films


def _between(ring: Ring, e: Array, settled: Mask) -> Array:
    """Return the smallest gap of each case between the nodes of a ring, (C,)."""
    gap = np.where(settled[:, None], 1 - np.hypot(*e), 1.0)
    return np.where(settled, least_between(ring.place, ring.period, gap), np.nan)


def _halved(e: Array, nodes: int) -> Array:
    """Return the values on a ring with an additional node in the middle of every step."""
    finer = np.empty((*e.shape[:-1], nodes))
    finer[..., ::2] = e
    finer[..., 1::2] = ((e + np.roll(e, -1, axis=-1)) / 2)[..., : nodes // 2]
    return finer


def _settled(ring: Ring, law: MobilityLaw, e: Array, tolerance: float, tried: Mask) -> tuple[Array, Mask]:
    """Return the result of Newton's method from a start, and a mask of the converged cases.

    A case also counts as converged only if its orbit stays away from the wall.
    """
    left, settled = tried.copy(), np.zeros(tried.shape, bool)
    a = differences(ring.steps())
    for _ in range(_MOST_STEPS if left.any() else 0):
        some = ring if left.all() else ring.of(left)
        f, slopes = _rate(some, e[:, left], law if left.all() else law.of(left))
        change = newton_step(a, imbalance(a, e[:, left], f), slopes)
        moved, size = _limited(e[:, left], change)
        e[:, left] = moved
        thin = 1 - np.hypot(*moved).max(axis=-1) < THINNEST
        done = (size < tolerance) & ~thin
        settled[left] = done
        left[left] = ~(done | (thin & (size < _STUCK)) | ~np.isfinite(size))
        if not left.any():
            break
    return e, settled


def _limited(e: Array, change: Array) -> tuple[Array, Array]:
    """Return the change as it is applied: limited so that each node stays within its bearing.

    The second result is its largest magnitude relative to the gap, (C,).
    """
    gap, length = 1 - np.hypot(*e), np.hypot(*change)
    share = np.minimum(1.0, _LONGEST / np.maximum(length, _LONGEST))
    radius = 1 - np.maximum(_THINNER * gap, THINNEST / 2)
    along, room = (e * change).sum(axis=0), radius**2 - (e**2).sum(axis=0)
    length2 = np.maximum(length**2, 1e-300)
    to_wall = (np.sqrt(along**2 + length2 * np.maximum(room, 0)) - along) / length2
    share = np.minimum(share, np.maximum(to_wall, 0.0))
    return e + share * change, (share * length / gap).max(axis=-1)


def _rate(ring: Ring, e: Array, law: MobilityLaw) -> tuple[Array, Array]:
    """Return d(eps)/d(theta), (2, C, K), and its derivatives with respect to eps, (2, 2, C, K)."""
    size = np.hypot(*ring.S)
    loaded = size > 0
    c, s = np.where(loaded, ring.S / np.where(loaded, size, 1.0), [[[1.0]], [[0.0]]])
    M, slopes = law(e[0] * c + e[1] * s, e[1] * c - e[0] * s)
    turn = np.array([[c, -s], [s, c]])
    f = size * np.einsum("rsck,sck->rck", turn, M) + ring.w * np.stack([-e[1], e[0]])
    by_e = size * np.einsum("rack,abck,sbck->rsck", turn, slopes, turn)
    by_e[0, 1] -= ring.w
    by_e[1, 0] += ring.w
    return f, by_e
