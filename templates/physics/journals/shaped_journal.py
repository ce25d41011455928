"""One journal bearing under static load with any bore, aligned or tilted, at every level that supports it.

A plain, aligned bearing has the levels of `static_journal`. `shaped_balance` solves a bore with lobes or bell
mouth, a tilted journal, and a plain bearing with grooves or supply pressure: at level `reynolds` with
Swift–Stieber rupture, at level `mass_conserving` with mass-conserving cavities. Everything is dimensionless
as in `static_journal`, based on the smallest clearance; angles are measured from the load.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.cavities.fed_film import Feed
from templates.physics.cavities.shaped_balance import SMALLEST, Balance, BearingCase, NoBalance, balance
from templates.physics.films.film_map import mapped_load
from templates.physics.films.film_shape import Bore, Lie, narrowest
from templates.physics.journals.journal_coefficients import Linear, coefficients_at
from templates.physics.journals.static_journal import FED, WIDTHS, JournalFilm, is_fed, static_film_at
from templates.physics.journals.whirl import threshold_mass

BORES = ("plain", "lemon", "offset", "multi_lobe")
"""Circumferential shapes of a bore."""
START_LINES = ("fixed", "moving")
"""Behaviour of the supply line at the widest gap while the journal is displaced."""
MOVABLE = ("short_bearing", "map", "reynolds")
"""Levels with coefficients of a plain film whose supply line rotates with the journal."""

Grooves = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Shape:
    """A bore and a tilt; numbers and arrays that broadcast together, lengths over the radial clearance."""

    bore: str
    """One of `BORES`."""
    lobes: int
    """Return the number of lobes of a bore multi_lobe."""
    preload: Array
    """1 − c_b/c_p of each lobe [-]."""
    angle: Array
    """Angle of the middle of a lobe from the load [rad]."""
    offset: Array
    """Fraction of a lobe's arc before its least gap [-]."""
    mouth: Array
    """Return the opening of the bell mouth at the ends [-]."""
    mouth_length: Array
    """Axial length of each mouth over half the width [-]."""
    tilt_x: Array
    """Displacement of the journal's end relative to its middle, along the load [-]."""
    tilt_y: Array
    """The same displacement, ahead of the load [-]."""

    def numbers(self) -> list[Array]:
        """Return all fields as arrays, except the first two."""
        return [np.asarray(getattr(self, field.name), float) for field in fields(self)[2:]]

    def at(self, preload: float, angle: float, offset: float, mouth: float, mouth_length: float) -> Bore:
        """Return the bore of one point."""
        lobes = self.lobes if self.bore == "multi_lobe" else 2
        return Bore(1 if self.bore == "plain" else lobes, preload, angle, offset, mouth, mouth_length)


@dataclass(frozen=True)
class StaticFilm:
    """The results of a static film; dimensionless arrays of one shape, except the matrices (..., 2, 2)."""

    eps: Array
    """Displacement of the journal at mid-width over the radial clearance; infinite if no film carries the
    load.
    """
    attitude: Array
    """Direction of the displacement from the load [rad]."""
    least: Array
    """Smallest gap over the radial clearance."""
    P_max: Array
    """Largest pressure p psi²/(eta omega_h); NaN at level fit, which has none."""
    peak: Array
    """Angle of the largest pressure from the load [rad]; NaN at level fit."""
    shear: Array
    """Shear force on the journal F_s psi/(B D eta (omega_journal − omega_sleeve))."""
    load_couple: Array
    """Friction due to pressure, which is added with the hydrodynamic speed; So eps sin(attitude)/2 in a plain
    bearing.
    """
    side_flow: Array
    """Oil flow out of both ends, Q/(R³ psi omega_h)."""
    couple_x: Array
    """Moment against a tilt along the load, over psi²/(B D eta omega_h) and B/2."""
    couple_y: Array
    """Moment against a tilt ahead of the load, in the same unit."""
    mesh_error: Array
    """Relative error of the smallest gap due to the meshes; NaN for a plain film."""
    place_error: Array
    """Error of the journal's position over its displacement; NaN for a plain film."""
    pressure_error: Array
    """Relative error of the largest pressure due to the meshes; NaN for a plain film."""
    flow_error: Array
    """Relative error of the side flow due to the meshes; NaN for a plain film."""
    K: Array
    """Stiffness in units of So; NaN for a plain film, see `linear_of`."""
    B: Array
    """Damping in units of So; NaN for a plain film, see `linear_of`."""

    def admitted(self, eps: Array) -> StaticFilm:
        """Return the same film with NaN where eps is NaN."""
        none = np.isnan(eps)
        values = {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}
        wide = {name: none[..., None, None] if name in ("K", "B") else none for name in values}
        return StaticFilm(**{name: np.where(wide[name], np.nan, v)[()] for name, v in values.items()})


