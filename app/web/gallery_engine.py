"""A design to start from: a four-cylinder engine, a film in each of its nine bearings, its crankshaft."""

from __future__ import annotations

from pydantic import JsonValue

_ENGINE: dict[str, JsonValue] = {
    "speed": "4500 rpm",
    "strokes": 4,
    "crank_angle_step": "5 deg",
    "firing_order": [1, 3, 4, 2],
    "cylinder_positions": {"value": [47, 141, 235, 329], "unit": "mm"},
    "stroke": "86 mm",
    "rod_length": "145 mm",
    "bore": "= bore",
    "rod_mass": "0.6 kg",
    "rod_centre": "42 mm",
    "rod_inertia": "2200 kg*mm**2",
    "piston_mass": "0.48 kg",
    "gas_cycle": "four_stroke",
    "suction_pressure": "0.9 bar",
    "exhaust_pressure": "1.1 bar",
    "compression_ratio": 10,
    "compression_exponent": 1.32,
    "expansion_exponent": 1.28,
    "combustion_pressure": "60 bar",
    "cutoff": 1.15,
    "inlet_closes": "222 deg",
    "exhaust_opens": "492 deg",
    "crankcase_pressure": "1 bar",
    "main_positions": {"value": [0, 94, 188, 282, 376], "unit": "mm"},
    "web_positions": {"value": [22, 72, 116, 166, 210, 260, 304, 354], "unit": "mm"},
    "web_unbalance": "12 kg*mm",
    "counterweights": "16 kg*mm",
    "support_stiffness": "500 kN/mm",
    "journal_diameter": "55 mm",
    "crankpin_diameter": "48 mm",
    "crankpin_length": "32 mm",
    "web_thickness": "18 mm",
    "web_width": "80 mm",
}
_CRANKSHAFT: dict[str, JsonValue] = {
    "pin_angles": "= engine.crankpin_angles",
    "journal_diameter": "= engine.journal_diameter",
    "journal_length": "= engine.main_positions[2] - engine.main_positions[1] - engine.crankpin_length"
    " - 2 * engine.web_thickness",
    "pin_diameter": "= engine.crankpin_diameter",
    "pin_length": "= engine.crankpin_length",
    "web_thickness": "= engine.web_thickness",
    "web_width": "= engine.web_width",
    "throw": "= engine.stroke / 2",
    "fillet": "2.5 mm",
    "oil_drilling_diameter": "5 mm",
    "counterweight_radius": {"value": [72, 0, 0, 72, 72, 0, 0, 72], "unit": "mm"},
    "flange_diameter": "90 mm",
    "bolt_hole_diameter": "10 mm",
}
_OUTPUTS: list[JsonValue] = [
    "layout", "crankpin_angles", "mean_torque", "crankpin_load_max", "main_load_max", "elastic_main_load_max",
    "elastic_difference", "governing_elastic_main",
]  # fmt: skip
_MAINS: dict[str, JsonValue] = {f"main_{n}": {"bearing": f"{n}"} for n in range(1, 6)}
_BIG_ENDS: dict[str, JsonValue] = {
    f"big_end_{n}": {
        "bearing": f"{n}",
        "film.load_x": "= engine.crankpin_load_x[bearing]",
        "film.load_y": "= engine.crankpin_load_y[bearing]",
        "film.sleeve_speed": "= engine.rod_angular_velocity[bearing]",
        "film.bearing_diameter": "= engine.crankpin_diameter + film.diametral_clearance",
    }
    for n in range(1, 5)
}

FOUR_CYLINDERS: dict[str, JsonValue] = {
    "name": "bearings of a four-cylinder engine",
    "parameters": {"bore": "86 mm", "bearing": "3"},
    "steps": {
        "engine": {"template": "engine", "version": 2, "inputs": _ENGINE, "outputs": _OUTPUTS},
        "film": {
            "template": "oil_film_cycle",
            "version": 2,
            "level": "mobility",
            "inputs": {
                "crank_angle": "= engine.crank_angle",
                "load_x": "= engine.elastic_main_load_x[bearing]",
                "load_y": "= engine.elastic_main_load_y[bearing]",
                "load_sense": "sleeve_on_journal",
                "speed": "= engine.speed",
                "bearing_diameter": "= engine.journal_diameter + film.diametral_clearance",
                "bearing_width": "20 mm",
                "diametral_clearance": "0.055 mm",
                "dynamic_viscosity": "10 mPa*s",
                "permissible_film": "1 um",
            },
        },
    },
    "models": {
        "shell": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {
                "inner_diameter": "= film.bearing_diameter",
                "width": "= film.bearing_width",
                "shell": "half",
            },
        },
        "crankshaft": {"id": "crankshaft", "version": 2, "parameters": _CRANKSHAFT},
    },
    "variants": {**_MAINS, **_BIG_ENDS},
}
