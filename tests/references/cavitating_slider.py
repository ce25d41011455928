"""Slider with a cavitating pocket, in one dimension: closed form and discrete film.

The gap falls linearly from the inlet to the outlet, and is deeper by a constant over a pocket in
between; the film ruptures at the pocket's start and re-forms inside it, mass being conserved.

References
----------
M. T. Fowell, A. V. Olver, A. D. Gosman, H. A. Spikes, I. Pegg, Trans. ASME J. Tribol. 129, 2007, p. 336.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, diags_array, eye_array

from templates.core.arrays import Array
from templates.physics.cavities.cavitation import Cavitation, Network, cavitation
from templates.physics.numerics.arrays import require


@dataclass(frozen=True)
class PocketedSlider:
    """Geometry and running state."""

    length: float
    """l [m]."""
    inlet: float
    """Gap h_i at the inlet [m]."""
    outlet: float
    """Gap h_o at the outlet, less than h_i [m]."""
    pocket_start: float
    """a from the inlet [m]."""
    pocket_end: float
    """b from the inlet [m]."""
    depth: float
    """Depth of the pocket [m]."""
    eta: float
    """Dynamic viscosity [Pa s]."""
    speed: float
    """Velocity of the plane face towards the outlet [m/s]."""
    ambient: float
    """Pressure at both ends, above that of the cavity [Pa]."""

    def land(self, x: Array) -> Array:
        """Gap without the pocket [m]."""
        return self.inlet - (self.inlet - self.outlet) * x / self.length


@dataclass(frozen=True)
class PocketedFilm:
    """Closed-form solution."""

    flow: float
    """Flow per width over speed, q/u [m]."""
    reformation: float
    """Where the film re-forms, from the inlet [m]."""
    P_max: float
    """Largest pressure above that of the cavity, at the pocket's end [Pa]."""


def film_Fowell_2007(slider: PocketedSlider) -> PocketedFilm:
    """Flow, re-formation and peak pressure of a pocketed slider whose film ruptures at the pocket's start.

    Parameters
    ----------
    slider
        Geometry and running state.

    Raises
    ------
    ValueError
        If the film does not re-form inside the pocket.

    References
    ----------
    Fowell et al. 2007, equations 10–21.
    """
    h_i, h_o = slider.inlet, slider.outlet
    h_a, h_b = slider.land(np.array([slider.pocket_start, slider.pocket_end]))
    unit = 6 * slider.speed * slider.eta * slider.length / (h_i - h_o)
    level = slider.ambient / unit
    q = h_i * h_a / (h_i + h_a) * (level * h_i * h_a / (h_i - h_a) + 1)
    steps = 1 / h_b - 1 / h_o - 1 / (h_b + slider.depth)
    squares = 1 / h_b**2 - 1 / h_o**2 - 1 / (h_b + slider.depth) ** 2
    rest = level + steps - q * squares
    h_f = (-1 - np.sqrt(1 + 4 * q * rest)) / (2 * rest)
    place = (h_i + slider.depth - h_f) / (h_i - h_o) * slider.length
    inside = slider.pocket_start < place < slider.pocket_end
    require(np.asarray(inside), "the film must re-form inside the pocket")
    peak = slider.ambient + unit * ((1 / h_b - 1 / h_o) - q * (1 / h_b**2 - 1 / h_o**2))
    return PocketedFilm(float(q), float(place), float(peak))


def discrete_slider(slider: PocketedSlider, n: int, start: tuple[Array, Array] | None = None) -> Cavitation:
    """The same film by `cavitation` on n equal intervals, to which the pocket's edges must belong.

    P of the answer is p h_o²/(eta u l) with all pressures above that of the cavity.
    """
    if start is None and n % 2 == 0 and n > 100:
        coarse = discrete_slider(slider, n // 2)
        start = _refined(coarse.P), _refined(coarse.void)
    x = np.linspace(0, slider.length, n + 1)
    middle = (x[1:] + x[:-1]) / 2
    pocket = (middle > slider.pocket_start) & (middle < slider.pocket_end)
    H = (slider.land(middle) + slider.depth * pocket) / slider.outlet
    upwind = eye_array(n, n + 1)
    step = eye_array(n, n + 1, k=1) - upwind
    fixed = np.arange(n + 1) % n == 0
    level = slider.ambient * slider.outlet**2 / (slider.eta * slider.speed * slider.length)
    A = csc_array(step.T @ diags_array(H**3 * n) @ step)
    T = csc_array(-step.T @ diags_array(6 * H) @ upwind)
    return cavitation(Network(A, T, fixed, np.where(fixed, level, 0.0)), start)


def _refined(values: Array) -> Array:
    """Values at nodes and midway between them."""
    return np.interp(np.arange(2 * values.size - 1) / 2, np.arange(values.size), values)
