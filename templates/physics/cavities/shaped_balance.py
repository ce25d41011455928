"""Static position of a journal in a bore of any shape, aligned or tilted, from its load.

Newton's method first searches on a fixed mesh. The mesh is then graded to the position found until both
agree, and refined to 32, 64 and 128 circumferential intervals. No step may reduce the gap by more than 70 %
anywhere, and a step that moves the force away from the load is rejected. The last two meshes give
Richardson's extrapolation, the last three an error estimate.

In a lobed or grooved bore, a mesh that is graded to one lobe exerts a spurious force on a centred journal.
Under a light load this force matters, and the meshes are not yet in the asymptotic range. Therefore, if the
last refinement moves the journal or changes its least gap by more than `SETTLED`, a mesh of 256 intervals
follows. If the changes still do not decrease with the square of the mesh size, the result of the finest mesh
is returned without extrapolation.

Oil enters at the grooves of `Feed`, which are stationary relative to the load. Without grooves it enters
along the joints of a lobed bore, or in a plain bore along a line opposite the displacement of the journal's
centre.

The equilibrium may lie on any side: supply pressure can lift the journal above the bearing's centre. The
search therefore starts at the position in a plain bearing, then near the centre, then on the other sides. An
equilibrium that does not resist slow displacement, det K ≤ 0, is rejected.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities.fed_film import Feed
from templates.physics.cavities.shaped_film import ShapedFilm, shaped_film
from templates.physics.cavities.shaped_network import FULL_TURN, Nodes, Pocket, shaped_nodes
from templates.physics.films.film_map import mapped_film
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.films.film_shape import Bore, Lie, narrowest
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

MESHES: Sequence[tuple[int, int]] = ((32, 6), (64, 8), (128, 16))
"""Numbers of intervals around the circumference and over half the width."""
FINER = 256, 32
"""The mesh that follows if the others have not converged."""
SETTLED = 0.01
"""Largest relative change of displacement and least gap by the last refinement if converged [-]."""
SAFETY = 1.25
"""Safety factor of a stated error over the change by refinement, after Roache 1994 [-]."""
EXTRAPOLATED = 1.5
"""Factor on the error of film, position and pressure if they are extrapolated [-]."""
OFF_ORDER = 0.5
"""Largest deviation of a change from a quarter of the previous one, over its size, in the asymptotic range.
"""
LEAST_GAP = 1e-6
"""Smallest gap at which a film is sought [-]."""
SMALLEST = 1e-3
"""Eccentricity of the plain film below which the result is scaled linearly with the load [-]."""
_SUDDEN = 6
"""Limit on the contribution of the previous change: a mesh that misses a lobe says nothing about finer ones.
"""
_STEPS = 40
_TURNS = 8
"""Largest number of regradings of the mesh."""
_ACCURACY = 1e-7
"""Step over the least gap at which a search on one mesh ends."""
_AGREED = 1e-5
"""Rotation of the supply line at which position and mesh agree [rad]."""
_NEAR_ENOUGH = 1e-2
"""Relative change of the least gap at which position and mesh agree."""


class NoBalance(ArithmeticError):
    """There is no position at which the film carries the load, or the search did not find it."""


@dataclass(frozen=True)
class BearingCase:
    """A bearing with its load, for which the journal's position is sought."""

    So: float
    """Sommerfeld number of the smallest clearance, 0 or more [-]."""
    ratio: float
    """Width over diameter B/D [-]."""
    bore: Bore
    tilt: Array
    """(2,) displacement of the journal's end zeta = 1 relative to its middle, over the radial clearance [-].
    """
    feed: Feed
    conserving: bool
    """Whether cavities conserve mass."""

    def pockets(self, attitude: float) -> list[Pocket]:
        """Return the oil inlets for a journal whose centre is displaced in a direction."""
        if self.feed.grooves:
            return [Pocket(angle, width, self.feed.pressure) for angle, width in self.feed.grooves]
        if self.bore.is_lobed:
            return [Pocket(float(angle), 0.0, self.feed.pressure) for angle in self.bore.joints()]
        return [Pocket(attitude + np.pi, 0.0, self.feed.pressure)]

    @property
    def line_turns(self) -> bool:
        """Return whether the supply line rotates with the journal's displacement."""
        return not self.feed.grooves and not self.bore.is_lobed

    def lie(self, e: Array) -> Lie:
        """Return the position of the journal after a displacement e."""
        return Lie(e, self.tilt)


@dataclass(frozen=True)
class MeshEquilibrium:
    """The film that carries a load on one mesh."""

    film: ShapedFilm
    lie: Lie
    gap: float
    """The least gap [-]."""


