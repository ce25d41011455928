"""The orbit of a journal in a mass-conserving film fed by holes and grooves: level `supplied`.

The film is marched over several cycles (`supplied_march`) on a mesh that rotates at the mean speed of journal
and sleeve. On this mesh the shear flow vanishes, and oil in a cavity stays in its cell, so there is no
numerical diffusion. The march runs on a coarse mesh until the orbit repeats, or the film clearly starves;
then on a mesh whose cells follow the least gap. `python -m benchmarks.supplied_orbits` measures its errors.
"""

from dataclasses import astuple, dataclass, replace
from enum import StrEnum

import numpy as np

from templates.core.arrays import Array
from templates.core.progress import report
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.supplied.supplied_march import Duty, State, gap_at, start
from templates.physics.supplied.supplied_mesh import Mesh, carried, supplied_mesh
from templates.physics.supplied.supplied_run import (
    WANDERS,
    Run,
    RunOutcome,
    in_frame,
    least_gap,
    returns,
    run_in,
)
from templates.physics.supplied.supply import Supply

MASS = 2.5e-4
"""Mass of the journal m c Omega psi²/(B D eta), c the radial clearance: it regularises the motion where the
film is empty [-]."""
SECTOR = np.pi / 3
"""A pocket is under the load if its half angle is smaller than this and its centre lies within this angle
of the load's direction [rad]."""
OFTEN = 0.4
"""Fraction of the cycle under the load from which a pocket counts as staying there [-]."""
THINNEST = 1e-4
"""Smallest gap that the mesh resolves [-]."""
_REPORTED = 0.05  # fraction of a cycle between two progress reports


class Verdict(StrEnum):
    """How a march ended."""

    REPEATING = "repeating"
    """The orbit repeats: its smallest gap repeats to 1e-3."""
    WANDERING = "wandering"
    """The smallest gap repeats only to `repeat_error`, at most 3 %."""
    STARVED = "starved"
    """The film thins with the cycle number n like 1/sqrt(n) or faster, or no film is left under the load."""
    UNSETTLED = "unsettled"
    """No orbit was found: the smallest gap changes by more than 3 % from cycle to cycle without thinning
    (for example if the supply lifts the journal more than the load presses it), or no film supports the
    load."""


@dataclass(frozen=True)
class MeshSettings:
    """A mesh, its largest time step, and the largest number of cycles to march on it."""

    around: int
    across: int
    step: float
    """Largest time step [rad]."""
    most: int
    near_edges: bool = False
    """Whether rows are also finer on both sides of a hole's edge, as they are at a groove's edge."""
    cells: float = 1.0
    """Circumferential cells relative to those that a thin gap needs [-]."""


COARSE = MeshSettings(64, 4, np.radians(4.0), 30)
"""The mesh of the first cycles."""
FINE = MeshSettings(128, 6, np.radians(2.0), 24)
"""The mesh of the result; it has more circumferential cells where the smallest gap is thin."""
RESOLVED, MOST_AROUND = 0.3, 384
"""Largest width of a cell over the width of the smallest gap, sqrt(2 (1 − eps)), and the largest number of
cells [-]."""

NEAR_HOLES = (
    MeshSettings(192, 6, np.radians(2.0), 24, near_edges=True, cells=1.5),
    MeshSettings(256, 8, np.radians(2.0), 24, near_edges=True, cells=2.0),
)
"""Further meshes for bearings in which every hole stays under the load: there all oil enters through the
hole's edges against the film's pressure, so the mesh at these edges determines the flow."""
NEAR_EDGES = 0.4
"""Largest row spacing at a hole's edge on these meshes, relative to equal rows [-]."""
STAYS = 0.6
"""Fraction of the cycle under the load above which the holes count as staying under it [-]."""
THIN, MORE_ROWS = 0.002, 4
"""If the smallest gap is below the first number, meshes after the first have the second number of extra
axial rows [-]."""


@dataclass(frozen=True)
class Totals:
    """The results of one cycle on one mesh; dimensionless."""

    gap: float
    """Smallest gap, also between the angles."""
    pressure: float
    """Largest pressure p psi²/(eta Omega)."""
    loss: float
    """Mean of shear times the square of the sliding speed, plus the mean work of the load on the film."""
    side_flow: float
    """Mean flow of oil out of both ends, Q/(B D c Omega), c the radial clearance."""

    def change(self, before: "Totals") -> "Totals":
        """Return the changes on another mesh, relative to the values on this one [-]."""
        pairs = zip(astuple(self), astuple(before), strict=True)
        return Totals(*(abs(old / new - 1) for new, old in pairs))

    def error(self, repeat: float, least: "Totals") -> "Totals":
        """Return the remaining error of mesh and step from the change since the previous mesh [-].

        `repeat` is the change from cycle to cycle, `least` the smallest error that is stated.
        """
        parts = zip(astuple(self), astuple(least), astuple(LEAVES), astuple(COARSE_BEYOND), strict=True)
        return Totals(*(
            repeat + low + leaves * min(c, knee) + max(c - knee, 0) / 4 for c, low, leaves, knee in parts
        ))  # fmt: skip


