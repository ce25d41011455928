"""March a supplied film over a cycle: BDF2 steps whose size follows the gap; a failed step is halved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.supplied.supplied_mesh import Mesh
from templates.physics.supplied.supply import Supply

if TYPE_CHECKING:
    from collections.abc import Callable

GAP_CHANGE = 0.2
"""Relative change of the gap that a step aims at; the step is not reduced below `SMALLEST` times the
requested step."""
STRAYS = 3.0
"""Aimed-at deviation of the journal from a move at constant velocity, in gaps per square of the requested
step [1/rad²]: at 2° 0.4 % of the gap."""
RETAKEN, SMALLEST = 2.0, 1 / 8
"""A step this many times too large is repeated; smallest fraction of the requested step [-]."""
SHORTEST = 1e-3
"""Fraction of the requested step below which a step that still fails ends the march."""
OVERDRAWN = 1.02
"""If the void of a cell exceeds this, a second-order step removed more oil than the cell held and is
repeated with first order [-]."""


@dataclass(frozen=True)
class TurnedAngle:
    """The integral of a periodic speed that is linear between its angles."""

    angle: Array
    """(N,) rising crank angles [rad]."""
    period: float
    speed: Array
    """(N,) speed over Omega [-]."""

    def __call__(self, theta: Array) -> Array:
        """Return the angle through which the part has rotated since crank angle 0 [rad]."""
        return self._since_first(theta - self.angle[0]) - self._at_zero

    @cached_property
    def of_cycle(self) -> float:
        """Return the angle through which the part rotates in a cycle [rad]."""
        return float(self._nodes[2][-1])

    @cached_property
    def _nodes(self) -> tuple[Array, Array, Array]:
        """Return (N + 1,) angles from the first one, the speeds there, and the angles rotated since."""
        place = np.append(self.angle - self.angle[0], self.period)
        speed = np.append(self.speed, self.speed[0])
        turned = np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(place))
        return place, speed, np.append(0.0, turned)

    @cached_property
    def _inner(self) -> tuple[Array, Array]:
        """Return (N − 1,) angles between pieces, and (N,) slopes of the speed on each piece."""
        place, speed, _ = self._nodes
        return place[1:-1], np.diff(speed) / np.diff(place)

    @cached_property
    def _at_zero(self) -> float:
        return float(self._since_first(np.array([-self.angle[0] % self.period]))[0])

    def _since_first(self, since: Array) -> Array:
        place, speed, turned = self._nodes
        cycle = np.floor(since / self.period)
        part = since - cycle * self.period
        between, slope = self._inner
        k = between.searchsorted(part, side="right")
        into = part - place[k]
        return np.asarray(cycle * turned[-1] + turned[k] + speed[k] * into + slope[k] * into**2 / 2)


@dataclass(frozen=True)
class Duty:
    """Loads and speeds of one bearing, and its oil supply."""

    load: CyclicLoad
    """One case."""
    sliding: Array
    """(N,) speed of the journal over the sleeve, over Omega [-]."""
    supply: Supply
    mass: float
    """Mass of the journal m c Omega psi²/(B D eta), c radial [-]."""

    @property
    def begin(self) -> float:
        """Return the first crank angle [rad]."""
        return float(self.load.angle[0])

    @cached_property
    def mesh_turning(self) -> TurnedAngle:
        """Return the rotation of the mesh in the frame, at the mean speed of journal and sleeve."""
        return TurnedAngle(self.load.angle, self.load.period, self.load.w[0])

    @cached_property
    def journal_turning(self) -> TurnedAngle:
        """Return the rotation of the journal in the mesh; the sleeve rotates back by the same angle."""
        return TurnedAngle(self.load.angle, self.load.period, self.sliding / 2)

    @cached_property
    def _force(self) -> tuple[Array, NDArray[np.complex128]]:
        """Return ascending angles from before 0 to beyond the period, and the load there, x + i y.

        They are stored because `np.interp` with a period would recompute both at every call.
        """
        angle = self.load.angle % self.load.period
        order = np.argsort(angle)
        ends = np.concatenate([order[-1:], order, order[:1]])
        around = angle[ends]
        around[0] -= self.load.period
        around[-1] += self.load.period
        x, y = self.load.S[:, 0, ends]
        return around, x + 1j * y

    def in_frame(self, theta: Array) -> tuple[NDArray[np.complex128], Array]:
        """Return the load x + i y and the mean speed of journal and sleeve in the frame, (K,) each."""
        period = self.load.period
        w = np.interp(theta, self.load.angle, self.load.w[0], period=period)
        return np.interp(theta % period, *self._force), w

    def seen(self, theta: Array) -> tuple[Array, Array]:
        """Return load (K, 2) and pocket positions (K, k, 3) in the axes of the mesh, for the kernel."""
        S = np.interp(theta % self.load.period, *self._force) * np.exp(-1j * self.mesh_turning(theta))
        turned = self.journal_turning(theta)
        places = np.empty((theta.size, len(self.supply.pockets), 3))
        for k, pocket in enumerate(self.supply.pockets):
            places[:, k, 0] = pocket.centre + (turned if pocket.on_journal else -turned)
            places[:, k, 1:] = pocket.half_angle, pocket.half_length
        return np.stack([S.real, S.imag], axis=-1), places


@dataclass(frozen=True)
class State:
    """A film at one crank angle, in the axes of the mesh."""

    theta: float
    e: Array
    """(2,) relative eccentricity."""
    P: Array
    """(n, m) pressure."""
    void: Array
    """(n, m) 1 − alpha."""
    oil: Array
    """(n, m) alpha H."""
    velocity: Array
    """(2,) d(e)/d(theta)."""
    step: float
    """Step that led to this state; 0 at a start [rad]."""
    feed: float = 0.0
    """Oil fed, Q/(B D c Omega), c the radial clearance."""
    side_flow: float = 0.0
    """Oil lost at both ends, Q/(B D c Omega)."""
    flows: tuple[float, float] = (0.0, 0.0)
    """Oil fed and oil lost over the last step, averaged as the step does: their difference is stored."""


def gap_at(mesh: Mesh, e: Array) -> Array:
    """Return the gap H at the nodes, divided by the radial clearance, (n,) [-]."""
    return np.asarray(1 - e @ mesh.normal)


def start(mesh: Mesh, duty: Duty) -> State:
    """Return a full film with the journal displaced by half the clearance along the load."""
    S = duty.seen(np.array([duty.begin]))[0][0]
    e, none = 0.5 * S / max(float(np.hypot(*S)), 1e-9), np.zeros((mesh.order.size, mesh.width.size))
    return State(duty.begin, e, none, none, none + gap_at(mesh, e)[:, None], np.zeros(2), 0.0)


def stepped(mesh: Mesh, duty: Duty, states: list[State], h: float) -> State | None:
    """Return the state after a step, with second order and the active-set method if possible."""
    from templates.physics.supplied.supplied_kernel import covered, solved  # numba takes a second to load

    last = states[-1]
    theta = last.theta + h
    (S,), (places,) = duty.seen(np.array([theta]))
    seen = covered(mesh, places)
    for second, smooth in ((True, False), (True, True), (False, False), (False, True)):
        if second and (len(states) < 2 or last.step == 0):
            continue
        r = h / last.step if second else 0.0
        older = states[-2] if second else last
        rate, a1, a2 = (1 + 2 * r) / (1 + r) / h, -(1 + r) / h, r * r / (1 + r) / h
        drift = a1 * last.e + a2 * older.e
        done, e, P, void, fed, side = solved(
            mesh, (last.e, last.P, last.void), S, seen, duty.supply.pressure, rate,
            a1 * last.oil + a2 * older.oil, duty.mass, np.array([rate / h, *((drift - last.velocity) / h)]),
            smooth,
        )  # fmt: skip
        if done and (not second or void.max() < OVERDRAWN):
            P, void = np.maximum(P, 0.0), np.maximum(void, 0.0)
            oil = (1 - void) * gap_at(mesh, e)[:, None]
            fed, side = fed / 24, side / 24
            now, past = (1 + r) / (1 + 2 * r), r / (1 + 2 * r)
            flows = (now * fed + past * last.flows[0], now * side + past * last.flows[1])
            return State(theta, e, P, void, oil, rate * e + drift, h, fed, side, flows)
    return None


def _size(last: State, after: State, step: float) -> float:
    """Return the ratio of a step to the best step, from the changes of the gap and of the velocity."""
    before, now = (1 - np.hypot(*state.e) for state in (last, after))
    gap = abs(np.log(now / before)) / GAP_CHANGE
    strayed = np.hypot(*(after.e - last.e - after.step * last.velocity)) / min(before, now)
    return float(max(gap, np.sqrt(strayed / STRAYS) / step if last.step > 0 else 0.0))


def marched(
    mesh: Mesh, duty: Duty, begin: State, step: float, say: Callable[[float], None]
) -> tuple[list[State], int, bool]:
    """Return the states of one cycle, the number of halved steps, and whether the cycle was completed.

    say: receives the completed fraction of the cycle before each step.
    """
    states, halvings, h = [begin], 0, step
    end = begin.theta + duty.load.period
    while states[-1].theta < end - 1e-9:
        last = states[-1]
        say(1 - (end - last.theta) / duty.load.period)
        left = end - last.theta
        h = left if left < 1.3 * h else h
        after = stepped(mesh, duty, states, h)
        if after is None:
            h, halvings = h / 2, halvings + 1
            if h < SHORTEST * step:
                return states, halvings, False
            continue
        size = _size(last, after, step)
        if size > RETAKEN and h > SMALLEST * step * (1 + 1e-9) and left > h:
            h = max(h / 2, SMALLEST * step)
            continue
        if size > 1:
            h = max(h / 2, SMALLEST * step)
        elif size < 0.5:
            h = min(2 * h, step)
        states.append(after)
    return states, halvings, True
