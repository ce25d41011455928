"""The film of a journal bearing over a cycle, at every level: orbit, pressure, loss and flow.

    mobility_short   Booker's closed form (1971) of the short bearing's half film
    mobility         the finite bearing's mobility, precomputed over eccentricity, direction and B/D
    transient        mass-conserving cavities in time, oil fed along the widest gap; one case at a time

Everything is dimensionless: P = p psi²/(eta Omega), load S = F psi²/(B D eta Omega), psi the diametral
clearance over the diameter, Omega the speed of the crank. Frame: that in which the load is given; a positive
speed turns x to y. A massless journal in a rigid, aligned bearing; isothermal, laminar.
"""

from dataclasses import dataclass, fields

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.numerics.arrays import largest_load as largest_load
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw, MobilityLaw, ShortLaw
from templates.physics.orbits.mobility_map import NARROWEST, WIDEST, mapped_film_under_load
from templates.physics.orbits.short_mobility import short_film_under_load
from templates.physics.orbits.transient_orbit import (
    Marching,
    TransientOrbit,
    along_march,
    sampled_orbit,
    transient_orbit,
)

BOUNDARY = {
    "mobility_short": "half film: p = 0 at the ends and wherever the gap widens; always full of oil",
    "mobility": "p = 0 at the ends alone; rupture where p = dp/dn = 0, anywhere around: no supply line, "
    "always full of oil. The static Swift-Stieber film of oil_film 2 has p = 0 along the widest gap besides: "
    "at eps 0.1 and B/D 1 its attitude is 79.4° instead of 83.8°",
    "transient": "Jakobsson-Floberg-Olsson: ambient pressure at the ends, in the cavities and along the "
    "widest gap, where oil is fed",
}
"""What each level takes for the pressure at the film's borders."""

WIDTHS = {
    "mobility_short": (0.01, 100.0),
    "mobility": (NARROWEST, WIDEST),
    "transient": (NARROWEST, WIDEST),
}
"""Width ratios B/D that each level takes [-]."""

MARCHING = Marching()
"""Mesh and step of level transient."""
FEWEST, MOST = 12, 3600
"""Angles of a cycle."""


@dataclass(frozen=True)
class Duty:
    """What a bearing has to do over a cycle, SI; axes before that of the cycle are points."""

    angle: Array
    """(N,) crank angles [rad]."""
    F_x: Array
    F_y: Array
    """Load on the journal along the axes of the frame, (..., N) [N]."""
    omega_J: Array
    omega_B: Array
    omega_F: Array
    """Speeds of journal, sleeve and frame, (..., N), (..., 1) or single values [rad/s]."""
    Omega: Array
    """Speed of the crank, (...) [rad/s]."""
    scale: Array
    """S over F, psi²/(B D eta Omega), (...) [1/N]."""
    ratio: Array
    """Width over diameter B/D, (...) [-]."""


@dataclass(frozen=True)
class Cases:
    """The points of a duty in one row, dimensionless; NaN where the level does not take the width."""

    load: CyclicLoad
    ratio: Array
    """(C,)."""
    sliding: Array
    """(C, N) speed of the journal over the sleeve, over Omega."""
    points: tuple[int, ...]


@dataclass(frozen=True)
class CycleOrbit:
    """Where the journal goes; NaN, and eps_max infinite, where no orbit was found."""

    eps_x: Array
    eps_y: Array
    """Relative eccentricity along the axes of the frame, (..., N)."""
    gap: Array
    """1 − |eps|, (..., N)."""
    eps_max: Array
    """Largest relative eccentricity, between the angles too, (...)."""
    angle: Array
    """Its crank angle [rad]."""
    step_error: Array
    """Relative error of the smallest gap by the step, (...); NaN at level transient."""
    marched: TransientOrbit | None = None
    """Results of marching in time."""

    def admitted(self, eps_max: Array) -> "CycleOrbit":
        """Return the same with NaN where the largest eccentricity was not admitted."""
        lost = np.isnan(eps_max)

        def kept(values: Array) -> Array:
            hidden = lost[..., None] if np.ndim(values) > np.ndim(lost) else lost
            return np.asarray(np.where(hidden, np.nan, values))[()]

        names = (field.name for field in fields(self) if field.name != "marched")
        return CycleOrbit(**{name: kept(getattr(self, name)) for name in names}, marched=self.marched)


