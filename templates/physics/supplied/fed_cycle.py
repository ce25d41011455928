"""The film of a journal bearing over a cycle, fed as in an engine, at every level.

The levels compute orbit, pressure, power loss and flow:

    mobility_short    Booker's closed form (1971) of the short bearing's half film; ignores the supply
    mobility          the finite bearing's mobility from its map; ignores the supply
    mobility_grooved  `mobility` with a groove in the sleeve: two lands carry a load that acts at the groove
    flooded           mass-conserving cavities in time, oil at ambient pressure along the widest gap and
                      nowhere else; ignores groove, hole and supply pressure; one case at a time
    supplied          mass-conserving cavities in time, fed by grooves and holes; case after case

Everything is dimensionless: P = p psi²/(eta Omega), load S = F psi²/(B D eta Omega), psi the diametral
clearance over the diameter, Omega the speed of the crank. The load is the force that the journal exerts, in a
frame whose axes coincide with those of sleeve and journal at crank angle 0; a positive speed turns x to y.
The journal is massless (nearly so at level `supplied`), the bearing rigid and aligned, the film isothermal
and laminar.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.declare import on_paper
from templates.core.progress import part_of_progress
from templates.physics.orbits.cyclic_film import CycleFilm, Duty, cycle_of, weights
from templates.physics.orbits.grooved_mobility import (
    Groove,
    GroovePassage,
    grooved_film_under_load,
    grooved_orbit,
    lift_of,
    lifting,
)
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw, ShortLaw
from templates.physics.orbits.mobility_map import NARROWEST, WIDEST, mapped_film_under_load
from templates.physics.orbits.rotation import turning
from templates.physics.orbits.short_mobility import short_film_under_load
from templates.physics.orbits.transient_orbit import (
    MarchSettings,
    TransientOrbit,
    along_march,
    sampled_orbit,
    transient_orbit,
)
from templates.physics.supplied.supplied_orbit import NEAR_HOLES, SuppliedOrbit, Verdict, supplied_orbit
from templates.physics.supplied.supply import Supply
from templates.physics.supplied.supply_geometry import AROUND, SupplyGeometry, supplies_of

MOBILITY = ("mobility_short", "mobility", "mobility_grooved")
LEVELS = (*MOBILITY, "flooded", "supplied")
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
"""Boundary conditions of the pressure at each level."""
WIDTHS = {"mobility_short": (0.01, 100.0), **dict.fromkeys(LEVELS[1:], (NARROWEST, WIDEST))}
"""Smallest and largest width ratio B/D at each level [-]."""
OWN_ERRORS = {
    "maximum_pressure": "pressure",
    "power_loss": "loss",
    "side_flow": "side_flow",
    "supply_flow": "side_flow",
    "bore_deflection": "pressure",
}
"""Outputs whose error the march states, each with the name of that error in `Totals`."""
UNREPEATED = (Verdict.STARVED, Verdict.UNSETTLED)
"""Verdicts for which no film is reported."""
REMEDY = {
    Verdict.STARVED: "move the groove or the hole to where the load seldom points, or add one",
    Verdict.UNSETTLED: "give less load in kN, or more `dynamic_viscosity` in mPa*s; under a light load give "
    "less `supply_pressure` in bar",
}
"""Changes of the input that can give a repeating film."""


@dataclass(frozen=True)
class FedDuty:
    """Loads and speeds of a bearing over a cycle, and its oil supply; SI."""

    duty: Duty
    """Load and speeds; the load is the force of the journal on the film."""
    groove_share: Array
    """Width of a groove in the sleeve over the width of the bearing, 0 without a groove, (...) [-]."""
    groove_start: Array
    """Angle from the sleeve's axis at which the groove begins, (...) [rad]."""
    groove_extent: Array
    """Angle that the groove extends from its start in the sense x to y, (...) [rad]."""
    pressure: Array
    """Supply pressure above ambient P = p psi²/(eta Omega), NaN without a supply, (...) [-]."""
    supplies: NDArray[np.object_] | None = None
    """Grooves and holes and their pressure, a `Supply` or None, (...); only level supplied needs them."""


