"""Torsion and life of the gallery's engines: the train of inertias, and the throw next to the flywheel.

The stiffness of the throws and the stress tensors of their fillets come from finite-element analyses of the
design's crankshaft. The inertia of the throws comes from its solid and from the masses on its pins. The
values of the nose, flywheel, clutch and damper are assumed, and are usual for such an engine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pydantic import JsonValue

THROWS = 4
STIFFNESS = "crankshaft.chain.throw_stiffnesses"  # stiffness of each throw between the centres of its mains
TENSORS = "crankshaft.unit_loads.stress_of_"
FIRST = 3  # number of the inertia of throw 1, after the damper's ring and hub
_SHAFTS = THROWS + 3
_MASS_ON_PIN = (
    "engine.rod_mass * (1 - engine.rod_centre / engine.rod_length)"
    " + (engine.piston_mass + engine.rod_mass * engine.rod_centre / engine.rod_length) / 2"
)


@dataclass(frozen=True)
class Train:
    """The data in which the engines of the gallery differ."""

    bank: str  # of cylinder 1 [a relation]
    per_throw: int  # cylinders on each pin
    ring: str  # inertia of the damper's ring
    flywheel: str  # inertia

    def on(self, throw: int) -> Sequence[int]:
        """Return the cylinders on a throw, counted from 1."""
        return [self.per_throw * (throw - 1) + n + 1 for n in range(self.per_throw)]


def parameters(train: Train) -> dict[str, JsonValue]:
    """Return the parameters that both steps use: cylinder torque, loads of throws, twisting moments."""
    last = THROWS
    torques = {f"torque_{k}": _torque(train, k) for k in range(1, last)}
    front = " + ".join(torques)
    return {
        "damping": "6 N*m*s/rad",
        "radius": "= engine.stroke / 2",
        "throw_inertia": f"= crankshaft.polar_inertia / {THROWS} + {train.per_throw} * ({_MASS_ON_PIN})"
        " * radius**2",
        "turn": "= engine.crank_angle + engine.crankpin_angles[1]",
        "swing": f"= turn - {train.bank}",
        "lean": "= radius / engine.rod_length * sin(swing)",
        "gas_torque": "= (engine.gas_pressure[1] - engine.crankcase_pressure) * pi / 4 * engine.bore**2"
        " * radius * (sin(swing) + cos(swing) * lean / sqrt(1 - lean**2))",
        "inertia_torque": "= radius * (engine.crankpin_load_y[1] * cos(turn)"
        " - engine.crankpin_load_x[1] * sin(turn)) - gas_torque",
        **torques,
        "front_torque": f"= {front}",
        "torque_swing": f"= torsion.largest_torque[{FIRST + last - 2}]"
        " / ((max(front_torque) - min(front_torque)) / 2)",
        "pin_turn": f"= engine.crank_angle + engine.crankpin_angles[{train.on(last)[0]}]",
        "pin_x": f"= {_load('x', train.on(last))}",
        "pin_y": f"= {_load('y', train.on(last))}",
    }


def _load(axis: str, cylinders: Sequence[int]) -> str:
    """Return the load of the rods on a pin."""
    return " + ".join(f"engine.crankpin_load_{axis}[{n}]" for n in cylinders)


def _torque(train: Train, throw: int) -> str:
    """Return the torque of the rods on a pin about the shaft, over the cycle."""
    cylinders = train.on(throw)
    angle = f"engine.crank_angle + engine.crankpin_angles[{cylinders[0]}]"
    x, y = _load("x", cylinders), _load("y", cylinders)
    return f"= radius * (({y}) * cos({angle}) - ({x}) * sin({angle}))"


def steps(train: Train) -> dict[str, JsonValue]:
    """Return two steps: forced torsion of the train, and life of the throw next to the flywheel."""
    return {"torsion": _torsion(train), "life": _life()}


def analyses() -> dict[str, JsonValue]:
    """Return the analyses of the crankshaft: the stiffness of each throw, and stress tensors at its fillets.

    The stiffness between bearings differs less between `coarse` and `fine` than between formulas, so the
    cheap level is sufficient. Stresses of `coarse` are up to a third too low.
    """
    return {
        "chain": {"level": "coarse", "boundary": "guided_end"},
        "unit_loads": {"level": "default"},
    }


def _between(throw: int) -> str:
    """Return the stiffness from the pin of one throw to that of the next: half of each throw, in series."""
    this, following = (f"{STIFFNESS}[{n}]" for n in (throw, throw + 1))
    return f"= 2 * {this} * {following} / ({this} + {following})"


def _torsion(train: Train) -> dict[str, JsonValue]:
    throws: list[JsonValue] = [_between(k) for k in range(1, THROWS)]
    still: list[JsonValue] = ["0 N*m*s/rad"] * (_SHAFTS - 2)
    section = "= pi / 16 * engine.crankpin_diameter**3"
    cylinders: list[JsonValue] = [FIRST + k - 1 for k in range(1, THROWS + 1) for _ in train.on(k)]
    return {
        "template": "forced_torsion",
        "version": 1,
        "inputs": {
            "inertias": [
                train.ring, "0.008 kg*m**2", *["= throw_inertia"] * THROWS, train.flywheel, "0.05 kg*m**2",
            ],
            "shaft_from": list(range(1, _SHAFTS + 1)),
            "shaft_to": list(range(2, _SHAFTS + 2)),
            "shaft_stiffness": [
                "0 kN*m/rad", "300 kN*m/rad", *throws, f"= 2 * {STIFFNESS}[{THROWS}]", "1 kN*m/rad",
            ],
            "shaft_damping": ["= damping", *still, "2 N*m*s/rad"],
            "loss_factors": [0, *[0.005] * (_SHAFTS - 2), 0.1],
            "section_moduli": ["0 cm**3", *[section] * (_SHAFTS - 2), "0 cm**3"],
            "absolute_damping": {"value": [0, 0, *[0.3] * THROWS, 0, 0.5], "unit": "N*m*s/rad"},
            "excited_inertias": cylinders,
            "firing_angles": "= engine.ignition_angles",
            "crank_angle": "= engine.crank_angle",
            "gas_torque": "= gas_torque",
            "inertia_torque": "= inertia_torque",
            "inertia_speed": "= engine.speed",
            "highest_order": 12,
            "speeds": {"value": list(range(1000, 6001, 100)), "unit": "rpm"},
        },
        "limits": {"permissible_vibratory_stress": "60 MPa", "permissible_shaft_heat": "800 W"},
        "outputs": [
            "natural_frequencies", "engine_orders", "mode_shapes", "torque_envelope", "stress_envelope",
            "largest_torque", "largest_stress", "worst_speed", "worst_order", "largest_shaft_heat",
            "power_balance_error",
        ],
    }  # fmt: skip


def _life() -> dict[str, JsonValue]:
    return {
        "template": "fatigue_life",
        "version": 1,
        "inputs": {
            "force_1": "= pin_x * cos(pin_turn) + pin_y * sin(pin_turn)",
            "force_2": "= pin_y * cos(pin_turn) - pin_x * sin(pin_turn)",
            "moment_1": "= mean(front_torque) + (front_torque - mean(front_torque)) * torque_swing",
            "stress_of_force_1": f"= {TENSORS}force_1",
            "stress_of_force_2": f"= {TENSORS}force_2",
            "stress_of_moment_1": f"= {TENSORS}moment_1",
            "ultimate_strength": "850 MPa",
            "yield_strength": "600 MPa",
            "surface": "ground",
            "diameter": "= engine.crankpin_diameter",
            "reliability": 0.99,
        },
        "limits": {"required_safety_factor": 1.3, "required_cycles": 1e9},
        "outputs": [
            "safety_factor", "load_use", "damage", "life", "governing_point",
            "equivalent_amplitude", "greatest_von_mises",
        ],
    }  # fmt: skip
