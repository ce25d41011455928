"""Random whole engines of every kind against rigid bodies whose motion is differentiated by Fourier series.

The other side of these tests knows geometry alone: where crankpin, rod and piston are at each angle. Newton's
and Euler's laws then give all forces. It shares no formula with the template.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from templates.bearing_load.engine_v1 import Engine
from templates.core.language.evaluate import evaluate

KINDS = ("one", "in line", "twin 270", "boxer", "V-twin 45", "V-twin 90", "V", "V12", "split pins")
CRANKCASE, STEPS, PITCH = 1.1e5, 360, 0.1
OUTPUTS = (
    "crankpin_angles", "gas_pressure", "crankpin_load_x", "crankpin_load_y", "main_load_x", "main_load_y",
    "shaking_force_x", "shaking_force_y", "shaking_moment_x", "shaking_moment_y", "torque",
    "equilibrium_residual",
)  # fmt: skip


class Layout(NamedTuple):
    """Of each cylinder: bank [rad], throw from 0, place [m], firing angle [deg]; cycle [deg]."""

    bank: Any
    throw: Any
    place: Any
    firing: Any
    cycle: float


def random_layout(kind: str, rng: np.random.Generator, top: Any, cycle: float, count: int) -> Layout:
    """Throws at random angles; banks of either sense, fork rods or rods side by side."""
    paired = kind.startswith(("V", "split"))
    half = {"V-twin 45": 22.5, "V-twin 90": 45.0}.get(kind, float(rng.choice([30, 36, 45])))
    side = np.where(np.arange(count) % 2 == 0, 1, -1)
    bank = np.radians(half) * side * rng.choice([-1, 1]) if paired else np.zeros(count)
    if kind == "boxer":
        bank = np.where(side > 0, 0, np.pi)
    throw = np.arange(count) // 2 if paired else np.arange(count)
    apart = 0.0 if paired and rng.random() < 0.5 and kind != "split pins" else 0.008
    place = PITCH * (throw + 0.5) - (apart * side if paired else 0)
    firing = rng.permutation(np.round(rng.uniform(0, cycle, count), 3))
    if paired and kind != "split pins":  # one pin a throw says when the second of its cylinders is on top
        pin = (bank - np.radians(firing) + top)[::2]
        later = rng.choice([0, 360], count // 2) if cycle > 360 else 0
        firing[1::2] = np.degrees(bank[1::2] + top[1::2] - pin) % 360 + later
    return Layout(bank, throw, place, firing, cycle)


def derivative(values: Any) -> Any:
    """By the crank angle, of a function over one turn, by Fourier series."""
    order = np.fft.fftfreq(STEPS, 1 / STEPS)
    order[STEPS // 2] = 0
    return np.fft.ifft(1j * order * np.fft.fft(values))


def forces(raw: dict[str, Any], layout: Layout, pin_angle: Any, pressure: Any, omega: float) -> Any:
    """Rod on pin, and with what turns there [N]; on the frame [N], its couple [N m]; torque [N m]."""
    turns = round(layout.cycle / 360)
    theta = np.arange(STEPS) * 2 * np.pi / STEPS
    size = {name: value["value"] for name, value in raw.items() if isinstance(value, dict)}
    loads, shaking, couple, torque = [], 0j, 0j, 0.0
    for j, bank in enumerate(layout.bank):
        r, length, e, bore, m_rod, centre, inertia, m_piston, unbalance = (
            size[name][j] for name in ("crank_radius", "rod_length", "cylinder_offset", "bore", "rod_mass",
                                       "rod_centre", "rod_inertia", "piston_mass", "crank_unbalance")
        )  # fmt: skip
        pin = r * np.exp(1j * (theta + pin_angle[j] - bank))
        rod = np.sqrt(length**2 - (e - pin.imag) ** 2) + 1j * (e - pin.imag)
        piston = (pin + rod).real
        rod_force = m_rod * derivative(derivative(pin + centre / length * rod)) * omega**2
        piston_force = m_piston * derivative(derivative(piston)).real * omega**2
        moment = inertia * derivative(derivative(np.angle(rod))).real * omega**2
        moment = moment + (np.conj(centre / length * rod) * rod_force).imag
        gas = (pressure[j] * raw["pressure_factor"][j] - CRANKCASE) * np.pi * bore**2 / 4
        pin, rod, rod_force, piston_force, moment = (
            np.tile(one, turns) for one in (pin, rod, rod_force, piston_force, moment)
        )
        along = piston_force + gas  # of the rod on the piston; across it the rod's moments balance
        across = (rod.imag * along - moment) / rod.real
        on_pin = -(rod_force + along + 1j * across)
        loads.append(on_pin * np.exp(1j * bank))
        torque = torque + (np.conj(pin) * on_pin).imag
        turning = unbalance * omega**2 * np.exp(1j * (np.tile(theta, turns) + pin_angle[j]))
        on_frame = turning - (rod_force + piston_force) * np.exp(1j * bank)
        shaking, couple = shaking + on_frame, couple + layout.place[j] * on_frame
        loads[-1] = np.stack([loads[-1], loads[-1] + turning])
    pins, on_shaft = np.stack(loads, axis=1)
    return pins, on_shaft, shaking, couple, torque


def on_mains(on_shaft: Any, place: Any, mains: Any) -> Any:
    """Of each load on the two mains beside it, by the lever; frame on shaft."""
    found = np.zeros((len(mains), on_shaft.shape[1]), complex)
    for load, z in zip(on_shaft, place, strict=True):
        left = int(z // PITCH)
        share = (z - mains[left]) / PITCH
        found[left] -= load * (1 - share)
        found[left + 1] -= load * share
    return found


def engine(kind: str, seed: int) -> tuple[dict[str, Any], Layout]:
    """Inputs of a random engine, every cylinder different."""
    rng = np.random.default_rng(seed)
    count = {"one": 1, "twin 270": 2, "V-twin 45": 2, "V-twin 90": 2, "V12": 12, "split pins": 6}.get(kind, 0)
    count = count or int(rng.choice([4, 6, 8])) - (kind == "in line")
    strokes = int(rng.choice([2, 4]))
    ranges = {
        "crank_radius": ("m", 0.04, 0.05), "rod_length": ("m", 0.14, 0.17),
        "cylinder_offset": ("m", -0.008, 0.008), "bore": ("m", 0.07, 0.1), "rod_mass": ("kg", 0.3, 1.3),
        "rod_centre": ("m", 0.02, 0.07), "rod_inertia": ("kg*m**2", 0.001, 0.01),
        "piston_mass": ("kg", 0.3, 1.3), "crank_unbalance": ("kg*m", -0.02, 0.05),
    }  # fmt: skip
    raw: dict[str, Any] = {
        name: {"value": rng.uniform(low, high, count).tolist(), "unit": unit}
        for name, (unit, low, high) in ranges.items()
    }
    r, length, e = (np.array(raw[n]["value"]) for n in ("crank_radius", "rod_length", "cylinder_offset"))
    layout = random_layout(kind, rng, np.arcsin(e / (length + r)), 180.0 * strokes, count)
    if kind == "twin 270":
        layout = layout._replace(firing=np.array([0.0, 270.0]))
    mains = PITCH * np.arange(layout.throw.max() + 2)
    raw |= {
        "speed": f"{rng.uniform(500, 9000)} rpm", "strokes": strokes, "crank_angle_step": "1 deg",
        "bank_angles": {"value": np.degrees(layout.bank).tolist(), "unit": "deg"},
        "throws": (layout.throw + 1).tolist(), "reference_position": "0 m",
        "cylinder_positions": {"value": layout.place.tolist(), "unit": "m"},
        "firing_angles": {"value": layout.firing.tolist(), "unit": "deg"}, "orders": [1, 2],
        "pressure_factor": rng.uniform(0.5, 1.5, count).tolist(), "gas_cycle": "otto",
        "suction_pressure": "1 bar", "compression_ratio": 9, "combustion_pressure": "60 bar",
        "crankcase_pressure": {"value": CRANKCASE, "unit": "Pa"},
        "main_positions": {"value": mains.tolist(), "unit": "m"},
        "pins_of_a_throw": "split" if kind == "split pins" else "shared",
    }  # fmt: skip
    return raw, layout


def off(found: Any, wanted: Any) -> float:
    """The largest deviation, relative to the largest value."""
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())


def check(kind: str, seed: int) -> None:
    raw, layout = engine(kind, seed)
    answer = evaluate(Engine, raw, outputs=OUTPUTS).outputs
    out = {name: np.asarray(one.value) for name, one in answer.items()}
    pins, mains, shaking, moment = (
        out[f"{name}_x"] + 1j * out[f"{name}_y"]
        for name in ("crankpin_load", "main_load", "shaking_force", "shaking_moment")
    )
    angle = np.radians(out["crankpin_angles"])
    e, length, r = (np.array(raw[n]["value"]) for n in ("cylinder_offset", "rod_length", "crank_radius"))
    expected = layout.bank - np.radians(layout.firing) + np.arcsin(e / (length + r))
    assert np.exp(1j * angle) == pytest.approx(np.exp(1j * expected), abs=1e-12)
    omega = float(raw["speed"].split()[0]) * np.pi / 30
    wanted = forces(raw, layout, angle, np.atleast_2d(out["gas_pressure"]) * 1e5, omega)
    places = raw["main_positions"]["value"]
    assert off(pins, wanted[0]) < 2e-9
    assert off(mains, on_mains(wanted[1], layout.place, places)) < 2e-9
    assert off(shaking, wanted[2]) < 2e-9
    assert off(moment, 1j * wanted[3]) < 2e-9
    assert off(out["torque"], wanted[4]) < 2e-9
    assert out["equilibrium_residual"] < 1e-10


@pytest.mark.parametrize("seed", [18, 19])
@pytest.mark.parametrize("kind", KINDS)
def test_property_engine_has_the_forces_of_its_rigid_bodies(kind: str, seed: int) -> None:
    check(kind, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("kind", KINDS)
def test_property_many_engines_have_the_forces_of_their_rigid_bodies(kind: str, seed: int) -> None:
    check(kind, seed)
