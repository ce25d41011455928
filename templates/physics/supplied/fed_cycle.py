"""The film of a journal bearing over a cycle, fed as in an engine, at every level.

Orbit, pressure, loss and flow:

    mobility_short    Booker's closed form (1971) of the short bearing's half film; knows no supply
    mobility          the finite bearing's mobility from its map; knows no supply
    mobility_grooved  the same, with a groove in the sleeve: where the load passes it, two lands bear
    flooded           mass-conserving cavities in time, oil at ambient pressure along the widest gap and
                      nowhere else; knows no groove, hole or supply pressure; one case at a time
    supplied          mass-conserving cavities in time, fed by grooves and holes; one case at a time

Level mobility_grooved takes from the load what the supply pressure bears at rest in a groove, the `lift` of a
duty. Level supplied goes on, on finer meshes, where every hole stays under the load.

Everything is dimensionless: P = p psi²/(eta Omega), load S = F psi²/(B D eta Omega), psi the diametral
clearance over the diameter, Omega the speed of the crank. The load is what the journal pushes with, in a
frame whose axes sleeve and journal share at crank angle 0; a positive speed turns x to y. A massless journal
(supplied: nearly so) in a rigid, aligned bearing; isothermal, laminar.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.language.declare import on_paper
from templates.physics.orbits.cyclic_film import CycleFilm, Duty, cycle_of, weights
from templates.physics.orbits.grooved_mobility import (
    Groove,
    Passing,
    grooved_film_under_load,
    grooved_orbit,
    lift_of,
    lifting,
)
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw, ShortLaw
from templates.physics.orbits.mobility_map import NARROWEST, WIDEST, mapped_film_under_load
from templates.physics.orbits.short_mobility import short_film_under_load
from templates.physics.orbits.transient_orbit import (
    Marching,
    TransientOrbit,
    along_march,
    sampled_orbit,
    transient_orbit,
)
from templates.physics.orbits.turning import turning
from templates.physics.supplied.feeding import Feeding, supply_of
from templates.physics.supplied.supplied_orbit import NEAR_HOLES, SuppliedOrbit, Verdict, supplied_orbit
from templates.physics.supplied.supply import Supply

LEVELS = ("mobility_short", "mobility", "mobility_grooved", "flooded", "supplied")
BOUNDARY = {
    "mobility_short": "half film: p = 0 at the ends and wherever the gap widens; always full, no supply",
    "mobility": "p = 0 at the ends alone; rupture where p = dp/dn = 0; always full, no supply",
    "mobility_grooved": "as mobility; where the load passes the groove, p = 0 at the groove's edges too; "
    "less load, by what the supply bears there at rest",
    "flooded": "Jakobsson-Floberg-Olsson: ambient pressure at the ends, in the cavities and along the "
    "widest gap, where oil is fed",
    "supplied": "Jakobsson-Floberg-Olsson: ambient pressure at the ends and in the cavities, supply pressure "
    "in grooves and holes; oil in a cavity stays where it is",
}
"""What each level takes for the pressure at the film's borders."""
WIDTHS = {"mobility_short": (0.01, 100.0), **dict.fromkeys(LEVELS[1:], (NARROWEST, WIDEST))}
"""Width ratios B/D that each level takes [-]."""
UNREPEATED = (Verdict.STARVED, Verdict.UNSETTLED)
"""Verdicts that leave no film to report."""


@dataclass(frozen=True)
class FedDuty:
    """What a bearing has to do over a cycle, and what feeds it; SI."""

    duty: Duty
    """Load and speeds; the load is what the journal pushes with."""
    groove_share: Array
    """Width of a groove in the sleeve over that of the bearing, 0 where there is none, (...) [-]."""
    groove_start: Array
    """Where it begins, from the sleeve's axis, (...) [rad]."""
    groove_extent: Array
    """Extent in the sense x to y, (...) [rad]."""
    supply: Supply | None
    """Grooves and holes and their pressure, of the one point of level supplied."""
    lift: Array
    """What the supply pressure bears at rest in the groove and over its lands, as a load number, (...); level
    mobility_grooved takes it from the load [-]."""


