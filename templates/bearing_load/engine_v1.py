"""A whole engine of any layout: crankpin and firing angles, balance by orders, torque, all bearing loads.

The engine may be an in-line, V, boxer or radial engine with two or four strokes. It may have shared or split
pins, articulated rods, odd firing, cylinders that differ, and mains with clearance.
"""

from __future__ import annotations

from templates.core.language.template import (
    Array,
    Truth,
    curve,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.articulated_engine import ArticulatedEngine
from templates.groups.engine_cylinders import EACH
from templates.groups.engine_motion import CYCLE
from templates.groups.petrol_engine import OVERLAP, PETROL_CYCLE, SHAFT
from templates.physics.crankshaft.crank_frame import CrankSections
from templates.physics.crankshaft.main_bearings import (
    ShaftLoads,
    Vectors,
    along_x,
    along_y,
    governing,
    greatest,
    greatest_at,
    mains_ascend,
)
from templates.physics.crankshaft.main_clearance import (
    SupportReactions,
    Supports,
    flexibilities,
    law_residual,
    play_of_each_main,
    supports_of,
    with_play,
)
from templates.physics.crankshaft.shaft_loads import (
    change_on_supports,
    crank_fits,
    determinate,
    elastic,
    has_one_for_each_main,
    imbalance,
    on_the_shaft,
    reactions_of,
    sections_of,
    spun,
)

MAINS = "mains"
UNEQUAL = (
    "sections of journals, pins and webs whose stiffnesses differ 1e12-fold cannot be solved: check the units"
)
UNLOADED = "no load, or no mains, or no crank"


class Engine(ArticulatedEngine):
    """A whole engine of any layout: crankpin and firing angles, balance by orders, torque, all bearing loads.

    In line, V, boxer, radial; shared or split pins; articulated rods; odd firing; two and four strokes;
    cylinders that may differ; mains with clearance.

    Limits
    ------
    Constant speed, rigid bodies in the mechanism, no friction, no gravity.
    Seen from the flywheel, which is at the end of the largest positions, x is up, y left, and the shaft
    rotates from x to y; angles are positive in that sense. A reference line on the shaft is at the crank
    angle.
    Pin j is at pin_angles from that line, its cylinder at bank_angles from x; it fires when its piston is at
    top dead centre: pin angle = bank angle - firing angle + the pin's angle from the cylinder axis at that
    dead centre.
    Give firing_order (equal intervals), pin_angles with firing_order, or firing_angles. With pins and order
    each cylinder of a four-stroke engine may fire in either revolution: the choice keeps the order and makes
    the smallest interval as large as possible.
    Bank angles with opposite signs describe another crank: if throws name a shared pin this is refused.
    Positions are along the shaft, from any plane; couples are about reference_position. A couple is the sum
    of position times force, as a vector; its moment is that vector rotated by 90 deg.
    Fork and blade rods have one position, side-by-side rods two.
    masters names for each cylinder the one whose rod carries its rod, 0 for a rod on the crankpin. The pin of
    an articulated rod is articulation_radius from the crankpin, at articulation_angle from the axis of the
    master rod. Master and articulated rod share throw, pin and position: give pin_angles with firing_order,
    then each fires when its own piston is at top dead centre. The stroke of an articulated cylinder is a
    result. crankpin_load of an articulated cylinder is the load of its own pin; crankpin_load of a master is
    the load of the crankpin with all rods. For balance by orders the mass at an articulated pin counts as
    rotating with the crankpin; shaking force and couple use its exact path, and orders of its piston are
    exact.
    cylinder_offset is the distance of the cylinder's axis from the shaft, positive on the side to which the
    pin moves first; an offset of the piston pin adds to it.
    rod_centre is measured from the big end. Without rod_inertia the rod is two masses at its pins.
    crank_unbalance is counted for each cylinder, at its pin and position, without the rod: of a throw with
    two rods, give each cylinder half. Webs and their counterweights at web_positions add to it; their angles
    are measured from the pin of the throw, which is the nearest one unless web_throws is given.
    A pressure table begins with the intake stroke as in bearing_load: combustion is at 360 deg in four
    strokes, at 0 in two. pressure_factor multiplies the pressure of a cylinder; gas_pressure is that before
    the factor. Valve angles are measured from top dead centre.
    With harmonics leading, orders 1 and 2 are r and r²/l, as in textbooks; with harmonics exact, from order 3
    on and with an offset they are Fourier coefficients of the exact motion. Forward components rotate with
    the crank. Force and couple of an order are largest, forward plus backward, at the given crank angle,
    where they point in the given direction; one that only rotates points to x at that angle.
    Orders are of the pistons alone; shaking force and couple are exact and include all moving parts and
    balance shafts. Roll moment is that of walls and heads on the frame about the shaft.
    Mean torque and power are indicated, from the work of the gas without friction; they are exact for any
    step. crank_angle_step determines only the angles at which curves are returned. Greatest loads, energy and
    areas come from a grid of at most 1 deg with both sides of each pressure jump. Energy is the trapezoidal
    integral of torque minus its mean on the same grid, so it closes. An energy area lies between torque and
    mean from crossing to crossing; energy_area gives at each angle the area to which it belongs.
    Main loads act from the frame on the shaft, crankpin loads from the rod on the pin, in the engine's axes;
    rows are bearings. For oil_film_cycle set load_sense to sleeve_on_journal.
    main_load is determinate: the lever rule distributes every load to the two mains of its span.
    elastic_main_load: a crank of beams on supports of support_stiffness (rigid if not given), equal in x and
    y; the flywheel end takes the torque. With main_clearance (radial) a support reacts to the displacement of
    its main beyond the clearance, measured from the centre of its bore, which bore_offset moves off the line.
    Webs have web_torsion_factor times the torsional stiffness of a St Venant bar: relative to finite elements
    of a four-throw shaft the reactions to a load on a pin then have errors of 0.014 of it radially and 0.045
    tangentially; with a factor of 1, 0.37 tangentially. Quasi-static: no resonance, no oil film in the
    clearance.

    References
    ----------
    S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94.
    """

    precision = 1e-9
    example = {
        "speed": "4500 rpm",
        "strokes": 4,
        "crank_angle_step": "60 deg",
        "firing_order": [1, 2],
        "pin_angles": {"value": [0, 0], "unit": "deg"},
        "bank_angles": {"value": [0, 60], "unit": "deg"},
        "throws": [1, 1],
        "masters": [0, 1],
        "articulation_radius": "38 mm",
        "articulation_angle": "62 deg",
        "cylinder_positions": {"value": [47, 47], "unit": "mm"},
        "crank_radius": "43 mm",
        "rod_length": {"value": [145, 107], "unit": "mm"},
        "bore": "86 mm",
        "rod_mass": {"value": [0.8, 0.4], "unit": "kg"},
        "rod_centre": {"value": [40, 36], "unit": "mm"},
        "rod_inertia": {"value": [2900, 700], "unit": "kg*mm**2"},
        "piston_mass": "0.48 kg",
        **PETROL_CYCLE,
        **OVERLAP,
        "orders": [1, 2],
        "main_positions": {"value": [0, 94, 170], "unit": "mm"},
        "web_positions": {"value": [22, 72, 132], "unit": "mm"},
        **SHAFT,
    }
    main_results = (
        "speed", "indicated_mean_effective_pressure", "mean_torque", "mean_power", "shaking_force_max",
    )  # fmt: skip
    criteria = {
        "main_load": {
            "require": "main_load_max <= permissible_main_load",
            "words": "every main bearing is loaded within what it bears",
            "limits": {
                "permissible_main_load": {"unit": "N", "words": "largest load that a main bearing bears"}
            },
        },
        "crankpin_load": {
            "require": "crankpin_load_max <= permissible_crankpin_load",
            "words": "every crankpin bearing is loaded within what it bears",
            "limits": {
                "permissible_crankpin_load": {
                    "unit": "N",
                    "words": "largest load that a crankpin bearing bears",
                }
            },
        },
        "shaking_force": {
            "require": "shaking_force_max <= permissible_shaking_force",
            "words": "the shaking force is within the permissible one all the way round",
            "limits": {"permissible_shaking_force": {"unit": "N", "words": "largest shaking force"}},
        },
    }

    z_m: Array = curve("mm", "main positions", along=MAINS, optional=True, ge=-1e6, le=1e6)
    k_s: Array = curve(
        "kN/mm", "support stiffness", along=MAINS, constant=True, alternative=True, gt=0, le=1e9
    )
    d_j: Array = given("mm", "journal diameter", optional=True, single=True, gt=0, le=1e4)
    d_p: Array = given("mm", "crankpin diameter", optional=True, single=True, gt=0, le=1e4)
    l_p: Array = given("mm", "crankpin length", optional=True, single=True, gt=0, le=1e4)
    t_s: Array = given("mm", "web thickness", optional=True, single=True, gt=0, le=1e4)
    b_s: Array = given("mm", "web width", optional=True, single=True, gt=0, le=1e4)
    c_m: Array = curve("mm", "main clearance", along=MAINS, constant=True, default="0 mm", ge=0, le=10,
                       assumed="the mains have no clearance")  # fmt: skip
    o_x: Array = curve("mm", "bore offset x", along=MAINS, constant=True, default="0 mm", ge=-10, le=10,
                       assumed="the main bores are in line along x")  # fmt: skip
    o_y: Array = curve("mm", "bore offset y", along=MAINS, constant=True, default="0 mm", ge=-10, le=10,
                       assumed="the main bores are in line along y")  # fmt: skip
    E: Array = given("GPa", "youngs modulus", default="210 GPa", single=True, gt=0, le=1000)
    nu: Array = given("1", "poisson ratio", default="0.3", single=True, ge=0, lt=0.5)
    f_w: Array = given("1", "web torsion factor", default="8", single=True, gt=0, le=100)

    @require("main_positions", remedy="give two or more, ascending")
    def mains_ascend(self) -> Truth:
        """The positions of the mains ascend along the shaft."""
        return mains_ascend(self.z_m)

    @require("support_stiffness", "main_positions", missing=True,
             remedy="give one number, or one for each main")  # fmt: skip
    def stiffness_of_each_main(self) -> Truth:
        """The support stiffness is one value, or one for each main."""
        return has_one_for_each_main(self.k_s, self.z_m)

    @require("main_clearance", "bore_offset_x", "bore_offset_y", "main_positions", missing=True,
             remedy="give one number, or one for each main")  # fmt: skip
    def play_of_each_main(self) -> Truth:
        """Clearance and offset of the mains are one value each, or one for each main."""
        return play_of_each_main(self.c_m, self.o_x, self.o_y, self.z_m)

    @require("crankpin_length", "web_thickness", "main_positions", "cylinder_positions",
             remedy="rods stand on their pin, mains outside its webs; check the unit")  # fmt: skip
    def crank_fits(self) -> Truth:
        """Pins and webs fit between the mains."""
        return crank_fits(self.z_m, self.z_i, self.layout.throw, self.sections)

    @shared
    def sections(self) -> CrankSections:
        """Return the sections of the crank."""
        return sections_of(self.d_j, self.d_p, self.l_p, self.t_s, self.b_s, self.E, self.nu, self.f_w)

    @shared
    def loads(self) -> ShaftLoads:
        """Return all loads on the shaft."""
        return on_the_shaft(
            self.places, self.pins + spun(self.throw_unbalance, self.omega, self.grid.theta),
            self.web_places, spun(self.webs, self.omega, self.grid.theta),
        )  # fmt: skip

    @shared
    def mains(self) -> Vectors:
        """Return the statically determinate loads of the mains."""
        return determinate(self.z_m, self.loads)

    @shared
    def reactions(self) -> Array:
        """Return the reactions of the mains to unit loads on the elastic crank."""
        return reactions_of(
            self.z_m, self.places, self.web_places, self.layout.throw, self.layout.pin, self.crank.r,
            self.sections, self.k_s,
        )  # fmt: skip

    @shared
    def supports(self) -> Supports:
        """Return the supports of the mains."""
        return supports_of(self.z_m, self.k_s, self.c_m, self.o_x, self.o_y)

    @shared
    def played(self) -> SupportReactions | None:
        """Return the loads of mains with clearance; None without a clearance or without crank sections."""
        shafts = flexibilities(
            self.z_m, self.places, self.web_places, self.layout.throw, self.layout.pin, self.crank.r,
            self.sections,
        ) if self.supports.have_play else []  # fmt: skip
        return with_play(self.z_m, self.loads, shafts, self.supports, self.grid.theta) if shafts else None

    @shared
    def elastic_mains(self) -> Vectors:
        """Return the loads of the mains on elastic supports."""
        if self.played:
            return self.played.forces
        return elastic(self.z_m, self.loads, self.reactions, self.grid.theta)

    @profile("N", "crankpin load x", along=CYCLE, axes=2, symbol="F_{px}")
    def F_px(self) -> Array:
        return along_x(self.big_ends, self.grid)

    @profile("N", "crankpin load y", along=CYCLE, axes=2, symbol="F_{py}")
    def F_py(self) -> Array:
        return along_y(self.big_ends, self.grid)

    @profile("N", "crankpin load max", along=EACH, symbol=r"F_\mathrm{p,max}")
    def F_p_max(self) -> Array:
        return greatest(self.big_ends)

    @profile("N", "main load x", along=CYCLE, axes=2, symbol="F_{mx}")
    def F_mx(self) -> Array:
        return along_x(self.mains, self.grid)

    @profile("N", "main load y", along=CYCLE, axes=2, symbol="F_{my}")
    def F_my(self) -> Array:
        return along_y(self.mains, self.grid)

    @profile("N", "main load max", along=MAINS, symbol=r"F_\mathrm{m,max}")
    def F_m_max(self) -> Array:
        return greatest(self.mains)

    @profile("deg", "main load max angle", along=MAINS, symbol=r"\theta_\mathrm{m,max}")
    def theta_m(self) -> Array:
        return greatest_at(self.mains, self.grid)

    @formula("1", "governing main", symbol=r"i_\mathrm{m}")
    def i_m(self) -> Array:
        return governing(self.mains)

    @profile("N", "elastic main load x", along=CYCLE, axes=2, symbol="F_{ex}", remedy=UNEQUAL)
    def F_ex(self) -> Array:
        return along_x(self.elastic_mains, self.grid)

    @profile("N", "elastic main load y", along=CYCLE, axes=2, symbol="F_{ey}", remedy=UNEQUAL)
    def F_ey(self) -> Array:
        return along_y(self.elastic_mains, self.grid)

    @profile("N", "elastic main load max", along=MAINS, symbol=r"F_\mathrm{e,max}", remedy=UNEQUAL)
    def F_e_max(self) -> Array:
        return greatest(self.elastic_mains)

    @formula("1", "governing elastic main", symbol=r"i_\mathrm{e}")
    def i_e(self) -> Array:
        return governing(self.elastic_mains)

    @profile("1", "elastic difference", along=MAINS, symbol=r"\Delta_{e}", absent=UNLOADED)
    def Delta_e(self) -> Array:
        return change_on_supports(self.elastic_mains, self.mains)

    @formula("1", "equilibrium residual", symbol=r"\epsilon_\mathrm{R}")
    def residual(self) -> Array:
        return imbalance(self.mains, self.loads, self.z_m)

    @formula("1", "elastic equilibrium residual", symbol=r"\epsilon_\mathrm{e}")
    def elastic_residual(self) -> Array:
        return imbalance(self.elastic_mains, self.loads, self.z_m)

    @formula("1", "support law residual", symbol=r"\epsilon_\mathrm{s}")
    def law_residual(self) -> Array:
        return law_residual(self.elastic_mains, self.played)
