"""Results of a forced response: torque, stress and twist of the shafts, heat, angles, speeds.

A vibratory value is half the range of the curve that is the sum of all orders. The sum of their amplitudes is
larger, by a factor of up to 2.5, because the orders do not peak at the same angle.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.torsion.forced_train import Response
from templates.physics.torsion.torque_harmonics import half_swing

SUMMED = "solved numerically by one linear system for each speed and order, and the curve of their sum"


def _across(values: Array) -> Array:
    """Return an array (…, speed, member) with its last two axes exchanged."""
    return np.asarray(np.swapaxes(values, -1, -2))


@on_paper(SUMMED)
@units(None, returns="N*m")
def vibratory_torque(response: Response) -> Array:
    """Return the vibratory torque of the shafts [N m], (…, S, V)."""
    return _across(half_swing(np.swapaxes(response.shaft_torque, -1, -2)))


@on_paper(SUMMED)
@units(None, returns="rad")
def vibratory_twist(response: Response) -> Array:
    """Return the vibratory twist of the shafts [rad], (…, S, V)."""
    return _across(half_swing(np.swapaxes(response.twist, -1, -2)))


@on_paper(SUMMED)
@units(None, returns="rad")
def vibratory_angle(response: Response) -> Array:
    """Return the vibratory angle of the inertias [rad], (…, n, V)."""
    return _across(half_swing(np.swapaxes(response.angles, -1, -2)))


@units("N*m", "m**3", returns="Pa", latex=r"\frac{{{0}}}{{{1}}}")
def stress_of(torque: Array, section: Array) -> Array:
    """Return the shear stress [Pa] of torques [N m; ..., shaft, speed].

    It is 0 where a shaft's section modulus is 0.
    """
    modulus = np.asarray(section)[..., None] if np.ndim(section) else np.asarray(section)
    return np.asarray(torque / np.where(modulus == 0, np.inf, modulus))


@on_paper("solved numerically by one linear system for each speed and order")
@units(None, returns="N*m")
def amplitudes_of_orders(response: Response) -> Array:
    """Return the amplitude of each order of the shafts' torque [N m], (…, S, V, H)."""
    return np.moveaxis(np.abs(response.shaft_torque), -1, -3)


@units("N*m", returns="N*m", latex=r"\max_{{n}}{0}")
def largest_of_torques(torque: Array) -> Array:
    """Return the largest torque over the speeds [N m], (…, S)."""
    return np.asarray(torque.max(axis=-1))


@units("Pa", returns="Pa", latex=r"\max_{{n}}{0}")
def largest_of_stresses(stress: Array) -> Array:
    """Return the largest stress over the speeds [Pa], (…, S)."""
    return np.asarray(stress.max(axis=-1))


@units("rad", returns="rad", latex=r"\max_{{n}}{0}")
def largest_of_angles(angle: Array) -> Array:
    """Return the largest angle over the speeds [rad], (…, member)."""
    return np.asarray(angle.max(axis=-1))


@units("N*m", "rad/s", returns="rad/s", latex=r"\arg\max_{{n}}{0}")
def speed_of_largest(torque: Array, speeds: Array) -> Array:
    """Return the speed [rad/s] at which each shaft's torque (…, S, V) is largest, (…, S)."""
    at = np.argmax(torque, axis=-1)
    each = np.broadcast_to(np.asarray(speeds)[..., None, :], torque.shape)
    chosen = np.take_along_axis(each, at[..., None], axis=-1)[..., 0]
    return np.where(np.isnan(torque).any(axis=-1), np.nan, chosen)


@units("N*m", "N*m", "1", returns="1", latex=r"\arg\max_{{h}}{1}")
def order_of_largest(torque: Array, amplitudes: Array, orders: Array) -> Array:
    """Return the order that is largest where each shaft's torque is largest, (…, S)."""
    at = np.argmax(torque, axis=-1)[..., None, None]
    there = np.take_along_axis(amplitudes, np.broadcast_to(at, (*at.shape[:-1], orders.size)), axis=-2)
    largest = orders[np.argmax(there[..., 0, :], axis=-1)]
    return np.where(np.isnan(torque).any(axis=-1), np.nan, largest)