@dataclass(frozen=True)
class CycleFilm:
    """What the film does."""

    P: Array
    """Largest pressure over the bearing, (..., N)."""
    P_max: Array
    """The same over the cycle, (...)."""
    P_angle: Array
    """Its crank angle [rad]."""
    loss: Array
    """Power 2 psi/(eta Omega² B D²), mean over the cycle, (...)."""
    side_flow: Array
    """Oil that leaves at both ends, Q/(B D c Omega), c the radial clearance, mean over the cycle, (...)."""


@on_paper(
    {
        "mobility_short": "solved numerically by Newton's method, by Booker's mobility of the short bearing",
        "mobility": "solved numerically by Newton's method, by a map of the mobility of finite bearings",
        "transient": "solved numerically by marching a film with mass-conserving cavities until it repeats",
    }
)
def cycle_orbit(level: str, duty: Duty, marching: Marching = MARCHING) -> CycleOrbit:
    """Return the periodic orbit of each point, at a level of fidelity; marching counts at level transient."""
    cases = _cases(level, duty)
    start = periodic_orbit(cases.load, _law(level, cases.ratio))
    if level != "transient":
        return _shaped(start, cases.points)
    marched = None
    if np.isfinite(start.least_gap).all():
        marched = transient_orbit(cases.load, float(cases.ratio[0]), start.eps[:, 0, 0], marching)
    return _shaped(sampled_orbit(marched, cases.load), cases.points, marched)


@on_paper(
    {
        "mobility_short": "solved numerically by Booker's film of the short bearing along the orbit",
        "mobility": "solved numerically by a map of films of finite bearings along the orbit",
        "transient": "solved numerically by marching a film with mass-conserving cavities until it repeats",
    }
)
def cycle_film(level: str, duty: Duty, orbit: CycleOrbit) -> CycleFilm:
    """Return the pressure, loss and flow along an orbit."""
    cases = _cases(level, duty)
    load, points = cases.load, cases.points
    eps = np.stack([orbit.eps_x, orbit.eps_y]).reshape(2, *load.w.shape)
    weight = weights(load.angle, load.period) / load.period
    if orbit.marched is not None:
        P, flow, shear, work = along_march(orbit.marched, load, eps)
    else:
        P, flow, shear, work = _under_load(level, cases.ratio, load.S, eps)
    top = np.where(np.isnan(P), -1.0, P).argmax(axis=-1)
    return CycleFilm(
        P=P.reshape(*points, -1),
        P_max=P.max(axis=-1).reshape(points)[()],
        P_angle=np.where(np.isnan(P).any(axis=-1), np.nan, load.angle[top]).reshape(points)[()],
        loss=((shear * cases.sliding**2 + work) @ weight).reshape(points)[()],
        side_flow=(flow @ weight).reshape(points)[()],
    )


def level_spread(level: str, duty: Duty, eps_max: Array) -> Array:
    """Return the spread of the smallest films of the levels: this one's, mobility's and the short bearing's.

    Largest less smallest over the smallest; NaN where a level has no film [-].
    """
    gaps = [np.asarray(1 - eps_max)]
    gaps += [
        1 - cycle_orbit(other, duty).eps_max for other in ("mobility_short", "mobility") if other != level
    ]
    films = np.stack(np.broadcast_arrays(*gaps))
    films = np.where(films > 0, films, np.nan)
    return np.asarray(films.max(axis=0) / films.min(axis=0) - 1)[()]


def weights(angle: Array, period: float) -> Array:
    """Return the weights of the trapezoidal rule over a cycle, (N,), in the unit of the angles."""
    widths = np.diff(angle, append=angle[0] + period)
    return np.asarray((widths + np.roll(widths, 1)) / 2)


