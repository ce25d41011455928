"""Group: a train of inertias with shafts, branches, gears, dampers and a propeller."""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, curve, given, require, shared
from templates.physics.torsion.engine_train import is_whole_propeller
from templates.physics.torsion.train_layout import (
    TrainLayout,
    are_few,
    are_gears,
    are_pairs,
    exist,
    has_no_loop,
    is_joined,
    name_inertias,
    train_layout,
    turns_freely,
)

INERTIAS, SHAFTS, GEARS = "inertias", "shafts", "gears"
NUMBERS = "number the inertias from 1; a shaft to 0 ends at the ground"


class TorsionTrain(Template):
    """A train of inertias with shafts, branches, gears, dampers and a propeller."""

    J: Array = curve("kg*m**2", "inertias", along=INERTIAS, gt=0, le=1e12)
    s_i: Array = curve("1", "shaft from", along=SHAFTS, integer=True, ge=1, remedy=NUMBERS)
    s_j: Array = curve("1", "shaft to", along=SHAFTS, integer=True, ge=0, remedy=NUMBERS)
    k: Array = curve("kN*m/rad", "shaft stiffness", along=SHAFTS, ge=0, le=1e12)
    c: Array = curve(
        "N*m*s/rad", "shaft damping", along=SHAFTS, constant=True, default="0 N*m*s/rad", ge=0, le=1e12
    )
    eta: Array = curve(
        "1", "loss factors", along=SHAFTS, constant=True, default="0", ge=0, le=10, symbol=r"\eta"
    )
    W: Array = curve(
        "cm**3", "section moduli", along=SHAFTS, constant=True, optional=True, ge=0, le=1e9, symbol="W_{t}"
    )
    g_i: Array = curve("1", "gear from", along=GEARS, alternative=True, integer=True, ge=1, remedy=NUMBERS)
    g_j: Array = curve("1", "gear to", along=GEARS, alternative=True, integer=True, ge=1, remedy=NUMBERS)
    i_g: Array = curve("1", "gear ratios", along=GEARS, alternative=True, ge=-1000, le=1000)
    c_a: Array = curve("N*m*s/rad", "absolute damping", along=INERTIAS, constant=True,
                       default="0 N*m*s/rad", ge=0, le=1e12)  # fmt: skip
    p: Array = given("1", "propeller inertia", alternative=True, single=True, integer=True, ge=1, symbol="p",
                     remedy=NUMBERS)  # fmt: skip
    T_p: Array = given("N*m", "propeller torque", alternative=True, ge=0, le=1e12)
    n_p: Array = given("rpm", "propeller speed", alternative=True, gt=0, le=1e6)
    f_p: Array = given("1", "propeller factor", default="2", ge=0, le=20)

    @require("inertias", "shaft_from", "gear_from", missing=True, remedy="join stiff parts to one inertia")
    def few(self) -> Truth:
        """There are at most 100 inertias, 300 shafts and 100 gears."""
        return are_few(self.J, self.s_i, self.g_i)

    @require("shaft_from", "shaft_to", remedy="give two lists of one number for each shaft")
    def pairs(self) -> Truth:
        """Each shaft connects two numbered inertias."""
        return are_pairs(self.s_i, self.s_j)

    @require("shaft_from", "shaft_to", "inertias", remedy=NUMBERS)
    def shafts_join(self) -> Truth:
        """Shafts connect two existing inertias."""
        return name_inertias(self.J, self.s_i, self.s_j)

    @require("gear_from", "gear_to", "gear_ratios", missing=True,
             remedy="give three lists of one value for each gear; no ratio is 0")  # fmt: skip
    def whole_gears(self) -> Truth:
        """Each gear has two inertias and a ratio."""
        return are_gears(self.g_i, self.g_j, self.i_g)

    @require("gear_from", "gear_to", "inertias", missing=True, remedy=NUMBERS)
    def gears_join(self) -> Truth:
        """Gears connect two existing inertias."""
        return name_inertias(self.J, self.g_i, self.g_j)

    @shared
    def layout(self) -> TrainLayout | None:
        """Return the layout of the train; None where a rule refuses it."""
        return train_layout(self.J, self.s_i, self.s_j, self.g_i, self.g_j, self.i_g)

    @require("gear_to", "gear_from", missing=True,
             remedy="omit the gear that closes the loop: the other gears determine its ratio")  # fmt: skip
    def no_gear_loop(self) -> Truth:
        """Gears drive each inertia at most once, and not in a loop."""
        return has_no_loop(self.layout)

    @require("shaft_from", "shaft_to", "inertias", remedy="connect the loose parts, or omit them")
    def joined(self) -> Truth:
        """Shafts and gears connect all inertias to one train."""
        return is_joined(self.layout)

    @require("gear_ratios", "shaft_from", "shaft_to", missing=True,
             remedy="correct a ratio: around a loop their product is 1")  # fmt: skip
    def turns(self) -> Truth:
        """The train can rotate without twisting its shafts."""
        return turns_freely(self.layout)

    @require("propeller_inertia", "propeller_torque", "propeller_speed", missing=True,
             remedy="give all three, or none")  # fmt: skip
    def whole_propeller(self) -> Truth:
        """A propeller has an inertia, a torque and a speed."""
        return is_whole_propeller(self.p, self.T_p, self.n_p)

    @require("propeller_inertia", "inertias", missing=True, remedy=NUMBERS)
    def propeller_exists(self) -> Truth:
        """The propeller is on an inertia that exists."""
        return exist(self.J, self.p)
