"""Effect of a load on the friction of a journal: Petrov's concentric film and the Reynolds solution.

The film is the converged static film of `film_map`: full circle without grooves, Swift–Stieber rupture, shear
over the full circle as in DIN 31652 and ISO 7902.
"""

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.films.film_map import NARROWEST, WIDEST, mapped_film
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.journals.petrov import friction_number_Petrov_1883


@units(
    "N", "1", "Pa*s", "rad/s", "m", "m", returns="1", latex=r"\frac{{{0}\,{1}^{{2}}}}{{{4}\,{5}\,{2}\,{3}}}"
)
def load_number(load: Array, psi: Array, eta: Array, omega: Array, width: Array, diameter: Array) -> Array:
    """Return the Sommerfeld number So = F psi²/(B D eta omega); NaN at rest, where no film forms [-].

    Parameters
    ----------
    load
        Radial load F [N].
    psi
        Relative clearance, radial clearance over radius [-].
    eta
        Dynamic viscosity [Pa s].
    omega
        Angular velocity of the journal relative to bearing and load [rad/s].
    width
        Width B [m].
    diameter
        Diameter D [m].
    """
    return load * psi**2 / (width * diameter * eta * np.where(omega > 0, omega, np.nan))


@on_paper("solved numerically by splines in a map of solutions of the Reynolds equation")
@units("1", "1", returns="1")
def eccentricity_of_load(So: Array, ratio: Array) -> Array:
    """Return the relative eccentricity at a load; NaN without So and outside B/D 0.01 … 100 [-].

    Parameters
    ----------
    So
        Sommerfeld number [-].
    ratio
        Width over diameter B/D [-].
    """
    valid = np.isfinite(So) & (So >= 0) & (ratio >= NARROWEST) & (ratio <= WIDEST)
    eps = mapped_eccentricity(np.where(valid, So, 0.0), np.where(valid, ratio, 1.0))
    return np.where(valid, eps, np.nan)[()]


@on_paper("solved numerically by splines in a map of solutions of the Reynolds equation")
@units("1", "1", returns="1")
def friction_over_Petrov(eps: Array, ratio: Array) -> Array:
    """Return the friction on the loaded journal relative to Petrov's, 1 or more; NaN where eps is NaN [-].

    Parameters
    ----------
    eps
        Relative eccentricity [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].

    Examples
    --------
    >>> round(float(friction_over_Petrov(np.float64(0.965), np.float64(2.0))), 1)
    5.3
    """
    valid = np.isfinite(eps)
    film = mapped_film(np.where(valid, eps, 0.0), np.where(valid, ratio, 1.0))
    return np.where(valid, film["friction"] / friction_number_Petrov_1883(), np.nan)[()]
