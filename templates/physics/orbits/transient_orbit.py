"""The orbit of a journal with mass-conserving cavities, marched until it repeats: the reference level.

The march starts from the mobility orbit and a full film, and repeats the cycle with `transient_film` at most
`MOST_CYCLES` times. `benchmarks/film_cycle.py` measures error and cost on big-end bearings, compared with a
mesh twice as fine and half the step.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.progress import report
from templates.physics.cavities.transient_balance import Journal, transient_mesh
from templates.physics.cavities.transient_film import State, stepped
from templates.physics.films.film_equations import dual_widths
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit

MOST_CYCLES = 8
"""Largest number of cycles for an orbit to repeat."""
REPEATS = 0.02
"""Largest difference between two cycles, over the gap, of an orbit that repeats; if the journal is nearly
centred, the feed node may change from cycle to cycle [-].
"""
MOST_NODES = 2000
"""Most steps in a cycle."""

_SUBSTEPS = 4
_REPORTED = 30  # steps between two reports of progress


@dataclass(frozen=True)
class MarchSettings:
    """Mesh and step."""

    around: int = 144
    across: int = 6
    step: float = np.radians(2.0)


@dataclass(frozen=True)
class TransientOrbit:
    """One cycle of an orbit that repeats; dimensionless, at equal steps."""

    place: Array
    """(K,) crank angles [rad]."""
    eps: Array
    """(2, K) relative eccentricity along the axes of the frame."""
    P_max: Array
    """(K,) largest pressure p psi²/(eta Omega)."""
    side_flow: Array
    """(K,) oil flow out of both ends, Q/(B D c Omega), c the radial clearance."""
    shear: Array
    """(K,) shear of the existing oil; pi/sqrt(1 − eps²) for a full film."""
    cycles: int
    """Number of marched cycles."""


def transient_orbit(
    load: CyclicLoad, ratio: float, start: Array, marching: MarchSettings
) -> TransientOrbit | None:
    """Return the orbit of one case, marched until it repeats; None if a step fails or it does not repeat.

    Parameters
    ----------
    load
        The load of one case.
    ratio
        Width over diameter B/D [-].
    start
        (2,) relative eccentricity at the first angle.
    marching
        Mesh and step.
    """
    count = min(MOST_NODES, int(np.ceil(load.period / marching.step - 1e-9)))
    place = load.angle[0] + load.period * np.arange(1, count + 1) / count
    S = np.stack([np.interp(place, load.angle, s, period=load.period) for s in load.S[:, 0]], axis=-1)
    w = np.interp(place, load.angle, load.w[0], period=load.period)
    journal = transient_mesh(ratio, marching.around, marching.across)
    states, before, difference = [_full(journal, start)], None, np.inf
    for cycle in range(1, MOST_CYCLES + 1):
        for k in range(count):
            if k % _REPORTED == 0:
                _report(cycle, k / count, difference)
            after = _next(journal, states, S[k], float(w[k]), load.period / count)
            if after is None:
                return None
            states.append(after)
        eps = np.stack([state.eps for state in states[-count:]], axis=-1)
        if before is not None:
            change, gap = np.hypot(*(eps - before)), 1 - np.hypot(*eps)
            if (change < REPEATS * gap).all():
                return _measured(journal, place, states[-count:], cycle)
            difference = float((change / gap).max())
        before, states = eps, states[-2:]
    return None


def sampled_orbit(marched: TransientOrbit | None, load: CyclicLoad) -> Orbit:
    """Return a marched orbit at the load's angles; NaN if there is none."""
    if marched is None:
        return Orbit(np.full(load.S.shape, np.nan), *np.full((5, load.w.shape[0]), np.nan))
    gap = 1 - np.hypot(*marched.eps)
    k = int(gap.argmin())
    eps = np.stack([_at(marched, e, load) for e in marched.eps])
    angle = load.angle[0] + (marched.place[k] - load.angle[0]) % load.period
    unknown = np.array([np.nan])
    return Orbit(eps[:, None], gap[[k]], np.array([angle]), unknown, gap[[k]], unknown)


def along_march(marched: TransientOrbit, load: CyclicLoad, eps: Array) -> tuple[Array, Array, Array, Array]:
    """Return the pressure, the side flow, the shear, and the work of the load on the film, (1, N) each."""
    P, flow, shear = (_at(marched, v, load)[None] for v in (marched.P_max, marched.side_flow, marched.shear))
    step = load.period / marched.place.size
    rate = [_at(marched, (np.roll(e, -1) - np.roll(e, 1)) / (2 * step), load) for e in marched.eps]
    squeezing = np.stack(rate)[:, None] - load.w * np.stack([-eps[1], eps[0]])
    return P, flow, shear, (load.S * squeezing).sum(axis=0)


def _at(marched: TransientOrbit, values: Array, load: CyclicLoad) -> Array:
    return np.interp(load.angle, marched.place, values, period=load.period)


def _report(cycle: int, part: float, difference: float) -> None:
    """Report the number of the cycle, and the change in the last cycle relative to the gap."""
    apart = "" if difference == np.inf else f", difference {difference:.1g} of at most {REPEATS:g}"
    report((cycle - 1 + part) / MOST_CYCLES, f"cycle {cycle} of at most {MOST_CYCLES}{apart}")


def _full(journal: Journal, eps: Array) -> State:
    """Return a full film that does not carry load yet."""
    nothing = np.zeros((journal.phi.size, journal.zeta.size - 1))
    return State(
        eps, nothing, nothing, np.broadcast_to(journal.gap(eps, journal.phi)[:, None], nothing.shape)
    )


def _next(journal: Journal, states: list[State], S: Array, w: float, step: float) -> State | None:
    """Return the state after one step; None if the step fails.

    The first step, and any step that fails with second order, is repeated with first order in several parts.
    """
    here = states[-1]
    if len(states) > 1:
        before = (states[-2].content / 2 - 2 * here.content) / step
        after = stepped(journal, here, S, w, 1.5 / step, before)
        if after is not None:
            return after
    part, after = step / _SUBSTEPS, here
    for _ in range(_SUBSTEPS):
        advanced = stepped(journal, after, S, w, 1 / part, -after.content / part)
        if advanced is None:
            return None
        after = advanced
    return after


def _measured(journal: Journal, place: Array, states: list[State], cycles: int) -> TransientOrbit:
    """Return the results of the films of a cycle."""
    step = 2 * np.pi / journal.phi.size
    width, last = dual_widths(journal.zeta)[:-1], np.diff(journal.zeta)[-1]
    gaps = [journal.gap(state.eps, journal.phi) for state in states]
    flows = (H**3 @ state.P[:, -1] for H, state in zip(gaps, states, strict=True))
    fills = ((1 - state.void) @ width / width.sum() for state in states)
    return TransientOrbit(
        place=place,
        eps=np.stack([state.eps for state in states], axis=-1),
        P_max=np.array([state.P.max() for state in states]),
        side_flow=np.array(list(flows)) * step / (24 * journal.ratio**2 * last),
        shear=np.array([fill @ (1 / H) for fill, H in zip(fills, gaps, strict=True)]) * step / 2,
        cycles=cycles,
    )
