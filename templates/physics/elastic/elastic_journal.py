"""A journal bearing under static load with elastic liner and housing, at every level.

    rigid    the converged Swift–Stieber film of `film_map`
    liner    that film with the liner as columns
    housing  that film with the liner, and the housing as a ring under the axial mean of the pressure

The effect of elasticity is the difference of two finite-volume solutions on the same mesh, compliant and
rigid, and is applied to the film of the map. A rigid bearing therefore has the map's film exactly, and the
mesh error affects only the difference. Results of 64 × 8 and 128 × 16 intervals are extrapolated. Everything
is dimensionless as in `static_journal`.
"""

from dataclasses import dataclass, fields

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.elastic.compliance import HARMONICS, ring_compliance
from templates.physics.elastic.soft_balance import (
    MESHES,
    FilmEquilibrium,
    NoBalance,
    carried,
    rigid_balance,
    soft_balance,
)
from templates.physics.elastic.soft_equations import SoftFilm, Softness
from templates.physics.journals.static_journal import static_film_at
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

_FAR = 1e3
"""Outer over inner radius at which a ring deforms as an infinite body [-]."""
RIGID, LINER, HOUSING = "rigid", "liner", "housing"
LEVELS = (RIGID, LINER, HOUSING)
ROELANDS_PRESSURE = 5.1e-9
"""Constant that multiplies a pressure in Pa in Roelands' law [1/Pa]."""
ROELANDS_SIZE = 9.67
"""Minus the logarithm of the pole viscosity in Pa s in Roelands' law [-]."""


@dataclass(frozen=True)
class Elasticity:
    """The elastic data of liner, housing and oil, in SI; arrays that broadcast together."""

    liner: Array
    """Deformation of the liner per unit of pressure; 0 without a liner [m/Pa]."""
    inner: Array
    outer: Array
    """Radii of the housing; NaN without a housing [m]."""
    modulus: Array
    """Young's modulus of the housing [Pa]."""
    poisson: Array
    """Poisson's ratio of the housing [-]."""
    exponent: Array
    """Roelands' exponent; 0 for constant viscosity [-]."""
    eta: Array
    """Viscosity at ambient pressure [Pa s]."""
    pressure: Array
    """The unit of P, eta omega_h/psi² [Pa]."""
    clearance: Array
    """Radial clearance [m]."""

    def numbers(self) -> list[Array]:
        """Return all values as a tuple."""
        return [getattr(self, field.name) for field in fields(self)]


@dataclass(frozen=True)
class ElasticJournalFilm:
    """The results of the film; dimensionless, NaN where no film carries the load."""

    eps: Array
    """Displacement of the journal relative to the displaced bore; infinite if no film carries the load."""
    attitude: Array
    """Angle from the load to that displacement in the sense of rotation [rad]."""
    least: Array
    """Smallest gap over the radial clearance."""
    P_max: Array
    peak: Array
    """Angle of the largest pressure from the load [rad]."""
    shear: Array
    load_couple: Array
    side_flow: Array
    deformation: Array
    """Largest deformation over the radial clearance; NaN at level rigid."""
    thickening: Array
    """Viscosity at the largest pressure over that at ambient pressure."""
    mesh_error: Array
    """Change of the smallest gap between the two meshes, relative; NaN at level rigid."""

    def admitted(self, eps: Array) -> "ElasticJournalFilm":
        """Return the same film with NaN where eps is outside its bounds."""
        values = (np.where(np.isnan(eps), np.nan, getattr(self, field.name))[()] for field in fields(self))
        return ElasticJournalFilm(*values)


