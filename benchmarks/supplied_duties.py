"""Random duties of supplied bearings: loads of engines and Fourier loads, with every kind of supply.

Dimensionless, as `templates/physics/supplied/supplied_orbit.py` takes them. Half of the duties are engines:
a big end or a main bearing of an idealised two- or four-stroke cylinder, seen from the block; the other half
are Fourier loads with or without a firing. Load number 0.3 … 105, B/D 0.15 … 1.2, supply pressure 0.02 … 1.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.supplied.supply import Pocket, Supply

SUPPLIES = ("pin_hole", "sleeve_hole", "slot", "half_groove", "full_groove")
GROOVES = ("half_groove", "full_groove")
POINTS = 180
SMALLEST, LARGEST = 0.3, 105.0
"""Load numbers [-]."""


@dataclass(frozen=True)
class RandomDuty:
    """One duty and its origin."""

    load: CyclicLoad
    sliding: Array
    ratio: float
    supply: Supply
    kind: str
    """Kind of the load: big_end_2, big_end_4, main_2, main_4 or fourier."""
    fed_by: str
    """One of SUPPLIES."""


def random_duty(seed: int, number: int, fed_by: str | None = None) -> RandomDuty:
    """Return a duty; even numbers are engines, and the kinds of supply alternate unless one is given."""
    rng = np.random.default_rng([seed, number])
    fed_by = SUPPLIES[(number // 2) % len(SUPPLIES)] if fed_by is None else fed_by
    kind, load, sliding = _engine(rng) if number % 2 == 0 else _fourier(rng)
    ratio = float(np.exp(rng.uniform(np.log(0.15), np.log(1.2))))
    return RandomDuty(load, sliding, ratio, _supply(rng, fed_by), kind, fed_by)


def _supply(rng: np.random.Generator, fed_by: str) -> Supply:
    pressure = float(np.exp(rng.uniform(np.log(0.02), 0.0)))
    centre, small = float(rng.uniform(-np.pi, np.pi)), float(np.radians(rng.uniform(3, 10)))
    half_angle, lengths = {
        "pin_hole": (small, (0.1, 0.35)),
        "sleeve_hole": (small, (0.1, 0.35)),
        "slot": (float(np.radians(rng.uniform(5, 15))), (0.5, 0.85)),
        "half_groove": (np.pi / 2, (0.1, 0.3)),
        "full_groove": (np.pi, (0.1, 0.3)),
    }[fed_by]
    return Supply((Pocket(centre, half_angle, float(rng.uniform(*lengths)), fed_by == "pin_hole"),), pressure)


def _engine(rng: np.random.Generator) -> tuple[str, CyclicLoad, Array]:
    """Return the load of the journal on a big end or a main bearing, in the axes of the block."""
    strokes, big = int(rng.choice([2, 4])), bool(rng.random() < 0.6)
    period = strokes * np.pi
    theta = np.arange(POINTS) * period / POINTS
    rod, gas, turning = rng.uniform(3, 5), rng.uniform(1, 8), rng.uniform(0.3, 1.0)
    late, rise, fall = rng.uniform(0.1, 0.3), rng.uniform(0.15, 0.3), rng.uniform(0.4, 0.8)
    swing = -np.cos(theta) / np.sqrt(rod**2 - np.sin(theta) ** 2)

    def on_pin(at: Array) -> Array:
        after = (at - late + period / 2) % period - period / 2
        fires = gas * np.exp(-((after / np.where(after < 0, rise, fall)) ** 2))
        along = np.cos(at) + np.cos(2 * at) / rod - fires
        force = along * (1 - 1j * np.tan(np.arcsin(np.sin(at) / rod))) + turning * np.exp(1j * at)
        return np.asarray(-force)

    if big:
        F, mean, sliding = on_pin(theta), (1 + swing) / 2, 1 - swing
    else:
        apart, share = rng.choice([1 / 4, 1 / 3, 1 / 2]) * period, rng.uniform(0, 0.6)
        F = -(on_pin(theta) + on_pin(theta - apart)) / 2 - share * np.exp(1j * theta)
        mean, sliding = np.full(POINTS, 0.5), np.ones(POINTS)
    return f"{'big_end' if big else 'main'}_{strokes}", _scaled(rng, theta, period, F, mean), sliding


def _fourier(rng: np.random.Generator) -> tuple[str, CyclicLoad, Array]:
    """Return a load of random harmonics, half of them with a firing; the sleeve is fixed."""
    period = float(rng.choice([2, 4]) * np.pi)
    theta = np.arange(POINTS) * period / POINTS
    order = np.arange(6)
    size = rng.normal(size=(6, 4)) / (1 + order[:, None]) * (rng.random((6, 1)) < 0.7)
    wave = np.exp(2j * np.pi / period * np.outer(order, theta))
    F = (size[:, 0] + 1j * size[:, 1]) @ wave + (size[:, 2] + 1j * size[:, 3]) @ wave.conj()
    if rng.random() < 0.5:
        at, width = rng.uniform(0, period), rng.uniform(0.2, 0.6)
        off = (theta - at + period / 2) % period - period / 2
        F = F + 4 * np.exp(1j * rng.uniform(-np.pi, np.pi)) * np.exp(-((off / width) ** 2))
    F = F + 0.3 * np.exp(1j * rng.uniform(-np.pi, np.pi))
    return "fourier", _scaled(rng, theta, period, F, np.full(POINTS, 0.5)), np.ones(POINTS)


def _scaled(rng: np.random.Generator, theta: Array, period: float, F: Array, mean: Array) -> CyclicLoad:
    """Return a load of random size."""
    F = F / np.abs(F).max() * np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST)))
    return CyclicLoad(theta, float(period), np.stack([F.real, F.imag])[:, None], mean[None])