UNKNOWN = Totals(np.nan, np.nan, np.nan, np.nan)
LEAST = Totals(gap=5e-3, pressure=0.05, loss=5e-3, side_flow=0.01)
LEAST_OF_HOLES = replace(LEAST, pressure=0.2)
"""Where only holes feed the bearing, a starved film may end in an impact, whose pressure depends on the
step."""
LEAVES = Totals(gap=3.0, pressure=3.0, loss=1.5, side_flow=2.0)
COARSE_BEYOND = Totals(gap=0.012, pressure=0.1, loss=0.02, side_flow=0.05)
"""The error of mesh and step is `LEAST` plus `LEAVES` times the change since the previous mesh. A change
beyond `COARSE_BEYOND` stems from the coarse mesh; only a quarter of it counts. The numbers were chosen on
marches with finer meshes and checked on others by `python -m benchmarks.film_cycle_engines` [-]."""


@dataclass(frozen=True)
class SuppliedOrbit:
    """The last marched cycle; dimensionless, at K angles of unequal steps."""

    theta: Array
    """(K,) rising crank angles; the last is one cycle after the load's first [rad]."""
    eps: Array
    """(2, K) relative eccentricity along the axes of the frame."""
    gap: Array
    """(K,) 1 − |eps|."""
    P_max: Array
    """(K,) largest pressure p psi²/(eta Omega)."""
    feed: Array
    """(K,) oil fed by all pockets, Q/(B D c Omega), c the radial clearance."""
    side_flow: Array
    """(K,) oil that leaves at both ends, Q/(B D c Omega)."""
    shear: Array
    """(K,) shear of the oil present; pi/sqrt(1 − eps²) for a full film."""
    void: Array
    """(K,) share of the gap's volume that is void."""
    least_gap: float
    """Smallest gap over the cycle, also between the angles (by a parabola); NaN without a whole cycle [-]."""
    least_angle: float
    """Crank angle of the smallest gap [rad]."""
    verdict: Verdict
    repeat_error: float
    """Relative change of the smallest gap since the previous cycle. If the orbit does not repeat, it is the
    largest change of the last three cycles, and infinite with fewer than two cycles."""
    error: Totals
    """Relative error from mesh, step and imperfect repetition of the cycle; NaN where unknown [-]."""
    drift: float
    """Change of the eccentricity since the previous cycle over the gap, averaged over the cycle [-]."""
    cycles: tuple[int, ...]
    """Cycles marched on each mesh."""
    around: int
    """Circumferential cells of the last mesh."""
    mean_feed: float
    """Mean flow of oil fed over the cycle, averaged over the steps [-]."""
    mean_side_flow: float
    """Mean flow of oil out of both ends, averaged over the steps [-]."""
    mass_balance: float
    """Oil fed minus oil lost at the ends minus oil stored, over the oil lost [-]."""
    halvings: int
    """Number of times a step of the last cycle was halved because it did not converge."""
    under_load: float
    """Fraction of the cycle in which every pocket is under the load, within 60° of its direction [-]."""
    change: Totals
    """Relative change of the cycle since the previous mesh; NaN if there was none [-]."""

    @property
    def reason(self) -> str:
        """Return the reason why the orbit does not repeat; empty if it does."""
        if self.verdict is Verdict.REPEATING:
            return ""
        if self.verdict is Verdict.WANDERING:
            return f"the smallest film wanders by {100 * self.repeat_error:.2g} % from cycle to cycle"
        if self.verdict is Verdict.UNSETTLED:
            return "no orbit repeats: the load is too large for a film, or too small to hold the journal"
        share, thins = f"{100 * self.under_load:.0f} % of the cycle", "the film thins from cycle to cycle"
        if self.under_load < OFTEN:
            return f"starved: {thins}, although the hole is within 60° of the load for {share} only"
        return f"starved: the hole stays under the load, within 60° of it for {share}; {thins}"


