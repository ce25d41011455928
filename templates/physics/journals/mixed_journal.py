r"""A journal whose load is shared by film and asperity contact, and its friction over speed (Stribeck curve).

The film force F_f acts at its attitude beta to the line of centres, the contact force F_c along that line,
and the contact friction mu F_c across it, against the rotation:

.. math::
    F^2 = (F_f\cos\beta + F_c)^2 + (F_f\sin\beta - \mu F_c)^2

Both grow with the eccentricity, so exactly one eccentricity carries a load. The film of smooth surfaces comes
from `film_map`, that of rough surfaces from the average Reynolds equation, which is solved at some
eccentricities; its difference from the map is interpolated. Only the journal rotates. The friction is the sum
of the shear over the full circle at the mean gap, the couple of the film force, and the contact friction.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.films.film_map import NARROWEST, WIDEST, mapped_film
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT
from templates.physics.numerics.roots import root_between
from templates.physics.pads.slider_film import interpolated
from templates.physics.roughness.asperities import contact_integrals, splined_summit_integral
from templates.physics.roughness.flow_factors import rough_journal

Indices = NDArray[np.int64]
"""Indices into a one-dimensional array of bearings."""

MAP, AVERAGED = "map", "averaged"
LEVELS = (MAP, AVERAGED)
"""The film of smooth surfaces, or of rough ones by the average Reynolds equation."""
MULTIPLES = np.geomspace(1e-3, 1e2, 41)
"""Speeds of the Stribeck curve over that of the bearing [-]."""
FULL_FILM = 3.0
"""Gap over roughness above which a film counts as full [-]."""

_DEEPEST = float(-np.log1p(-ECCENTRICITY_LIMIT))
_NODES = 20
_ABOUT_LOWEST = 21
_FROM_EPS = 0.05
_TO_GAP = (
    0.5  # relative to the roughness: the end of the tables, and the last gap at which the equation is solved
)


@dataclass(frozen=True, kw_only=True)
class RoughJournal:
    """A journal bearing with rough surfaces, in SI; arrays that broadcast together."""

    F: Array
    """Load [N]."""
    viscous: Array
    """Film force over speed and Sommerfeld number, B D eta/psi² [N s]."""
    area: Array
    """Half of B D [m²]."""
    ratio: Array
    """B/D [-]."""
    psi: Array
    """Relative clearance [-]."""
    roughness: Array
    """Composite roughness over radial clearance; 0 is smooth [-]."""
    asymmetry: Array
    """Squared roughness of the journal minus that of the bearing, over their sum [-]."""
    contact: Array
    """Contact pressure over F_{5/2} [Pa]."""
    mu: Array
    """Friction coefficient of the contact [-]."""


@dataclass(frozen=True)
class MixedFilm:
    """The results of film and contact; dimensionless, NaN where they cannot carry the load."""

    eps: Array
    """Relative eccentricity."""
    attitude: Array
    """Angle from the load to the narrowest gap in the sense of rotation [rad]."""
    film_share: Array
    """Force of the film over the load."""
    contact_share: Array
    """Force of the contact along the line of centres over the load."""
    contact_sum: Array
    """Integral of the contact pressure over the surface, over the load."""
    shear: Array
    """Friction force of the film on the journal over the load."""
    friction: Array
    """Friction coefficient of film and contact together."""

    def admitted(self, eps: Array) -> "MixedFilm":
        """Return the same film with NaN where eps is NaN."""
        values = (getattr(self, field.name) for field in fields(MixedFilm))
        return MixedFilm(*(np.where(np.isnan(eps), np.nan, value)[()] for value in values))


@dataclass(frozen=True)
class SmoothFilms:
    """Sommerfeld number and attitude of smooth films of a 1-D array of bearings, at any eccentricity."""

    ratio: Array
    """B/D of each bearing (N,) [-]."""

    def at(self, eps: Array, point: Indices) -> tuple[Array, Array]:
        """Return So and attitude [rad] at eccentricities of the bearings with these indices."""
        film = mapped_film(eps, self.ratio[point])
        return film["So"], film["attitude"]


class AveragedFilms:
    """Sommerfeld number and attitude of rough films, from solutions at some eccentricities.

    They are solutions of the average Reynolds equation.
    """

    def __init__(self, ratio: Array, roughness: Array, asymmetry: Array) -> None:
        self.smooth, self.low = SmoothFilms(ratio), np.full_like(roughness, -np.log1p(-_FROM_EPS))
        deepest = -np.log(np.maximum(_TO_GAP * roughness, 1 - ECCENTRICITY_LIMIT))
        self.high = np.maximum(deepest, self.low + 0.1)
        at = self.low[:, None] + (self.high - self.low)[:, None] * np.linspace(0, 1, _NODES + 1)
        eps, number = -np.expm1(-at), np.arange(ratio.size)[:, None] + np.zeros(_NODES + 1, dtype=np.int64)
        So, attitude = self.smooth.at(eps, number)
        film = np.stack([So, attitude], axis=-1)
        for i in np.flatnonzero(roughness > 0):
            film[i] = [rough_journal(e, ratio[i], roughness[i], asymmetry[i]) for e in eps[i]]
        self.load, self.turn = np.log(film[..., 0] / So), np.log(film[..., 1] / attitude)

    def at(self, eps: Array, point: Indices) -> tuple[Array, Array]:
        """Return So and attitude [rad] at eccentricities of the bearings with these indices."""
        So, attitude = self.smooth.at(eps, point)
        low, high = self.low[point], self.high[point]
        t = np.clip((-np.log1p(-eps) - low) / (high - low), 0, 1)[..., None]
        more, turn = (interpolated(values[point], t)[0][..., 0] for values in (self.load, self.turn))
        return So * np.exp(more), attitude * np.exp(turn)


@dataclass(frozen=True)
class MixedJournal:
    """A one-dimensional array of bearings with their films, and the shape of the points."""

    bearing: RoughJournal
    """The bearings whose data are complete (N,)."""
    films: SmoothFilms | AveragedFilms
    """The films of these bearings."""
    number: Indices
    """Index of the bearing of each point (...); −1 where data are missing."""

    def shares(self, eps: Array, speed: Array, i: Indices) -> tuple[Array, ...]:
        """Return the forces along and across the line of centres, and their parts, for bearings i."""
        bearings = self.bearing
        So, attitude = self.films.at(np.minimum(eps, ECCENTRICITY_LIMIT), i)
        along, around = contact_integrals(eps, bearings.roughness[i])
        scale = bearings.contact[i] * bearings.area[i]
        film, contact = bearings.viscous[i] * speed * So, scale * along
        across = film * np.sin(attitude) - bearings.mu[i] * contact
        return film * np.cos(attitude) + contact, across, film, contact, scale * around, So, attitude

    def excess(self, deep: Array, speed: Array, number: Array) -> Array:
        """Return the excess of force over load, −1 … 1, at the eccentricity 1 − exp(−deep) [-]."""
        i = number.astype(np.int64)
        along, across, *_ = self.shares(-np.expm1(-deep), speed, i)
        force = np.hypot(along, across)
        return np.asarray((force - self.bearing.F[i]) / (force + self.bearing.F[i]))

    def film(self, omega: Array, i: Indices) -> MixedFilm:
        """Return the films of bearings i at speeds, both one-dimensional."""
        deepest = np.full(omega.shape, _DEEPEST)
        deep = root_between(self.excess, np.zeros(omega.shape), deepest, omega, i.astype(float))
        eps = -np.expm1(-np.asarray(deep).reshape(omega.shape))
        borne = np.isfinite(eps)
        e, F = np.where(borne, eps, 0.0), self.bearing.F[i]
        along, across, film, contact, around, So, attitude = self.shares(e, omega, i)
        drag = np.pi / np.sqrt((1 - e) * (1 + e)) + e * So * np.sin(attitude) / 2
        shear = self.bearing.viscous[i] * omega * self.bearing.psi[i] * drag / F
        friction = shear + self.bearing.mu[i] * around / F
        values = (e, np.arctan2(across, along), film / F, contact / F, around / F, shear, friction)
        return MixedFilm(*(np.where(borne, value, np.nan) for value in values))


def mixed_journal(level: str, bearing: RoughJournal) -> MixedJournal:
    """Return the bearings with their films, at one of `LEVELS`."""
    names = [field.name for field in fields(RoughJournal)]
    values = np.broadcast_arrays(*(np.asarray(getattr(bearing, name), float) for name in names))
    rows = dict(zip(names, values, strict=True))
    usable = np.all(np.isfinite(values), axis=0) & (rows["ratio"] >= NARROWEST) & (rows["ratio"] <= WIDEST)
    bearings = RoughJournal(**{name: value[usable] for name, value in rows.items()})
    number = np.where(usable, np.cumsum(usable).reshape(usable.shape) - 1, -1)
    films: SmoothFilms | AveragedFilms = SmoothFilms(bearings.ratio)
    if level == AVERAGED:
        films = AveragedFilms(bearings.ratio, bearings.roughness, bearings.asymmetry)
    return MixedJournal(bearings, films, number)


@on_paper(
    {
        MAP: "solved numerically by bracketing the eccentricity in a map of the Reynolds equation",
        AVERAGED: "solved numerically by bracketing the eccentricity, with finite volumes of the average "
        "Reynolds equation",
    }
)
def mixed_films(journal: MixedJournal, omega: Array) -> MixedFilm:
    """Return the equilibrium of film, contact and load at each speed, arrays of the same shape.

    Parameters
    ----------
    journal
        The bearings.
    omega
        Speeds for every point (..., speeds) [rad/s].
    """
    number = np.broadcast_arrays(journal.number[..., None], omega)[0]
    speeds = np.broadcast_to(omega, number.shape)
    usable = (number >= 0) & np.isfinite(speeds)
    values = np.full((len(fields(MixedFilm)), *number.shape), np.nan)
    if usable.any():
        with np.errstate(all="ignore"):
            film = journal.film(speeds[usable], number[usable])
        values[:, usable] = [getattr(film, field.name) for field in fields(MixedFilm)]
    return MixedFilm(*values)


def mixed_film(journal: MixedJournal, omega: Array) -> MixedFilm:
    """Return the equilibrium that carries the load at one speed for each point; arrays have shape (...).

    See `mixed_films`.
    """
    films = mixed_films(journal, np.asarray(omega)[..., None])
    return MixedFilm(*(getattr(films, field.name)[..., 0] for field in fields(MixedFilm)))


@on_paper("the speed at which film and contact bear the load with this gap: the root of a square")
@units(None, "1", returns="rad/s")
def speed_at_gap(journal: MixedJournal, gap: Array) -> Array:
    """Return the speed at which the smallest gap has a given value; NaN where there is none [rad/s].

    Parameters
    ----------
    journal
        The bearings.
    gap
        Smallest gap over the radial clearance for every point [-].
    """
    number, eps = np.broadcast_arrays(journal.number, 1 - np.asarray(gap))
    usable = (number >= 0) & (eps > 0) & (eps <= ECCENTRICITY_LIMIT)
    omega, i = np.full(usable.shape, np.nan), number[usable]
    if usable.any():
        F, mu = journal.bearing.F[i], journal.bearing.mu[i]
        with np.errstate(all="ignore"):
            _, _, film, contact, *_, attitude = journal.shares(eps[usable], np.ones(i.size), i)
            half = contact * (np.cos(attitude) - mu * np.sin(attitude))
            rest = F**2 - contact**2 * (1 + mu**2)
            root = rest / (half + np.sqrt(half**2 + rest)) / film
        omega[usable] = np.where(rest > 0, root, np.nan)
    return omega[()]


@dataclass(frozen=True)
class LeastFriction:
    """The minimum of a Stribeck curve; NaN if it lies at an end of the curve."""

    multiple: Array
    """Speed of the minimum over that of the bearing."""
    friction: Array
    """Friction coefficient at the minimum."""


@on_paper("by a parabola through the lowest of 21 points about the lowest one of the curve")
def least_friction(journal: MixedJournal, omega: Array, films: MixedFilm) -> LeastFriction:
    """Return the minimum of the curve over `MULTIPLES`, refined between the neighbouring points.

    Parameters
    ----------
    journal
        The bearings.
    omega
        Their speeds [rad/s].
    films
        Equilibria at the speeds of the curve.
    """
    last = MULTIPLES.size - 1
    lowest = np.nan_to_num(films.friction, nan=np.inf).argmin(axis=-1)
    inner = (lowest > 0) & (lowest < last) & np.isfinite(films.friction).any(axis=-1)
    middle = np.where(inner, MULTIPLES[lowest], np.nan)
    step = np.log(MULTIPLES[1] / MULTIPLES[0])
    about = middle[..., None] * np.exp(step * np.linspace(-1, 1, _ABOUT_LOWEST))
    friction = mixed_films(journal, np.asarray(omega)[..., None] * about).friction
    k = np.clip(np.nan_to_num(friction, nan=np.inf).argmin(axis=-1), 1, _ABOUT_LOWEST - 2)[..., None]
    before, top, after = (np.take_along_axis(friction, k + i, axis=-1)[..., 0] for i in (-1, 0, 1))
    bend, slope = before - 2 * top + after, (after - before) / 2
    shift = np.clip(-slope / np.where(bend > 0, bend, np.inf), -1, 1)
    at, beyond = (np.take_along_axis(about, k + i, axis=-1)[..., 0] for i in (0, 1))
    return LeastFriction((at * (beyond / at) ** shift)[()], (top + slope * shift / 2)[()])


@units("Pa", "m", "m", returns="Pa", latex=r"{0}\,F_{{5/2}}\left({1}/{2}\right)")
def contact_pressure(scale: Array, gap: Array, roughness: Array) -> Array:
    """Return the contact pressure at a gap of rough surfaces, 0 for smooth ones [Pa]."""
    thick = np.where(roughness > 0, gap / np.where(roughness > 0, roughness, 1.0), gap * np.inf)
    return (scale * splined_summit_integral(np.maximum(thick, 0)) + 0 * gap)[()]


@units("m", "m", returns="m", latex=r"\sqrt{{{0}^2+{1}^2}}")
def composite_roughness(R_1: Array, R_2: Array) -> Array:
    """Return the root mean square roughness of both surfaces together [m]."""
    return np.hypot(R_1, R_2)


@units("m", "m", returns="1", latex=r"\frac{{{0}^2-{1}^2}}{{{0}^2+{1}^2}}")
def roughness_asymmetry(R_1: Array, R_2: Array) -> Array:
    """Return the asymmetry of the squared roughness of both surfaces, 0 if both are smooth [-]."""
    total = np.hypot(R_1, R_2)
    return ((R_1 - R_2) / np.where(total > 0, total, 1.0) * ((R_1 + R_2) / np.where(total > 0, total, 1.0)))[
        ()
    ]
