"""The nine-cylinder generator set of DYREMI (Rao & Singh 1993/94), as far as its inputs survive.

l/r and several masses are missing from the print. From its couples follow m_rot = 20.0 kg, m_rec = 65.0 kg
and n = 4.00: derived, not printed. The crank masses below are one way to m_rot = 20 kg: the rod leaves 40 kg
at the crankpin, and a counterweight of 20 kg at crank radius takes away 20 kg.
"""

INPUTS = {
    "speed": "1000 rpm",
    "stroke": "0.3 m",
    "rod_ratio": 4,
    "bore": "0 mm",
    "counterweight_mass": "20 kg",
    "counterweight_centre": "150 mm",
    "rod_mass": "60 kg",
    "rod_centre": "0.2 m",
    "piston_mass": "45 kg",
    "strokes": 4,
    "gas_cycle": "none",
    "cylinders": 9,
    "firing_order": [1, 7, 4, 2, 8, 6, 3, 9, 5],
    "cylinder_positions": {"value": [0.4 * i for i in range(9)], "unit": "m"},
    "damper_position": "-0.5 m",
    "flywheel_position": "3.8 m",
    "speed_fluctuation": "0.1 %",
    "maximum_acceleration": {"value": 250, "unit": "rpm/s"},
    "damper_inertia": "20 kg*m**2",
    "driven_inertia": "200 kg*m**2",
}