def cycle_of(angle: Array) -> float:
    """Return the cycle [rad] that crank angles [rad] cover once, 2 pi or 4 pi; NaN if neither, or not rising.

    The last angle is not the first one again, and from it to the end of the cycle is no farther than twice
    the largest other step.
    """
    if angle.ndim != 1 or not FEWEST <= angle.size <= MOST:
        return float("nan")
    steps = np.diff(angle)
    for period in (2 * np.pi, 4 * np.pi):
        last = period - (angle[-1] - angle[0])
        if (steps > 0).all() and 1e-9 < last <= 2 * steps.max() * (1 + 1e-9):
            return period
    return float("nan")


@units("rad", returns="rad", latex=r"\text{{the whole cycle that the angles cover}}")
def cycle_length(angle: Array) -> Array:
    """Return the same as a number for a formula."""
    return np.asarray(cycle_of(angle))[()]


@units("rad/s", returns="rad/s", latex=r"\left|\overline{{{0}}}\right|")
def mean_speed(speed: Array) -> Array:
    """Return the size of the mean of a speed over the cycle [rad/s]."""
    return np.abs(speed if np.ndim(speed) == 0 else np.mean(speed, axis=-1))


def _law(level: str, ratio: Array) -> MobilityLaw:
    return ShortLaw(ratio) if level == "mobility_short" else MapLaw(ratio)


def _cases(level: str, duty: Duty) -> Cases:
    """Make the points of a duty dimensionless."""
    Omega, scale, ratio = (np.asarray(v)[..., None] for v in (duty.Omega, duty.scale, duty.ratio))
    speeds = (duty.omega_J / Omega, duty.omega_B / Omega, duty.omega_F / Omega)
    curves = np.broadcast_arrays(duty.F_x * scale, duty.F_y * scale, *speeds, ratio, duty.angle)
    points = curves[0].shape[:-1]
    x, y, journal, sleeve, frame, ratio, _ = (np.reshape(c, (-1, duty.angle.size)) for c in curves)
    low, high = WIDTHS[level]
    taken = (ratio[:, 0] >= low) & (ratio[:, 0] <= high)
    w = np.where(taken[:, None], (journal + sleeve) / 2 - frame, np.nan)
    load = CyclicLoad(duty.angle, cycle_of(duty.angle), np.stack([x, y]), w)
    return Cases(load, np.where(taken, ratio[:, 0], 1.0), journal - sleeve, points)


def _under_load(level: str, ratio: Array, S: Array, eps: Array) -> tuple[Array, Array, Array, Array]:
    """Pressure, side flow, shear and the load's work on the film at the mobility levels, (C, N) each."""
    size = np.hypot(*S)
    c, s = np.where(size > 0, S / np.where(size > 0, size, 1.0), 0.0)
    valid = np.isfinite(eps[0])
    xi, eta = (np.where(valid, v, 0.0) for v in (eps[0] * c + eps[1] * s, eps[1] * c - eps[0] * s))
    M = _law(level, ratio)(xi, eta)[0]
    under = short_film_under_load if level == "mobility_short" else mapped_film_under_load
    share, leak = under(xi, eta, ratio[:, None])
    gap = 1 - np.hypot(*np.where(valid, eps, 0.0))
    integrands = size * share, leak * size * np.hypot(*M), np.pi / np.sqrt(gap * (2 - gap)), size**2 * M[0]
    P, flow, shear, work = (np.where(valid, values, np.nan) for values in integrands)
    return P, flow, shear, work


def _shaped(orbit: Orbit, points: tuple[int, ...], marched: TransientOrbit | None = None) -> CycleOrbit:
    """Return the cases in the shape of the points."""
    x, y = (e.reshape(*points, -1) for e in orbit.eps)
    gap = orbit.least_gap.reshape(points)
    return CycleOrbit(
        eps_x=x,
        eps_y=y,
        gap=1 - np.hypot(x, y),
        eps_max=np.where(np.isnan(gap), np.inf, 1 - gap)[()],
        angle=orbit.least_angle.reshape(points)[()],
        step_error=orbit.step_error.reshape(points)[()],
        marched=marched,
    )
