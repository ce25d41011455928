r"""The film of a moving journal with mass-conserving cavities, advanced one time step at a time.

.. math::
    \nabla\cdot(H^3\nabla P) = 12\,\partial_\theta(\alpha H) + 12 w\,\partial_\varphi(\alpha H),\quad
    P \ge 0,\ 1-\alpha \ge 0,\ P(1-\alpha) = 0

alpha is the filled fraction of the gap, P = p psi²/(eta Omega) the pressure above the cavity pressure, which
is ambient. Angles phi are fixed in the frame of the load, in which the gap rotates at w. The journal has no
mass: at every step its position is solved for together with pressure and fill so that the film carries the
load. Newton's method solves the complementarity condition (Fischer, Burmeister) as in `cavitation`, with two
more unknowns. The discretisation uses finite volumes on half the width, second-order backward differences in
time, and upwind transport in the cavities. Oil enters at ambient pressure along the line of the widest gap,
as in `cavitating_film` without grooves.

References
----------
T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58:18, 2015;
H. G. Elrod, Trans. ASME J. Lubr. Technol. 103, 1981, p. 350.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities.transient_balance import Balance, Journal, balance
from templates.physics.films.film_equations import dual_widths

_MOST_STEPS = 60
_ACCURACY = 1e-8
_THINNER = 0.3
"""Fraction of the gap that a Newton step must leave."""
_NUDGE = 1e-7
"""Change of the eccentricity, relative to the gap, for the difference quotient."""


@dataclass(frozen=True)
class State:
    """Film and journal at one instant."""

    eps: Array
    """(2,) relative eccentricity in the frame of the load."""
    P: Array
    """(n, m) pressure."""
    void: Array
    """(n, m) fraction of the gap without oil."""
    content: Array
    """(n, m) oil in the gap, fill times H."""


def stepped(
    journal: Journal, start: State, load: Array, w: float, rate: float, before: Array
) -> State | None:
    """Return the film and journal at the next instant; None if Newton's method does not converge.

    Parameters
    ----------
    journal
        Mesh and bearing.
    start
        The initial guess.
    load
        (2,) S along the axes of the frame.
    w
        Mean speed of journal and sleeve relative to the frame, over Omega.
    rate, before
        d(content)/d(theta) = rate · content + before, (n, m) [1/rad].
    """
    eps, P, void = start.eps, start.P.copy(), start.void.copy()
    stored = 12 * before * 2 * np.pi / journal.phi.size * dual_widths(journal.zeta)[:-1]
    feed = int(
        journal.gap(eps, journal.phi).argmax()
    )  # kept during a step: moving it could prevent convergence
    P[feed] = void[feed] = 0
    for _ in range(_MOST_STEPS):
        flows = balance(journal, eps, w, rate)
        dP, dvoid, de, worst = _newton(journal, flows, eps, P, void, stored, feed, load, (w, rate))
        if not np.isfinite(de).all():
            return None
        share = _share(eps, de)
        P, void, eps = P + share * dP, void + share * dvoid, eps + share * de
        if worst < _ACCURACY and np.hypot(*de) < 1e-6 * (1 - np.hypot(*eps)):
            P, void = np.maximum(P, 0), np.clip(void, 0, 1)
            return State(eps, P, void, (1 - void) * journal.gap(eps, journal.phi)[:, None])
    return None


def _share(eps: Array, de: Array) -> float:
    """Return the fraction of a step after which the journal is still inside the bearing."""
    share, gap = 1.0, 1 - np.hypot(*eps)
    while share > 1e-6 and 1 - np.hypot(*(eps + share * de)) < _THINNER * gap:
        share /= 2
    return share


def _newton(
    journal: Journal, flows: Balance, eps: Array, P: Array, void: Array, stored: Array, feed: int,
    load: Array, motion: tuple[float, float],
) -> tuple[Array, Array, Array, float]:  # fmt: skip
    """Return the changes of pressure, void and eccentricity, and the residual of the equations."""
    loss = _loss(flows, P, void, stored)
    scale = flows.diagonals()
    pair = np.array([scale[0] * P, scale[1] * void])
    size = np.maximum(np.hypot(*pair), np.finfo(float).tiny)
    fischer, slopes = pair.sum(axis=0) - np.hypot(*pair), 1 - pair / size
    full = pair[0] >= pair[1]
    ratio, rest = slopes.min(axis=0) / slopes.max(axis=0), -fischer / slopes.max(axis=0)
    alpha = np.where(full, 1.0, -ratio) / scale[0]
    beta = np.where(full, ratio, -1.0) / scale[1]
    right = -loss + flows.by_fill(np.where(full, rest, 0) / scale[1])
    right -= flows.by_pressure(np.where(full, 0, rest) / scale[0])
    columns = [right, *(-d for d in _by_eps(journal, eps, P, void, stored, loss, motion))]
    kept = flows.solve(alpha, beta, np.stack(columns), feed)
    fed = np.arange(P.shape[0]) == feed
    offset = np.where(full | fed[:, None], 0, rest / scale[0])
    shares = alpha * np.where(fed[:, None], 0, 1)
    bearing = np.array([journal.load(shares * k) for k in kept])
    lack = load - journal.load(P + offset) - bearing[0]
    de = np.linalg.lstsq(bearing[1:].T, lack, rcond=1e-12)[0]
    k = kept[0] + de[0] * kept[1] + de[1] * kept[2]
    dP, dvoid = shares * k + offset, np.where(full, rest / scale[1], 0) - beta * k
    dvoid[feed] = 0
    unmet = np.where(fed[:, None], 0, np.maximum(np.abs(loss), np.abs(fischer)))
    total = (np.abs(flows.stored).max() + np.abs(flows.carried).max()) * flows.width.min()
    short = np.hypot(*(load - journal.load(P))) / max(np.hypot(*load), np.finfo(float).tiny)
    return dP, dvoid, de, float(max(unmet.max() / total, short))


def _loss(flows: Balance, P: Array, void: Array, stored: Array) -> Array:
    return flows.by_pressure(P) + flows.by_fill(1 - void) + stored


def _by_eps(
    journal: Journal,
    eps: Array,
    P: Array,
    void: Array,
    stored: Array,
    loss: Array,
    motion: tuple[float, float],
) -> list[Array]:
    """Return the derivative of the loss with respect to each component of the eccentricity."""
    nudge = _NUDGE * (1 - np.hypot(*eps))
    moved = (balance(journal, eps + nudge * axis, *motion) for axis in np.eye(2))
    return [(_loss(flows, P, void, stored) - loss) / nudge for flows in moved]
