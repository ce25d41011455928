"""Group: an engine with articulated rods, which act on the big end of a master rod."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Truth, curve, require, shared
from templates.groups.engine_cylinders import EACH
from templates.groups.engine_motion import EngineMotion
from templates.physics.crankshaft.main_bearings import Vectors
from templates.physics.engine.articulated_rod import (
    arms_are_given,
    articulated_rods_reach,
    carriers,
    link_force,
    masters_are_named,
    off_the_circle,
    on_big_ends,
    order_amplitudes,
    rods_share_a_pin,
    walls_with_articulated,
    with_articulated,
)
from templates.physics.engine.engine_curves import Parts, piston_shaking
from templates.physics.engine.engine_layout import count_of
from templates.physics.engine.engine_sizes import crank_of
from templates.physics.engine.harmonics import Phasor
from templates.physics.engine.offset_crank import OffsetCrank, wall_force


class ArticulatedEngine(EngineMotion):
    """An engine in which some rods are articulated: they are attached to the big end of a master rod."""

    masters: Array = curve("1", "masters", along=EACH, alternative=True, integer=True, ge=0, le=32,
                           symbol=r"\mathrm{master}")  # fmt: skip
    rho_a: Array = curve("mm", "articulation radius", along=EACH, constant=True, alternative=True, ge=0,
                         le=1e5, symbol=r"\rho_{a}")  # fmt: skip
    gamma_a: Array = curve("deg", "articulation angle", along=EACH, constant=True, default="0 deg", ge=-360,
                           le=360, symbol=r"\gamma_{a}")  # fmt: skip

    @require("masters", missing=True,
             remedy="name the cylinder whose rod carries this one, 0 for a rod on the crankpin")  # fmt: skip
    def masters_are_named(self) -> Truth:
        """For each cylinder, masters names a cylinder whose rod is on the crankpin, or 0."""
        return masters_are_named(self.masters, self.order, self.psi_g, self.phi_g)

    @require("articulation_radius", "masters", missing=True, remedy="from crankpin to the rod's pin, in mm")
    def arms_are_given(self) -> Truth:
        """Each articulated rod has a radius above 0."""
        return arms_are_given(self.masters, self.rho_a)

    @require("masters", "throws", "cylinder_positions", "pin_angles", missing=True,
             remedy="name their throws, give `pin_angles` with `firing_order`, and one position")  # fmt: skip
    def rods_share_a_pin(self) -> Truth:
        """Articulated rods have the throw, pin, position and crank radius of their master."""
        return rods_share_a_pin(self.crank, self.layout, self.z_i)

    @require("articulation_radius", "articulation_angle", "rod_length", missing=True,
             remedy="take a longer rod or a smaller radius")  # fmt: skip
    def articulated_rods_reach(self) -> Truth:
        """Articulated rods are long enough for a full revolution."""
        return articulated_rods_reach(self.crank)

    @shared
    def crank(self) -> OffsetCrank:
        """Return the mechanisms."""
        carrier = carriers(self.masters, count_of(self.order, self.psi_g, self.phi_g))
        plain = crank_of(self.s, self.r_g, self.l, self.e)
        return with_articulated(plain, carrier, self.rho_a, self.gamma_a, self.beta)

    @shared
    def weight(self) -> Phasor:
        """Return the force of each piston at the orders [N], (…, N, H)."""
        return (self.m_rec * np.asarray(self.omega)[..., None] ** 2)[..., None] * order_amplitudes(
            self.crank, self.h, self.terms == "exact"
        )

    @shared
    def own_wall(self) -> Array:
        """Return the force that each piston exerts on its wall due to its own rod [N]."""
        return wall_force(self.axial, self.rods.excess, self.omega[..., None], self.motion)

    @shared
    def links(self) -> Vectors:
        """Return the force of each rod on its own pin in the cylinder's axes [N], complex."""
        return link_force(self.rods.at_crank, self.omega[..., None], self.motion, self.axial, self.own_wall)

    @shared
    def wall(self) -> Array:
        """Return the wall force of each piston [N], with the reaction of articulated rods on their master."""
        return walls_with_articulated(self.own_wall, self.motion, self.links)

    @shared
    def rod_forces(self) -> Vectors:
        """Return the force of each cylinder's rod on its crankpin, in the cylinder's axes [N], complex."""
        return link_force(self.rods.at_crank, self.omega[..., None], self.motion, self.axial, self.wall)

    @shared
    def big_ends(self) -> Vectors:
        """Return the load of each rod on the pin of its bearing in the engine's axes [N], complex."""
        return on_big_ends(self.pins, self.motion)

    @shared
    def moving(self) -> Parts:
        """Return all moving parts, with their forces on the frame."""
        omega, bank = self.omega[..., None], self.layout.bank
        return Parts(
            piston_shaking(self.m_rec, omega, self.motion, bank)
            + off_the_circle(self.rods.at_crank, omega, self.motion, bank),
            self.places,
            self.rotors,
        )  # fmt: skip
