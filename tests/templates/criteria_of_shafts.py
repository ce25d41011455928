"""Cases for the criteria of shafts, by hand, used by `test_criteria_of_families`.

Each: template, criterion, what differs from the example, limits given, verdict, value and limit.
"""

from math import log10

THROW, FATIGUE = ("crank_stiffness", 1), ("fatigue_life", 1)
K_WILSON = 2.626476e6  # the overlap of the example is 0.13 of the diameters: Ker Wilson alone
OTHERS = ("force_2", "stress_of_force_2", "moment_1", "stress_of_moment_1", "stress_concentration_factor")


def pulled(stress):
    """Reversed tension of so many MPa at one point; 300 MPa are borne for ever, 700 MPa for 1000 cycles."""
    return {**dict.fromkeys(OTHERS), "notch_radius": None, "multiaxial_criterion": "signed_von_mises",
            "force_1": {"value": [1, -1], "unit": "kN"},
            "stress_of_force_1": {"value": [[0, 0, stress, 0, 0, 0]], "unit": "MPa/kN"},
            "endurance_limit": "300 MPa", "strength_at_1000_cycles": "700 MPa"}  # fmt: skip


LIFE = 1e3 * (500 / 700) ** (3 / log10(3 / 7))

CASES = [
    (THROW, "stiffness", {}, {"required_stiffness": "2.5 MN*m/rad"}, "met", K_WILSON, 2.5e6),
    (THROW, "stiffness", {}, {"required_stiffness": "2.7 MN*m/rad"}, "not_met", K_WILSON, 2.7e6),
    (THROW, "reference", {}, {"permissible_difference": 0.02}, "met", K_WILSON - 2.6e6, 52e3),
    (THROW, "reference", {}, {"permissible_difference": "0.5 %"}, "not_met", K_WILSON - 2.6e6, 13e3),
    (FATIGUE, "strength", pulled(500), {}, "met", 500, 650),
    (FATIGUE, "strength", pulled(680), {}, "not_met", 680, 650),
    (FATIGUE, "life", pulled(500), {"required_cycles": 1e4}, "met", 1e4 / LIFE, 1),
    (FATIGUE, "life", pulled(500), {"required_cycles": 1e5}, "not_met", 1e5 / LIFE, 1),
    (FATIGUE, "safety", pulled(200), {"required_safety_factor": 1.4}, "met", 1.5, 1.4),
    (FATIGUE, "safety", pulled(200), {"required_safety_factor": 2}, "not_met", 1.5, 2),
]