@dataclass(frozen=True)
class FedOrbit:
    """The orbit of the journal; NaN, and eps_max infinite, where no orbit was found."""

    eps_x: Array
    eps_y: Array
    """Relative eccentricity along the axes of the frame, (..., N)."""
    gap: Array
    """1 − |eps|, (..., N)."""
    eps_max: Array
    """Largest relative eccentricity, also between the angles (by a parabola), (...)."""
    angle: Array
    """Crank angle of the largest eccentricity; the mobility levels give that of the nearest node [rad]."""
    numerical_error: Array
    """Relative error of the smallest gap from the step or from cycle to cycle, (...); NaN where unknown."""
    marches: tuple[SuppliedOrbit | None, ...] = ()
    """Result of the march at level supplied for each point; None for a point without speed or supply."""
    flooded: TransientOrbit | None = None
    """Result of the march at level flooded."""

    def admitted(self, eps_max: Array) -> "FedOrbit":
        """Return the same orbit with NaN where the largest eccentricity is NaN."""
        lost = np.isnan(eps_max)

        def kept(values: Array) -> Array:
            hidden = lost[..., None] if np.ndim(values) > np.ndim(lost) else lost
            return np.asarray(np.where(hidden, np.nan, values))[()]

        names = (field.name for field in fields(self) if field.name not in ("marches", "flooded"))
        values = {name: kept(getattr(self, name)) for name in names}
        return FedOrbit(**values, marches=self.marches, flooded=self.flooded)

    def required(self) -> "FedOrbit":
        """Return the same orbit if its film repeats or there are several points; otherwise raise an error.

        Raises
        ------
        InvalidInputs
            Named after the verdict, if the film of a single point starves or no orbit was found.
        """
        if len(self.marches) == 1 and (marched := self.marches[0]) and marched.verdict in UNREPEATED:
            detail = f"no film repeats: {marched.reason}; {REMEDY[marched.verdict]}"
            raise InvalidInputs([Fault("supply", marched.verdict.value, detail)])
        return self

    @property
    def verdict(self) -> str:
        """Return the outcome of a march at level supplied, numbered for several points; else empty."""
        return _of_points([marched.verdict.value if marched else "" for marched in self.marches])

    @property
    def reason(self) -> str:
        """Return the reason why no film repeats; empty if one does or level supplied was not used."""
        return _of_points([marched.reason if marched else "" for marched in self.marches])

    @property
    def cycles(self) -> Array:
        """Return the cycles marched on all meshes; NaN without a march, (...)."""
        if self.flooded:
            return self._everywhere(float(self.flooded.cycles))
        return self.of_marches(lambda marched: float(sum(marched.cycles)))

    @property
    def mass_balance(self) -> Array:
        """Return oil fed minus oil lost and stored, over the oil lost; NaN except at level supplied."""
        return self.of_marches(lambda marched: marched.mass_balance)

    @property
    def feed(self) -> Array:
        """Return the mean flow of oil fed, Q/(B D c Omega), c the radial clearance, (...).

        It is NaN if no film repeats.
        """
        return self.of_marches(lambda m: np.nan if m.verdict in UNREPEATED else m.mean_feed)

    def of_marches(self, value: Callable[[SuppliedOrbit], float]) -> Array:
        """Return a value of each point's march; NaN for points without a march, (...)."""
        if not self.marches:
            return self._everywhere(np.nan)
        values = [value(marched) if marched else np.nan for marched in self.marches]
        return np.reshape(values, np.shape(self.eps_max))[()]

    def march_error(self, output: str) -> Array:
        """Return the numerical error of an output of level supplied; NaN where unknown, (...) [-]."""
        name = OWN_ERRORS[output]
        return self.of_marches(lambda m: np.nan if m.verdict in UNREPEATED else getattr(m.error, name))

    def _everywhere(self, value: float) -> Array:
        return np.full_like(self.eps_max, value)[()]


