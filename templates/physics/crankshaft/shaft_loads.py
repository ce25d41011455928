"""Loads on a whole crankshaft from rods and unbalances of throws and webs, and rules about its inputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.crankshaft.crank_frame import CrankFrame, CrankSections, Throw
from templates.physics.crankshaft.crank_supports import support_reactions
from templates.physics.crankshaft.main_bearings import (
    ShaftLoads,
    Vectors,
    determinate_loads,
    elastic_loads,
    left_over,
    relative_change,
)

_NONE = np.array(np.nan)
Places = NDArray[np.intp]


def throw_places(places: Array, throw: Places) -> Array:
    """Return the middle of each throw [m]: midway between its outermost cylinders."""
    return np.array([_middle(places[throw == t]) for t in range(int(throw.max()) + 1)])


def _middle(places: Array) -> float:
    return float((places.min() + places.max()) / 2)


def throw_of_web(places: Array, named: Array, middles: Array) -> Places:
    """Return the index of each web's throw: the given one (from 1 in the input), else the nearest one."""
    if np.ndim(named):
        return np.clip(np.rint(named).astype(int) - 1, 0, middles.size - 1)
    return np.argmin(np.abs(places[:, None] - middles), axis=1)


def web_unbalance(
    U: Array, angle: Array, counterweight: Array, its_angle: Array, places: Array, named: Array,
    middles: Array, pins: Array,
) -> Vectors:  # fmt: skip
    """Return the unbalance of webs with counterweights [kg m], complex at crank angle 0, (…, W).

    Angles [rad] are measured from the web's throw; `pins`, (…, T), are the angles of the crankpins.
    """
    vector = U * np.exp(1j * angle) + counterweight * np.exp(1j * its_angle)
    throw = throw_of_web(places, named, middles)
    return np.asarray(vector * np.exp(1j * pins[..., throw]) + np.zeros(places.shape))


def determinate(mains: Array, loads: ShaftLoads) -> Vectors:
    """Return the loads of the mains by the lever rule; a single NaN without mains."""
    return determinate_loads(mains, loads) if np.ndim(mains) else _NONE + 0j


def elastic(mains: Array, loads: ShaftLoads, reactions: Array, theta: Array) -> Vectors:
    """Return the loads of the mains on elastic supports; a single NaN without the crank's sections."""
    return elastic_loads(reactions, loads, theta) if np.ndim(reactions) else _NONE + 0j


def reactions_of(
    mains: Array, cylinders: Array, webs: Array, throw: Places, pins: Array, radius: Array,
    sections: CrankSections, stiffness: Array,
) -> Array:  # fmt: skip
    """Return reactions to unit loads on rods and webs, (…, 2 n, 2 L).

    Supports are rigid if no stiffness is given. `pins` [rad] and `radius` [m] are (…, N): points with
    different cranks are solved separately.
    """
    if not np.ndim(mains) or np.isnan([vars(sections)[n] for n in vars(sections)]).any():
        return _NONE
    if not np.isfinite(pins).all() or not fits(mains, cylinders, throw, sections):
        return _NONE
    vectors = radius * np.exp(1j * pins)
    flat = vectors.reshape(-1, vectors.shape[-1])
    order, middles = np.argsort(cylinders, kind="stable"), throw_places(cylinders, throw)
    places = np.concatenate([cylinders, webs])
    k = np.where(np.isnan(stiffness), np.inf, stiffness) + np.zeros(mains.size)
    found = []
    for one in flat:
        throws = [
            Throw(z, tuple((float(cylinders[j]), complex(one[j]), int(j)) for j in order if throw[j] == t))
            for t, z in enumerate(middles)
        ]
        flexibility = CrankFrame(sections, mains, throws).flexibility(cylinders.size, webs)
        found.append(support_reactions(mains, places, flexibility, k))
    return np.array(found).reshape(*vectors.shape[:-1], *found[0].shape)


