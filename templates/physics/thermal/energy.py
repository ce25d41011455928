r"""The energy equation of a film, circumferentially and across the film, averaged over the width.

.. math::
    \rho c\,(u\,\partial_x T + v\,\partial_y T) = \partial_y(k\,\partial_y T)
    + \eta\left[(\partial_y u)^2 + (\partial_y w)^2\right]

The temperature is constant along the width, where measured temperatures differ little (Dowson, Hudson,
Hunter, March 1966). Every term is averaged over the width, so dissipation, power input of journal and
supply, and removed heat are equal. In a cavity the oil flows in streamers of the film's height: every term is
multiplied by the share of the width that the streamers fill. Circumferential conduction is neglected.

Finite volumes on the strips of `across`: circumferentially upwind, exponential across the film (Scharfetter,
Gummel; Patankar). The equations are linear in T: one sparse system also gives the temperatures of the groove
and of the journal.

In units of T: :math:`\delta = \eta_s\omega/(\rho c\,\psi^2)` for dissipation, :math:`\kappa = k/(\rho c\,
\omega c_r^2)` for conduction across.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from templates.core.arrays import Array
from templates.physics.thermal.pressure import PressureSolution


@dataclass(frozen=True)
class HeatSources:
    """The heating and cooling of a film; temperatures in K."""

    delta: float
    """Temperature scale of dissipation, eta_s omega/(rho c psi²) [K]."""
    kappa: float
    """Conduction across the film, k/(rho c omega c_r²) [-]."""
    wall: float
    """Heat transfer of the bush, h_B/(rho c omega c_r); 0 if adiabatic, infinite at a given temperature
    [-]."""
    outside: float
    """Temperature behind the bush [K]."""
    supply: float
    """Temperature of the fresh oil [K]."""
    journal: float
    """Temperature of the journal; NaN for a journal without net heat flow [K]."""
    carry_over: float = 1.0
    """Fraction of the oil arriving at the groove that continues into the film [-]."""


@dataclass(frozen=True)
class FilmHeat:
    """The temperatures of a film, and its heat flows, each over rho c U c_r B [K]."""

    T: Array
    """(n + 1, J) temperature at the nodes and strips; the first and last are the groove's [K]."""
    bush: Array
    """(n + 1,) temperature of the bush's surface; at the groove's edges that of the neighbouring node [K]."""
    journal: float
    """Temperature of the journal [K]."""
    groove: float
    """Temperature of the oil that enters the film [K]."""
    dissipated: float
    by_side: float
    """Heat that leaves with the oil at the ends, relative to the supply temperature."""
    by_drain: float
    """Heat that leaves with the arriving oil that drains from the groove."""
    by_bush: float
    by_journal: float
    side: float
    """Oil flow out of the ends, over U c_r B [-]."""
    fresh: float
    """Oil flow from the supply into the groove, over U c_r B [-]."""

    @property
    def residual(self) -> float:
        """Return the error of the heat balance relative to the dissipation [-]."""
        away = self.by_side + self.by_drain + self.by_bush + self.by_journal
        return (self.dissipated - away) / self.dissipated


@dataclass(frozen=True)
class StripFlows:
    """Oil flows between the strips, over U c_r B, and their dissipation and cooling."""

    around: Array
    """(n, J) flow from node to node."""
    side: Array
    """(n − 1, J) flow out of the ends."""
    up: Array
    """(n − 1, J − 1) flow from strip to strip towards the journal."""
    heat: Array
    """(n − 1, J) dissipation at the inner nodes, over delta."""
    wet: Array
    """(n − 1,) length of each inner node's cell that is wetted by oil [rad]."""
    near: Array
    """(n − 1,) wetted length over the gap [rad]."""


