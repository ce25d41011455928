"""Cases for the criteria of whole engines (inertia alone, by hand), used by `test_criteria_of_families`.

Each: template, criterion, what differs from the example, limits given, verdict, value and limit.
"""

from math import cos, pi, sqrt

from benchmarks.in_line_four import IN_LINE_FOUR

ENGINE, ROLLING, BURNT = ("engine", 1), ("rolling_bearing_life", 1), ("combustion_cycle", 1)
TWIST, BESIDE = ("forced_torsion", 1), ("measured_curves", 1)
# One inertia on a shaft to the ground in resonance at 200 rad/s: 1 N m over a loss factor of 0.01.
TONE = {
    **dict.fromkeys([
        "shaft_damping", "gear_from", "gear_to", "gear_ratios", "absolute_damping", "propeller_inertia",
        "propeller_torque", "propeller_speed", "inertia_torque", "inertia_speed",
    ]),
    "inertias": {"value": [0.5], "unit": "kg*m**2"}, "shaft_from": [1], "shaft_to": [0],
    "shaft_stiffness": {"value": [20], "unit": "kN*m/rad"}, "loss_factors": [0.01],
    "section_moduli": {"value": [5], "unit": "cm**3"}, "excited_inertias": [1],
    "firing_angles": {"value": [0], "unit": "deg"}, "highest_order": 1, "observed_inertia": 1,
    "crank_angle": {"value": list(range(0, 360, 45)), "unit": "deg"},
    "gas_torque": {"value": [cos(pi / 4 * i) for i in range(8)], "unit": "N*m"},
    "speeds": {"value": [100, 200], "unit": "rad/s"},
}  # fmt: skip
RESONANT = sqrt(1 + 0.01**2) / 0.01  # N m
OUTSIDE, INSIDE = (
    {"lowest_running_speed": "0 rpm", "highest_running_speed": highest}
    for highest in ("1000 rpm", "3000 rpm")
)
COLD = {"heat_release": "0 J", "inlet_closes": "180 deg"}  # a polytrope of 1.32 from 0.95 bar, by 10.5
STEADY = {"radial_load": "10 kN", "axial_load": "0 N", "reliability": 0.9}  # on 55.3 and 31.5 kN
HOURS = 5.53**3 * 1e6 / (60 * 3000)
NO_GAS = {
    **dict.fromkeys([
        "masters", "articulation_radius", "articulation_angle", "pin_angles", "bank_angles", "throws",
        "crank_radius",
    ]),
    **IN_LINE_FOUR, "gas_cycle": "none", "cylinder_offset": "0 mm", "crank_angle_step": "30 deg",
}  # fmt: skip
RADIUS, SHARE, FACTOR = 0.043, 43 / 145, (4500 * pi / 30) ** 2  # m, r/l, rad²/s²
BIG_END, PISTON = 0.6 * 103 / 145, 0.6 * 42 / 145 + 0.48  # kg
PIN = (BIG_END + PISTON * (1 + SHARE)) * FACTOR * RADIUS  # at top dead centre
MAIN = PIN - 2 * 0.004 * FACTOR  # the middle one: half of two throws, and four webs, half of them each
SHAKING = 4 * PISTON * FACTOR * RADIUS * SHARE / sqrt(1 - SHARE**2)  # where the throws stand across


# The example of measured_curves, measured at the calculated angles: differences of 0.3 and −0.4 um, by hand.
AT_ANGLES = {
    "measured_shift": "-10 deg",
    "calculated_film": {"value": [3, 4, 6, 5, 2, 3, 4, 4], "unit": "um"},
    "measured_film": {"value": [3.3, 3.6, 6, 5, 2, 3, 4, 4], "unit": "um"},
    "calculated_speed": {"value": [1500] * 8, "unit": "rpm"},
    "measured_speed": {"value": [1503, 1496, *[1500] * 6], "unit": "rpm"},
    "calculated_strain": {"value": [0] * 8, "unit": "1"},
    "measured_strain": {"value": [3e-4, -4e-4, *[0] * 6], "unit": "1"},
}
RMS = sqrt((0.3**2 + 0.4**2) / 8)
COMPARED = [
    (BESIDE, f"{by}_{what}", AT_ANGLES, {f"permissible_{by}_{what}_difference": limit}, verdict, value, bound)
    for by, value_of in (("rms", RMS), ("largest", 0.4))
    for what, unit, scale in (("film", "um", 1), ("speed", "rpm", 10), ("strain", "1", 1e-3))
    for share, verdict in ((1.1, "met"), (0.9, "not_met"))
    for value in (value_of * scale,)
    for bound in (share * value,)
    for limit in (f"{bound:.12g} {unit}",)
]

CASES = [
    *COMPARED,
    (ENGINE, "crankpin_load", NO_GAS, {"permissible_crankpin_load": "14 kN"}, "met", PIN, 14e3),
    (ENGINE, "crankpin_load", NO_GAS, {"permissible_crankpin_load": "5 kN"}, "not_met", PIN, 5e3),
    (ENGINE, "main_load", NO_GAS, {"permissible_main_load": "14 kN"}, "met", MAIN, 14e3),
    (ENGINE, "main_load", NO_GAS, {"permissible_main_load": "5 kN"}, "not_met", MAIN, 5e3),
    (ENGINE, "shaking_force", NO_GAS, {"permissible_shaking_force": "9 kN"}, "met", SHAKING, 9e3),
    (ENGINE, "shaking_force", NO_GAS, {"permissible_shaking_force": "5 kN"}, "not_met", SHAKING, 5e3),
    (ROLLING, "life", STEADY, {"required_life": "900 h"}, "met", HOURS, 900),
    (ROLLING, "life", STEADY, {"required_life": "1000 h"}, "not_met", HOURS, 1000),
    (ROLLING, "static_safety", STEADY, {"required_static_safety": 2}, "met", 3.15, 2),
    (ROLLING, "static_safety", STEADY, {"required_static_safety": 4}, "not_met", 3.15, 4),
    (TWIST, "torque", TONE, {"permissible_vibratory_torque": "101 N*m"}, "met", RESONANT, 101),
    (TWIST, "torque", TONE, {"permissible_vibratory_torque": "99 N*m"}, "not_met", RESONANT, 99),
    (TWIST, "stress", TONE, {"permissible_vibratory_stress": "21 MPa"}, "met", RESONANT / 5, 21),
    (TWIST, "stress", TONE, {"permissible_vibratory_stress": "19 MPa"}, "not_met", RESONANT / 5, 19),
    (TWIST, "heat", TONE, {"permissible_shaft_heat": "0.6 W"}, "met", 200 / (2 * 200), 0.6),
    (TWIST, "heat", TONE, {"permissible_shaft_heat": "0.4 W"}, "not_met", 200 / (2 * 200), 0.4),
    (TWIST, "separation", TONE, OUTSIDE, "met", 200 * 30 / pi - 500, 500),
    (TWIST, "separation", TONE, INSIDE, "not_met", 200 * 30 / pi - 1500, 1500),
    (BURNT, "peak_pressure", COLD, {"permissible_peak_pressure": "25 bar"}, "met", 0.95 * 10.5**1.32, 25),
    (BURNT, "peak_pressure", COLD, {"permissible_peak_pressure": "20 bar"}, "not_met", 0.95 * 10.5**1.32, 20),
]
