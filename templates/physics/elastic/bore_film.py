r"""The film of a journal bearing whose bore deforms in modes, by the equilibrium of `soft_balance`.

.. math:: H = 1 - \varepsilon\cos\phi + l\,P + \sum_{i,j} m_i\,C_{ij}\,a_j + \sum_{n>9} g_n\,(\ldots),\quad
    a_j = \overline{m_j P}

m are the modes of `bore_modes`, a_j the mean of pressure times mode over the bore, g_n the compliances of a
half-space under plane strain.

A ring has the same compliance in all directions, but a housing does not: its modes are measured from the
block, and the film from the displacement of the journal. The angle between the two, the turn, is the angle
from block to load plus the attitude angle, which the film determines. The equilibrium is therefore solved at
a trial turn, and a secant method finds the turn that agrees with the attitude.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from templates.core.arrays import Array, Mask
from templates.physics.elastic.bore_modes import BENDING, MODES, modes_along, modes_around
from templates.physics.elastic.soft_balance import (
    MESHES,
    FilmEquilibrium,
    NoBalance,
    carried,
    rigid_balance,
    settled,
    soft_balance,
)
from templates.physics.elastic.soft_equations import SoftFilm, Softness
from templates.physics.films.film_equations import dual_widths

_TURNS = 25
"""Most equilibria in the search for the turn."""
_TURNED = 1e-9
"""Accuracy of the turn [rad]."""
_LARGEST_TURN = 0.3
"""Largest step of the turn [rad]."""
_SHORTER = 3
"""Largest number of times that a step may be divided by three."""
_GRADED = 1.25
"""Change of the least gap beyond which the mesh is graded again."""


@dataclass(frozen=True)
class BoreSoftness(Softness):
    """Compliance of gap and oil, with a matrix for the bore; `ring` contains the harmonics above it."""

    matrix: Array = field(default_factory=lambda: np.zeros((len(MODES), len(MODES))))
    """(38, 38) deformation in each mode per mode of P [-]."""
    share: float = 1.0
    """Width of the film relative to that of the bore [-]."""
    turn: float = 0.0
    """Angle from the block to the journal's displacement in the sense of rotation [rad]."""

    def times(self, share: float) -> BoreSoftness:
        """Return the compliances multiplied by a factor."""
        less = super().times(share)
        return BoreSoftness(
            less.liner, less.ring, less.size, less.scale, less.power, share * self.matrix, self.share,
            self.turn,
        )  # fmt: skip


@dataclass(frozen=True)
class BoreFilm(SoftFilm):
    """A pressure on a mesh, with the gap that it produces in a bore that deforms in modes."""

    softness: BoreSoftness

    @cached_property
    def shapes(self) -> Array:
        """Return the (n + 1, m + 1, 38) modes at the nodes."""
        around = modes_around(self.mesh.phi + self.softness.turn)
        along = modes_along(self.softness.share * self.mesh.zeta)
        return np.concatenate([around[:, None] * along[None, :, k, None] for k in range(2)], axis=-1)

    @cached_property
    def bent(self) -> Array:
        """Return the (36, nodes) deformation per nodal pressure in each mode that bends the bore."""
        weight = np.outer(self.mesh.weight_phi, self.mesh.weight_zeta) * self.softness.share / (4 * np.pi)
        taken = (self.shapes * weight[..., None]).reshape(self.P.size, len(MODES))
        return np.asarray(self.softness.matrix[BENDING] @ taken.T)

    @cached_property
    def deformation(self) -> Array:
        """Return the change of the gap due to pressure (n + 1, m + 1) [-]."""
        plain = SoftFilm(self.mesh, self.ratio, self.softness, self.modes, self.eps, self.P).deformation
        return np.asarray(plain + self.shapes[..., BENDING] @ (self.bent @ self.P.ravel()))

    @cached_property
    def amplitudes_of(self) -> Array:
        """Return the (M, nodes) deformations per nodal pressure.

        The non-zero ones of the half-plane come first, then those of the modes.
        """
        plain = SoftFilm(self.mesh, self.ratio, self.softness, self.modes, self.eps, self.P).amplitudes_of
        return np.concatenate([plain[self.modes.compliance != 0], self.bent])

    def jacobian(self, film: Mask) -> tuple[csc_array, Array, Array]:
        """Return the derivatives of the loss inside the film with respect to P, the amplitudes and eps."""
        matrix, plain, by_eps = super().jacobian(film)
        shapes = self.shapes[..., BENDING]
        around, across = (shapes[:-1] + shapes[1:]) / 2, (shapes[:, :-1] + shapes[:, 1:]) / 2
        onward, outward = self._by_gap
        modal = np.zeros((*film.shape, shapes.shape[-1]))
        for flow, here, there in (
            (onward[..., None] * around, np.s_[:-1], np.s_[1:]),
            (outward[..., None] * across, np.s_[:, :-1], np.s_[:, 1:]),
        ):
            modal[here] += flow
            modal[there] -= flow
        own = (film[..., None] * modal).reshape(film.size, -1)
        return matrix, np.concatenate([plain[:, self.modes.compliance != 0], own], axis=1), by_eps

    @cached_property
    def _by_gap(self) -> tuple[Array, Array]:
        """Return how circumferential (n, m + 1) and axial (n + 1, m) flows change with the gap."""
        H, eta, _, rise = self.around
        H_side, eta_side, _, rise_side = self.across
        width, cells = dual_widths(self.mesh.zeta), dual_widths(self.mesh.phi)[:, None] / self.ratio**2
        return (6 - 3 * H**2 / eta * rise) * width, -3 * H_side**2 / eta_side * rise_side * cells