@dataclass(frozen=True)
class FedOrbit:
    """Where the journal goes; NaN, and eps_max infinite, where no orbit was found."""

    eps_x: Array
    eps_y: Array
    """Relative eccentricity along the axes of the frame, (..., N)."""
    gap: Array
    """1 − |eps|, (..., N)."""
    eps_max: Array
    """Largest relative eccentricity, between the angles too, by a parabola, (...)."""
    angle: Array
    """Its crank angle, at the mobility levels that of the nearest node [rad]."""
    numerical_error: Array
    """Relative error of the smallest gap by the step, or from cycle to cycle, (...); NaN where unknown."""
    marched: SuppliedOrbit | None = None
    """Results of marching in time at level supplied."""
    flooded: TransientOrbit | None = None
    """Results of marching in time at level flooded."""

    def admitted(self, eps_max: Array) -> "FedOrbit":
        """Return the same with NaN where the largest eccentricity was not admitted."""
        lost = np.isnan(eps_max)

        def kept(values: Array) -> Array:
            hidden = lost[..., None] if np.ndim(values) > np.ndim(lost) else lost
            return np.asarray(np.where(hidden, np.nan, values))[()]

        names = (field.name for field in fields(self) if field.name not in ("marched", "flooded"))
        values = {name: kept(getattr(self, name)) for name in names}
        return FedOrbit(**values, marched=self.marched, flooded=self.flooded)

    @property
    def verdict(self) -> str:
        """End of a march at level supplied; empty without one."""
        return self.marched.verdict.value if self.marched else ""

    @property
    def reason(self) -> str:
        """Return why no film repeats, in words; empty where one does or level supplied did not march."""
        return self.marched.reason if self.marched else ""

    @property
    def cycles(self) -> Array:
        """Return the cycles marched on all meshes; NaN without a march, (...)."""
        if self.flooded:
            return self._everywhere(float(self.flooded.cycles))
        return self._everywhere(float(sum(self.marched.cycles)) if self.marched else np.nan)

    @property
    def mass_balance(self) -> Array:
        """Return oil fed less oil lost and stored, over the oil lost; NaN but at level supplied."""
        return self._everywhere(self.marched.mass_balance if self.marched else np.nan)

    @property
    def feed(self) -> Array:
        """Return oil fed, Q/(B D c Omega), c the radial clearance, in the mean.

        NaN if no film repeats, (...).
        """
        if not self.marched or self.marched.verdict in UNREPEATED:
            return self._everywhere(np.nan)
        return self._everywhere(self.marched.mean_feed)

    def _everywhere(self, value: float) -> Array:
        return np.full_like(self.eps_max, value)[()]


@dataclass(frozen=True)
class _Cases:
    """The points of a duty in one row, dimensionless."""

    passing: Passing
    ratio: Array
    """(C,) width over diameter; 1 where the level does not take it, and the load has no speed then."""
    sliding: Array
    """(C, N) speed of the journal over the sleeve, over Omega."""
    points: tuple[int, ...]

    @property
    def load(self) -> CyclicLoad:
        """Return the load on its own."""
        return self.passing.load


@on_paper(
    {
        "mobility_short": "solved numerically by Newton's method, by Booker's mobility of the short bearing",
        "mobility": "solved numerically by Newton's method, by a map of the mobility of finite bearings",
        "mobility_grooved": "solved numerically by Newton's method, by a map for bearing and lands",
        "flooded": "solved numerically by marching a film with mass-conserving cavities until it repeats",
        "supplied": "solved numerically by marching a fed film that conserves its oil until it repeats",
    }
)
def fed_orbit(level: str, fed: FedDuty) -> FedOrbit:
    """Return the periodic orbit of each point, at a level of fidelity."""
    cases = _cases(level, fed)
    if level == "flooded":
        return _flooded_orbit(cases)
    if level != "supplied":
        return _shaped(_periodic(level, cases), cases)
    if fed.supply is None or not np.isfinite(cases.load.w).all():
        return _shaped(_nowhere(cases.load), cases)
    marched = supplied_orbit(
        cases.load, cases.sliding[0], float(cases.ratio[0]), fed.supply, near_holes=NEAR_HOLES
    )
    if marched.verdict in UNREPEATED:
        return _filmless(_shaped(_nowhere(cases.load), cases, marched))
    return _shaped(_sampled(marched, cases.load), cases, marched)


