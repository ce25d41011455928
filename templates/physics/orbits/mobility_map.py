"""The mobility of a finite bearing, precomputed over eccentricity, direction of the load, and width.

Booker's frame: xi along the load, eta ahead of it. The map's coordinates are the gap in the direction of the
load, h = 1 − xi, as ln h + h; the position on the chord of that gap, |eta|/sqrt(1 − xi²), in which the thin
film has the same extent at every h; and ln(B/D). Cubic splines represent the ratio of the mobility to the
short bearing's (Booker 1971), which is smooth even where the journal is centred. Film and boundary condition
are those of `film_mobility`, with rotation and squeeze solved together; directions are mirrored.
`benchmarks/mobility_map.py` computes and measures the map from solutions extrapolated by Richardson. Measured
at 800 places, the error of M is at most 7e-4 of its magnitude up to eps 0.999 at B/D 0.1 … 4 (median 5e-5),
and at most 3e-3 anywhere; the error of P_max is 2 % and largest where the journal separates; `mobility_error`
returns the errors near each place. Range: eps 0 … 1 − 1e-6, B/D 0.02 … 10, every direction; values outside
are refused. Velocity of the centre: d(eps)/dt = M F psi²/(B D eta) + omega_bar × eps, omega_bar the mean
speed of journal and sleeve.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; J. Lubr. Technol. 93, 1971, p. 168.
"""

from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT, require
from templates.physics.numerics.uniform_spline import Axis, surface
from templates.physics.numerics.volume_spline import Axes, at_third, volume
from templates.physics.orbits.film_mobility import Motion

NARROWEST, WIDEST = 0.02, 10.0
"""Width ratios B/D that the map covers [-]."""
LARGEST = 1 - 1e-6
"""The largest relative eccentricity of the map [-]."""

_DATA = Path(__file__).with_name("mobility_map.npz")


@dataclass(frozen=True)
class MobilityMap:
    """The map's data."""

    axes: Axes
    """Nodes over gap, chord and width; see `coordinates`."""
    motion: Array
    """Spline coefficients of the first two values of `encode`."""
    film: Array
    """Spline coefficients of the last two values of `encode`."""
    error: Array
    """(cells over gap, chord, width, 4) largest error measured in each cell; see `mobility_error`."""


@cache
def mobility_map() -> MobilityMap:
    """Return the map's data, which are read once."""
    with np.load(_DATA) as data:
        gap, chord, width = (Axis(float(a), float(h), int(n)) for a, h, n in data["axes"])
        values, error = data["values"].astype(float), data["error"].astype(float)
    return MobilityMap((gap, chord, width), values[..., :2].copy(), values[..., 2:].copy(), error)