@units(None, returns="1")
def middle_of_least_gap(bore: str) -> Array:
    """Return the fraction of a lobe's arc that lies before its least gap [-].

    It is 1 if halves are offset, otherwise 1/2.
    """
    return np.asarray(1.0 if bore == "offset" else 0.5)


def is_shaped(shape: Shape) -> bool:
    """Return whether any point has a bore that is not plain, or a tilted journal."""
    return bool(np.any(departure(shape.preload, shape.mouth, shape.tilt_x, shape.tilt_y) > 0))


@units("1", "1", "1", "1", returns="1", latex=r"\max\left({0},\,{1},\,|{2}|,\,|{3}|\right)")
def departure(preload: Array, mouth: Array, tilt_x: Array, tilt_y: Array) -> Array:
    """Return the largest deviation of bore and journal from plain and aligned [-]."""
    return np.asarray(np.maximum(np.maximum(preload, mouth), np.maximum(np.abs(tilt_x), np.abs(tilt_y))))[()]


@on_paper(
    {
        "short_bearing": "solved numerically by bracketing the eccentricity of Ocvirk's short bearing",
        "fit": "solved numerically by bracketing the eccentricity in the fit of ISO 7902",
        "map": "solved numerically by splines in a map of solutions of the Reynolds equation",
        "reynolds": "solved numerically by finite volumes of the Reynolds equation, extrapolated",
        "mass_conserving": "solved numerically by finite volumes with mass-conserving cavities, extrapolated",
    }
)
def journal_film_at(
    level: str, So: Array, ratio: Array, pressure: Array, grooves: Grooves, shape: Shape, away: Array
) -> StaticFilm:
    """Return the film that carries So, at a level of fidelity.

    Parameters
    ----------
    level
        A key of `static_journal.WIDTHS`; a shaped bearing needs reynolds or mass_conserving.
    So
        Sommerfeld number based on the smallest clearance, 0 or more [-].
    ratio
        Width over diameter B/D [-].
    pressure
        Supply pressure above ambient, P = p psi²/(eta omega_h) [-].
    grooves
        (angle from the load, width) of each groove [rad].
    shape
        Bore and tilt.
    away
        Their `departure` from plain and aligned, NaN where the level cannot calculate it [-].
    """
    parts = np.broadcast_arrays(
        *(np.asarray(a, float) for a in (So, ratio, pressure, away)), *shape.numbers()
    )
    So, ratio, pressure, away, *numbers = parts
    fed = (pressure > 0) | bool(grooves)
    solved = (away > 0) | (fed & (level == FED))
    film = plain_film(static_film_at(level, np.where(solved | np.isnan(away), np.nan, So), ratio))
    names = [field.name for field in fields(StaticFilm)]
    values = {name: np.array(getattr(film, name), float) for name in names}
    low, high = WIDTHS[level]
    valid = np.isfinite(parts).all(axis=0) & (So >= 0) & (ratio >= low) & (ratio <= high)
    for place in zip(*np.nonzero(np.atleast_1d(solved & valid)), strict=True):
        at = place if So.shape else ()
        one = _solved(
            level, float(So[at]), float(ratio[at]), Feed(float(pressure[at]), grooves), shape,
            [float(part[at]) for part in numbers],
        )  # fmt: skip
        for name in names:
            values[name][at] = one[name]
    return StaticFilm(**{name: value[()] for name, value in values.items()})


def plain_film(film: JournalFilm) -> StaticFilm:
    """Return the film of a plain, aligned bearing fed along its widest gap, as a `StaticFilm`."""
    nought, matrix = np.zeros_like(film.eps), np.full((*np.shape(film.eps), 2, 2), np.nan)
    unknown = np.full_like(nought, np.nan)
    with np.errstate(invalid="ignore"):
        couple = film.So * np.where(np.isinf(film.eps), np.nan, film.eps) * np.sin(film.attitude) / 2
    return StaticFilm(
        film.eps, film.attitude, 1 - film.eps, film.P_max, film.attitude + film.peak, film.shear, couple,
        film.side_flow, nought, nought, unknown, unknown, unknown, unknown, matrix, matrix,
    )  # fmt: skip


def _solved(
    level: str, So: float, ratio: float, feed: Feed, shape: Shape, numbers: list[float]
) -> dict[str, Array | float]:
    """Return the fields of `StaticFilm` of one point by `shaped_balance`.

    eps is infinite if no film carries the load.
    """
    bore, tilt, conserving = shape.at(*numbers[:5]), np.array(numbers[5:]), level == FED
    if level not in ("reynolds", FED):
        return _unborne()
    loaded = BearingCase(So, ratio, bore, tilt, feed, conserving)
    smallest = float(mapped_load(np.array(SMALLEST), np.array(ratio))) if loaded.line_turns else 0.0
    if feed.pressure > 0 or So >= smallest:
        smallest = So
    try:
        balanced = balance(BearingCase(smallest, ratio, bore, tilt, feed, conserving))
    except NoBalance:
        return _unborne()
    return measured(balanced, bore, tilt, So / smallest if smallest > 0 else 1.0)


