"""Oil film of a journal bearing under static load; pressure deforms liner and bore and thickens the oil.

The plain, aligned bearing is rigid, or its liner deforms as columns, its housing as a thick ring, or its bore
by the compliance of a designed housing or rod.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
    Truth,
    derived,
    formula,
    given,
    require,
    shared,
    table,
    text,
)
from templates.groups.film_assumptions import ISOTHERMAL, PARALLEL, SMOOTH
from templates.groups.journal import ISO, Journal
from templates.groups.journal_criteria import CRITERIA
from templates.groups.oil import Oil
from templates.physics.elastic.bore_journal import (
    ALL_LEVELS,
    ELASTIC,
    Bore,
    bore_film_at,
    neglected_in_bore,
)
from templates.physics.elastic.bore_modes import (
    MODES,
    Rows,
    count_modes,
    gains_no_energy,
    is_mutual,
    is_square,
)
from templates.physics.elastic.compliance import liner_compliance
from templates.physics.elastic.elastic_journal import (
    HOUSING,
    LINER,
    RIGID,
    Elasticity,
    ElasticJournalFilm,
    roelands_exponent,
    wall_ratio,
)
from templates.physics.journals.lubrication_regime import friction_coefficient

LAME = "Lamé 1852; Michell 1899"
ROELANDS = "Roelands 1966"
RIGID_HAS_NONE = "level `rigid` has none; choose level `liner`, `housing` or `elastic`"
UNBORNE = (
    "no film was found that bears this: lower the load, or stiffen what gives way. Where a soft liner is "
    "pressed far into its backing, the ends of the bearing, which no pressure bends, almost touch the journal"
)


class ElasticFilm(Oil, Journal):
    """Oil film of a journal bearing under static load; pressure deforms liner and bore and thickens the oil.

    The plain, aligned bearing is rigid, or its liner deforms as columns, its housing as a thick ring, or its
    bore by the compliance of a designed housing or rod.

    Limits
    ------
    Static load, laminar and isothermal film, fed along its widest gap; no grooves, no supply pressure.
    Level rigid, the default, is level map of oil_film 2. The effect of elasticity is the difference between a
    compliant and a rigid solution on meshes of 64 x 8 and 128 x 16 intervals; it is extrapolated and applied
    to that film. mesh_error is the change of the smallest film between the two meshes, an estimate. No level
    states an error: rigid neglects the deformation, and the elastic levels were not compared with a finer
    solution.
    Level liner: a bonded layer on a rigid backing, each column independent. It applies to a layer that is
    thin relative to the length of the pressure zone; near Poisson's ratio 1/2 a layer is more compliant than
    its columns.
    Level housing: the liner, and behind it a ring in plane strain with a free outer surface. It is loaded by
    the axial mean of the pressure. Ribs, caps, bolts and the support of the ring are neglected. 40 harmonics
    are included.
    Level elastic: the liner, and behind it a bore with a given compliance: the matrix of the analysis
    bore_compliance of a bearing_housing or connecting_rod, with 38 rows and columns. Modes are
    circumferential harmonics 0 to 9, axially uniform or as Legendre's second polynomial, scaled to a mean
    square of 1. Harmonics 10 to 40 are those of a half-plane of housing_modulus and housing_poisson_ratio.
    The angle in the matrix is measured from the block or shank in the sense of rotation, and load_angle is
    the angle from there to the load, which is the force of the journal on the bearing. For the other sense of
    rotation, change the sign of each entry between a cosine and a sine; a symmetric bore has no such entries.
    The bearing lies in the middle of bore_width and is not wider. Linear and static; axially symmetric, so no
    misalignment; the joint neither opens nor slides; no inertia of a moving rod.
    At both levels the rigid-body motion of the bore is excluded: eccentricity is that of the journal relative
    to the displaced bore, and may exceed 1. The journal is rigid; thermal expansion and the interference fit
    of the shell are neglected.
    The viscosity increases with pressure after Roelands, with the given coefficient, at the elastic levels
    only: with rigid walls and this increase there may be no film at all. The density is constant.
    A film is refused if the deformation exceeds a hundred times the smallest film.
    Criterion elasticity compares the deformation that the level neglects, estimated from the largest
    pressure, the load and the compliance, with the smallest film; a matrix takes precedence over a ring. With
    a matrix it uses the position and shape of the rigid film's pressure, and may be a quarter below the
    solution.
    A point takes about 0.06 s of processor time at level liner, 0.1 to 0.4 s at level housing, 0.2 to 1 s at
    level elastic, and some seconds if it is refused; at level rigid some milliseconds.

    References
    ----------
    Michell: Proceedings of the London Mathematical Society 31, 1899; Lamé: Leçons sur la théorie mathématique
    de l'élasticité, 1852; Barber: Elasticity, 3rd ed. 2010, for the ring.
    Johnson: Contact Mechanics, 1985, section 4.3, for the layer as columns.
    Roelands: Correlational aspects of the viscosity-temperature-pressure relationship, Delft 1966.
    Johnson, section 13.2, for the half-plane.
    Oh, Goenka: Journal of Tribology 107, 1985, p. 389, for elastic engine bearings.
    DIN 31652:1983, ISO 7902:1998, for the rigid film.
    """

    assumptions = (PARALLEL, SMOOTH, ISOTHERMAL)
    levels = ALL_LEVELS
    default_level = RIGID
    most_points = {"rigid": 5_000, "liner": 100, "housing": 50, "elastic": 20}
    precision = 1e-6
    example = {
        "radial_load": "10 kN",
        "diametral_clearance": "0.055 mm",
        "bearing_diameter": "48 mm",
        "bearing_width": "18 mm",
        "speed": "5000 rpm",
        "oil_temperature": "83.881 degC",
        "liner_thickness": "0.3 mm",
        "housing_outer_diameter": "76 mm",
    }
    main_results = (
        "radial_load", "speed", "maximum_pressure", "minimum_film_thickness", "power_loss",
        "total_oil_flow",
    )  # fmt: skip
    criteria = {
        "elasticity": {
            "require": "neglected_deformation <= 0.1 * minimum_film_thickness",
            "words": "what the level takes for rigid gives way by less than a tenth of the smallest film",
            "source": "an estimate of the deformation at the largest pressure; see the limits",
            "warning": "elasticity_matters",
        },
        "own_film": CRITERIA["own_film"],
        "film_exists": CRITERIA["film_exists"],
        "pressure": CRITERIA["pressure"],
    }

    T_film: Array = given("degC", "oil temperature", symbol="T", alternative=True, ge=-100, le=500)
    t_l: Array = given("mm", "liner thickness", default="0 mm", ge=0)
    E_l: Array = given("GPa", "liner modulus", default="50 GPa", gt=0)
    nu_l: Array = given("1", "liner Poisson ratio", symbol=r"\nu_{l}", default="0.35", ge=0, le=0.49)
    D_h: Array = given("mm", "housing outer diameter", symbol="D_{h}", alternative=True, gt=0)
    E_h: Array = given("GPa", "housing modulus", default="210 GPa", gt=0)
    nu_h: Array = given("1", "housing Poisson ratio", symbol=r"\nu_{h}", default="0.3", ge=0, le=0.49)
    alpha: Array = given("1/MPa", "pressure viscosity", symbol=r"\alpha_{p}", default="0 1/MPa", ge=0, le=0.1)
    C_b: Rows = table("um/GPa", "compliance", *MODES, most=38, symbol="C_{ij}", ge=-1e9, le=1e9)
    theta_F: Array = given("deg", "load angle", symbol=r"\theta_{F}", default="0 deg", ge=-360, le=360)

    @derived("mm", "bore width", symbol="W_{b}", gt=0)
    def W_b(self) -> Array:
        """Axial length of the bore whose compliance is given; default: the width of the bearing."""
        return self.W

    @require("compliance", remedy="give 38 rows in the order of its columns, one for each mode")
    def compliance_is_square(self) -> Truth:
        """The compliance has as many rows as columns, 38."""
        return is_square(self.C_b)

    @require("compliance", remedy="give equal values in row i, column j and in row j, column i")
    def compliance_is_mutual(self) -> Truth:
        """The compliance matrix is symmetric (Betti's theorem)."""
        return is_mutual(self.C_b)

    @require("compliance", remedy="give a matrix without negative eigenvalues, as an elastic bore has")
    def compliance_takes_energy(self) -> Truth:
        """No pressure does negative work on the bore."""
        return gains_no_energy(self.C_b)

    @require("bearing_width", "bore_width", remedy="give the width of the bore that was analysed")
    def bearing_within_bore(self) -> Truth:
        """The bearing is not wider than the bore whose compliance is given."""
        return (self.W <= 1.000001 * self.W_b) | np.isnan(self.W_b)

    @require(
        "housing_outer_diameter", "bearing_diameter", "liner_thickness", remedy="give that of its outside"
    )
    def housing_is_outside(self) -> Truth:
        """The outer diameter of the housing exceeds that of bearing and liner by a thousandth or more."""
        return (self.D_h >= 1.001 * (self.D + 2 * self.t_l)) | np.isnan(self.D_h)

    @require(
        "pressure_viscosity", warning="unused_input", remedy="choose a level other than `rigid`, or omit it"
    )
    def thickening_counts(self) -> Truth:
        """The pressure–viscosity coefficient has no effect at level rigid."""
        return (self.level != RIGID) | (self.alpha == 0)

    def ladder(self) -> tuple[str, ...]:
        """Return the levels whose elastic data are given."""
        known = {
            RIGID: True, LINER: bool(np.all(self.t_l > 0)), HOUSING: bool(np.all(np.isfinite(self.D_h))),
            ELASTIC: bool(len(self.C_b)),
        }  # fmt: skip
        return tuple(level for level in self.levels if known[level])

    @formula("1", "Sommerfeld number", symbol="S_{0}", ge=0, source=ISO)
    def S_0(self) -> Array:
        return self.F * self.psi**2 / (self.D * self.W * self.eta * self.omega_h)

    @formula("MPa", "pressure scale", symbol="p_{0}")
    def p_0(self) -> Array:
        """The unit of the film's dimensionless pressure."""
        return self.eta * self.omega_h / self.psi**2

    @formula(
        "1", "liner ratio", symbol="t_{l}/D", remedy="level `liner` needs `liner_thickness`; choose `rigid`",
        per_level={"liner": limits(1e-9)},
    )  # fmt: skip
    def liner_ratio(self) -> Array:
        return self.t_l / self.D

    @formula(
        "1", "wall ratio", symbol="w", remedy="level `housing` needs `housing_outer_diameter`",
        per_level={"housing": limits(1.001)},
    )  # fmt: skip
    def wall(self) -> Array:
        """Outer over inner diameter of the housing; 1 without a housing."""
        return wall_ratio(self.D_h, self.D + 2 * self.t_l)

    @formula(
        "1", "compliance modes", symbol="n_{m}",
        remedy="level `elastic` needs compliance, the matrix of an analysis `bore_compliance`",
        per_level={"elastic": limits(38)},
    )  # fmt: skip
    def n_m(self) -> Array:
        """Number of rows of the bore's compliance matrix; 0 without a matrix."""
        return count_modes(self.C_b)

    @formula("um/GPa", "liner compliance", symbol="C_{l}", source="Johnson 1985")
    def C_l(self) -> Array:
        return liner_compliance(self.t_l, self.E_l, self.nu_l)

    @formula("1", "Roelands exponent", symbol="Z", ge=0, source=ROELANDS,
             remedy="the law holds for more than 0.063 mPa s")  # fmt: skip
    def Z(self) -> Array:
        return roelands_exponent(self.alpha, self.eta)

    @shared
    def elasticity(self) -> Elasticity:
        """Return the compliances of the bearing."""
        return Elasticity(
            liner=self.C_l, inner=self.D / 2 + self.t_l, outer=self.D_h / 2, modulus=self.E_h,
            poisson=self.nu_h, exponent=self.Z, eta=self.eta, pressure=self.p_0, clearance=self.c / 2,
        )  # fmt: skip

    @shared
    def bore(self) -> Bore:
        """Return the additional inputs of level elastic."""
        return Bore(self.C_b, self.W / self.W_b, self.theta_F)

    @shared
    def unbounded_film(self) -> ElasticJournalFilm:
        """Return the film at this level, before its bounds are checked."""
        return bore_film_at(self.level, self.S_0, self.b, self.elasticity, self.bore)

    @formula(
        "1",
        "relative eccentricity",
        ge=0,
        lt=1000,
        assumes=("b", "liner_ratio", "wall", "n_m"),
        remedy=UNBORNE,
    )
    def eps(self) -> Array:
        """Displacement of the journal relative to the displaced bore, over the radial clearance."""
        return self.unbounded_film.eps

    @shared
    def film(self) -> ElasticJournalFilm:
        """Return the film if it carries the load."""
        return self.unbounded_film.admitted(self.eps)

    @text("boundary condition")
    def boundary(self) -> str:
        return self.boundary_of_level

    @shared
    def boundary_of_level(self) -> str:
        """Return the boundary condition of the pressure, which is the same at every level."""
        return "Swift-Stieber: p = 0 at the ends and along the widest gap; rupture where p = dp/dn = 0"

    @formula("deg", "attitude angle", symbol=r"\beta")
    def beta(self) -> Array:
        """Angle from the load to the displacement of the journal."""
        return self.film.attitude

    @formula("um", "minimum film thickness", symbol="h_{0}")
    def h_0(self) -> Array:
        """The smallest gap of the whole bearing."""
        return self.c * self.film.least / 2

    @formula("1", "mesh error", symbol="e_{h}", absent=RIGID_HAS_NONE)
    def mesh_error(self) -> Array:
        """Change of the smallest film between the two meshes."""
        return self.film.mesh_error

    @formula("MPa", "maximum pressure", symbol="p_{max}")
    def p_max(self) -> Array:
        return self.film.P_max * self.p_0

    @formula("deg", "maximum pressure angle", symbol=r"\theta_{p}")
    def theta_p(self) -> Array:
        """Angle from the load, in the sense of the hydrodynamic speed."""
        return self.film.peak

    @formula("um", "largest deformation", symbol="u_{max}", absent=RIGID_HAS_NONE, source=LAME)
    def u_max(self) -> Array:
        """Deformation of the bore without its rigid-body displacement."""
        return self.film.deformation * self.c / 2

    @formula("um", "neglected deformation", symbol="u_{n}", source=LAME)
    def u_n(self) -> Array:
        """Estimated deformation that the level neglects."""
        return neglected_in_bore(
            self.level, self.p_max, self.F, self.D / 2, self.W, self.C_l, self.D / 2 + self.t_l,
            self.D_h / 2, self.E_h, self.nu_h, self.C_b, self.W_b, self.theta_F + self.theta_p,
        )  # fmt: skip

    @formula("1", "largest thickening", symbol=r"\eta_{max}/\eta", source=ROELANDS)
    def thickening(self) -> Array:
        """Viscosity at the largest pressure over that at ambient pressure."""
        return self.film.thickening

    @formula("N*m", "shear torque", symbol="M_{s}", source=ISO)
    def M_s(self) -> Array:
        return self.film.shear * self.eta * self.omega_s * self.W * self.D**2 / (2 * self.psi)

    @formula("N*m", "load couple", symbol="M_{F}")
    def M_F(self) -> Array:
        """Moment due to pressure, in addition to that due to shear."""
        return self.film.load_couple * self.eta * self.omega_h * self.W * self.D**2 / (2 * self.psi)

    @formula("N*m", "friction torque", symbol="M_{f}")
    def M_f(self) -> Array:
        return self.M_s + self.M_F

    @formula("1", "friction coefficient", symbol="f", absent="there is no load to relate friction to")
    def f(self) -> Array:
        return friction_coefficient(self.M_f, self.F, self.D)

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M_s * self.omega_s + self.M_F * self.omega_h

    @formula("l/min", "side flow", symbol="Q", source=ISO)
    def Q(self) -> Array:
        return self.film.side_flow * (self.D / 2) ** 3 * self.psi * self.omega_h

    @formula("l/min", "total oil flow", symbol="Q_{t}")
    def Q_t(self) -> Array:
        """Flow that the supply must deliver: all oil that leaves at the ends."""
        return self.Q