def _of_points(texts: Sequence[str]) -> str:
    """Return one text for all points, or a text for each point; empty if no text applies."""
    if len(set(texts)) <= 1:
        return next(iter(texts), "")
    return "; ".join(f"point {number}: {text}" for number, text in enumerate(texts, 1) if text)


@dataclass(frozen=True)
class _Cases:
    """The points of a duty as a one-dimensional array, dimensionless."""

    passing: GroovePassage
    ratio: Array
    """(C,) width over diameter; 1, and a load without speed, where the level does not support the width."""
    sliding: Array
    """(C, N) speed of the journal over the sleeve, over Omega."""
    pressure: Array
    """(C,) supply pressure [-]."""
    points: tuple[int, ...]

    @property
    def load(self) -> CyclicLoad:
        """Return the cyclic load alone."""
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
    supplies = np.broadcast_to(np.asarray(fed.supplies, dtype=object), cases.points).ravel()
    marches: list[SuppliedOrbit | None] = []
    for number, supply in enumerate(supplies):
        with part_of_progress(number, supplies.size):
            marches.append(_marched(cases, number, supply))
    return _of_marches(cases, tuple(marches))


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
    """Return pressure, loss and flow along an orbit.

    At level supplied the side flow includes the flow that the supply drives.
    """
    cases = _cases(level, fed)
    load, points = cases.load, cases.points
    eps = np.stack([orbit.eps_x, orbit.eps_y]).reshape(2, *load.w.shape)
    if orbit.flooded is not None:
        P, flow, shear, work = along_march(orbit.flooded, load, eps)
    elif orbit.marches:
        each = [_of_march(m, load.of(one), eps[:, one]) for one, m in _one_by_one(orbit.marches)]
        P, flow, shear, work = (np.concatenate(rows) for rows in zip(*each, strict=True))
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
        feed_flow=_driven(level, cases, eps, weight).reshape(points)[()],
    )


def _driven(level: str, cases: _Cases, eps: Array, weight: Array) -> Array:
    """Return the mean flow that the supply pressure drives from the groove over both lands, (C,).

    The pressure of the film does not reduce it, as in ISO 7902-1 for a steady load. It is 0 if the level
    ignores the supply pressure, or includes this flow in the side flow.
    """
    if level not in MOBILITY:
        return np.zeros(cases.ratio.shape)
    groove, sleeve = cases.passing.groove, cases.passing.sleeve
    angle = cases.load.angle
    start = sleeve.at(angle, sleeve.swing) + groove.start[:, None]
    whole = (groove.extent >= AROUND)[:, None]
    cubes = gap_cubed(eps[0], eps[1], np.where(whole, np.nan_to_num(start), start), groove.extent[:, None])
    lands = 24 * cases.ratio**2 * (1 - groove.share)
    return np.where(groove.share > 0, cases.pressure * (cubes @ weight) / lands, 0.0)


def gap_cubed(eps_x: Array, eps_y: Array, start: Array, extent: Array) -> Array:
    """Return the integral of H³ over an arc of a bearing, H = 1 − eps · n, by its antiderivative [rad].

    Parameters
    ----------
    eps_x, eps_y
        Relative eccentricity [-].
    start, extent
        Start and extent of the arc [rad].
    """
    eps, centre = np.hypot(eps_x, eps_y), np.arctan2(eps_y, eps_x)

    def up_to(angle: Array) -> Array:
        sin = np.sin(angle)
        square = 1.5 * eps**2 * (angle + sin * np.cos(angle))
        return np.asarray(angle - 3 * eps * sin + square - eps**3 * (sin - sin**3 / 3))

    return up_to(start + extent - centre) - up_to(start - centre)


