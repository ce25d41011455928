r"""The average Reynolds equation of rough surfaces after Patir and Cheng, solved for a journal bearing.

.. math::
    \partial_x(\phi_x h^3\partial_x p) + \partial_z(\phi_x h^3\partial_z p)
    = 6\,\eta\,U\,\partial_x(\bar h_T + \sigma\Phi_s)

phi_x is the factor of isotropic roughness (gamma = 1) in both directions. Phi_s is (sigma_1/sigma)² phi_s of
the moving surface minus (sigma_2/sigma)² phi_s of the other, so it vanishes for surfaces of equal roughness.
The mean gap h_T of a normal distribution is h where the surfaces do not touch. Below h/sigma = 0.5, where the
tables end, the factors are constant.

The tables' numbers were taken from the source code of foam-extend 4.0 (flowFactorsPatirCheng.C), which quotes
the papers; at h/sigma = 5 the two branches of phi_s agree to 1e-3.

References
----------
N. Patir, H. S. Cheng: J. Lubr. Technol. 100, 1978, p. 12 (phi_x); 101, 1979, p. 220 (phi_s).
"""

import numpy as np
from scipy.special import ndtr

from templates.core.arrays import Array
from templates.physics.films.complementarity import rupture
from templates.physics.films.film_equations import film_equations, midpoints, rotation
from templates.physics.films.film_measures import force
from templates.physics.films.film_mesh import gap, journal_mesh

PRESSURE = {
    1 / 9: (1.48, 0.42), 1 / 6: (1.38, 0.42), 1 / 3: (1.18, 0.42), 1: (0.90, 0.56),
    3: (0.225, 1.5), 6: (0.520, 1.5), 9: (0.870, 1.5),
}  # fmt: skip
"""Constants C and r of phi_x for each gamma: 1 − C exp(−r u) up to gamma = 1, 1 + C u^−r above."""
SHEAR = {
    1 / 9: (2.046, 1.12, 0.78, 0.03, 1.856), 1 / 6: (1.962, 1.08, 0.77, 0.03, 1.754),
    1 / 3: (1.858, 1.01, 0.76, 0.03, 1.561), 1: (1.899, 0.98, 0.92, 0.05, 1.126),
    3: (1.560, 0.85, 1.13, 0.08, 0.556), 6: (1.290, 0.62, 1.09, 0.08, 0.388),
    9: (1.011, 0.54, 1.07, 0.08, 0.295),
}  # fmt: skip
"""Constants A_1, alpha_1, alpha_2, alpha_3 and A_2 of phi_s for each gamma."""
THINNEST = 0.5
"""Smallest h/sigma of the tables [-]."""


def pressure_flow_factor(u: Array, gamma: float = 1) -> Array:
    """Return phi_x at u = h/sigma, for a gamma of the table [-].

    gamma is the correlation length along the flow over that across it.
    """
    C, r = PRESSURE[gamma]
    u = np.maximum(u, THINNEST)
    return 1 - C * np.exp(-r * u) if gamma <= 1 else 1 + C * u**-r


def shear_flow_factor(u: Array, gamma: float = 1) -> Array:
    """Return phi_s at u = h/sigma, for a gamma of the table [-]."""
    A_1, alpha_1, alpha_2, alpha_3, A_2 = SHEAR[gamma]
    u = np.maximum(u, THINNEST)
    near = np.minimum(u, 5.0)
    thin = A_1 * near**alpha_1 * np.exp(-alpha_2 * near + alpha_3 * near**2)
    return np.where(u <= 5, thin, A_2 * np.exp(-0.25 * u))


def mean_gap(u: Array) -> Array:
    """Return the mean gap over sigma [-] of rough, normally distributed surfaces, without overlaps."""
    return u * ndtr(u) + np.exp(-np.square(u) / 2) / np.sqrt(2 * np.pi)


def rough_journal(
    eps: float, ratio: float, roughness: float, asymmetry: float, around: int = 64, across: int = 8
) -> tuple[float, float]:
    """Return the Sommerfeld number and attitude [rad] of a journal by the average Reynolds equation.

    Parameters
    ----------
    eps
        Relative eccentricity, above 0 to 1 − 1e-7 [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].
    roughness
        Composite roughness over radial clearance; 0 is smooth [-].
    asymmetry
        (sigma_journal² − sigma_bearing²)/sigma² times sliding over hydrodynamic speed [-].
    around, across
        Numbers of circumferential and axial intervals.
    """
    mesh = journal_mesh(eps, ratio, around, across)
    H, H_mid = gap(mesh.phi, eps), gap(midpoints(mesh.phi), eps)
    source = rotation(H_mid)
    if roughness > 0:
        u, u_mid = H / roughness, H_mid / roughness
        source = rotation(roughness * (mean_gap(u_mid) + asymmetry * shear_flow_factor(u_mid)))
        H, H_mid = H * np.cbrt(pressure_flow_factor(u)), H_mid * np.cbrt(pressure_flow_factor(u_mid))
    along, ahead = force(mesh, rupture(film_equations(mesh, ratio, H, H_mid, source)).P)
    return float(np.hypot(along, ahead)), float(np.arctan2(-ahead, along))