def supplied_orbit(
    load: CyclicLoad,
    sliding: Array,
    ratio: float,
    supply: Supply,
    meshes: tuple[MeshSettings, ...] = (COARSE, FINE),
    mass: float = MASS,
    refined: bool = True,
    near_holes: tuple[MeshSettings, ...] = (),
) -> SuppliedOrbit:
    """Return the orbit of one case, marched until it repeats or clearly starves.

    It reports progress by `templates.core.progress.report`, which may raise an error to cancel. The first
    call compiles the kernel, or reads it from disk (`templates.physics.numerics.machine_code`).

    Parameters
    ----------
    load
        One case: S (2, 1, N), the force of the journal; w (1, N).
    sliding
        (N,) speed of the journal relative to the sleeve, over Omega, at the load's angles [-].
    ratio
        Width over diameter B/D [-].
    supply
        Pockets and supply pressure.
    meshes
        The successive meshes of the march.
    mass
        Mass of the journal m c Omega psi²/(B D eta), c radial [-].
    refined
        Whether meshes after the first follow a thin gap, with more cells and with rows closer to the edges.
    near_holes
        Further meshes for a case in which every pocket stays under the load for more than `STAYS` of the
        cycle.

    Raises
    ------
    ValueError
        If a pocket that does not extend around the whole circle is not back at its position in the frame
        after the cycle.
    """
    duty = Duty(load, np.asarray(sliding, float), supply, mass)
    _require_return(duty)
    further = near_holes if near_holes and under_load(duty) > STAYS else ()
    meshes = (*meshes, *further)
    runs: list[Run] = []
    for number, meshing in enumerate(meshes):
        gap = min(runs[-1].gaps, default=0.0) if runs and refined else 1.0
        around = max(meshing.around, _cells(gap, meshing.cells))
        across = meshing.across + (MORE_ROWS if gap < THIN else 0)
        near, finest = supply.grooved or meshing.near_edges, NEAR_EDGES if meshing.near_edges else 1.0
        mesh = supplied_mesh(ratio, around, across, supply.edges, near, max(gap, THINNEST), finest)
        state = start(mesh, duty) if not runs else transferred(runs[-1].mesh, mesh, runs[-1].states[-1])
        progress = _Progress(number, meshes)
        runs.append(run_in(mesh, duty, state, meshing.step, meshing.most, progress))
        if runs[-1].ending is RunOutcome.THINNING:
            break
    return _measured(duty, runs)


def _cells(gap: float, times: float = 1.0) -> int:
    """Return `times` the number of circumferential cells that resolves a gap, rounded to steps of 16."""
    wanted = times * 2 * np.pi / (RESOLVED * np.sqrt(2 * max(gap, THINNEST)))
    return int(min(16 * np.ceil(wanted / 16), MOST_AROUND))


class _Progress:
    """Reports the progress of a march several times per cycle."""

    def __init__(self, number: int, meshes: tuple[MeshSettings, ...]) -> None:
        self.number, self.meshes, self.last = number, meshes, -1.0

    def __call__(self, cycle: int, part: float) -> None:
        if cycle + part < self.last + _REPORTED:
            return
        self.last, most = cycle + part, self.meshes[self.number].most
        done = (self.number + (cycle - 1 + part) / most) / len(self.meshes)
        report(done, f"mesh {self.number + 1} of {len(self.meshes)}, cycle {cycle} of at most {most}")


def transferred(mesh: Mesh, finer: Mesh, state: State) -> State:
    """Return a state interpolated to another mesh."""
    void = carried(mesh, finer, state.void, state.void[:, -1])
    P = carried(mesh, finer, state.P, 0 * state.P[:, -1])
    oil = (1 - void) * gap_at(finer, state.e)[:, None]
    return replace(state, P=P, void=void, oil=oil, step=0.0, velocity=0 * state.velocity)


def return_error(duty: Duty) -> float:
    """Return the largest distance of a pocket from its initial position after a cycle [rad]."""
    mean, half = duty.mesh_turning.of_cycle, duty.journal_turning.of_cycle
    turns = [
        mean + half if p.on_journal else mean - half for p in duty.supply.pockets if p.half_angle < np.pi
    ]
    return max((abs((turn + np.pi) % (2 * np.pi) - np.pi) for turn in turns), default=0.0)


def under_load(duty: Duty) -> float:
    """Return the fraction of the cycle in which every pocket is within 60° of the load's direction [-]."""
    theta = duty.begin + duty.load.period * np.arange(720) / 720
    S, places = duty.seen(theta)
    off = places[..., 0] - np.arctan2(S[:, 1], S[:, 0])[:, None]
    away = np.abs((off + np.pi) % (2 * np.pi) - np.pi)
    return float(((away < SECTOR) & (places[..., 1] < SECTOR)).all(axis=1).mean())


def _require_return(duty: Duty) -> None:
    missed = return_error(duty)
    if not returns(missed):
        raise ValueError(
            f"a pocket is {np.degrees(missed):.3g}° away from its initial position after the cycle: "
            "sleeve and journal speed must turn it by whole turns relative to the frame"
        )


