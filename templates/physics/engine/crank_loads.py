"""Forces in a crank mechanism at constant speed, after Rao & Singh (DYREMI), with their errata corrected.

x points from the crankshaft to the cylinder head, y in the direction in which the crankpin moves at top dead
centre; F_ij acts from body i on body j: 1 frame, 2 crank, 3 rod, 4 piston. Gravity and friction are
neglected.

The rod is replaced by two statically equivalent masses at its ends. Their moment of inertia exceeds that of
the rigid rod by `excess`; the correction is a couple `excess` · d²phi/dt², which the cylinder wall and the
main bearing react. With an excess of 0 the forces are those of DYREMI.

References
----------
S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.engine.slider_crank import Motion

GRAVITY = 9.80665  # m/s², used to compute an inertia from a pendulum period


def _column(value: Array) -> Array:
    return np.asarray(value)[..., None]


@units("kg", "m", "s", returns="kg*m**2", latex=r"{0}\,{1}\left(\frac{{{2}^2 g}}{{4\pi^2}}-{1}\right)")
def pendulum_inertia(m_3: Array, a_g: Array, tau: Array) -> Array:
    """Return the inertia of the rod about its centre of mass [kg m²] from its period about the wristpin [s].

    I_3 = m_3 a_g (L − a_g), L = τ² g/(4 π²), a_g from the wristpin. Erratum: the paper's m_3 b (l − L) in the
    correction torque mixes the two pivots.
    """
    return m_3 * a_g * (tau**2 * GRAVITY / (4 * np.pi**2) - a_g)


@units(None, "kg*m**2", returns="kg*m**2", latex=r"{1}\ \text{{(rigid) or}}\ 0\ \text{{(lumped)}}")
def excess_at(level: str, excess: Array) -> Array:
    """Return the excess [kg m²] used at a level: all of it for a rigid rod, 0 for two masses."""
    return excess if level == "rigid" else np.zeros(np.shape(excess))[()]


@units("kg", "rad/s", "m", "m**2", None, "Pa", "Pa", returns="N")
def axial_force(m: Array, omega: Array, r: Array, A: Array, motion: Motion, p: Array, p_c: Array) -> Array:
    """Return K = m a + (p − p_c) A [N], the force of the crank that drives the mass m against the gas."""
    inertia = _column(m * omega**2 * r) * motion.acceleration
    return inertia + _column(A) * (p - _column(p_c))


@units("N", "kg*m**2", "rad/s", "m", None, returns="N")
def wall_force_Rao_Singh_1993(K: Array, excess: Array, omega: Array, r: Array, motion: Motion) -> Array:
    """Return F_41y = −K tan φ + d [N], piston on wall.

    d = −excess · φ̈/(l cos φ) is the contribution of the rigid rod.
    """
    couple = _column(excess * omega**2 / r) * (motion.rod_acceleration / motion.q)
    return -K * motion.tan_phi - couple


@units("kg", "rad/s", "m", "N", None, returns="N")
def crankpin_load_x_Rao_Singh_1993(m_3A: Array, omega: Array, r: Array, K: Array, motion: Motion) -> Array:
    """Return F_32x = m_3A ω² r cos θ − K [N], rod on crank."""
    return _column(m_3A * omega**2 * r) * motion.cos - K


@units("kg", "rad/s", "m", "N", None, returns="N")
def crankpin_load_y_Rao_Singh_1993(m_3A: Array, omega: Array, r: Array, S: Array, motion: Motion) -> Array:
    """Return F_32y = m_3A ω² r sin θ − S [N], rod on crank; S: wall force. Erratum: the paper prints −pA."""
    return _column(m_3A * omega**2 * r) * motion.sin - S


@units("kg", "rad/s", "m", "N", None, returns="N")
def main_load_x_Rao_Singh_1993(M: Array, omega: Array, r: Array, K: Array, motion: Motion) -> Array:
    """Return F_12x = K − ω² r M cos θ [N], frame on crank; M the rotating mass."""
    return K - _column(M * omega**2 * r) * motion.cos


@units("kg", "rad/s", "m", "N", None, returns="N")
def main_load_y_Rao_Singh_1993(M: Array, omega: Array, r: Array, S: Array, motion: Motion) -> Array:
    """Return F_12y = S − ω² r M sin θ [N], frame on crank; S the wall force."""
    return S - _column(M * omega**2 * r) * motion.sin


@units("kg", "rad/s", "m", "m**2", None, "Pa", "Pa", returns="N")
def wristpin_load_x(
    m_4: Array, omega: Array, r: Array, A: Array, motion: Motion, p: Array, p_c: Array
) -> Array:
    """Return F_34x = m_4 a + (p − p_c) A [N], rod on piston."""
    return np.asarray(axial_force(m_4, omega, r, A, motion, p, p_c))


@dataclass(frozen=True)
class CrankForces:
    """Forces of a mechanism at all angles of a motion [N], (…, K): axial, wall and wristpin force."""

    K: Array
    wall: Array
    wristpin_x: Array
    motion: Motion
    omega: Array
    r: Array

    def crankpin(self, m_3A: Array) -> NDArray[np.complex128]:
        """Return the complex load of the crankpin [N]."""
        x = crankpin_load_x_Rao_Singh_1993(m_3A, self.omega, self.r, self.K, self.motion)
        return x + 1j * crankpin_load_y_Rao_Singh_1993(m_3A, self.omega, self.r, self.wall, self.motion)

    def main(self, M: Array) -> NDArray[np.complex128]:
        """Return the complex load of the main bearings [N]."""
        x = main_load_x_Rao_Singh_1993(M, self.omega, self.r, self.K, self.motion)
        return x + 1j * main_load_y_Rao_Singh_1993(M, self.omega, self.r, self.wall, self.motion)

    def wristpin(self) -> NDArray[np.complex128]:
        """Return the complex load of the wristpin [N]."""
        return np.asarray(self.wristpin_x + 1j * self.wall)


@units(None, returns="N")
def greatest_force(force: NDArray[np.complex128] | Array) -> Array:
    """Return the greatest magnitude of a force over the cycle [N]."""
    return np.asarray(np.abs(force).max(axis=-1))[()]


@units("kg*m**2", "rad/s", None, returns="N*m")
def correction_torque(excess: Array, omega: Array, motion: Motion) -> Array:
    """Return T_c = (m_3 a_g b_g − I_3) φ̈ cos θ/(n cos φ) [N m]: the torque that a rigid rod adds."""
    return _column(excess * omega**2) * (motion.rod_acceleration * motion.rod_velocity)


@units("N", "m", "kg*m**2", "rad/s", None, returns="N*m")
def torque_Rao_Singh_1993(K: Array, r: Array, excess: Array, omega: Array, motion: Motion) -> Array:
    """Return T = K (cos θ + n cos φ) r tan φ + T_c [N m], rod on crank. Erratum: the paper prints n cos θ."""
    return np.asarray(K * (motion.lever * _column(r)) + correction_torque(excess, omega, motion))