def fed_duty(level: str, duty: Duty, feeding: SupplyGeometry, pressure: Array) -> FedDuty:
    """Return a duty with its oil supply at a level, for a supply pressure P = p psi²/(eta Omega) [-]."""
    share = np.where(feeding.grooved, feeding.groove_width / feeding.W, 0.0)
    supplies = supplies_of(feeding, pressure) if level == "supplied" else None
    return FedDuty(duty, share, feeding.groove_start, feeding.groove_extent, pressure, supplies)


def _cases(level: str, fed: FedDuty) -> _Cases:
    """Return the points of a duty, dimensionless; NaN speeds where the level does not support the width."""
    duty, period = fed.duty, cycle_of(fed.duty.angle)
    of_groove = (fed.groove_share, fed.groove_start, fed.groove_extent)
    fed_points = np.zeros(
        () if fed.supplies is None else fed.supplies.shape
    )  # points may differ only in the size of a hole, so the shape of the supplies counts too
    single = (duty.Omega, duty.scale, duty.ratio, *of_groove, fed.pressure, fed_points)
    Omega, scale, *flat = (np.asarray(v)[..., None] for v in single)
    speeds = (duty.omega_J / Omega, duty.omega_B / Omega, duty.omega_F / Omega)
    curves = np.broadcast_arrays(duty.F_x * scale, duty.F_y * scale, *speeds, *flat, duty.angle)
    points = curves[0].shape[:-1]
    x, y, journal, sleeve, frame, *rows, _ = (np.reshape(c, (-1, duty.angle.size)) for c in curves)
    ratio, share, start, extent, pressure, _ = (row[:, 0] for row in rows)
    groove = Groove(np.nan_to_num(share), np.nan_to_num(start), np.nan_to_num(extent))
    turned = turning(duty.angle, period, sleeve - frame)
    taken = _taken(level, ratio, groove, turned.turns)
    rests = replace(turned, turns=np.where(taken, np.nan_to_num(turned.turns), turned.turns))
    whole = Groove(np.where(taken, groove.share, 0.0), groove.start, groove.extent)
    w = np.where(taken[:, None], (journal + sleeve) / 2 - frame, np.nan)
    S = np.stack([x, y])
    if level == "mobility_grooved":
        S = S - lifting(lift_of(groove.share, groove.extent, pressure), rests, whole, duty.angle)
    passing = GroovePassage(CyclicLoad(duty.angle, period, S, w), rests, whole)
    return _Cases(passing, np.where(taken, ratio, 1.0), journal - sleeve, pressure, points)


def _taken(level: str, ratio: Array, groove: Groove, turns: Array) -> Mask:
    """Return a mask of the cases that a level supports.

    It depends on the widths of bearing and lands, and on the rotation of the sleeve.
    """
    low, high = WIDTHS[level]
    taken = (ratio >= low) & (ratio <= high)
    if level != "mobility_grooved":
        return np.asarray(taken)
    around = groove.extent >= 2 * np.pi - 1e-9
    back = np.isfinite(turns) | around | (groove.share == 0)
    return np.asarray(taken & (groove.land(ratio) >= NARROWEST) & back)


def _flooded_orbit(cases: _Cases) -> FedOrbit:
    """Return the orbit of a single case at level flooded, marched from that at level mobility."""
    ratio = cases.ratio
    start, flooded = periodic_orbit(cases.load, MapLaw(ratio)), None
    if np.isfinite(start.least_gap).all():
        flooded = transient_orbit(cases.load, float(ratio[0]), start.eps[:, 0, 0], MarchSettings())
    return replace(_shaped(sampled_orbit(flooded, cases.load), cases), flooded=flooded)


def _periodic(level: str, cases: _Cases) -> Orbit:
    if level == "mobility_grooved":
        return grooved_orbit(cases.passing, cases.ratio)
    return periodic_orbit(
        cases.load, ShortLaw(cases.ratio) if level == "mobility_short" else MapLaw(cases.ratio)
    )


def _of_map(level: str, cases: _Cases, eps: Array) -> tuple[Array, Array, Array, Array]:
    """Return pressure, side flow, shear and work on the film at the mobility levels, (C, N) each."""
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


