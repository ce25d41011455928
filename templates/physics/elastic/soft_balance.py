"""The film under a load with an elastic bearing and pressure-dependent viscosity, by a single Newton method.

The unknowns are the nodal pressures, the set of nodes in the film (P ≥ 0, loss ≥ 0, P · loss = 0), and the
eccentricity. The ring couples all nodes with each other, but through few harmonics, so its part of the matrix
has low rank: each step needs one sparse factorisation with as many right-hand sides (Woodbury's formula).

The search starts at the rigid film and increases the compliance in steps, each starting from the previous
solution; a step that does not converge is halved. The mesh is graded to the least gap found.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.linalg import splu

from templates.core.arrays import Array, Mask
from templates.physics.elastic.soft_equations import SoftFilm, Softness, modes
from templates.physics.films.complementarity import rupture
from templates.physics.films.film_mesh import ring_mesh
from templates.physics.films.reynolds import journal_equations

MESHES = ((64, 8), (128, 16))
"""Numbers of intervals around the circumference and over half the width."""
_STEPS = 30
MOST_DEFORMED = 100.0
"""Deformation over the least gap beyond which no film is sought [-]."""
_LEAST_STEP = 0.02
"""Smallest increment of the compliance, relative to that reached, before the search stops."""
_FIRST = 1.0
"""Deformation over the least gap in the first step of compliance [-]."""
_REGRADE = 1.25
"""Change of the least gap beyond which the mesh is graded again."""
_ACCURACY = 1e-9


class NoBalance(ArithmeticError):
    """No film was found that carries the load."""


@dataclass(frozen=True)
class FilmEquilibrium:
    """A film that carries the load, and a mask of the nodes with pressure."""

    film: SoftFilm
    inside: Mask
    graded: float
    """The least gap to which the mesh is graded [-]."""
    steps: int
    """Number of factorisations for all compliances and meshes so far."""


def rigid_balance(So: float, ratio: float, eps: float, around: int, across: int) -> FilmEquilibrium:
    """Return the film of a rigid bearing under a load, on a mesh graded to nearly its eccentricity."""
    mesh = ring_mesh(eps, ratio, around, across)
    stiff = Softness(0.0, np.zeros(1))
    solved = rupture(journal_equations(eps, ratio, mesh))
    film = SoftFilm(mesh, ratio, stiff, modes(mesh, stiff.ring), eps, solved.P)
    return settled(film, solved.film, So, 1 - eps)


def soft_balance(So: float, softness: Softness, rigid: FilmEquilibrium) -> FilmEquilibrium:
    """Return the film of an elastic bearing, from the rigid film under the same load.

    Raises
    ------
    NoBalance
        If there is no film at some fraction of the compliance.
    """
    film = rigid.film
    probe = replace(film, softness=softness, modes=modes(film.mesh, softness.ring))
    at_once = _FIRST * (1 - film.eps) / max(float(probe.deformation.max()), 1e-300)
    done, step, at = 0.0, min(1.0, at_once), rigid
    while done < 1:
        share = min(1.0, done + step)
        try:
            after = _shared(So, softness.times(share), at)
        except (NoBalance, RuntimeError, np.linalg.LinAlgError) as failure:
            step /= 3
            if step < _LEAST_STEP * max(done, 0.1 * at_once):
                raise NoBalance("the film breaks down while the bearing deforms") from failure
            continue
        if float((after.film.deformation / after.film.H.min()).max()) > MOST_DEFORMED:
            raise NoBalance("the bearing deforms so far that its ends nearly touch")
        at, step, done = after, max(step, 0.7 * share), share
    return at


def _shared(So: float, softness: Softness, at: FilmEquilibrium) -> FilmEquilibrium:
    """Return the film at a fraction of the compliance, on the present mesh, then on one graded to its gap."""
    film = replace(at.film, softness=softness, modes=modes(at.film.mesh, softness.ring))
    film = replace(film, eps=_opened(film, at.film))
    found = settled(film, at.inside, So, at.graded, at.steps)
    for _ in range(4):
        if 1 / _REGRADE < float(found.film.H.min()) / found.graded < _REGRADE:
            break
        found = carried(found, So, *(size - 1 for size in found.film.P.shape))
    return found


def _opened(film: SoftFilm, before: SoftFilm) -> float:
    """Return the eccentricity at which a more compliant bearing has the same least gap as before."""
    return film.eps + float(film.H.min() - before.H.min())


def carried(found: FilmEquilibrium, So: float, around: int, across: int) -> FilmEquilibrium:
    """Return the film on a mesh with the given number of intervals that is graded to its gap."""
    film, own = found.film, found.film.mesh
    least = min(max(float(film.H.min()), 1e-7), 1.0)
    mesh = ring_mesh(1 - least, film.ratio, around, across)
    columns = np.stack([np.interp(mesh.phi, own.phi, column) for column in film.P.T], axis=1)
    P = np.stack([np.interp(mesh.zeta, own.zeta, row) for row in columns])
    P[[0, -1]], P[:, -1] = 0.0, 0.0
    there = replace(film, mesh=mesh, modes=modes(mesh, film.softness.ring), P=P)
    return settled(there, P > 0, So, least, found.steps)


def settled(film: SoftFilm, inside: Mask, So: float, graded: float, steps: int = 0) -> FilmEquilibrium:
    """Return the film on one mesh by Newton's method.

    Raises
    ------
    NoBalance
        If the method does not converge.
    """
    may = np.zeros(film.P.shape, bool)
    may[1:-1, :-1] = True
    inside = inside & may
    noise = 1e-12 * float(np.abs(film.loss).max())
    for step in range(_STEPS):
        dP, deps = _step(film, inside, So)
        share = _kept(film, dP, deps)
        P = film.P + share * dP
        after = replace(film, P=np.where(inside & (P > 0), P, 0.0), eps=film.eps + share * deps)
        moved = may & np.where(inside, P > 0, after.loss < -noise)
        change = float(np.abs(after.P - film.P).max()) / max(float(after.P.max()), 1e-300)
        least = float(after.H.min())
        if not (np.isfinite(change) and least > 0):
            break
        done = share == 1 and change < _ACCURACY and abs(deps) < _ACCURACY * least
        if done and np.array_equal(moved, inside):
            return FilmEquilibrium(after, inside, graded, steps + step + 1)
        film, inside = after, moved
    raise NoBalance("the film does not converge")


def _step(film: SoftFilm, inside: Mask, So: float) -> tuple[Array, float]:
    """Return the Newton step of pressure and eccentricity."""
    matrix, modal, by_eps = film.jacobian(inside)
    right = np.concatenate([-(film.loss * inside).reshape(-1, 1), by_eps[:, None], modal], axis=1)
    solved = splu(matrix).solve(right)
    own, eps, ring = solved[:, 0], solved[:, 1], solved[:, 2:]
    count = ring.shape[1]
    size = float(np.hypot(*film.force))
    by_force = film.force @ film.force_of / size
    left = np.zeros((count + 1, count + 1))
    left[:count, :count] = np.eye(count) + film.amplitudes_of @ ring
    left[:count, count] = film.amplitudes_of @ eps
    left[count, :count] = -(by_force @ ring)
    left[count, count] = -(by_force @ eps)
    wanted = np.concatenate([film.amplitudes_of @ own, [So - size - by_force @ own]])
    found = np.linalg.solve(left, wanted)
    dP = own - ring @ found[:count] - eps * found[count]
    return dP.reshape(film.P.shape), float(found[count])


def _kept(film: SoftFilm, dP: Array, deps: float) -> float:
    """Return the fraction of a step that leaves at least 30 % of the gap everywhere."""
    after = replace(film, P=film.P + dP, eps=film.eps + deps)
    worst = float(((film.H - after.H) / film.H).max())
    return min(1.0, 0.7 / worst) if worst > 0 else 1.0