@on_paper(
    {
        "mobility_short": "solved numerically by Booker's film of the short bearing along the orbit",
        "mobility": "solved numerically by a map of films of finite bearings along the orbit",
        "mobility_grooved": "solved numerically by a map of films, for bearing and lands, along the orbit",
        "flooded": "solved numerically by marching a film with mass-conserving cavities until it repeats",
        "supplied": "solved numerically by marching a fed film that conserves its oil until it repeats",
    }
)
def fed_film(level: str, fed: FedDuty, orbit: FedOrbit) -> CycleFilm:
    """Return the pressure, loss and flow along an orbit.

    Side flow of level supplied with what its supply drives.
    """
    cases = _cases(level, fed)
    load, points = cases.load, cases.points
    eps = np.stack([orbit.eps_x, orbit.eps_y]).reshape(2, *load.w.shape)
    if orbit.flooded is not None:
        P, flow, shear, work = along_march(orbit.flooded, load, eps)
    elif orbit.marched is not None:
        P, flow, shear, work = _of_march(orbit.marched, load, eps)
    else:
        P, flow, shear, work = _of_map(level, cases, eps)
    weight = weights(load.angle, load.period) / load.period
    top = np.where(np.isnan(P), -1.0, P).argmax(axis=-1)
    return CycleFilm(
        P=P.reshape(*points, -1),
        P_max=P.max(axis=-1).reshape(points)[()],
        P_angle=np.where(np.isnan(P).any(axis=-1), np.nan, load.angle[top]).reshape(points)[()],
        loss=((shear * cases.sliding**2 + work) @ weight).reshape(points)[()],
        side_flow=(flow @ weight).reshape(points)[()],
    )


def fed_duty(duty: Duty, feeding: Feeding, pressure: Array) -> FedDuty:
    """Return a duty with what feeds it, at a supply pressure P = p psi²/(eta Omega) [-]."""
    share = np.where(feeding.grooved, feeding.groove_width / feeding.W, 0.0)
    supply = supply_of(feeding, pressure) if np.size(pressure) == 1 else None
    lift = lift_of(share, feeding.groove_extent, pressure)
    return FedDuty(duty, share, feeding.groove_start, feeding.groove_extent, supply, lift)


def _cases(level: str, fed: FedDuty) -> _Cases:
    """Make the points of a duty dimensionless; NaN speeds where the level does not take the width."""
    duty, period = fed.duty, cycle_of(fed.duty.angle)
    lifted = level == "mobility_grooved"
    of_groove = (fed.groove_share, fed.groove_start, fed.groove_extent, fed.lift if lifted else 0.0)
    single = (duty.Omega, duty.scale, duty.ratio, *of_groove)
    Omega, scale, *flat = (np.asarray(v)[..., None] for v in single)
    speeds = (duty.omega_J / Omega, duty.omega_B / Omega, duty.omega_F / Omega)
    curves = np.broadcast_arrays(duty.F_x * scale, duty.F_y * scale, *speeds, *flat, duty.angle)
    points = curves[0].shape[:-1]
    x, y, journal, sleeve, frame, *rows, _ = (np.reshape(c, (-1, duty.angle.size)) for c in curves)
    ratio, share, start, extent, lift = (row[:, 0] for row in rows)
    groove = Groove(np.nan_to_num(share), np.nan_to_num(start), np.nan_to_num(extent))
    turned = turning(duty.angle, period, sleeve - frame)
    taken = _taken(level, ratio, groove, turned.turns)
    rests = replace(turned, turns=np.where(taken, np.nan_to_num(turned.turns), turned.turns))
    whole = Groove(np.where(taken, groove.share, 0.0), groove.start, groove.extent)
    w = np.where(taken[:, None], (journal + sleeve) / 2 - frame, np.nan)
    S = np.stack([x, y])
    if lifted:
        S = S - lifting(lift, rests, whole, duty.angle)
    passing = Passing(CyclicLoad(duty.angle, period, S, w), rests, whole)
    return _Cases(passing, np.where(taken, ratio, 1.0), journal - sleeve, points)


def _taken(level: str, ratio: Array, groove: Groove, turns: Array) -> Mask:
    """Return which cases a level takes: by their width, that of the lands, and what the sleeve does."""
    low, high = WIDTHS[level]
    taken = (ratio >= low) & (ratio <= high)
    if level != "mobility_grooved":
        return np.asarray(taken)
    around = groove.extent >= 2 * np.pi - 1e-9
    back = np.isfinite(turns) | around | (groove.share == 0)
    return np.asarray(taken & (groove.land(ratio) >= NARROWEST) & back)


def _flooded_orbit(cases: _Cases) -> FedOrbit:
    """Return the orbit of the one case at level flooded, marched from that at level mobility."""
    ratio = cases.ratio
    start, flooded = periodic_orbit(cases.load, MapLaw(ratio)), None
    if np.isfinite(start.least_gap).all():
        flooded = transient_orbit(cases.load, float(ratio[0]), start.eps[:, 0, 0], Marching())
    return replace(_shaped(sampled_orbit(flooded, cases.load), cases), flooded=flooded)


