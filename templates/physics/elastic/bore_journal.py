"""One journal bearing under static load in a bore of known compliance; it complements `elastic_journal`.

    elastic    the liner as columns, and behind it the bore as a matrix of modes with a half-plane above them

As for the other elastic levels, the change from rigid to compliant is solved on 64 × 8 and 128 × 16
intervals, extrapolated, and applied to the film of the map. A rigid bore reproduces the map's film exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.elastic.bore_film import BoreSoftness, bore_balances
from templates.physics.elastic.bore_modes import (
    BENDING,
    HIGHEST,
    Rows,
    half_plane,
    matrix_of,
    modes_along,
    modes_around,
)
from templates.physics.elastic.elastic_journal import (
    HOUSING,
    LEVELS,
    LINER,
    RIGID,
    ROELANDS_PRESSURE,
    ROELANDS_SIZE,
    Elasticity,
    ElasticJournalFilm,
    elastic_film_at,
    mean_pressure,
    measured,
    neglected_deformation,
)
from templates.physics.elastic.soft_balance import NoBalance
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

ELASTIC = "elastic"
ALL_LEVELS = (*LEVELS, ELASTIC)
_RATIOS = ("least", "P_max", "shear", "load_couple", "side_flow")
_DIFFERENCES = ("eps", "attitude", "peak")
_OWN = ("deformation", "thickening")
_PLACES = 72
"""Number of circumferential places at which the deformation is estimated."""


@dataclass(frozen=True)
class Bore:
    """A bore as a matrix of modes, in SI; arrays that broadcast with those of the film."""

    rows: Rows
    """The matrix, one for all points; empty for a rigid bore [m/Pa]."""
    share: Array
    """Width of the film over that of the bore [-]."""
    to_load: Array
    """Angle from the block or shank to the load in the sense of rotation [rad]."""


@on_paper(
    {
        RIGID: "solved numerically by splines in a map of solutions of the Reynolds equation",
        LINER: "solved numerically by finite volumes of film and liner together, extrapolated",
        HOUSING: "solved numerically by finite volumes of film, liner and ring together, extrapolated",
        ELASTIC: "solved numerically by finite volumes of film, liner and modes together, extrapolated",
    }
)
def bore_film_at(
    level: str, So: Array, ratio: Array, elasticity: Elasticity, bore: Bore
) -> ElasticJournalFilm:
    """Return the film that carries So at one of `ALL_LEVELS`.

    Parameters
    ----------
    level
        Which parts are elastic.
    So
        Sommerfeld number, 0 or more [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].
    elasticity
        Liner, housing and oil; at level elastic the radii are used only for the half-plane.
    bore
        Further data for level elastic.
    """
    if level != ELASTIC:
        return elastic_film_at(level, So, ratio, elasticity)
    stiff = elastic_film_at(RIGID, So, ratio, elasticity)
    So, ratio, share, to_load, *rest = np.broadcast_arrays(
        *(np.asarray(v, float) for v in (So, ratio, bore.share, bore.to_load, *elasticity.numbers()))
    )
    names = (*_RATIOS, *_DIFFERENCES, *_OWN, "mesh_error")
    values = {name: np.array(np.broadcast_to(getattr(stiff, name), So.shape), float) for name in names}
    values["deformation"], values["mesh_error"] = (np.where(So == 0, 0.0, np.nan) for _ in range(2))
    matrix = matrix_of(bore.rows)
    for at in np.ndindex(So.shape):
        if So[at] > 0 and np.isfinite(values["eps"][at]):
            one = Elasticity(*(part[at] for part in rest))
            softness = _softness(one, matrix, float(share[at]))
            before = {name: float(value[at]) for name, value in values.items()}
            after = _changed(float(So[at]), float(ratio[at]), softness, float(to_load[at]), before)
            for name, value in after.items():
                values[name][at] = value
    return ElasticJournalFilm(**{name: value[()] for name, value in values.items()})


def _softness(one: Elasticity, matrix: Array, share: float) -> BoreSoftness:
    """Return the dimensionless compliances; if no matrix is given, the half-plane is rigid too."""
    per_gap = float(one.pressure / one.clearance)
    tail = per_gap * half_plane(one.inner, one.modulus, one.poisson) * bool(matrix.any())
    return BoreSoftness(
        per_gap * float(one.liner), tail, float(np.log(one.eta)) + ROELANDS_SIZE,
        ROELANDS_PRESSURE * float(one.pressure), float(one.exponent), per_gap * matrix, share,
    )  # fmt: skip


def _changed(
    So: float, ratio: float, softness: BoreSoftness, to_load: float, stiff: dict[str, float]
) -> dict[str, float]:
    """Return the values of the rigid film, corrected by the changes found on the meshes.

    Without a film, eps is infinite.
    """
    unborne = dict.fromkeys(stiff, np.nan) | {"eps": np.inf}
    if not (np.isfinite(softness.liner + softness.share + to_load) and np.isfinite(softness.ring).all()):
        return unborne
    if not np.isfinite(softness.matrix).all():
        return unborne
    try:
        pairs = bore_balances(So, ratio, min(stiff["eps"], ECCENTRICITY_LIMIT), softness, to_load)
    except (NoBalance, RuntimeError, np.linalg.LinAlgError):
        return unborne
    coarse, fine = (
        _change(measured(rigid.film), measured(soft.film)) for rigid, soft in pairs
    )  # fmt: skip
    change = {name: fine[name] + (fine[name] - coarse[name]) / 3 for name in fine}
    found = {name: stiff[name] * float(np.exp(change[name])) for name in _RATIOS}
    found |= {name: stiff[name] + change[name] for name in _DIFFERENCES}
    found |= {name: change[name] for name in _OWN}
    return found | {"mesh_error": abs(float(np.expm1(fine["least"] - coarse["least"])))}


def _change(before: dict[str, float], after: dict[str, float]) -> dict[str, float]:
    """Return the changes (logarithms of ratios, differences of angles), and values of the elastic film."""
    change = {name: float(np.log(after[name] / before[name])) for name in _RATIOS}
    change |= {name: after[name] - before[name] for name in _DIFFERENCES}
    return change | {name: after[name] for name in _OWN}


@on_paper("estimated for a pressure that falls as a parabola to the ends and as a cosine squared around")
@units(None, "Pa", "N", "m", "m", "m/Pa", "m", "m", "Pa", "1", None, "m", "rad", returns="m")
def neglected_in_bore(
    level: str, p_max: Array, load: Array, radius: Array, width: Array, liner: Array, inner: Array,
    outer: Array, modulus: Array, poisson: Array, rows: Rows, bore_width: Array, peak: Array,
) -> Array:  # fmt: skip
    """Estimate the displacement under the largest pressure of the parts that a level treats as rigid [m].

    With a matrix, the bore is the one that the matrix describes, not a ring. The shape of the pressure is
    that of `neglected_deformation`, centred on the largest pressure.

    Parameters
    ----------
    level
        One of `ALL_LEVELS`: rigid neglects liner and bore, liner the bore, the others nothing.
    p_max
        Largest pressure [Pa].
    load
        Radial load [N].
    radius, width
        Radius and width of the bearing [m].
    liner
        Deformation of the liner per unit of pressure; 0 without a liner [m/Pa].
    inner, outer
        Radii of the housing; NaN without a housing [m].
    modulus, poisson
        Young's modulus [Pa] and Poisson's ratio [-] of the housing.
    rows
        The matrix [m/Pa]; empty for a ring.
    bore_width
        Axial length of the bore [m].
    peak
        Angle from the block to the largest pressure in the sense of rotation [rad].
    """
    known = HOUSING if level == ELASTIC else level
    if not len(rows) or known == HOUSING:
        return neglected_deformation(known, p_max, load, radius, width, liner, inner, outer, modulus, poisson)
    p_max, load, radius, width, bore_width, peak = np.broadcast_arrays(
        *(np.asarray(v, float) for v in (p_max, load, radius, width, bore_width, peak))
    )
    around = mean_pressure(p_max, load, radius, width)
    share = width / bore_width
    along = np.stack([share, share * np.sqrt(5) * (0.3 * share**2 - 0.5)], axis=-1)  # of 3/2 (1 − zeta²)
    turned = np.where(np.isfinite(peak), peak, 0.0)[..., None] * np.arange(1, HIGHEST + 1)
    waves = np.sqrt(0.5) * np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    waves = (around[..., 1 : HIGHEST + 1, None] * waves).reshape(*peak.shape, 2 * HIGHEST)
    flat = np.concatenate([around[..., :1], waves], axis=-1)
    amplitudes = np.concatenate([flat * along[..., k, None] for k in range(2)], axis=-1)
    bent = amplitudes @ matrix_of(rows)[:, BENDING]
    places = modes_around(np.linspace(0, 2 * np.pi, _PLACES, endpoint=False))
    ends = modes_along(np.stack([0 * share, share], axis=-1))
    deepest = np.full(peak.shape, -np.inf)
    for end in range(2):
        shape = np.concatenate([places * ends[..., end, k, None, None] for k in range(2)], axis=-1)
        sunk = (shape[..., BENDING] @ bent[..., None])[..., 0]
        deepest = np.maximum(deepest, sunk.max(axis=-1))
    above = (around * half_plane(inner, modulus, poisson)).sum(axis=-1)
    of_liner = liner * p_max if level == RIGID else 0 * p_max
    return np.asarray(of_liner + deepest + above + 0 * p_max)[()]