def fits(mains: Array, cylinders: Array, throw: Places, sections: CrankSections) -> bool:
    """Return whether rods are on their pins, throws do not overlap, and no main lies within a throw."""
    middles = throw_places(cylinders, throw)
    on_pins = np.abs(cylinders - middles[throw]) < sections.pin_length / 2
    length = sections.pin_length + 2 * sections.web_thickness
    apart = np.diff(np.sort(middles)) > length * (1 - 1e-9)
    clear = np.abs(mains[:, None] - middles) > length / 2 * (1 - 1e-9)
    return bool(on_pins.all() and apart.all() and clear.all())


@units("m", "m", None, None, returns="1")
def crank_fits(mains: Array, cylinders: Array, throw: Places, sections: CrankSections) -> Truth:
    """Return whether the sections, if given, fit between mains and cylinders."""
    if not np.ndim(mains) or np.size(cylinders) != throw.size:
        return True
    if np.isnan([vars(sections)[n] for n in vars(sections)]).any():
        return True
    return fits(mains, np.atleast_1d(cylinders), throw, sections)


@units("N/m", "m", returns="1")
def has_one_for_each_main(stiffness: Array, mains: Array) -> Truth:
    """Return whether the stiffness of the supports is one number, or a list with one value for each main."""
    return np.ndim(stiffness) == 0 or np.ndim(mains) == 0 or np.shape(stiffness) == np.shape(mains)


@units("m", "kg*m", "rad", "kg*m", "rad", "1", None, returns="1")
def webs_are_whole(
    places: Array, unbalance: Array, angle: Array, counterweight: Array, its_angle: Array, throws: Array,
    count: int,
) -> Truth:  # fmt: skip
    """Return whether webs with an unbalance or a list have positions, and named throws exist."""
    if np.ndim(places) == 0:
        listed = any(np.ndim(one) for one in (unbalance, angle, counterweight, its_angle, throws))
        return not listed and bool(unbalance == 0 and counterweight == 0)
    named = np.ndim(throws) == 0 or bool(np.all(throws <= count))
    return np.ndim(places) == 1 and named


@units("kg*m", "kg*m", "kg*m", returns="kg*m")
def greatest_unbalance(throws: Array, webs: Array, counterweights: Array) -> Array:
    """Return the greatest unbalance of throws, webs and counterweights, by its absolute value [kg m]."""
    return np.asarray(max(float(np.max(np.abs(one))) for one in (throws, webs, counterweights)))


@units(None, None, returns="1")
def change_on_supports(elastic_forces: Vectors, determinate_forces: Vectors) -> Array:
    """Return the relative change of each main's greatest load from the determinate one."""
    if not np.ndim(elastic_forces):
        return _NONE
    return relative_change(elastic_forces, determinate_forces)


@units(None, None, "m", returns="1")
def imbalance(forces: Vectors, loads: ShaftLoads, mains: Array) -> Array:
    """Return the largest force or moment that the reactions leave unbalanced, relative to the loads."""
    return left_over(forces, loads, mains) if np.ndim(forces) else _NONE


def on_the_shaft(places: Array, pins: Vectors, webs: Array, spinning: Vectors) -> ShaftLoads:
    """Return the loads of rods and webs together, broadcast over the points."""
    shape = np.broadcast_shapes(pins.shape[:-2], spinning.shape[:-2])
    parts = [np.broadcast_to(one, shape + one.shape[-2:]) for one in (pins, spinning)]
    return ShaftLoads(np.concatenate([places, webs]), np.concatenate(parts, axis=-2))


def spun(unbalance: Vectors, omega: Array, theta: Array) -> Vectors:
    """Return the forces of unbalances [kg m] that rotate with the crank [N], (…, L, K)."""
    return np.asarray(
        (unbalance * np.asarray(omega)[..., None] ** 2)[..., None] * np.exp(1j * theta[..., None, :])
    )


def sections_of(
    journal: Array, pin: Array, pin_length: Array, thickness: Array, width: Array, E: Array, nu: Array,
    torsion: Array,
) -> CrankSections:  # fmt: skip
    """Return the sections of a shaft as plain numbers; NaN if they are not given."""
    sizes = (journal, pin, pin_length, thickness, width, E, nu, torsion)
    return CrankSections(*(float(size) for size in sizes))
