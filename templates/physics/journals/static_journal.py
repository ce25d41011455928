"""One journal bearing under static load at every fidelity: all film results from load and width.

Levels, cheapest first. Each states its boundary condition in `BOUNDARY` and its widths in `WIDTHS`.

    short_bearing    Ocvirk's closed form
    fit              DIN 31652-2 / ISO 7902-2
    map              the converged Swift–Stieber film, precomputed (`film_map`)
    reynolds         the Swift–Stieber film, solved on two meshes and extrapolated
    mass_conserving  cavities after Jakobsson, Floberg and Olsson; grooves and supply pressure

Everything is dimensionless, P = p psi²/(eta omega_h), So = F psi²/(B D eta omega_h). Results are NaN at
points without a load or width, or with a width outside the level's range; eps is infinite where no film
carries the load.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.language.declare import on_paper
from templates.physics.cavities.fed_film import Feed, fed_film
from templates.physics.films.film_fit import attitude_ISO_7902, load_ISO_7902
from templates.physics.films.film_fit_flow import side_flow_ISO_7902
from templates.physics.films.film_map import mapped_film, mapped_load
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.films.reynolds import extrapolated_film
from templates.physics.films.short_bearing import (
    attitude_Ocvirk_1952,
    friction_Ocvirk_1952,
    load_Ocvirk_1952,
    peak_angle_Ocvirk_1952,
    peak_pressure_Ocvirk_1952,
    side_flow_Ocvirk_1952,
)
from templates.physics.numerics.eccentricity import eccentricity

WIDTHS = {
    "short_bearing": (0.01, 100.0),
    "fit": (0.125, 1.0),
    "map": (0.01, 100.0),
    "reynolds": (0.01, 100.0),
    "mass_conserving": (0.01, 100.0),
}
"""Range of width ratios B/D of each level [-]."""

_SWIFT_STIEBER = "Swift-Stieber: p = 0 at the ends and along the widest gap; rupture where p = dp/dn = 0"
BOUNDARY = {
    "short_bearing": "Gümbel half film: p = 0 at the ends, at the widest gap and over the diverging half",
    "fit": f"{_SWIFT_STIEBER} (fitted)",
    "map": _SWIFT_STIEBER,
    "reynolds": _SWIFT_STIEBER,
    "mass_conserving": "Jakobsson-Floberg-Olsson: ambient pressure at the ends and in the cavities, supply "
    "pressure in the grooves, or along the widest gap where there are none",
}
"""Boundary condition of each level for the pressure."""


_CENTRED = 1e-6
"""Eccentricity below which a full solution is scaled linearly [-]."""


FED = "mass_conserving"
"""The level that models grooves and supply pressure."""


def is_fed(pressure: Array, grooves: tuple[tuple[float, float], ...]) -> bool:
    """Return whether there is a supply pressure above 0, or a groove."""
    return bool(grooves) or bool(np.any(np.asarray(pressure) > 0))


def ladder(
    levels: tuple[str, ...], pressure: Array, grooves: tuple[tuple[float, float], ...]
) -> tuple[str, ...]:
    """Return the levels that can model the oil supply: all except FED, or only FED."""
    return (FED,) if is_fed(pressure, grooves) else tuple(level for level in levels if level != FED)


@dataclass(frozen=True)
class JournalFilm:
    """The results of a static film; dimensionless arrays of one shape."""

    eps: Array
    """Relative eccentricity; infinite if no film carries the load."""
    So: Array
    """Sommerfeld number F psi²/(B D eta omega_h)."""
    attitude: Array
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    P_max: Array
    """Largest pressure p psi²/(eta omega_h); NaN at level fit, which has none."""
    peak: Array
    """Angle of the largest pressure from the narrowest gap in the sense of rotation [rad]; NaN at level fit.
    """
    shear: Array
    """Shear force on the journal F_s psi/(B D eta (omega_journal − omega_sleeve))."""
    side_flow: Array
    """Oil flow out of both ends, Q/(R³ psi omega_h)."""

    def admitted(self, eps: Array) -> "JournalFilm":
        """Return the same film with NaN where eps is NaN."""
        return self._each(lambda values: np.where(np.isnan(eps), np.nan, values)[()])

    def _each(self, change: Callable[[Array], Array]) -> "JournalFilm":
        return replace(self, **{field.name: change(getattr(self, field.name)) for field in fields(self)})


@on_paper(
    {
        "short_bearing": "solved numerically by bracketing the eccentricity of Ocvirk's short bearing",
        "fit": "solved numerically by bracketing the eccentricity in the fit of ISO 7902",
        "map": "solved numerically by splines in a map of solutions of the Reynolds equation",
        "reynolds": "solved numerically by finite volumes of the Reynolds equation, extrapolated",
        "mass_conserving": "solved numerically by finite volumes with mass-conserving cavities, extrapolated",
    }
)
def static_film_at(
    level: str,
    So: Array,
    ratio: Array,
    pressure: Array | float = 0.0,
    grooves: tuple[tuple[float, float], ...] = (),
) -> JournalFilm:
    """Return the film that carries So, at a level of fidelity.

    Parameters
    ----------
    level
        A key of `WIDTHS`.
    So
        Sommerfeld number, 0 or more; any shape that broadcasts with the others [-].
    ratio
        Width over diameter B/D [-].
    pressure
        Supply pressure above ambient, P = p psi²/(eta omega_h); used by mass_conserving [-].
    grooves
        (angle from the load, width) of each groove [rad]; used by mass_conserving.

    Examples
    --------
    >>> film = static_film_at("map", 3.5718, 1.0)
    >>> round(float(film.eps), 3), round(float(np.degrees(film.attitude)), 1)
    (0.8, 36.2)
    """
    So, ratio, pressure = np.broadcast_arrays(*(np.asarray(a, float) for a in (So, ratio, pressure)))
    low, high = WIDTHS[level]
    valid = np.isfinite(So) & (So >= 0) & (ratio >= low) & (ratio <= high) & np.isfinite(pressure)
    feeds = [Feed(p, grooves) for p in pressure[valid]] if level == "mass_conserving" else []
    film = SOLVERS[level](So[valid], ratio[valid], feeds)
    unborne = replace(film, eps=np.where(np.isnan(film.eps), np.inf, film.eps))
    return unborne._each(lambda values: _scattered(values, valid))


def _scattered(values: Array, valid: Mask) -> Array:
    """Return the values of the valid points in arrays with NaN elsewhere; for a single point as a number."""
    whole = np.full(valid.shape, np.nan)
    whole[valid] = values
    return whole[()]


def short_film(So: Array, ratio: Array, _: list[Feed]) -> JournalFilm:
    """Return Ocvirk's film; NaN where no film carries the load."""
    eps = eccentricity(load_Ocvirk_1952, So, ratio)
    e = np.where(np.isnan(eps), 0.0, eps)
    return JournalFilm(
        eps, So, attitude_Ocvirk_1952(e), peak_pressure_Ocvirk_1952(e, ratio),
        peak_angle_Ocvirk_1952(e) - np.pi, friction_Ocvirk_1952(e), side_flow_Ocvirk_1952(e, ratio),
    )  # fmt: skip