def mapped_mobility(eps: Array, ratio: Array, load_direction: Array) -> Array:
    """Return the mobility M: the journal velocity that a load causes if the film does not rotate [-].

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-6 [-].
    ratio
        Width over diameter B/D, 0.02 … 10 [-]; fastest if it is one number.
    load_direction
        Angle of the load on the journal from the narrowest gap, −pi … pi [rad].

    Returns
    -------
    (2, ...) along the line of centres (towards the narrowest gap) and ahead of it.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    eps = np.asarray(eps, float)
    require((eps >= 0) & (eps <= LARGEST), "eps must lie in [0, 1 - 1e-6] for the mobility map")
    require(np.abs(load_direction) <= np.pi, "load_direction must lie in [-pi, pi]")
    cos, sin = np.cos(load_direction), np.sin(load_direction)
    along, ahead = mapped_mobility_along_load(eps * cos, -eps * sin, ratio)
    return np.stack([along * cos - ahead * sin, along * sin + ahead * cos])


def mapped_mobility_along_load(xi: Array, eta: Array, ratio: Array) -> Array:
    """Return the mobility M in Booker's frame, without angles, for the integration of an orbit [-].

    Parameters
    ----------
    xi
        Relative eccentricity along the load on the journal [-].
    eta
        The same ahead of the load, a quarter turn in the positive sense [-].
    ratio
        Width over diameter B/D, 0.02 … 10 [-]; fastest if it is one number.

    Returns
    -------
    (2, ...) M along the load and ahead of it.

    Raises
    ------
    ValueError
        If the eccentricity exceeds 1 − 1e-6, or B/D lies outside its range.
    """
    xi, eta, ratio = _accepted(xi, eta, ratio)
    return decode_motion(xi, eta, ratio, _look_up("motion", xi, eta, ratio))


def mapped_film_under_load(xi: Array, eta: Array, ratio: Array) -> Array:
    """Return the largest pressure and the side flow of the film under a load, in Booker's frame [-].

    Parameters
    ----------
    xi
        Relative eccentricity along the load on the journal [-].
    eta
        Relative eccentricity ahead of the load [-].
    ratio
        Width over diameter B/D, 0.02 … 10 [-].

    Returns
    -------
    (2, ...) largest pressure p_max B D/F, and side flow Q/(B D v), where v = c |M| F psi²/(B D eta),
    c the radial clearance, is the speed that the load gives the journal in the rotating frame. The side
    flow has errors of 10 per cent and more where 1 − xi < 0.01 and the load meets the thinnest film.

    Raises
    ------
    ValueError
        If the eccentricity exceeds 1 − 1e-6, or B/D lies outside its range.
    """
    xi, eta, ratio = _accepted(xi, eta, ratio)
    P_max, side = _look_up("film", xi, eta, ratio)
    return np.stack([np.exp(P_max) / np.sqrt(1 - xi), side])


def mobility_error(xi: Array, eta: Array, ratio: Array) -> Array:
    """Return the largest measured difference [-] near a point between the map and new, finer solutions.

    Returns
    -------
    (..., 4): errors of ln M along the load, of M as a vector over its magnitude, of ln P_max, of side flow.
    """
    data = mobility_map()
    cells = np.array(data.error.shape[:3])
    xi, eta, ratio = _accepted(xi, eta, ratio)
    places = np.stack(np.broadcast_arrays(*coordinates(xi, eta), np.log(ratio)), axis=-1)
    index = np.clip(cell_of(data.axes, places, cells), 0, cells - 1)
    return np.asarray(data.error[index[..., 0], index[..., 1], index[..., 2]])


def cell_of(axes: Axes, places: Array, cells: Array) -> Array:
    """Return the indices (..., 3) of the error table's cells at points (..., 3) in the map's coordinates."""
    first = np.array([axis.first for axis in axes])
    length = np.array([axis.step * (axis.nodes - 1) for axis in axes])
    return np.asarray(np.floor((places - first) / length * cells).astype(int))


def coordinates(xi: Array, eta: Array) -> tuple[Array, Array]:
    """Return the coordinates of the gap and of the position on its chord [-]."""
    h = ECCENTRICITY_LIMIT - xi
    chord = np.sqrt(np.maximum(h * (ECCENTRICITY_LIMIT + xi), 1e-30))
    return np.log(h) + h, np.minimum(np.abs(eta) / chord, 1.0)


def encode(xi: float, eta: float, ratio: float, motion: Motion) -> Array:
    """Return the values, (4,), by which the map interpolates a solution smoothly."""
    h = 1 - xi
    along, ahead = motion.velocity
    return np.array([
        np.log(along * np.pi * ratio**2 / h**2.5),
        -ahead * h / (along * eta),
        np.log(motion.P_max * np.sqrt(h)),
        motion.side_flow,
    ])  # fmt: skip


def decode_motion(xi: Array, eta: Array, ratio: Array, values: Array) -> Array:
    """Return M along the load and ahead of it, (2, ...) [-], from the first two values of `encode`."""
    h = 1 - xi
    along = h**2 * np.sqrt(h) / (np.pi * ratio**2) * np.exp(values[0])
    return np.stack([along, -along * values[1] * eta / h])


def _accepted(xi: Array, eta: Array, ratio: Array) -> tuple[Array, Array, Array]:
    """Return the arguments as arrays; they must lie within the map's range.

    Raises
    ------
    ValueError
        If an argument is outside its range; the message names it and its limit.
    """
    xi, eta, ratio = (np.asarray(x, float) for x in (xi, eta, ratio))
    inside = xi**2 + eta**2 <= (LARGEST + 4e-16) ** 2
    require(inside, "the relative eccentricity must lie in [0, 1 - 1e-6] for the mobility map")
    require((ratio >= NARROWEST) & (ratio <= WIDEST), "ratio B/D must lie in [0.02, 10] for the mobility map")
    return xi, eta, ratio


def _look_up(part: str, xi: Array, eta: Array, ratio: Array) -> Array:
    """Return the interpolated motion or film at points of any shape, (functions, ...).

    It is fastest if all points have the same width.
    """
    axes = mobility_map().axes
    x, v = np.broadcast_arrays(*coordinates(xi, eta))
    if ratio.size == 1:
        values = surface(_at_width(part, float(ratio.item())), *axes[:2], x.ravel(), v.ravel())
        return values.reshape(-1, *np.broadcast_shapes(x.shape, ratio.shape))
    x, v, y = np.broadcast_arrays(x, v, np.log(ratio))
    places = np.stack([x.ravel(), v.ravel(), y.ravel()])
    return volume(getattr(mobility_map(), part), axes, places).reshape(-1, *x.shape)


@lru_cache(maxsize=64)
def _at_width(part: str, ratio: float) -> Array:
    """Return the spline coefficients over gap and chord at one width, cached for the steps of an orbit."""
    return at_third(getattr(mobility_map(), part), mobility_map().axes[2], float(np.log(ratio)))