@on_paper(
    {
        RIGID: "solved numerically by splines in a map of solutions of the Reynolds equation",
        LINER: "solved numerically by finite volumes of film and liner together, extrapolated",
        HOUSING: "solved numerically by finite volumes of film, liner and ring together, extrapolated",
    }
)
def elastic_film_at(level: str, So: Array, ratio: Array, elasticity: Elasticity) -> ElasticJournalFilm:
    """Return the film that carries So at one of `LEVELS`.

    Parameters
    ----------
    level
        Which parts are elastic.
    So
        Sommerfeld number, 0 or more [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].
    elasticity
        Liner, housing and oil.
    """
    So, ratio, *rest = np.broadcast_arrays(
        *(np.asarray(v, float) for v in (So, ratio, *elasticity.numbers()))
    )
    rigid = static_film_at("map", So, ratio)
    with np.errstate(invalid="ignore"):
        couple = So * np.where(np.isinf(rigid.eps), np.nan, rigid.eps) * np.sin(rigid.attitude) / 2
    values = {
        "eps": rigid.eps, "attitude": rigid.attitude, "least": 1 - rigid.eps, "P_max": rigid.P_max,
        "peak": rigid.attitude + rigid.peak, "shear": rigid.shear, "load_couple": couple,
        "side_flow": rigid.side_flow, "deformation": np.full(So.shape, np.nan),
        "thickening": 0 * rigid.attitude + 1, "mesh_error": np.full(So.shape, np.nan),
    }  # fmt: skip
    if level == RIGID:
        return ElasticJournalFilm(**{name: np.asarray(value)[()] for name, value in values.items()})
    values = {name: np.array(value, float) for name, value in values.items()}
    values["deformation"], values["mesh_error"] = (np.where(So == 0, 0.0, np.nan) for _ in range(2))
    for at in np.ndindex(So.shape):
        if So[at] > 0 and np.isfinite(values["eps"][at]):
            one = Elasticity(*(part[at] for part in rest))
            stiff = {name: float(value[at]) for name, value in values.items()}
            for name, value in _changed(
                float(So[at]), float(ratio[at]), _softness(level, one), stiff
            ).items():
                values[name][at] = value
    return ElasticJournalFilm(**{name: value[()] for name, value in values.items()})


def _softness(level: str, one: Elasticity) -> Softness:
    """Return the dimensionless compliances of a level."""
    per_gap = float(one.pressure / one.clearance)
    ring = np.zeros(HARMONICS + 1)
    if level == HOUSING:
        ring = per_gap * ring_compliance(one.inner, one.outer, one.modulus, one.poisson)
    return Softness(
        per_gap * float(one.liner), ring, float(np.log(one.eta)) + ROELANDS_SIZE,
        ROELANDS_PRESSURE * float(one.pressure), float(one.exponent),
    )  # fmt: skip


def _changed(So: float, ratio: float, softness: Softness, stiff: dict[str, float]) -> dict[str, float]:
    """Return the values of the rigid film, corrected by the changes found on the meshes.

    Without a film, eps is infinite.
    """
    unborne = dict.fromkeys(stiff, np.nan) | {"eps": np.inf}
    if not (np.isfinite(softness.liner) and np.isfinite(softness.ring).all()):
        return unborne
    try:
        changes = _changes(So, ratio, softness, min(stiff["eps"], ECCENTRICITY_LIMIT))
    except (NoBalance, RuntimeError, np.linalg.LinAlgError):
        return unborne
    coarse, fine = changes
    change = {name: fine[name] + (fine[name] - coarse[name]) / 3 for name in fine}
    found = {name: stiff[name] * np.exp(change[name]) for name in _RATIOS}
    found |= {name: stiff[name] + change[name] for name in ("eps", "attitude", "peak")}
    found |= {name: change[name] for name in ("deformation", "thickening")}
    return found | {"mesh_error": abs(float(np.expm1(fine["least"] - coarse["least"])))}


_RATIOS = ("least", "P_max", "shear", "load_couple", "side_flow")


def _changes(So: float, ratio: float, softness: Softness, eps: float) -> list[dict[str, float]]:
    """Return for each mesh the changes as logarithms and angles, the deformation and the viscosity ratio."""
    soft: FilmEquilibrium | None = None
    changes = []
    for mesh in MESHES:
        rigid = rigid_balance(So, ratio, eps, *mesh)
        soft = soft_balance(So, softness, rigid) if soft is None else carried(soft, So, *mesh)
        before, after = measured(rigid.film), measured(soft.film)
        change = {name: float(np.log(after[name] / before[name])) for name in _RATIOS}
        change |= {name: after[name] - before[name] for name in ("eps", "attitude", "peak")}
        changes.append(change | {name: after[name] for name in ("deformation", "thickening")})
    return changes


def measured(film: SoftFilm) -> dict[str, float]:
    """Return the values of `ElasticJournalFilm` on one mesh, without errors."""
    along, ahead = film.force
    attitude = float(np.arctan2(-ahead, along))
    peak, P_max = _peak(film)
    H, _, _, rise = film.around
    weight = np.outer(film.mesh.weight_phi, film.mesh.weight_zeta)
    eta_at, _ = film.softness.thickening(film.P)
    cells = np.diff(film.mesh.phi)[:, None] * film.mesh.weight_zeta
    outflow = -film.loss[1:-1, -1][film.P[1:-1, -2] > 0].sum()
    return {
        "eps": film.eps,
        "attitude": attitude,
        "least": float(film.H.min()),
        "P_max": P_max,
        "peak": attitude + peak,
        "shear": float((eta_at / film.H * weight).sum() / 4),
        "load_couple": float((H * rise * cells).sum() / 8),
        "side_flow": float(outflow * film.ratio / 6),
        "deformation": float(film.deformation.max()),
        "thickening": float(film.softness.thickening(np.array(P_max))[0]),
    }