def _one_by_one(marches: tuple[SuppliedOrbit | None, ...]) -> Iterator[tuple[Mask, SuppliedOrbit | None]]:
    """Yield the mask of each case with its march."""
    for number, marched in enumerate(marches):
        yield np.arange(len(marches)) == number, marched


def _marched(cases: _Cases, number: int, supply: Supply | None) -> SuppliedOrbit | None:
    """Return the march of one case; None if the level does not support it."""
    load = cases.load.of(np.arange(cases.ratio.size) == number)
    if supply is None or not np.isfinite(load.w).all():
        return None
    ratio = float(cases.ratio[number])
    return supplied_orbit(load, cases.sliding[number], ratio, supply, near_holes=NEAR_HOLES)


def _of_marches(cases: _Cases, marches: tuple[SuppliedOrbit | None, ...]) -> FedOrbit:
    """Return the orbits of all cases; a starved film has eccentricities of NaN, which no bound refuses."""
    orbits = [
        _sampled(marched, cases.load.of(one)) if marched and marched.verdict not in UNREPEATED
        else _nowhere(cases.load.of(one))
        for one, marched in _one_by_one(marches)
    ]  # fmt: skip
    eps, *single = ([getattr(orbit, field.name) for orbit in orbits] for field in fields(Orbit))
    whole = Orbit(np.concatenate(eps, axis=1), *map(np.concatenate, single))
    shaped = replace(_shaped(whole, cases), marches=marches)
    filmless = np.reshape([marched is not None for marched in marches], cases.points) & np.isinf(
        shaped.eps_max
    )
    return replace(shaped, eps_max=np.where(filmless, np.nan, shaped.eps_max)[()])


def _shaped(orbit: Orbit, cases: _Cases) -> FedOrbit:
    """Return the values of the cases in the shape of the points."""
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
    )


def _nowhere(load: CyclicLoad) -> Orbit:
    return Orbit(np.full(load.S.shape, np.nan), *np.full((5, load.w.shape[0]), np.nan))


def _sampled(marched: SuppliedOrbit, load: CyclicLoad) -> Orbit:
    """Return a marched orbit at the load's angles."""
    eps = np.stack([_at(marched, e, load) for e in marched.eps])
    gap, angle, error = (np.array([v]) for v in (marched.least_gap, marched.least_angle, marched.error.gap))
    return Orbit(eps[:, None], gap, angle, error, gap, error)


def _at(marched: SuppliedOrbit, values: Array, load: CyclicLoad) -> Array:
    return np.interp(load.angle, marched.theta, values, period=load.period)


def _of_march(
    marched: SuppliedOrbit | None, load: CyclicLoad, eps: Array
) -> tuple[Array, Array, Array, Array]:
    """Return pressure, mean side flow, shear and the work of the load on the film, (1, N) each."""
    if marched is None:
        nothing = np.full_like(load.w, np.nan)
        return nothing, nothing, nothing, nothing
    P, shear = (_at(marched, v, load)[None] for v in (marched.P_max, marched.shear))
    flow = np.full_like(
        P, marched.mean_side_flow
    )  # mean over the steps, which are finer than the angles of the load
    rate = [_at(marched, _slope(marched.theta, e, load.period), load) for e in marched.eps]
    squeezing = np.stack(rate)[:, None] - load.w * np.stack([-eps[1], eps[0]])
    valid = np.isfinite(eps[0])
    P, flow, shear = (np.where(valid, values, np.nan) for values in (P, flow, shear))
    return P, flow, shear, (load.S * squeezing).sum(axis=0)


def _slope(theta: Array, values: Array, period: float) -> Array:
    """Return d/d(theta) of periodic values by central differences, (K,)."""
    before = theta - np.roll(theta, 1)
    before[0] += period
    after = np.roll(before, -1)
    rise = (values - np.roll(values, 1)) / before
    return np.asarray((rise * after + np.roll(rise, -1) * before) / (before + after))
