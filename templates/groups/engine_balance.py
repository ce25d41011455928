"""Group: the layout of an engine (pins, firing, axial positions) and its unbalance by orders."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import (
    Array,
    Truth,
    choice,
    curve,
    derived,
    formula,
    profile,
    require,
    shared,
    text,
)
from templates.groups.engine_cylinders import EACH, EngineCylinders
from templates.physics.crankshaft.shaft_loads import (
    greatest_unbalance,
    throw_places,
    web_unbalance,
    webs_are_whole,
)
from templates.physics.engine.balance import mid_plane
from templates.physics.engine.engine_curves import Rotors
from templates.physics.engine.engine_layout import (
    Layout,
    arranged,
    firing_angles,
    firing_intervals,
    has_times,
    is_one_layout,
    is_order,
    layout_in_words,
    order_agrees,
    pin_angles,
    pin_splits,
    pins_agree,
    pins_are_shared,
    says_layout,
    throws_are_named,
    times_are_said,
)
from templates.physics.engine.engine_sizes import (
    each,
    has_a_place_each,
    has_one_each,
    is_one_list,
    or_none,
    orders_are_whole,
)
from templates.physics.engine.harmonics import (
    Harmonics,
    Phasor,
    backward_couple,
    backward_force,
    couple_size,
    direction,
    force_size,
    forward_couple,
    forward_force,
    harmonics,
    largest_at,
    largest_towards,
    piston_harmonics,
    rotating_sum,
)

WEBS, ORDERS = "webs", "orders"
NO_ORDER = "give `firing_order` or `firing_angles`"
SIGN = "turn the sign of `bank_angles`, or set `pins_of_a_throw` to `split`"


class EngineBalance(EngineCylinders):
    """The layout of an engine (pins, firing, axial positions) and its unbalance by orders."""

    order: Array = curve("1", "firing order", along=EACH, alternative=True, integer=True, ge=1, le=32,
                         symbol=r"\mathrm{order}")  # fmt: skip
    psi_g: Array = curve("deg", "pin angles", along=EACH, alternative=True, ge=-720, le=720)
    phi_g: Array = curve("deg", "firing angles", along=EACH, alternative=True, ge=-720, le=1440)
    beta: Array = curve("deg", "bank angles", along=EACH, constant=True, default="0 deg", ge=-360, le=360)
    throws: Array = curve("1", "throws", along=EACH, alternative=True, integer=True, ge=1, le=32,
                          symbol=r"\mathrm{throw}")  # fmt: skip
    shares: str = choice("shared", "split", words="pins of a throw", default="shared")
    z_i: Array = curve("mm", "cylinder positions", along=EACH, ge=-1e6, le=1e6, symbol="z_{i}")
    h: Array = curve("1", "orders", along=ORDERS, constant=True, default="1", integer=True, ge=1, le=80)
    terms: str = choice("leading", "exact", words="harmonics", default="leading")
    z_w: Array = curve("mm", "web positions", along=WEBS, alternative=True, ge=-1e6, le=1e6)
    U_w: Array = curve("kg*mm", "web unbalance", along=WEBS, constant=True, default="0 kg*mm", ge=0, le=1e8)
    a_w: Array = curve("deg", "web angles", along=WEBS, constant=True, default="0 deg", ge=-360, le=360,
                       symbol=r"\gamma_{w}")  # fmt: skip
    U_k: Array = curve("kg*mm", "counterweights", along=WEBS, constant=True, default="0 kg*mm", ge=0, le=1e8)
    a_k: Array = curve("deg", "counterweight angles", along=WEBS, constant=True, default="180 deg",
                       symbol=r"\gamma_{k}", ge=-360, le=360)  # fmt: skip
    t_w: Array = curve("1", "web throws", along=WEBS, alternative=True, integer=True, ge=1, le=32,
                       symbol=r"\mathrm{throw}_{w}")  # fmt: skip

    @derived("mm", "reference position", symbol="z_{0}", ge=-1e6, le=1e6)
    def z_0(self) -> Array:
        """Default: midway between the outermost cylinders."""
        return mid_plane(self.z_i)

    @require("firing_order", "pin_angles", "firing_angles", missing=True,
             remedy="give `firing_order` as [1, 3, 4, 2] for equal intervals")  # fmt: skip
    def layout_is_said(self) -> Truth:
        """The layout is defined by firing_order, by pin_angles with firing_order, or by firing_angles."""
        return says_layout(self.order, self.psi_g, self.phi_g)

    @require("firing_order", "pin_angles", "firing_angles", missing=True,
             remedy="give each a value for each cylinder")  # fmt: skip
    def one_layout(self) -> Truth:
        """Firing order, pin angles and firing angles are lists of equal length."""
        return is_one_layout(self.order, self.psi_g, self.phi_g)

    @require("firing_order", missing=True, remedy="name each cylinder from 1 on once, in the order they fire")
    def each_fires_once(self) -> Truth:
        """The firing order contains every cylinder once."""
        return is_order(self.order, self.psi_g, self.phi_g)

    @require("pin_angles", "firing_order", "firing_angles", missing=True,
             remedy="give `firing_order` too, or set `gas_cycle` to `none`")  # fmt: skip
    def times_are_said(self) -> Truth:
        """With gas forces a four-stroke engine needs firing data: pin angles leave two revolutions."""
        return times_are_said(self.strokes, self.order, self.psi_g, self.phi_g, self.gas_cycle)

    @require("bank_angles", "cylinder_offset", "stroke", "crank_radius", "rod_length", "bore", "rod_mass",
             "rod_centre", "rod_inertia", "piston_mass", "crank_unbalance", "pressure_factor", missing=True,
             remedy="give one number, or a list with one for each cylinder")  # fmt: skip
    def one_for_each(self) -> Truth:
        """Inputs that differ between cylinders have one value for each cylinder."""
        return has_one_each(
            (self.beta, self.e, self.s, self.r_g, self.l, self.D, self.m_3, self.b_g, self.I_3, self.m_4,
             self.U_c, self.f_p),
            self.order, self.psi_g, self.phi_g,
        )  # fmt: skip

    @require("bank_angles", remedy="give one list of angles")
    def one_set_of_banks(self) -> Truth:
        """The bank angles describe a single engine."""
        return is_one_list(self.beta)

    @require("orders", remedy="give one list of whole orders, such as [1, 2, 4]")
    def one_set_of_orders(self) -> Truth:
        """The orders are a single list."""
        return orders_are_whole(self.h)

    @require("cylinder_positions", missing=True, remedy="give a position for each cylinder, in mm")
    def a_place_each(self) -> Truth:
        """There is one position for each cylinder."""
        return has_a_place_each(self.z_i, self.order, self.psi_g, self.phi_g)

    @require("throws", missing=True, remedy="number the throws from 1, as [1, 1, 2, 2] for pairs on a pin")
    def a_throw_each(self) -> Truth:
        """There is a throw for each cylinder."""
        return throws_are_named(self.throws, self.order, self.psi_g, self.phi_g)

    @require("pin_angles", "firing_order", missing=True,
             remedy="turn the firing order, or give `firing_angles`")  # fmt: skip
    def order_has_times(self) -> Truth:
        """With these pin angles the cylinders can fire in this order within one cycle."""
        return has_times(self.layout)

    @require("pin_angles", "firing_angles", "bank_angles", missing=True,
             remedy="each pin stands at bank - firing angle; omit one of the lists")  # fmt: skip
    def pins_agree(self) -> Truth:
        """Pin angles and firing angles agree to 1e-6 deg."""
        return pins_agree(self.layout, self.crank.top)

    @require("firing_order", "firing_angles", "pin_angles", missing=True,
             remedy="omit one of the lists")  # fmt: skip
    def order_agrees(self) -> Truth:
        """The cylinders fire in the given order."""
        return order_agrees(self.layout, self.order)

    @require("throws", "bank_angles", "pins_of_a_throw", missing=True, remedy=SIGN)
    def pins_are_shared(self) -> Truth:
        """Cylinders on the same throw share its pin angle."""
        return pins_are_shared(self.layout, self.shares)

    @require("web_positions", "web_unbalance", "web_angles", "counterweights", "counterweight_angles",
             "web_throws", missing=True, remedy="give `web_positions` as one list, and throws that exist",
             )  # fmt: skip
    def webs_are_whole(self) -> Truth:
        """Webs with an unbalance, a counterweight or a list of values have positions."""
        return webs_are_whole(self.z_w, self.U_w, self.a_w, self.U_k, self.a_k, self.t_w, self.layout.throws)

    @require("crank_unbalance", "web_unbalance", "counterweights", warning="massless_crank",
             remedy="give `crank_unbalance`, or `web_unbalance`, counterweights and `web_positions`; main "
             "loads and balance are of rods and pistons alone")  # fmt: skip
    def crank_has_mass(self) -> Truth:
        """At least one throw or web has an unbalance."""
        return self.U_max > 0

    @shared(unit="kg*mm")
    def U_max(self) -> Array:
        """Return the greatest unbalance of throws, webs and counterweights."""
        return greatest_unbalance(self.U_c, self.U_w, self.U_k)

    @shared
    def layout(self) -> Layout:
        """Return the layout of pins and firing."""
        return arranged(
            self.strokes, self.order, self.psi_g, self.phi_g, self.beta, self.throws, self.crank.top,
            self.gas_cycle,
        )  # fmt: skip

    @shared
    def places(self) -> Array:
        """Return the positions of the cylinders [m], one for each."""
        return each(self.z_i)

    @shared
    def web_places(self) -> Array:
        """Return the positions of the webs [m]; empty if none are given."""
        return or_none(self.z_w)

    @shared
    def webs(self) -> Phasor:
        """Return the unbalance of each web with its counterweight [kg m], complex at crank angle 0."""
        return web_unbalance(
            self.U_w, self.a_w, self.U_k, self.a_k, self.web_places, self.t_w,
            throw_places(self.places, self.layout.throw), self.layout.throw_pin,
        )  # fmt: skip

    @shared
    def throw_unbalance(self) -> Phasor:
        """Return the crank unbalance of each cylinder's throw [kg m], complex at crank angle 0."""
        return each(self.U_c) * np.exp(1j * self.layout.pin)

    @shared
    def turning(self) -> tuple[Rotors, Rotors]:
        """Return all parts that rotate with the crank: throws with the big ends of the rods, and webs."""
        return (
            Rotors(
                self.throw_unbalance + self.rods.at_crank * self.crank.r * np.exp(1j * self.layout.pin),
                self.places,
            ),
            Rotors(self.webs, self.web_places),
        )

    @shared
    def rotating(self) -> Phasor:
        """Return the force of all rotating parts [N] at crank angle 0."""
        return rotating_sum([(one.unbalance, one.place) for one in self.turning], self.omega, None)

    @shared
    def rotating_couples(self) -> Phasor:
        """Return the couple of all rotating parts about the reference position [N m] at crank angle 0."""
        return rotating_sum([(one.unbalance, one.place) for one in self.turning], self.omega, self.z_0)

    @shared
    def weight(self) -> Phasor:
        """Return the force of each piston at the orders [N], (…, N, H)."""
        return (self.m_rec * np.asarray(self.omega)[..., None] ** 2)[..., None] * piston_harmonics(
            self.crank, self.h, self.terms == "exact"
        )

    @shared
    def forces(self) -> Harmonics:
        """Return the forces of the pistons at the orders."""
        return harmonics(self.layout, self.h, self.weight)

    @shared
    def couples(self) -> Harmonics:
        """Return the couples of the pistons at the orders about the reference position."""
        return harmonics(self.layout, self.h, self.weight, self.places - np.asarray(self.z_0)[..., None])

    @text("layout", name="layout")
    def words(self) -> str:
        """Description of the layout in words."""
        return layout_in_words(self.layout)

    @profile("deg", "crankpin angles", along=EACH, symbol=r"\psi", latex=r"\beta-\varphi+\alpha_{T}")
    def psi(self) -> Array:
        """Angle of each cylinder's pin from the reference line."""
        return pin_angles(self.layout)

    @profile("deg", "ignition angles", along=EACH, symbol=r"\varphi", latex=r"\beta-\psi+\alpha_{T}",
             absent=NO_ORDER)  # fmt: skip
    def phi(self) -> Array:
        """Firing angle of each cylinder."""
        return firing_angles(self.layout)

    @profile("deg", "firing intervals", along="firing_intervals", symbol=r"\Delta\varphi",
             absent=NO_ORDER)  # fmt: skip
    def dphi(self) -> Array:
        """Intervals between firings, in the firing order."""
        return firing_intervals(self.layout)

    @profile("deg", "pin split", along="pin_split", symbol=r"\Delta\psi")
    def dpsi(self) -> Array:
        """Largest angle between the pins of each throw."""
        return pin_splits(self.layout)

    @formula("N", "rotating force", symbol="F_{r}")
    def F_r(self) -> Array:
        """Force of all masses that rotate with the crank."""
        return force_size(self.rotating)

    @formula("deg", "rotating force angle", symbol=r"\gamma_{F}")
    def gamma_F(self) -> Array:
        """Direction of the rotating force at crank angle 0."""
        return direction(self.rotating)

    @formula("N*m", "rotating couple", symbol="C_{r}")
    def C_r(self) -> Array:
        """Couple of all masses that rotate with the crank."""
        return couple_size(self.rotating_couples)

    @formula("deg", "rotating couple angle", symbol=r"\gamma_{C}")
    def gamma_C(self) -> Array:
        """Direction of the sum of position times force at crank angle 0."""
        return direction(self.rotating_couples)

    @profile("N", "order force forward", along=ORDERS, symbol=r"F_\mathrm{fwd}",
             latex=r"\left|\tfrac12\sum w\,e^{i(\beta+h(\psi-\beta))}\right|")  # fmt: skip
    def F_f(self) -> Array:
        """Component of the force that rotates with the crank."""
        return forward_force(self.forces)

    @profile("N", "order force backward", along=ORDERS, symbol=r"F_\mathrm{bwd}",
             latex=r"\left|\tfrac12\sum w\,e^{i(\beta-h(\psi-\beta))}\right|")  # fmt: skip
    def F_b(self) -> Array:
        """Component of the force that rotates against the crank."""
        return backward_force(self.forces)

    @profile("deg", "order force crank angle", along=ORDERS, symbol=r"\theta_{F}")
    def theta_F(self) -> Array:
        """Crank angle at which the force is largest."""
        return largest_at(self.forces)

    @profile("deg", "order force direction", along=ORDERS, symbol=r"\delta_{F}")
    def delta_F(self) -> Array:
        """Direction of the force at that crank angle."""
        return largest_towards(self.forces)

    @profile("N*m", "order couple forward", along=ORDERS, symbol=r"C_\mathrm{fwd}",
             latex=r"\left|\tfrac12\sum z\,w\,e^{i(\beta+h(\psi-\beta))}\right|")  # fmt: skip
    def C_f(self) -> Array:
        """Component of the couple that rotates with the crank."""
        return forward_couple(self.couples)

    @profile("N*m", "order couple backward", along=ORDERS, symbol=r"C_\mathrm{bwd}",
             latex=r"\left|\tfrac12\sum z\,w\,e^{i(\beta-h(\psi-\beta))}\right|")  # fmt: skip
    def C_b(self) -> Array:
        """Component of the couple that rotates against the crank."""
        return backward_couple(self.couples)

    @profile("deg", "order couple crank angle", along=ORDERS, symbol=r"\theta_{C}")
    def theta_C(self) -> Array:
        """Crank angle at which the couple is largest."""
        return largest_at(self.couples)

    @profile("deg", "order couple direction", along=ORDERS, symbol=r"\delta_{C}")
    def delta_C(self) -> Array:
        """Direction of the sum of position times force at that crank angle."""
        return largest_towards(self.couples)