def _peak(film: SoftFilm) -> tuple[float, float]:
    """Return the angle (from the narrowest gap of the rigid bore) and the value of the largest pressure.

    Both are taken from a parabola through three nodes.
    """
    i, j = np.unravel_index(film.P.argmax(), film.P.shape)
    phi, P = film.mesh.phi[i - 1 : i + 2] - film.mesh.phi[i], film.P[i - 1 : i + 2, j]
    bend, slope, top = np.polyfit(phi / phi[2], P, 2)
    if bend >= 0:
        return float(film.mesh.phi[i]), float(P[1])
    return float(film.mesh.phi[i] - phi[2] * slope / (2 * bend)), float(top - slope**2 / (4 * bend))


@units("1/Pa", "Pa*s", returns="1")
def roelands_exponent(alpha: Array, eta: Array) -> Array:
    """Return Roelands' Z from a pressure–viscosity coefficient at ambient pressure [-].

    The result is NaN if the viscosity is too low.

    Parameters
    ----------
    alpha
        d(ln eta)/dp at ambient pressure [1/Pa].
    eta
        Viscosity at ambient pressure, above 6.3e-5 Pa s [Pa s].
    """
    size = np.log(eta) + ROELANDS_SIZE
    known = alpha / (ROELANDS_PRESSURE * np.where(size > 0, size, np.nan))
    return np.where(alpha == 0, 0.0, known)[()]


@units("m", "m", returns="1", latex=r"\frac{{{0}}}{{{1}}}")
def wall_ratio(outer: Array, inner: Array) -> Array:
    """Return outer over inner diameter of a housing; 1 (no housing) if no outer diameter is given [-]."""
    return np.where(np.isnan(outer), 1.0, outer / inner)[()]


def mean_pressure(p_max: Array, load: Array, radius: Array, width: Array) -> Array:
    """Return the harmonics (..., 41) of the axial mean pressure about its peak [Pa].

    The axial mean is 2/3 of the largest pressure.
    """
    mean = np.asarray(2 / 3 * p_max)
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.clip(load / (radius * width * np.where(mean > 0, mean, np.nan)), 1e-6, np.pi)
    n = np.arange(HARMONICS + 1)
    angle = np.asarray(half)[..., None] * n
    bump = np.sinc(angle / np.pi) + np.sinc(angle / np.pi + 1) / 2 + np.sinc(angle / np.pi - 1) / 2
    share = np.where(n == 0, 0.5, 1.0) * np.asarray(mean * half / np.pi)[..., None] * bump
    return np.nan_to_num(share, nan=0.0)


@on_paper("estimated for a pressure that falls as a parabola to the ends and as a cosine squared around")
@units(None, "Pa", "N", "m", "m", "m/Pa", "m", "m", "Pa", "1", returns="m")
def neglected_deformation(
    level: str, p_max: Array, load: Array, radius: Array, width: Array, liner: Array, inner: Array,
    outer: Array, modulus: Array, poisson: Array,
) -> Array:  # fmt: skip
    """Estimate the displacement under the largest pressure of the parts that a level treats as rigid [m].

    The axial mean of the pressure is 2/3 of the largest. Circumferentially it is a squared cosine, as wide as
    the load requires.

    Parameters
    ----------
    level
        One of `LEVELS`: rigid neglects liner and housing, liner the housing, housing nothing.
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
    """
    of_liner = liner * p_max if level == RIGID else 0 * p_max
    if level == HOUSING:
        return np.asarray(of_liner)[()]
    around = mean_pressure(p_max, load, radius, width)
    of_ring = (around * ring_compliance(inner, outer, modulus, poisson)).sum(axis=-1)
    return np.asarray(of_liner + np.nan_to_num(of_ring, nan=0.0) + 0 * p_max)[()]


@units("Pa", "N", "m", "m", returns="m", latex=r"\text{{estimate, steel without end}}")
def deflection_in_steel(p_max: Array, load: Array, radius: Array, width: Array) -> Array:
    """Estimate the displacement of a bore in an infinite steel body under the largest pressure [m].

    The shape of the pressure is that of `neglected_deformation`. The estimate is a lower limit of that
    deformation.

    Parameters
    ----------
    p_max
        Largest pressure [Pa].
    load
        Radial load [N].
    radius, width
        Radius and width of the bearing [m].
    """
    steel = np.asarray(210e9), np.asarray(0.3)
    no_liner, far = np.asarray(0.0), _FAR * radius
    return neglected_deformation(RIGID, p_max, load, radius, width, no_liner, radius, far, *steel)