@units("N*m", returns="N*m", latex=r"\max_{{s}}{0}")
def torque_envelope(torque: Array) -> Array:
    """Return the largest torque of all shafts [N m], (…, V)."""
    return np.asarray(torque.max(axis=-2))


@units("Pa", returns="Pa", latex=r"\max_{{s}}{0}")
def stress_envelope(stress: Array) -> Array:
    """Return the largest stress of all shafts [Pa], (…, V)."""
    return np.asarray(stress.max(axis=-2))


@units(
    None,
    returns="W",
    latex=r"\sum_{{h}}\tfrac12\left|\Delta\Phi\right|^2 h\omega\left(k\eta+h\omega c\right)",
)
def heat_of_shafts(response: Response) -> Array:
    """Return the power dissipated by the damping of the shafts [W], (…, S, V)."""
    return _across(response.shaft_power)


@units("W", returns="W", latex=r"\max_{{n}}{0}")
def largest_of_powers(power: Array) -> Array:
    """Return the largest power over the speeds [W], (…, S)."""
    return np.asarray(power.max(axis=-1))


@units(None, returns="W", latex=r"\sum_{{h}}\tfrac12\left|\Phi\right|^2\left(h\omega\right)^2c")
def loss_of_inertias(response: Response) -> Array:
    """Return the power dissipated by the damping of the inertias to ground [W], (…, n, V)."""
    return _across(response.ground_power)


@units(None, returns="W", latex=r"\sum_{{h}}\tfrac12 h\omega\,\mathrm{{Im}}\left(\Phi^*T\right)")
def power_put_in(response: Response) -> Array:
    """Return the power input of the varying torque [W], (…, V)."""
    return response.power_in


@units("W", "W", returns="W", latex=r"\sum {0}+\sum {1}")
def power_lost(shafts: Array, inertias: Array) -> Array:
    """Return the power dissipated by all damping [W], (…, V)."""
    return np.asarray(shafts.sum(axis=-2) + inertias.sum(axis=-2))


@units(
    "W",
    "W",
    None,
    returns="1",
    latex=r"\max_{{n}}\frac{{\left|{0}-{1}\right|}}{{\tfrac12\sum h\omega\left|\Phi T\right|}}",
)
def power_error(put_in: Array, lost: Array, response: Response) -> Array:
    """Return the largest difference between input and dissipation over all speeds, (…).

    It is relative to the apparent power. Values below 1e-12 are returned as 0.
    """
    size = response.apparent_power
    error = (np.abs(put_in - lost) / np.where(size == 0, 1, size)).max(axis=-1)
    return np.where(error < 1e-12, 0.0, error)[()]


@units(None, "1", returns="rad/s", latex=r"h\omega\left|\Phi_{{{1}}}\right|")
def speed_spectrum(response: Response, number: Array) -> Array:
    """Return the amplitude of each order, from 1, of one inertia's angular speed [rad/s], (…, V, H)."""
    return np.asarray(response.frequency * np.abs(response.angles[..., int(number) - 1]))


@units(
    None, "1", "rad/s", returns="1", latex=r"\frac{{\omega_{{max}}-\omega_{{min}}}}{{\overline{{\omega}}}}"
)
def irregularity(response: Response, number: Array, speeds: Array) -> Array:
    """Return the range of the angular speed of one inertia, numbered from 1, relative to its mean, (…, V)."""
    at = int(number) - 1
    layout = response.train.layout
    mean = np.abs(np.asarray(speeds) * layout.speeds[at] / layout.speeds[response.train.crank])
    return np.asarray(2 * half_swing(1j * response.frequency * response.angles[..., at]) / mean)