def _measured(duty: Duty, runs: list[Run]) -> SuppliedOrbit:
    """Return the verdict on the last cycle."""
    change = _change(duty, runs)
    run = next((run for run in reversed(runs) if run.gaps), runs[-1])
    mesh, states = run.mesh, run.states[1:] or run.states
    theta, z = in_frame(duty, states)
    shift = duty.begin + duty.load.period - theta[-1]
    gap = 1 - np.abs(z)
    least, angle = least_gap(theta, gap, duty.load.period)
    H = np.array([gap_at(mesh, state.e) for state in states])
    fill = np.array([(1 - state.void) @ mesh.width for state in states])
    step, share = 2 * np.pi / mesh.order.size, under_load(duty)
    fed, lost = _flows(run.states)
    return SuppliedOrbit(
        theta=theta + shift,
        eps=np.stack([z.real, z.imag]),
        gap=gap,
        P_max=np.array([state.P.max() for state in states]),
        feed=np.array([state.feed for state in states]),
        side_flow=np.array([state.side_flow for state in states]),
        shear=(fill / H).sum(axis=1) / mesh.width.sum() * step / 2,
        void=1 - (fill * H).sum(axis=1) / (mesh.width.sum() * H.sum(axis=1)),
        least_gap=least if run.gaps else np.nan,
        least_angle=angle + shift,
        verdict=_verdict(runs[-1], share),
        repeat_error=run.repeat_error,
        error=change.error(run.repeat_error, LEAST if duty.supply.grooved else LEAST_OF_HOLES),
        drift=run.drift,
        cycles=tuple(len(run.gaps) for run in runs),
        around=mesh.order.size,
        mean_feed=fed / duty.load.period,
        mean_side_flow=lost / duty.load.period,
        mass_balance=(fed - lost - _stored(mesh, run.states)) / max(lost, 1e-300),
        halvings=run.halvings,
        under_load=share,
        change=change,
    )


def _change(duty: Duty, runs: list[Run]) -> Totals:
    """Return the change between the results of the last two meshes; NaN without a full cycle on both."""
    if len(runs) < 2 or not (runs[-2].gaps and runs[-1].gaps):
        return UNKNOWN
    return _totals(duty, runs[-1]).change(_totals(duty, runs[-2]))


def _totals(duty: Duty, run: Run) -> Totals:
    """Return the results of the last cycle of a run."""
    states, mesh = run.states[1:], run.mesh
    theta, z = in_frame(duty, run.states)
    fill = np.array([(1 - state.void) @ mesh.width for state in states])
    H = np.array([gap_at(mesh, state.e) for state in states])
    shear = (fill / H).sum(axis=1) / mesh.width.sum() * np.pi / mesh.order.size
    load, w = duty.in_frame((theta[1:] + theta[:-1]) / 2)
    middle, step = (z[1:] + z[:-1]) / 2, np.diff(theta)
    work = (load.conj() * (np.diff(z) - 1j * w * middle * step)).real.sum()
    at_ends = np.interp(theta[1:] % duty.load.period, duty.load.angle, duty.sliding, period=duty.load.period)
    return Totals(
        gap=run.gaps[-1],
        pressure=max(float(state.P.max()) for state in states),
        loss=float((shear * at_ends**2) @ step + work) / duty.load.period,
        side_flow=_flows(run.states)[1] / duty.load.period,
    )


def _verdict(run: Run, share: float) -> Verdict:
    """Return the outcome of the last run.

    `share` is the fraction of the cycle in which all pockets are under load.
    """
    if run.ending is RunOutcome.REPEATING:
        return Verdict.REPEATING
    if run.ending is RunOutcome.THINNING or (run.ending is RunOutcome.FAILED and share >= OFTEN):
        return Verdict.STARVED
    wanders = run.ending is RunOutcome.UNSETTLED and run.repeat_error <= WANDERS
    return Verdict.WANDERING if wanders else Verdict.UNSETTLED


def _flows(states: list[State]) -> tuple[float, float]:
    """Return the oil fed and the oil lost over a cycle.

    A BDF2 step stores a weighted mean of the flow at its end and the mean of the step before. The flows are
    summed with the same weights, so that they are consistent with the oil content of the march; the
    trapezoidal rule differs by some per cent where the step size changes, as at an impact.
    """
    fed, lost = (sum(state.step * state.flows[k] for state in states[1:]) for k in range(2))
    return float(fed), float(lost)


def _stored(mesh: Mesh, states: list[State]) -> float:
    """Return the oil in the film at the end of a cycle minus that at its start."""
    kept = (states[-1].oil - states[0].oil) @ mesh.width
    return float(kept.sum()) * np.pi / mesh.order.size
