"""Friction of a concentric journal after Petrov: light load, high speed, high viscosity.

References
----------
N. P. Petrov, Inzhenernyj Zhurnal, 1883; course MEC 315.
"""

import numpy as np

from templates.core.arrays import Array


def friction_Petrov_1883(radius: Array, width: Array, clearance: Array, eta: Array, omega: Array) -> Array:
    r"""Return the friction force on a concentric journal [N].

    .. math:: F_f = \frac{2\pi r^2 b\,\eta\,\omega}{c}

    The course prints :math:`4\pi^2 r^2\eta N b/(60 c)` with N in rpm, which is equivalent.

    Parameters
    ----------
    radius
        Journal radius [m].
    width
        Bearing width [m].
    clearance
        Radial clearance [m].
    eta
        Dynamic viscosity [Pa s].
    omega
        Angular velocity of the journal relative to the bearing [rad/s].

    Examples
    --------
    >>> omega = 1500 * 2 * np.pi / 60
    >>> round(float(friction_Petrov_1883(0.025, 0.1, 0.00025, 11.877e-3, omega)), 4)
    2.9305
    """
    return 2 * np.pi * radius**2 * width * eta * omega / clearance


def friction_number_Petrov_1883() -> float:
    """Return the friction force in the form of the film solutions, F_f psi/(B D eta omega) = pi [-]."""
    return float(np.pi)
