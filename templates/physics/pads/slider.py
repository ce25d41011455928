"""Plane slider bearings without side leakage: parallel faces and the fixed incline, per unit width.

The pad spans 0 ≤ x ≤ l with film h_i at the inlet and h_o at the outlet; ambient pressure at both ends.
a = h_i/h_o is the film ratio; a = 1 is the parallel pad, which carries no load.

References
----------
Lord Rayleigh, Phil. Mag. 35, 1918, p. 1; A. Cameron, Basic Lubrication Theory, 1976, chapter 4.
"""

import numpy as np

from templates.core.arrays import Array, Mask
from templates.physics.numerics.arrays import require

_NEAR = 0.1


def _require_ratio(a: Array) -> None:
    """Raise an error for a film ratio that is not positive and finite."""
    a = np.asarray(a)
    require((a > 0) & np.isfinite(a), "film ratio h_i/h_o must be positive and finite")


def _near_one(a: Array) -> Mask:
    """Return a mask of the film ratios at which the closed forms lose digits by cancellation."""
    return np.abs(np.asarray(a) - 1) < _NEAR


def _ratio_away_from_one(a: Array) -> Array:
    """Return the film ratio, moved away from 1 so that a closed form that is not used there stays finite."""
    return np.where(_near_one(a), 2.0, a)


def _shape(x: Array, a: Array) -> Array:
    """Return the pressure divided by a − 1, which does not vanish at a = 1."""
    return x * (1 - x) / ((a + 1) * (a - (a - 1) * x) ** 2)


def _moment_near_one(a: Array, power: int) -> Array:
    """Return the integral of the pressure's shape times x^power, accurate for film ratios near 1."""
    x, weight = np.polynomial.legendre.leggauss(12)
    x, weight = (1 + x) / 2, weight / 2
    near = np.where(_near_one(a), a, 1.0)[..., None]
    return np.asarray((weight * x**power * _shape(x, near)).sum(-1))


def pressure_incline_Rayleigh_1918(x: Array, a: Array) -> Array:
    r"""Return the pressure along the pad, p h_o²/(6 eta U l) at x/l [-].

    .. math:: p^* = \frac{(a-1)\,x(1-x)}{(a+1)\,(a-(a-1)x)^2}

    Parameters
    ----------
    x
        Position along the pad over its length, 0 (inlet) … 1 (outlet) [-].
    a
        Film ratio h_i/h_o; below 1 the pressure is negative: the film would cavitate [-].

    Raises
    ------
    ValueError
        If a or x lies outside its range.
    """
    _require_ratio(a)
    require((np.asarray(x) >= 0) & (np.asarray(x) <= 1), "x/l must lie in [0, 1]")
    return (a - 1) * _shape(x, a)


def load_incline_Rayleigh_1918(a: Array) -> Array:
    r"""Return the load per unit width W h_o²/(6 eta U l²) [-].

    .. math:: W^* = \frac{1}{(a-1)^2}\left[\ln a - \frac{2(a-1)}{a+1}\right]

    Parameters
    ----------
    a
        Film ratio h_i/h_o; 1 gives 0, and the load is largest at 2.1889 [-].

    Examples
    --------
    >>> round(float(load_incline_Rayleigh_1918(2.0)), 8)
    0.02648051
    """
    _require_ratio(a)
    b = _ratio_away_from_one(a)
    closed = (np.log(b) - 2 * (b - 1) / (b + 1)) / (b - 1) ** 2
    return np.where(_near_one(a), (a - 1) * _moment_near_one(a, 0), closed)


def centre_of_pressure_Rayleigh_1918(a: Array) -> Array:
    r"""Return the distance of the centre of pressure from the inlet, over the length [-].

    .. math:: x_c = \frac{a(a+2)\ln a - \frac{1}{2}(a-1)(5a+1)}{(a-1)\left[(a+1)\ln a - 2(a-1)\right]}

    Parameters
    ----------
    a
        Film ratio h_i/h_o; 1 gives the limit 1/2 [-].
    """
    _require_ratio(a)
    b = _ratio_away_from_one(a)
    moment = b * (b + 2) * np.log(b) - (b - 1) * (5 * b + 1) / 2
    closed = moment / ((b - 1) * ((b + 1) * np.log(b) - 2 * (b - 1)))
    return np.where(_near_one(a), _moment_near_one(a, 1) / _moment_near_one(a, 0), closed)


def friction_incline_Rayleigh_1918(a: Array) -> tuple[Array, Array]:
    r"""Return the friction on the moving face and on the pad, F h_o/(eta U l) per unit width [-].

    .. math:: F^* = \frac{\ln a}{a-1} \pm 3 (a-1) W^*

    The power loss per unit width is the moving face's friction times U.

    Parameters
    ----------
    a
        Film ratio h_i/h_o; 1 gives 1 on both faces [-].
    """
    _require_ratio(a)
    m = np.where(np.asarray(a) == 1, 1e-300, np.asarray(a) - 1)
    shear = np.log1p(m) / m
    pressure = 3 * (a - 1) * load_incline_Rayleigh_1918(a)
    return shear + pressure, shear - pressure


def film_velocity(z: Array, h: Array, pressure_gradient: Array, eta: Array, u_a: Array) -> Array:
    r"""Return the velocity across the film between a fixed face at z = 0 and a face moving at u_a [m/s].

    .. math:: u(z) = \frac{1}{2\eta}\frac{dp}{dx}(z^2 - z h) + u_a\frac{z}{h}

    Erratum: the course MEC 315 omits z in its last two terms.

    Parameters
    ----------
    z
        Height above the fixed face, 0 … h [m].
    h
        Film thickness [m].
    pressure_gradient
        dp/dx [Pa/m].
    eta
        Dynamic viscosity [Pa s].
    u_a
        Velocity of the moving face [m/s].
    """
    return pressure_gradient / (2 * eta) * (z**2 - z * h) + u_a * z / h


def reduced_Reynolds_number(density: Array, speed: Array, h: Array, eta: Array, length: Array) -> Array:
    """Return the inertia over viscous force of a thin film, rho u h²/(eta l); it must be well below 1 [-].

    Parameters
    ----------
    density
        Density rho [kg/m³].
    speed
        Velocity u along that length [m/s].
    h
        Film thickness [m].
    eta
        Dynamic viscosity [Pa s].
    length
        Length l along the film, or h itself for the number across it [m].
    """
    return density * speed * h**2 / (eta * length)


def squeeze_number(density: Array, h: Array, eta: Array, time: Array) -> Array:
    """Return local inertia over viscous force, rho h²/(eta t) [-].

    Erratum: the course prints l² or b² for h².

    Parameters
    ----------
    density
        Density rho [kg/m³].
    h
        Film thickness [m].
    eta
        Dynamic viscosity [Pa s].
    time
        Duration of the film's change [s].
    """
    return density * h**2 / (eta * time)
