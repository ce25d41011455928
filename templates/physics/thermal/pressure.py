r"""Dowson's generalised Reynolds equation with mass-conserving cavities, on the arc of a film.

.. math::
    \nabla\cdot(12 F_2 H^3\nabla P) = 12\,\partial_\phi\left[(1-\lambda)(1 - F_1/F_0) H\right],\quad
    P \ge 0,\ \lambda \ge 0,\ P\lambda = 0

P = p psi²/(eta_s omega) with the viscosity eta_s of the supply. The groove is full; its pressure falls
linearly over the lands at its ends. The ends are at ambient pressure, as are the cavities. The method is that
of `cavitation`.

References
----------
Dowson: Int. J. Mech. Sci. 4, 1962, p. 159; H. G. Elrod, Trans. ASME J. Lubr. Technol. 103, 1981, p. 350.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, diags_array, eye_array, kron

from templates.core.arrays import Array
from templates.physics.cavities.cavitation import Network, cavitation
from templates.physics.films.film_equations import midpoints
from templates.physics.thermal.across import Across, across
from templates.physics.thermal.arc import Arc


@dataclass(frozen=True)
class Gap:
    """Gap and viscosity of a film on its arc."""

    arc: Arc
    y: Array
    """(2,) position of the journal along and ahead of the load, with length atanh(eps)."""
    nodes: Across
    """Integrals across the film at the n + 1 nodes."""
    faces: Across
    """Integrals across the film midway between the nodes, n."""
    pressure: float
    """Pressure P_s of the groove [-]."""
    length: float
    """Axial length of the groove over the bearing's width [-]."""

    @property
    def eps(self) -> float:
        """Return the relative eccentricity [-]."""
        return float(np.tanh(np.hypot(*self.y)))

    @property
    def attitude(self) -> float:
        """Return the angle from the load to the narrowest gap [rad]."""
        return float(np.arctan2(self.y[1], self.y[0]))

    def H(self, phi: Array) -> Array:
        """Return the gap relative to the radial clearance, without cancellation where it is narrow [-]."""
        return (1 - self.eps) + 2 * self.eps * np.sin((phi - self.attitude) / 2) ** 2

    @property
    def fed(self) -> Array:
        """Return the (m + 1,) pressure along the groove's edges; over the land it falls linearly to 0."""
        land = max(1 - self.length, 1e-12)
        return self.pressure * np.clip((1 - self.arc.zeta) / land, 0, 1)

    @property
    def H_nodes(self) -> Array:
        """Return the (n + 1,) gap at the nodes."""
        return self.H(self.arc.phi)

    @property
    def H_faces(self) -> Array:
        """Return the (n,) gap midway between the nodes."""
        return self.H(midpoints(self.arc.phi))


def gap_of(arc: Arc, y: Array, fluidity: Array, edges: Array, feed: tuple[float, float]) -> Gap:
    """Return the gap at a position of the journal with a fluidity (n + 1, J) at the nodes.

    `feed` is the pressure of the groove and its length over the bearing's width [-].
    """
    faces = across((fluidity[1:] + fluidity[:-1]) / 2, edges)
    return Gap(arc, y, across(fluidity, edges), faces, *feed)


@dataclass(frozen=True)
class PressureSolution:
    """A solved film."""

    gap: Gap
    P: Array
    """(n + 1, m + 1) pressure [-]."""
    void: Array
    """(n + 1, m + 1) fraction of the gap without oil; at the ends that of the neighbouring node [-]."""

    @property
    def fill(self) -> Array:
        """Return the (n + 1,) fraction of the gap filled with oil, averaged over the width [-]."""
        return np.asarray((1 - self.void) @ self.gap.arc.across)

    @property
    def force(self) -> Array:
        """Return the (2,) force of the film along the load and ahead of it, in units of So."""
        arc = self.gap.arc
        weight = self.P @ arc.across * arc.around / 2
        first, last = arc.phi[-1], arc.phi[0] + 2 * np.pi
        groove = np.array([np.sin(last) - np.sin(first), np.cos(first) - np.cos(last)])
        axes = np.array([np.cos(arc.phi), np.sin(arc.phi)])
        return np.asarray(axes @ weight + self.gap.fed @ arc.across * groove / 2)

    @property
    def slopes(self) -> Array:
        """Return (n,) pressure difference between nodes over their distance, averaged over the width."""
        return np.asarray(np.diff(self.P, axis=0) @ self.gap.arc.across / np.diff(self.gap.arc.phi))

    @property
    def torque(self) -> float:
        """Return the shear torque on the journal without the groove, M psi/(B R² eta_s omega) [-]."""
        gap, arc = self.gap, self.gap.arc
        drag = arc.around * self.fill * gap.nodes.shear / gap.H_nodes
        pushed = (np.diff(self.P, axis=0) * (1 - self.void[:-1])) @ arc.across
        return float(drag.sum() + (gap.H_faces * gap.faces.carried * pushed).sum())


def pressed(gap: Gap, start: tuple[Array, Array] | None = None) -> PressureSolution:
    """Return the solution for pressure and void, starting from the (n + 1, m + 1) values of a nearby film.

    Raises
    ------
    ArithmeticError
        If the cavities do not converge.
    """
    shape = gap.arc.phi.size, gap.arc.zeta.size
    near = None if start is None else (start[0].ravel(), start[1].ravel())
    solution = cavitation(_network(gap), near)
    P, void = solution.P.reshape(shape), solution.void.reshape(shape).copy()
    void[1:-1, -1] = void[1:-1, -2]
    return PressureSolution(gap, P, void)


def _network(gap: Gap) -> Network:
    """Return the flow balances."""
    arc, n, m = gap.arc, gap.arc.phi.size - 1, gap.arc.zeta.size - 1
    step, axial = _steps(n), _steps(m)
    along = 12 * gap.faces.conductance * gap.H_faces**3 / np.diff(arc.phi)
    out = 12 * gap.nodes.conductance * gap.H_nodes**3 * arc.around / arc.ratio**2
    drag = 12 * gap.faces.carried * gap.H_faces
    upwind = eye_array(n, n + 1)
    around = kron(step.T @ diags_array(along) @ step, diags_array(arc.across))
    across_ = kron(diags_array(out), axial.T @ diags_array(1 / np.diff(arc.zeta)) @ axial)
    shear = kron(-step.T @ diags_array(drag) @ upwind, diags_array(arc.across))
    fixed = np.full((n + 1, m + 1), -1.0)
    fixed[:, -1] = 0.0
    fixed[[0, -1]] = gap.fed
    return Network(csc_array(around + across_), csc_array(shear), (fixed >= 0).ravel(), fixed.ravel())


def _steps(n: int) -> csc_array:
    """Return the (n, n + 1) matrix of differences between neighbours."""
    return csc_array(eye_array(n, n + 1, k=1) - eye_array(n, n + 1))
