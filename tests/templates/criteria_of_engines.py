"""Cases of the criteria of whole engines, for `test_criteria_of_families`: inertia alone, by hand.

Each: template, criterion, what differs from the example, limits given, verdict, value and limit.
"""

from math import pi, sqrt

ENGINE, ROLLING, BURNT = ("engine", 2), ("rolling_bearing_life", 1), ("combustion_cycle", 1)
COLD = {"heat_release": "0 J", "inlet_closes": "180 deg"}  # a polytrope of 1.32 from 0.95 bar, by 10.5
STEADY = {"radial_load": "10 kN", "axial_load": "0 N", "reliability": 0.9}  # on 55.3 and 31.5 kN
HOURS = 5.53**3 * 1e6 / (60 * 3000)
NO_GAS = {"gas_cycle": "none", "cylinder_offset": "0 mm", "crank_angle_step": "30 deg"}
RADIUS, SHARE, FACTOR = 0.043, 43 / 145, (4500 * pi / 30) ** 2  # m, r/l, rad²/s²
BIG_END, PISTON = 0.6 * 103 / 145, 0.6 * 42 / 145 + 0.48  # kg
PIN = (BIG_END + PISTON * (1 + SHARE)) * FACTOR * RADIUS  # at top dead centre
MAIN = PIN - 2 * 0.004 * FACTOR  # the middle one: half of two throws, and four webs, half of them each
SHAKING = 4 * PISTON * FACTOR * RADIUS * SHARE / sqrt(1 - SHARE**2)  # where the throws stand across

CASES = [
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
    (BURNT, "peak_pressure", COLD, {"permissible_peak_pressure": "25 bar"}, "met", 0.95 * 10.5**1.32, 25),
    (BURNT, "peak_pressure", COLD, {"permissible_peak_pressure": "20 bar"}, "not_met", 0.95 * 10.5**1.32, 20),
]