def carried(film: PressureSolution) -> StripFlows:
    """Return the flows that conserve the oil of every strip, and the dissipation.

    The half cells at the groove are added to their neighbours, so that only mixing takes place in the groove.
    """
    gap, arc = film.gap, film.gap.arc
    faces, nodes, fill = gap.faces, gap.nodes, film.fill
    H, H_f, wet = gap.H_nodes, gap.H_faces, arc.around * film.fill
    around = (H_f**3 * film.slopes)[:, None] * faces.by_pressure + (H_f * fill[:-1])[:, None] * faces.by_drag
    gain = around[:-1] - around[1:]
    share = nodes.by_pressure / -nodes.conductance[:, None]
    side = gain.sum(axis=1)[:, None] * share[1:-1]
    up = np.cumsum(gain - side, axis=1)[:, :-1]
    return StripFlows(
        around, side, up, *(_inner(part) for part in (_dissipation(film, wet / H), wet, wet / H))
    )


def _inner(values: Array) -> Array:
    """Return the values of the inner nodes, to which those at the groove are added."""
    inner = values[1:-1].copy()
    inner[0] += values[0]
    inner[-1] += values[-1]
    return inner


def _dissipation(film: PressureSolution, drag: Array) -> Array:
    """Return the dissipation by drag and by circumferential and axial flow; its sum is the power input."""
    gap, arc = film.gap, film.gap.arc
    faces, nodes, step = gap.faces, gap.nodes, np.diff(arc.phi)
    steep = (np.diff(film.P, axis=0) / step[:, None]) ** 2 @ arc.across
    both = np.diff(film.P, axis=0) * (1 - film.void[:-1]) @ arc.across
    of_faces = (gap.H_faces**3 * steep * step)[:, None] * faces.heat_of_pressure
    of_faces = of_faces + (gap.H_faces * both)[:, None] * faces.heat_of_both
    widths = np.diff(arc.zeta)
    out = (np.diff(film.P, axis=1) / widths) ** 2 @ widths
    out[[0, -1]] = 0.0
    heat = drag[:, None] * nodes.heat_of_drag
    heat = heat + (gap.H_nodes**3 * out * arc.around / arc.ratio**2)[:, None] * nodes.heat_of_pressure
    heat[:-1] += of_faces / 2
    heat[1:] += of_faces / 2
    return np.asarray(heat)


def heated(film: PressureSolution, heating: HeatSources, edges: Array) -> FilmHeat:
    """Return the temperatures of a film.

    Raises
    ------
    RuntimeError
        If nothing removes the heat.
    """
    flow = carried(film)
    system = _System(flow, heating, edges)
    T = splu(system.matrix()).solve(system.right)
    if not np.isfinite(T).all():
        raise RuntimeError("no oil flow or surface removes the heat")
    return system.read(T)


