r"""Plane slider pads with a fixed incline, of infinite or finite width, for any number of pads at once.

.. math::
    \partial_x(H^3\partial_x P) + (2l/b)^2\,\partial_\zeta(H^3\partial_\zeta P) = 6\,dH/dx,
    \quad H = a - (a-1)x, \quad P = \frac{p\,h_o^2}{\eta U l}

x = 0 (inlet) … 1 (outlet), zeta = 2z/b = −1 … 1; P = 0 (ambient) at all four edges. Isothermal,
incompressible, rigid, laminar. Motion brings oil to no node of a diverging film (a < 1), so P = 0 satisfies
the conditions of `complementarity`: the whole film is ruptured and carries no load, and only streamers that
fill h_i/h of it are sheared. A parallel film (a = 1) carries no load either.

`pad_equations` solves pads of finite width with second order, extrapolated by Richardson from 32 × 8 and 64 ×
16 intervals. Errors measured by `benchmarks/slider_bearing.py`: load 2e-5 up to a film ratio of 10 and 2e-4
up to 1000, pressure 5e-5 and 3e-4 of its peak, largest pressure 3e-4 and 8e-4. The flows are less smooth at
the corners: the error is 2e-3 at the inlet, and 1e-2 for the small side flow of wide pads.

References
----------
Lord Rayleigh, Phil. Mag. 35, 1918, p. 1; A. G. M. Michell, Z. Math. Phys. 52, 1905, p. 123.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.numerics.arrays import require
from templates.physics.numerics.arrays import spread as spread
from templates.physics.pads.pad_equations import solved_pads
from templates.physics.pads.pad_mesh import NodeMap, grading
from templates.physics.pads.slider import (
    centre_of_pressure_Rayleigh_1918,
    film_velocity,
    friction_incline_Rayleigh_1918,
    load_incline_Rayleigh_1918,
    pressure_incline_Rayleigh_1918,
)

STEEPEST = 1000.0
"""Largest film ratio h_i/h_o that the mesh resolves [-]."""
NARROWEST, WIDEST = 0.01, 100.0
"""Smallest and largest width b/l that the mesh resolves [-]."""
STATIONS = np.linspace(0, 1, 101)
"""Positions x/l at which the pressure along a pad is reported [-]."""
HEIGHTS = np.linspace(0, 1, 41)
"""Positions z/h at which the velocity across the film is reported [-]."""

_BLOCK = 512


@dataclass(frozen=True)
class PadFilm(ABC):
    """The results of the film under a pad; every value is dimensionless, in the shape of the pads."""

    a: Array
    """Film ratio h_i/h_o."""
    load: Array
    """W h_o²/(6 eta U l² b)."""
    centre: Array
    """Distance of the centre of pressure from the inlet over l; NaN where the pad supports no load."""
    P_max: Array
    """Largest pressure p h_o²/(6 eta U l)."""
    peak: Array
    """Distance of the largest pressure from the inlet over l; NaN where the pad supports no load."""
    inlet_flow: Array
    """Flow in at the inlet over U h_o b."""
    side_flow: Array
    """Flow out at both sides over U h_o b."""

    @property
    def friction_moving(self) -> Array:
        """Return the friction on the moving face F h_o/(eta U l b); times U it is the power loss."""
        return shear_of_wedge(self.a) + 3 * (self.a - 1) * self.load

    @property
    def friction_fixed(self) -> Array:
        """Return the friction on the pad F h_o/(eta U l b); the pressure on the incline reduces it."""
        return shear_of_wedge(self.a) - 3 * (self.a - 1) * self.load

    @property
    def friction_coefficient(self) -> Array:
        """Return the friction on the moving face over load, times l/h_o; NaN where there is no load."""
        load = np.where(self.load > 0, self.load, np.nan)
        return self.friction_moving / (6 * load)

    @abstractmethod
    def pressure(self, x: Array) -> Array:
        """Return the pressure p h_o²/(6 eta U l) at mid-width and x/l, (..., places)."""

    @abstractmethod
    def gradient(self, x: Array) -> Array:
        """Return the pressure gradient h_o²/(eta U) dp/dx at mid-width and at one x/l per pad."""


def pad_film(level: str, a: Array, width: Array) -> PadFilm:
    """Return the film at a level of fidelity: `infinite`, without side leakage, or `finite`.

    Parameters
    ----------
    level
        Name of the level.
    a
        Film ratio h_i/h_o, above 0, and up to 1000 at level finite; NaN gives NaN [-].
    width
        b/l, 0.01 … 100 at level finite; NaN gives NaN [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    Examples
    --------
    >>> round(float(pad_film("infinite", 2.0, 1.0).load), 8)
    0.02648051
    >>> round(float(pad_film("finite", 2.0, 1.0).load), 6)
    0.011546
    """
    a, width = np.asarray(a, float), np.asarray(width, float)
    require(np.isnan(a) | (a > 0) & np.isfinite(a), "film ratio h_i/h_o must be positive and finite")
    if level == "infinite":
        return _infinite(a + 0 * width)
    require(np.isnan(a) | (a <= STEEPEST), "film ratio h_i/h_o must not be above 1000")
    inside = (width >= NARROWEST) & (width <= WIDEST)
    require(np.isnan(width) | inside, "width b/l must lie in [0.01, 100]")
    return finite_pad(a, width)


def shear_of_wedge(a: Array) -> Array:
    """Return the friction due to the mean velocity gradient alone, F h_o/(eta U l b) [-].

    It is ln a/(a − 1), and 1 for streamers: those that carry the flow of the inlet fill h_i/h of a diverging
    film, and the mean of h_i h_o/h² is 1.

    Parameters
    ----------
    a
        Film ratio h_i/h_o; below 1 the film is ruptured [-].
    """
    return sum(friction_incline_Rayleigh_1918(_bearing(a))) / 2 + 0 * a


@units("m", "Pa/m", "Pa*s", "m/s", returns="m/s")
def velocity_profile(h: Array, pressure_gradient: Array, eta: Array, u_a: Array) -> Array:
    """Return the velocity at `HEIGHTS` across the film, (..., 41): see `slider.film_velocity` [m/s].

    Parameters
    ----------
    h
        Film thickness [m].
    pressure_gradient
        dp/dx [Pa/m].
    eta
        Dynamic viscosity [Pa s].
    u_a
        Velocity of the moving face, at z = h [m/s].
    """
    h, gradient, eta, u_a = (value[..., None] for value in (h, pressure_gradient, eta, u_a))
    return film_velocity(HEIGHTS * h, h, gradient, eta, u_a)


def _bearing(a: Array) -> Array:
    """Return the film ratio; 1 if the film is ruptured or the ratio is NaN."""
    return np.where(a > 1, a, 1.0)


@dataclass(frozen=True)
class InfinitePad(PadFilm):
    """The closed forms of an incline without side leakage; P = 0 where they would give tension."""

    def pressure(self, x: Array) -> Array:
        """Return the pressure p h_o²/(6 eta U l) at x/l, (..., places)."""
        return pressure_incline_Rayleigh_1918(x, _bearing(self.a)[..., None]) + 0 * self.a[..., None]

    def gradient(self, x: Array) -> Array:
        """Return the pressure gradient 6 (H − H_m)/H³; at H_m = 2a/(a + 1) there is only shear flow."""
        a = _bearing(self.a)
        H = a - (a - 1) * x
        return 6 * (H - 2 * a / (a + 1)) / H**3 + 0 * self.a


def _infinite(a: Array) -> InfinitePad:
    """Return the closed forms for pads (...)."""
    wedge, nothing = _bearing(a), 0 * a
    bears = a > 1
    return InfinitePad(
        a=a,
        load=load_incline_Rayleigh_1918(wedge) + nothing,
        centre=np.where(bears, centre_of_pressure_Rayleigh_1918(wedge), np.nan),
        P_max=(wedge - 1) / (4 * wedge * (wedge + 1)) + nothing,
        peak=np.where(bears, wedge / (wedge + 1), np.nan),
        inlet_flow=np.where(bears, wedge / (wedge + 1), a / 2),
        side_flow=nothing,
    )


@dataclass(frozen=True)
class FinitePad(PadFilm):
    """A solved pad of finite width, with its pressure at mid-width."""

    mesh: NodeMap
    """The nodes along the pad."""
    P: Array
    """(..., n + 1) pressure p h_o²/(6 eta U l) at the nodes, equally spaced in t."""

    def pressure(self, x: Array) -> Array:
        """Return the pressure p h_o²/(6 eta U l) at mid-width and x/l, (..., places), by cubics.

        At the ends of the pad it is exactly 0.
        """
        return np.maximum(interpolated(self.P, self.mesh.coordinate(x))[0], 0) * ((x > 0) & (x < 1))

    def gradient(self, x: Array) -> Array:
        """Return the pressure gradient h_o²/(eta U) dp/dx at mid-width and at one x/l per pad, by cubics."""
        t = self.mesh.coordinate(x[..., None])
        return (6 * interpolated(self.P, t)[1] / self.mesh.slope(t))[..., 0]


def interpolated(values: Array, t: Array) -> tuple[Array, Array]:
    """Return the values and derivatives d/dt at t of the cubic through four of n + 1 equally spaced nodes.

    Parameters
    ----------
    values
        (..., n + 1) values at the nodes, which span 0 … 1.
    t
        (..., places) at which the values are wanted [-].
    """
    n = values.shape[-1] - 1
    first = np.clip(np.nan_to_num(t * n).astype(int) - 1, 0, n - 3)
    y = t * n - first
    values = np.broadcast_to(values, (*first.shape[:-1], n + 1))
    four = [np.take_along_axis(values, first + k, axis=-1) for k in range(4)]
    steps = np.diff(four, axis=0)
    bends = np.diff(steps, axis=0)
    twist = bends[1] - bends[0]
    value = four[0] + y * (steps[0] + (y - 1) / 2 * (bends[0] + (y - 2) / 3 * twist))
    slope = steps[0] + (y - 0.5) * bends[0] + (3 * y**2 - 6 * y + 2) / 6 * twist
    return value, n * slope


def finite_pad(a: Array, width: Array, along: int = 64, across_half: int = 16) -> FinitePad:
    """Return the solutions for pads (...), extrapolated from the given mesh and one half as fine.

    Parameters
    ----------
    a
        Film ratio h_i/h_o, above 0 to 1000; NaN gives NaN [-].
    width
        b/l, 0.01 … 100; NaN gives NaN [-].
    along
        Number of intervals along the pad, even.
    across_half
        Number of intervals over half the width, even.
    """
    a, width = np.broadcast_arrays(a, width)
    size = along, across_half
    valid = np.isfinite(a * width)
    wedge, ratio = np.where(valid, _bearing(a), 1.0), np.where(valid, width, 1.0)
    blocks = [slice(i, i + _BLOCK) for i in range(0, a.size, _BLOCK)]
    solved = [_extrapolated(wedge.ravel()[part], ratio.ravel()[part], *size) for part in blocks]
    measures, P = (np.concatenate(parts).reshape(*a.shape, -1) for parts in zip(*solved, strict=True))
    load, moment, inlet_flow, side_flow = np.moveaxis(measures, -1, 0)
    mesh, nothing, bears = grading(wedge, ratio), np.where(valid, 0.0, np.nan), valid & (a > 1)
    P_max, peak = _peak(P)
    return FinitePad(
        a=a + nothing,
        load=load + nothing,
        centre=np.where(bears, moment / np.where(bears, load, 1.0), np.nan),
        P_max=P_max + nothing,
        peak=np.where(bears, mesh.place(peak[..., None])[..., 0], np.nan),
        inlet_flow=np.where(bears, inlet_flow, a / 2) + nothing,
        side_flow=side_flow + nothing,
        mesh=mesh,
        P=P + nothing[..., None],
    )


def _peak(P: Array) -> tuple[Array, Array]:
    """Return the value of the largest pressure and its place t, from a parabola through three nodes."""
    n = P.shape[-1] - 1
    k = np.clip(P.argmax(axis=-1), 1, n - 1)
    before, top, after = (np.take_along_axis(P, (k + i)[..., None], axis=-1)[..., 0] for i in (-1, 0, 1))
    bend, slope = before - 2 * top + after, (after - before) / 2
    shift = -slope / np.where(bend < 0, bend, -1.0)
    return top + slope * shift / 2, (k + shift) / n


def _extrapolated(a: Array, width: Array, along: int, across_half: int) -> tuple[Array, Array]:
    """Return extrapolated load, moment, inlet and side flow (N, 4), and mid-width pressure (N, n + 1)."""
    coarse, P_coarse = solved_pads(a, width, along // 2, across_half // 2)
    fine, P_fine = solved_pads(a, width, along, across_half)
    nodes = np.broadcast_to(np.linspace(0, 1, along + 1), P_fine.shape)
    error, _ = interpolated((P_fine[:, ::2] - P_coarse) / 3, nodes)
    return fine + (fine - coarse) / 3, P_fine + error