def _unborne() -> dict[str, Array | float]:
    none: dict[str, Array | float] = dict.fromkeys((field.name for field in fields(StaticFilm)), np.nan)
    return none | {"eps": np.inf}


def measured(balanced: Balance, bore: Bore, tilt: Array, share: float) -> dict[str, Array | float]:
    """Return the fields of `StaticFilm`, by Richardson extrapolation in the asymptotic range of the meshes.

    The order is 2, or 1 for results that depend on a re-formation front or on the pressure at the ends.
    Outside the asymptotic range the results are those of the finest mesh. `share` is the force over the load:
    if it is below 1, the journal lies closer to the middle in proportion.
    """
    coarse, fine, at_fine = balanced.coarse.film, balanced.fine.film, balanced.fine.lie
    third = 1 / 3 if balanced.is_asymptotic else 0.0
    lie = Lie(share * (at_fine.e + third * (at_fine.e - balanced.coarse.lie.e)), tilt)
    if not 0.5 * balanced.fine.gap < narrowest(bore, lie)[0] and share == 1:
        lie = at_fine
    couple = fine.couple + third * (fine.couple - coarse.couple)
    first = third if not fine.conserving else 3 * third
    return {
        "eps": lie.eps,
        "attitude": lie.attitude,
        "least": narrowest(bore, lie)[0],
        "P_max": share * (fine.peak[0] + third * (fine.peak[0] - coarse.peak[0])),
        "peak": fine.peak[1],
        "shear": fine.shear + first * (fine.shear - coarse.shear),
        "load_couple": share * (fine.load_couple + third * (fine.load_couple - coarse.load_couple)),
        "side_flow": share * (fine.side_flow + 3 * third * (fine.side_flow - coarse.side_flow)),
        "couple_x": float(couple[0]),
        "couple_y": float(couple[1]),
        "mesh_error": balanced.gap_error,
        "place_error": balanced.place_error,
        "pressure_error": balanced.pressure_error,
        "flow_error": balanced.flow_error,
        "K": fine.linear[0],
        "B": fine.linear[1],
    }


def linear_of(
    level: str, film: StaticFilm, So: Array, ratio: Array, start_line: str, pressure: Array, grooves: Grooves
) -> Linear:
    """Return stiffness, damping and threshold mass; NaN at points without a film and at level fit [-].

    With a fixed supply line, the line stays in place while the journal is displaced. With a moving line, it
    rotates with the journal's displacement; the film then rotates as a whole, which changes the stiffness
    against displacement across the line of centres, but not the damping. Lobes and grooves are stationary.
    """
    K, B = (np.array(matrix, float) for matrix in (film.K, film.B))
    plain = np.isfinite(film.eps) & np.isnan(K).all(axis=(-1, -2))
    K_plain, B_plain = coefficients_at(level, np.where(plain, film.eps, np.nan), ratio)
    if start_line == "moving":
        K_plain = _turning(K_plain, film, So) if level in MOVABLE else np.full_like(K_plain, np.nan)
        if not (is_fed(pressure, grooves) and level == FED):
            K = np.where(np.asarray(film.couple_x == 0)[..., None, None], K, np.nan)
    K, B = (np.where(plain[..., None, None], *pair) for pair in ((K_plain, K), (B_plain, B)))
    entries = {
        f"{name}_{xy}": matrix[..., i, j][()]
        for name, matrix in (("K", K), ("B", B))
        for xy, i, j in (("xx", 0, 0), ("xy", 0, 1), ("yx", 1, 0), ("yy", 1, 1))
    }
    valid = np.asarray(np.isfinite(K).all(axis=(-1, -2)))
    unit = np.broadcast_to(np.eye(2), K.shape)
    mass = threshold_mass(*(np.where(valid[..., None, None], matrix, unit) for matrix in (K, B)))
    return Linear(**entries, M_c=np.where(valid, mass, np.nan)[()])


def _turning(K: Array, film: StaticFilm, So: Array) -> Array:
    """Return the stiffness with the column for displacements across the line of centres changed.

    The film rotates as a whole: a displacement across by eps d(gamma) rotates the force by d(gamma), so the
    force changes by So/eps at right angles.
    """
    cos, sin = np.cos(film.attitude), np.sin(film.attitude)
    turn = np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)
    along_centres = np.swapaxes(turn, -1, -2) @ K @ turn
    eps = np.maximum(np.asarray(film.eps, float), 1e-12)
    along_centres[..., 0, 1] = So * sin / eps
    along_centres[..., 1, 1] = So * cos / eps
    return np.asarray(turn @ along_centres @ np.swapaxes(turn, -1, -2))