def _periodic(level: str, cases: _Cases) -> Orbit:
    if level == "mobility_grooved":
        return grooved_orbit(cases.passing, cases.ratio)
    return periodic_orbit(
        cases.load, ShortLaw(cases.ratio) if level == "mobility_short" else MapLaw(cases.ratio)
    )


def _of_map(level: str, cases: _Cases, eps: Array) -> tuple[Array, Array, Array, Array]:
    """Return the pressure, side flow, shear and work on the film at the mobility levels, (C, N) each."""
    S, ratio = cases.load.S, cases.ratio
    size = np.hypot(*S)
    c, s = np.where(size > 0, S / np.where(size > 0, size, 1.0), 0.0)
    valid = np.isfinite(eps[0])
    xi, eta = (np.where(valid, v, 0.0) for v in (eps[0] * c + eps[1] * s, eps[1] * c - eps[0] * s))
    if level == "mobility_grooved":
        M, (share, leak) = grooved_film_under_load(xi, eta, ratio, cases.passing)
    elif level == "mobility":
        M, (share, leak) = MapLaw(ratio)(xi, eta)[0], mapped_film_under_load(xi, eta, ratio[:, None])
    else:
        M, (share, leak) = ShortLaw(ratio)(xi, eta)[0], short_film_under_load(xi, eta, ratio[:, None])
    gap = 1 - np.hypot(*np.where(valid, eps, 0.0))
    integrands = size * share, leak * size * np.hypot(*M), np.pi / np.sqrt(gap * (2 - gap)), size**2 * M[0]
    P, flow, shear, work = (np.where(valid, values, np.nan) for values in integrands)
    return P, flow, shear, work


def _filmless(orbit: FedOrbit) -> FedOrbit:
    """Return the same without any eccentricity: there is no film, and no refusal either."""
    return replace(orbit, eps_max=np.full_like(orbit.eps_max, np.nan)[()])


def _shaped(orbit: Orbit, cases: _Cases, marched: SuppliedOrbit | None = None) -> FedOrbit:
    """Return the cases in the shape of the points."""
    points = cases.points
    x, y = (e.reshape(*points, -1) for e in orbit.eps)
    gap = orbit.between.reshape(points)
    return FedOrbit(
        eps_x=x,
        eps_y=y,
        gap=1 - np.hypot(x, y),
        eps_max=np.where(np.isnan(gap), np.inf, 1 - gap)[()],
        angle=orbit.least_angle.reshape(points)[()],
        numerical_error=orbit.step_bound.reshape(points)[()],
        marched=marched,
    )


def _nowhere(load: CyclicLoad) -> Orbit:
    return Orbit(np.full(load.S.shape, np.nan), *np.full((5, load.w.shape[0]), np.nan))


def _sampled(marched: SuppliedOrbit, load: CyclicLoad) -> Orbit:
    """Return a marched orbit at the load's angles."""
    eps = np.stack([_at(marched, e, load) for e in marched.eps])
    gap, angle, error = (
        np.array([v])
        for v in (marched.least_gap, marched.least_angle, marched.repeat_error + marched.mesh_error)
    )
    return Orbit(eps[:, None], gap, angle, error, gap, error)


def _at(marched: SuppliedOrbit, values: Array, load: CyclicLoad) -> Array:
    return np.interp(load.angle, marched.theta, values, period=load.period)


def _of_march(marched: SuppliedOrbit, load: CyclicLoad, eps: Array) -> tuple[Array, Array, Array, Array]:
    """Return the pressure, mean side flow, shear and the load's work on the film, (1, N) each."""
    P, shear = (_at(marched, v, load)[None] for v in (marched.P_max, marched.shear))
    flow = np.full_like(P, marched.mean_side_flow)  # of the steps, which are finer than the load's angles
    rate = [_at(marched, _slope(marched.theta, e, load.period), load) for e in marched.eps]
    squeezing = np.stack(rate)[:, None] - load.w * np.stack([-eps[1], eps[0]])
    valid = np.isfinite(eps[0])
    P, flow, shear = (np.where(valid, values, np.nan) for values in (P, flow, shear))
    return P, flow, shear, (load.S * squeezing).sum(axis=0)


def _slope(theta: Array, values: Array, period: float) -> Array:
    """Return d/d(theta) of what repeats, from the neighbours on either side, (K,)."""
    before = theta - np.roll(theta, 1)
    before[0] += period
    after = np.roll(before, -1)
    rise = (values - np.roll(values, 1)) / before
    return np.asarray((rise * after + np.roll(rise, -1) * before) / (before + after))