def fitted_film(So: Array, ratio: Array, _: list[Feed]) -> JournalFilm:
    """Return the film of the standard's fit, with shear over the full circle as in the standard."""
    eps = eccentricity(load_ISO_7902, So, ratio)
    e, none = np.where(np.isnan(eps), 0.0, eps), np.full_like(eps, np.nan)
    shear = np.pi / np.sqrt((1 - e) * (1 + e))
    return JournalFilm(eps, So, attitude_ISO_7902(e, ratio), none, none, shear, side_flow_ISO_7902(e, ratio))


def interpolated_film(So: Array, ratio: Array, _: list[Feed]) -> JournalFilm:
    """Return the film that the map gives."""
    eps = mapped_eccentricity(So, ratio)
    return replace(_mapped(np.where(np.isnan(eps), 0.0, eps), ratio), eps=eps, So=So)


def _mapped(eps: Array, ratio: Array) -> JournalFilm:
    """Return the map's film at an eccentricity."""
    film = mapped_film(eps, ratio)
    names = ("So", "attitude", "P_max", "peak", "side_flow")
    return JournalFilm(eps=eps, shear=np.pi / np.sqrt((1 - eps) * (1 + eps)), **{n: film[n] for n in names})


def solved_film(So: Array, ratio: Array, _: list[Feed]) -> JournalFilm:
    """Return the film solved point by point at the map's eccentricity, corrected to the load."""
    start = mapped_eccentricity(np.maximum(So, mapped_load(np.full_like(So, _CENTRED), ratio)), ratio)
    return _moved(So, ratio, np.array([_solved(e, b) for e, b in zip(start, ratio, strict=True)]))


def _solved(eps: float, ratio: float) -> list[float]:
    """Return the fields of `JournalFilm` from full solutions; where eps is NaN, they are NaN."""
    if np.isnan(eps):
        return [np.nan] * 7
    film = extrapolated_film(eps, ratio)[0]
    shear = np.pi / np.sqrt((1 - eps) * (1 + eps))
    return [eps, film.So, film.attitude, film.P_max, film.peak, shear, film.side_flow]


def conserving_film(So: Array, ratio: Array, feeds: list[Feed]) -> JournalFilm:
    """Return the film with cavities, point by point; in cavities only the oil is sheared.

    The results are corrected to the load in the same proportion as those of the map.
    """
    films = [fed_film(*point) for point in zip(So, ratio, feeds, strict=True)]
    film = {
        name: np.array([np.nan if film is None else getattr(film, name) for film in films])
        for name in ("eps", "solved_eps", "attitude", "P_max", "peak", "shear", "side_flow")
    }
    there, here = (_mapped(np.nan_to_num(film[name]), ratio) for name in ("eps", "solved_eps"))
    with np.errstate(invalid="ignore"):
        moved = {n: film[n] * getattr(there, n) / getattr(here, n) for n in ("P_max", "shear", "side_flow")}
    return JournalFilm(eps=film["eps"], So=So, attitude=film["attitude"], peak=film["peak"], **moved)


def _moved(So: Array, ratio: Array, near: Array) -> JournalFilm:
    """Return films near the wanted load, (N, 7), corrected to it in the same proportion as the map's film."""
    film = JournalFilm(*near.reshape(-1, 7).T)
    valid = np.isfinite(film.eps)
    at = np.where(valid, film.eps, 0.5)
    here = _mapped(at, ratio)
    there = interpolated_film(np.where(valid, So * here.So / np.where(valid, film.So, 1.0), 0.0), ratio, [])
    names = ("attitude", "P_max", "peak", "shear", "side_flow")
    moved = {name: getattr(film, name) * getattr(there, name) / getattr(here, name) for name in names}
    return JournalFilm(eps=np.where(valid, there.eps, np.nan), So=So, **moved)


SOLVERS: dict[str, Callable[[Array, Array, list[Feed]], JournalFilm]] = {
    "short_bearing": short_film,
    "fit": fitted_film,
    "map": interpolated_film,
    "reynolds": solved_film,
    "mass_conserving": conserving_film,
}