@dataclass(frozen=True)
class Balance:
    """The films that carry a load on the last meshes, from coarse to fine."""

    before: MeshEquilibrium | None
    """The coarsest of three meshes; None if only two have a solution."""
    coarse: MeshEquilibrium
    fine: MeshEquilibrium

    @property
    def is_settled(self) -> bool:
        """Return whether the load is carried on three meshes and the last refinement changed little."""
        step, _ = self._steps
        moved = float(np.hypot(*step)) <= SETTLED * self.fine.lie.eps
        return self.before is not None and moved and abs(self.fine.gap / self.coarse.gap - 1) <= SETTLED

    @property
    def is_asymptotic(self) -> bool:
        """Return whether the changes decrease with the square of the mesh size, or the last one is small."""
        step, previous = self._steps
        off = float(np.hypot(*(step - previous / 4)))
        return self.is_settled or (self.before is not None and off <= OFF_ORDER * float(np.hypot(*step)))

    @property
    def place_error(self) -> float:
        """Return the estimated error of the journal's position, relative to its displacement [-]."""
        step, previous = (float(np.hypot(*step)) for step in self._steps)
        moved = max(step, min(previous / 4, _SUDDEN * step))
        return self._trust * SAFETY * moved / max(self.fine.lie.eps, 1e-300)

    @property
    def gap_error(self) -> float:
        """Return the estimated relative error of the least gap [-]."""
        return self._trust * self._error(lambda refined: refined.gap, 2)

    @property
    def pressure_error(self) -> float:
        """Return the estimated relative error of the largest pressure [-]."""
        return self._trust * self._error(lambda refined: refined.film.peak[0], 2)

    @property
    def flow_error(self) -> float:
        """Return the estimated relative error of the side flow, which converges irregularly [-]."""
        return 2 * self._error(lambda refined: refined.film.side_flow, 1)

    def _error(self, value: Callable[[MeshEquilibrium], float], order: int) -> float:
        """Return the relative change by the last refinement.

        If the previous change divided by the expected reduction is larger, return that.
        """
        coarse, fine = value(self.coarse), value(self.fine)
        previous = 0.0 if self.before is None else (coarse - value(self.before)) / 2**order
        return SAFETY * max(abs(fine - coarse), abs(previous)) / max(abs(fine), 1e-300)

    @property
    def _trust(self) -> float:
        """Return the factor by which extrapolation reduces the error; 1 outside the asymptotic range [-]."""
        return EXTRAPOLATED if self.is_asymptotic else 1.0

    @property
    def _steps(self) -> tuple[Array, Array]:
        """Return the displacements by the last refinement and by the one before it."""
        e = self.coarse.lie.e
        return self.fine.lie.e - e, np.zeros(2) if self.before is None else e - self.before.lie.e


def balance(loaded: BearingCase) -> Balance:
    """Return the equilibrium position of the journal.

    Raises
    ------
    NoBalance
        If no search finds a stable position.
    """
    failure: Exception | None = None
    for meshes, start in product(_ladders(loaded), _starts(loaded)):
        try:
            return _refined(loaded, start, meshes)
        except (
            ArithmeticError,
            RuntimeError,
            np.linalg.LinAlgError,
        ) as reason:  # the last indicates a singular matrix
            failure = reason
    raise NoBalance("no position of the journal was found where the film supports the load") from failure


def _ladders(loaded: BearingCase) -> list[Sequence[tuple[int, int]]]:
    """Return the sequences of meshes for the refinement.

    For a lobed bore there is also one without the coarsest mesh, which may not resolve some lobes.
    """
    return [MESHES, MESHES[1:]] if loaded.bore.is_lobed and not loaded.feed.grooves else [MESHES]


def _starts(loaded: BearingCase) -> Iterator[Array]:
    """Yield the displacements at which to start a search."""
    eps = float(np.nan_to_num(mapped_eccentricity(np.array(loaded.So), np.array(loaded.ratio)), nan=0.999))
    eps = min(max(eps, SMALLEST), ECCENTRICITY_LIMIT)
    attitude = float(mapped_film(np.array(eps), np.array(loaded.ratio))["attitude"])
    plain = np.array([np.cos(attitude), np.sin(attitude)])
    yield _inside(loaded, eps * plain)
    yield _inside(loaded, 0.05 * plain)
    if loaded.feed.grooves:
        for turn in (np.pi / 2, np.pi, -np.pi / 2):
            cos, sin = np.cos(attitude + turn), np.sin(attitude + turn)
            yield _inside(loaded, 0.6 * np.array([cos, sin]))


def _inside(loaded: BearingCase, e: Array) -> Array:
    """Return the displacement, shortened until the journal touches the bore nowhere."""
    for _ in range(60):
        if narrowest(loaded.bore, loaded.lie(e))[0] > 10 * LEAST_GAP:
            return e
        e = e * 0.9
    raise NoBalance("the tilted journal touches the bore in every position")


def _refined(loaded: BearingCase, e: Array, meshes: Sequence[tuple[int, int]]) -> Balance:
    """Return the balance on successive meshes, each started from the last one, and on `FINER` if needed."""
    films: list[MeshEquilibrium] = []
    for mesh in meshes:
        films.append(
            stable_film(loaded, films[-1].lie.e if films else e, mesh, films[-1].film if films else None)
        )
    balanced = Balance(films[-3] if len(films) > 2 else None, *films[-2:])
    if balanced.is_settled:
        return balanced
    try:
        finer = stable_film(loaded, balanced.fine.lie.e, FINER, balanced.fine.film)
    except (ArithmeticError, RuntimeError, np.linalg.LinAlgError):
        return balanced
    return Balance(balanced.coarse, balanced.fine, finer)


