"""Cycles of a supplied film on one mesh, until they repeat or the film is found to lose its oil.

A fed bearing soon forgets its initial state: most orbits repeat after 3 to 6 cycles. Two kinds do not. If all
the oil has to enter under the load, little enters: the film thins like 1/sqrt(n) with the cycle n, or faster
(`thins`). And if the journal crosses a space without oil and hits the film on the other side, the position of
the impact may change from cycle to cycle by more than a step, although the least gap does not change. The
test therefore uses the mean change over the cycle.

If the mesh, and with it the oil, makes half a revolution per cycle, as with cycles of 360°, the load acts on
the film of the cycle before the last: then two successive changes must be small.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from templates.core.arrays import Array
from templates.physics.orbits.step_bound import least_between
from templates.physics.supplied.supplied_march import Duty, State, marched
from templates.physics.supplied.supplied_mesh import Mesh

if TYPE_CHECKING:
    from collections.abc import Callable

REPEATS = 1e-3
"""Largest relative change of the smallest gap between two cycles of a repeating orbit [-]."""
DRIFTS = 0.02
"""Largest change of the eccentricity between two cycles of a repeating orbit, over the gap and averaged
over the cycle [-]."""
WANDERS = 0.03
"""Largest change of the smallest gap in `RECENT` cycles for which an orbit is reported with its
`repeat_error` [-]."""
RECENT = 3
STARVING, EARLIEST = 0.15, 24
"""A film starves if its smallest gap tends to less than this fraction of the last one; first cycle that is
judged [-]."""

_SAMPLES = 361


class RunOutcome(StrEnum):
    """How a run on one mesh ended."""

    REPEATING = "repeating"
    UNSETTLED = "unsettled"
    THINNING = "thinning"
    FAILED = "failed"


@dataclass(frozen=True)
class Run:
    """The cycles on one mesh."""

    mesh: Mesh
    states: list[State]
    """States of the last whole cycle; the first state is its start."""
    gaps: list[float]
    """Smallest gap of each cycle [-]."""
    drift: float
    """Change of the eccentricity since the previous cycle over the gap, averaged over the cycle; infinite
    in the first [-]."""
    halvings: int
    """Number of halved steps in the last cycle."""
    ending: RunOutcome

    @property
    def repeat_error(self) -> float:
        """Return the change of the least gap in the last cycle, or the largest recent change.

        The largest recent change counts if the orbit does not repeat.
        """
        if len(self.gaps) < 2:
            return np.inf
        return change(self.gaps, 1 if self.ending is RunOutcome.REPEATING else RECENT)


def run_in(
    mesh: Mesh,
    duty: Duty,
    state: State,
    step: float,
    most: int,
    say: Callable[[int, float], None],
) -> Run:
    """March until the orbit repeats, thins or fails, or the number of cycles is used up; return the run.

    Parameters
    ----------
    mesh
        The mesh of the state.
    duty
        Loads, speeds and oil supply of the bearing.
    state
        The initial state.
    step
        Largest step [rad].
    most
        Largest number of cycles.
    say
        Receives the cycle, from 1, and its completed fraction.
    """
    gaps: list[float] = []
    before, states, drift, halvings = None, [state], np.inf, 0
    alternating = 1 if returns(duty.mesh_turning.of_cycle) else 2
    for cycle in range(1, most + 1):
        new, halved, ended = marched(mesh, duty, states[-1], step, partial(say, cycle))
        if not ended:
            return Run(mesh, states, gaps, drift, halvings, RunOutcome.FAILED)
        states, halvings = new, halved
        theta, z = in_frame(duty, states)
        gaps.append(least_gap(theta[1:], 1 - np.abs(z[1:]), duty.load.period)[0])
        sampled = np.interp(np.linspace(theta[0], theta[-1], _SAMPLES), theta, z)
        if before is not None:
            drift = float(np.mean(np.abs(sampled - before) / (1 - np.abs(sampled))))
            if len(gaps) > alternating and change(gaps, alternating) < REPEATS and drift < DRIFTS:
                return Run(mesh, states, gaps, drift, halvings, RunOutcome.REPEATING)
        before = sampled
        if thins(gaps):
            return Run(mesh, states, gaps, drift, halvings, RunOutcome.THINNING)
    return Run(mesh, states, gaps, drift, halvings, RunOutcome.UNSETTLED)


def change(gaps: list[float], cycles: int) -> float:
    """Return the largest relative change of the least gap between consecutive cycles, over the last ones."""
    return float(np.abs(np.diff(gaps[-cycles - 1 :]) / gaps[-cycles:]).max())


def returns(turned: float, within: float = 0.02) -> bool:
    """Return whether an angle [rad] is a whole number of revolutions."""
    return bool(abs((turned + np.pi) % (2 * np.pi) - np.pi) <= within)


def thins(gaps: list[float]) -> bool:
    """Return whether the least gaps of all cycles on a mesh tend to zero, like 1/sqrt(n) or faster.

    A film that no oil enters is squeezed out: under a constant load its gap falls like 1/sqrt(n) with the
    cycle n. A line in 1/sqrt(n) through the second half of the gaps then extrapolates to nearly zero. For an
    orbit that converges it extrapolates to nearly the gap itself.
    """
    n = len(gaps)
    if n < EARLIEST:
        return False
    late = np.array(gaps[n // 2 :])
    slope, limit = np.polyfit(np.arange(n // 2 + 1, n + 1) ** -0.5, late, 1)
    return bool(slope > 0 and limit < STARVING * late[-1])


def in_frame(duty: Duty, states: list[State]) -> tuple[Array, Array]:
    """Return the crank angles [rad] and eccentricities e_x + i e_y [-] of states, (K,) each."""
    theta = np.array([state.theta for state in states])
    e = np.array([state.e for state in states])
    return theta, (e[:, 0] + 1j * e[:, 1]) * np.exp(1j * duty.mesh_turning(theta))


def least_gap(theta: Array, gap: Array, period: float) -> tuple[float, float]:
    """Return the smallest gap of a cycle and its angle, by a parabola through three angles.

    Parameters
    ----------
    theta
        (K,) ascending angles of one cycle [rad].
    gap
        (K,) gaps at these angles [-].
    period
        The cycle [rad].
    """
    if theta.size < 3:
        return float(gap.min()), float(theta[gap.argmin()])
    nodes = (int(gap.argmin()) + np.array([-1, 0, 1])) % theta.size
    here = theta[nodes[1]]
    bend, slope, _ = np.polyfit((theta[nodes] - here + period / 2) % period - period / 2, gap[nodes], 2)
    angle = here - slope / (2 * bend) if bend > 0 else here
    return float(least_between(theta, period, gap[None])[0]), float(angle)