def bore_balances(So: float, ratio: float, eps: float, softness: BoreSoftness, to_load: float) -> list[
    tuple[FilmEquilibrium, FilmEquilibrium]
]:  # fmt: skip
    """Return the films under a load in a rigid and in a compliant bore on each mesh of `MESHES`.

    Parameters
    ----------
    So, ratio
        Sommerfeld number and B/D [-].
    eps
        Relative eccentricity near that of the rigid film [-].
    softness
        The compliances; the turn in it is ignored.
    to_load
        Angle from the block to the load in the sense of rotation [rad].

    Raises
    ------
    NoBalance
        If no film was found.
    """
    pairs: list[tuple[FilmEquilibrium, FilmEquilibrium]] = []
    soft: FilmEquilibrium | None = None
    for mesh in MESHES:
        rigid = rigid_balance(So, ratio, eps, *mesh)
        if soft is None:
            turned = replace(softness, turn=to_load + attitude(rigid.film))
            at = replace(rigid, film=_in_bore(rigid.film, softness.times(0.0)))
            soft = soft_balance(So, turned, at)
        else:
            soft = carried(soft, So, *mesh)
        soft = confirmed(soft, So, to_load)
        pairs.append((rigid, soft))
    return pairs


def _in_bore(film: SoftFilm, softness: BoreSoftness) -> BoreFilm:
    return BoreFilm(film.mesh, film.ratio, softness, film.modes, film.eps, film.P)


def attitude(film: SoftFilm) -> float:
    """Return the angle from the load to the journal's displacement in the sense of rotation [rad]."""
    along, ahead = film.force
    return float(np.arctan2(-ahead, along))


def confirmed(found: FilmEquilibrium, So: float, to_load: float) -> FilmEquilibrium:
    """Return the film whose attitude agrees with the turn of its bore; the search starts from a nearby film.

    Raises
    ------
    NoBalance
        If the turn does not converge.
    """
    before: tuple[float, float] | None = None
    for _ in range(_TURNS):
        turn = _softness(found).turn
        off = _wrapped(to_load + attitude(found.film) - turn)
        if abs(off) < _TURNED:
            return found
        step = off
        if before is not None and before[1] != off:
            step = off * (turn - before[0]) / (before[1] - off)
        before = (turn, off)
        found = _nearer(found, So, turn, float(np.clip(step, -_LARGEST_TURN, _LARGEST_TURN)))
    raise NoBalance("the direction of the journal does not converge")


def _nearer(found: FilmEquilibrium, So: float, turn: float, step: float) -> FilmEquilibrium:
    """Return the equilibrium after a change of the turn, which is shortened until the search converges."""
    for _ in range(_SHORTER):
        try:
            return _turned(found, So, turn + step)
        except (NoBalance, RuntimeError, np.linalg.LinAlgError):
            step /= 3
    return _turned(found, So, turn + step)


def _turned(found: FilmEquilibrium, So: float, turn: float) -> FilmEquilibrium:
    """Return the equilibrium at another turn, on a mesh graded to its gap."""
    film = replace(found.film, softness=replace(_softness(found), turn=turn))
    film = replace(film, eps=film.eps + float(found.film.H.min() - film.H.min()))
    after = settled(film, found.inside, So, found.graded, found.steps)
    if 1 / _GRADED < float(after.film.H.min()) / after.graded < _GRADED:
        return after
    return carried(after, So, *(size - 1 for size in after.film.P.shape))


def _softness(found: FilmEquilibrium) -> BoreSoftness:
    softness = found.film.softness
    assert isinstance(softness, BoreSoftness)
    return softness


def _wrapped(angle: float) -> float:
    """Return the angle wrapped to at most half a revolution."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