def stable_film(
    loaded: BearingCase, e: Array, mesh: tuple[int, int], near: ShapedFilm | None
) -> MeshEquilibrium:
    """Return the equilibrium on one mesh; one that does not resist slow displacement is refused."""
    film, lie = _agreed(loaded, e, mesh, near)
    if np.linalg.det(film.linear[0]) <= 0:
        raise NoBalance("the equilibrium position found is not stable")
    return MeshEquilibrium(film, lie, narrowest(loaded.bore, lie)[0])


def _agreed(
    loaded: BearingCase, e: Array, mesh: tuple[int, int], near: ShapedFilm | None
) -> tuple[ShapedFilm, Lie]:
    """Return the equilibrium on a mesh that is graded to it, with the supply line opposite to it."""
    line = loaded.lie(e).attitude
    for turn in range(_TURNS):
        before = narrowest(loaded.bore, loaded.lie(e))[0]
        pockets = loaded.pockets(line)
        nodes = shaped_nodes(loaded.bore, loaded.lie(e), loaded.ratio, pockets, *mesh)
        near, e = film, e = _searched(loaded, e, nodes, pockets, near)
        after = narrowest(loaded.bore, loaded.lie(e))[0]
        aside = (loaded.lie(e).attitude - line + np.pi) % FULL_TURN - np.pi
        graded = abs(after / before - 1) <= _NEAR_ENOUGH or turn >= _TURNS // 2
        if graded and (not loaded.line_turns or abs(aside) <= _AGREED):
            break
        line += aside
    return film, loaded.lie(e)


def _searched(
    loaded: BearingCase, e: Array, nodes: Nodes, pockets: list[Pocket], near: ShapedFilm | None
) -> tuple[ShapedFilm, Array]:
    """Return the equilibrium on one mesh by Newton's method."""
    film = _solved(loaded, e, nodes, pockets, near)
    wanted = np.array([loaded.So, 0.0])
    for _ in range(_STEPS):
        lack = wanted - film.force
        step = np.asarray(np.linalg.solve(film.linear[0], lack), float)
        H = film.H
        gains = np.cos(nodes.phi[:-1]) * step[0] + np.sin(nodes.phi[:-1]) * step[1]
        share = min(1.0, 0.7 / max(float((gains[:, None] / H.nodes).max()), 1e-300))
        least = float(H.nodes.min())
        if float(np.hypot(*step)) <= _ACCURACY * least:
            return film, e
        film, e = _nearer(loaded, film, e, share * step, nodes, pockets)
        if float(film.H.nodes.min()) < LEAST_GAP:
            raise NoBalance("the film that would carry the load is thinner than a millionth of the clearance")
    raise NoBalance("the search for the journal's position does not converge")


def _nearer(
    loaded: BearingCase, film: ShapedFilm, e: Array, step: Array, nodes: Nodes, pockets: list[Pocket]
) -> tuple[ShapedFilm, Array]:
    """Return the film after a step, which is halved until the force is closer to the load than before."""
    wanted = np.array([loaded.So, 0.0])
    distance = float(np.hypot(*(wanted - film.force)))
    for _ in range(12):
        try:
            after = _solved(loaded, e + step, nodes, pockets, film)
        except (ArithmeticError, RuntimeError):
            after = None
        if after is not None and float(np.hypot(*(wanted - after.force))) < distance:
            return after, e + step
        step = step / 2
    raise NoBalance("no displacement brings the film's force nearer to the load")


def _solved(
    loaded: BearingCase, e: Array, nodes: Nodes, pockets: list[Pocket], near: ShapedFilm | None
) -> ShapedFilm:
    """Return the film at a displacement; the solution starts from a nearby film if there is one."""
    start = None if near is None else _carried(near, nodes)
    lie = loaded.lie(e)
    try:
        return shaped_film(nodes, loaded.bore, lie, pockets, conserving=loaded.conserving, start=start)
    except ArithmeticError:
        return shaped_film(nodes, loaded.bore, lie, pockets, conserving=loaded.conserving)


def _carried(film: ShapedFilm, nodes: Nodes) -> tuple[Array, Array]:
    """Return the pressure and void of a film at other nodes, interpolated linearly in each direction."""
    if film.nodes is nodes:
        return film.solution.P.copy(), film.solution.void.copy()
    own = film.nodes

    def carried(values: Array) -> Array:
        columns = values.T
        rows = np.stack(
            [np.interp(nodes.phi[:-1], own.phi[:-1], c, period=FULL_TURN) for c in columns], axis=1
        )
        return np.stack([np.interp(nodes.zeta, own.zeta, row) for row in rows]).ravel()

    return carried(film.P), carried(film.void)