class _System:
    """The linear equations: T of the strips at inner nodes, then of the groove and of the journal."""

    def __init__(self, flow: StripFlows, heating: HeatSources, edges: Array) -> None:
        self.flow, self.heating = flow, heating
        n, J = flow.around.shape
        self.n, self.J, self.size = n, J, (n - 1) * J + 2
        self.index = np.arange((n - 1) * J).reshape(n - 1, J)
        self.groove, self.journal = self.size - 2, self.size - 1
        conducting = heating.kappa * flow.near
        half = np.diff(edges) / 2
        self.between = conducting[:, None] / (half[1:] + half[:-1])
        self.to_journal = conducting / half[-1]
        wall = np.full(n - 1, np.inf) if np.isinf(heating.wall) else heating.wall * flow.wet
        own = conducting / half[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            self.share = np.where(np.isinf(wall), 1.0, wall / (wall + own))
        self.to_bush = own * self.share
        self.rows: list[Array] = []
        self.columns: list[Array] = []
        self.values: list[Array] = []
        self.right = np.zeros(self.size)

    def add(self, row: Array | int, column: Array | int, value: Array | float) -> None:
        """Add entries to the matrix."""
        parts = np.broadcast_arrays(row, column, value)
        for kept, part in zip((self.rows, self.columns, self.values), parts, strict=True):
            kept.append(part.ravel())

    def flows(self, giver: Array | int, taker: Array | int, flow: Array) -> None:
        """Add the heat that oil carries from one unknown to another, as a loss of the first one."""
        self.add(giver, giver, flow)
        self.add(taker, giver, -flow)

    def matrix(self) -> csc_array:
        """Set the right side and return the matrix."""
        flow, heat = self.flow, self.heating
        index = self.index
        whole = np.concatenate([np.full((1, self.J), self.groove), index, np.full((1, self.J), self.groove)])
        on, back = np.maximum(flow.around, 0), np.maximum(-flow.around, 0)
        self.flows(whole[1:-1], whole[2:], on[1:])
        self.flows(whole[1:-1], whole[:-2], back[:-1])
        self.add(whole[1], self.groove, -on[0])
        self.add(whole[-2], self.groove, -back[-1])
        self.add(index, index, flow.side)
        rise, fall = _exponential(flow.up, self.between)
        self.flows(index[:, :-1], index[:, 1:], rise)
        self.flows(index[:, 1:], index[:, :-1], fall)
        self.add(index[:, 0], index[:, 0], self.to_bush)
        self.add(index[:, -1], index[:, -1], self.to_journal)
        self.add(index[:, -1], self.journal, -self.to_journal)
        self.right[: self.groove] = heat.delta * flow.heat.ravel()
        self.right[index[:, 0]] += self.to_bush * heat.outside
        self._mixing(on, back)
        self._journal()
        rows, columns = (np.concatenate(part).astype(np.intp) for part in (self.rows, self.columns))
        return csc_array((np.concatenate(self.values), (rows, columns)), shape=(self.size, self.size))

    def _mixing(self, on: Array, back: Array) -> None:
        """Add the mixing of arriving and fresh oil in the groove; some of the arriving oil may drain."""
        heat = self.heating
        entering, arriving = on[0].sum() + back[-1].sum(), on[-1].sum() + back[0].sum()
        self.fresh = entering - heat.carry_over * arriving
        self.drained = 1 - heat.carry_over
        self.add(self.groove, self.groove, entering)
        self.add(self.groove, self.index[-1], self.drained * on[-1])
        self.add(self.groove, self.index[0], self.drained * back[0])
        self.right[self.groove] = self.fresh * heat.supply

    def _journal(self) -> None:
        """Add the equation of the journal: its temperature is given, or its net heat flow is zero."""
        if np.isfinite(self.heating.journal):
            self.add(self.journal, self.journal, 1.0)
            self.right[self.journal] = self.heating.journal
        else:
            self.add(self.journal, self.journal, self.to_journal.sum())
            self.add(self.journal, self.index[:, -1], -self.to_journal)

    def read(self, solved: Array) -> FilmHeat:
        """Return the temperatures and heat flows."""
        flow, heat = self.flow, self.heating
        inner, groove, journal = solved[: self.groove].reshape(self.index.shape), *solved[self.groove :]
        T = np.concatenate([np.full((1, self.J), groove), inner, np.full((1, self.J), groove)])
        bush = self.share * heat.outside + (1 - self.share) * inner[:, 0]
        above = inner - heat.supply
        arriving = np.maximum(flow.around[-1], 0) @ above[-1] + np.maximum(-flow.around[0], 0) @ above[0]
        return FilmHeat(
            T=T, bush=np.pad(bush, 1, mode="edge"), journal=float(journal), groove=float(groove),
            dissipated=float(heat.delta * flow.heat.sum()),
            by_side=float((flow.side * above).sum()),
            by_drain=float(self.drained * arriving),
            by_bush=float((self.to_bush * (inner[:, 0] - heat.outside)).sum()),
            by_journal=float((self.to_journal * (inner[:, -1] - journal)).sum()),
            side=float(flow.side.sum()), fresh=float(self.fresh),
        )  # fmt: skip


def _exponential(flow: Array, conduction: Array) -> tuple[Array, Array]:
    """Return the coefficients of heat flow up and down between strips: conduction × B(∓flow/conduction).

    B(x) = x/(exp(x) − 1) is exact if flow and conduction are constant between the two strips.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x = np.clip(np.where(conduction > 0, flow / conduction, np.sign(flow) * np.inf), -500, 500)
        x = np.where(np.isnan(x), 0.0, x)
        bernoulli = np.where(np.abs(x) < 1e-6, 1 - x / 2, x / np.expm1(x))
    strong = np.abs(x) >= 500
    down = np.where(strong, np.maximum(-flow, 0), conduction * bernoulli)
    return np.asarray(down + flow), np.asarray(down)
