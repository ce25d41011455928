"""Example designs: an in-line four and a V8, from the bore of their cylinders to verdicts.

Each calculates loads, the film in each bearing, shells, the crankshaft, finite elements of its throws,
torsion of the train, and the life of the shaft's fillets.
"""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import JsonValue

from app.designs.gallery import train as gallery_train
from app.designs.gallery.engine_bearings import SHELL, Bearing, bearings, film_step
from app.designs.gallery.train import THROWS, Train
from templates.groups.petrol_engine import IN_LINE_FOUR

FOUR: dict[str, JsonValue] = {**IN_LINE_FOUR, "crank_angle_step": "5 deg", "bore": "= bore"}
V_EIGHT: dict[str, JsonValue] = {
    **FOUR,
    "firing_order": [1, 8, 4, 3, 6, 5, 7, 2],
    "bank_angles": {"value": [45, -45] * 4, "unit": "deg"},
    "throws": [1, 1, 2, 2, 3, 3, 4, 4],
    "cylinder_positions": {"value": [46, 68, 160, 182, 274, 296, 388, 410], "unit": "mm"},
    "main_positions": {"value": [0, 114, 228, 342, 456], "unit": "mm"},
    "web_positions": {"value": [24, 90, 138, 204, 252, 318, 366, 432], "unit": "mm"},
    "crankpin_length": "46 mm",
    "web_thickness": "20 mm",
    "web_width": "84 mm",
}
_CRANKSHAFT: dict[str, JsonValue] = {
    "journal_diameter": "= engine.journal_diameter",
    "journal_length": "= engine.main_positions[2] - engine.main_positions[1] - engine.crankpin_length"
    " - 2 * engine.web_thickness",
    "pin_diameter": "= engine.crankpin_diameter",
    "pin_length": "= engine.crankpin_length",
    "web_thickness": "= engine.web_thickness",
    "web_width": "= engine.web_width",
    "throw": "= engine.stroke / 2",
    "fillet": "3.5 mm",  # 2.5 mm takes twice as many elements
    "oil_drilling_diameter": "5 mm",
    "flange_diameter": "90 mm",
    "bolt_hole_diameter": "10 mm",
}
_OUTPUTS: list[JsonValue] = [
    "layout", "crankpin_angles", "mean_torque", "crankpin_load_max", "main_load_max", "elastic_main_load_max",
    "elastic_difference", "governing_elastic_main",
]  # fmt: skip


_BIG_END = Bearing("22 mm", "0.055 mm")


def _places(between: str, cylinders: Sequence[float], webs: float) -> dict[str, JsonValue]:
    """Return the positions of cylinders, mains and webs; a wider bore makes the engine longer.

    The length of a throw is the bore plus the distance `between` two bores. Each cylinder is offset by
    `cylinders` [mm] from the middle of its throw, and the webs lie `webs` [mm] before and after that middle.
    """
    middle = [f"= {2 * k + 1} * pitch / 2" for k in range(THROWS)]
    return {
        "pitch": f"= bore + {between}",
        "cylinder_positions": [f"{at} + {off:g} mm" for at in middle for off in cylinders],
        "main_positions": [f"= {k} * pitch" for k in range(THROWS + 1)],
        "web_positions": [f"{at} + {off:g} mm" for at in middle for off in (-webs, webs)],
    }


def _document(
    name: str,
    places: dict[str, JsonValue],
    engine: dict[str, JsonValue],
    shaft: dict[str, JsonValue],
    variants: dict[str, JsonValue],
    train: Train,
) -> dict[str, JsonValue]:
    """Return a design with a variant for each bearing.

    Its steps are the engine, a film in one bearing with its shell, the crankshaft, torsion and life.
    """
    placed = {name: value for name, value in places.items() if name != "pitch"}
    return {
        "name": name,
        "parameters": {
            "bore": "86 mm",
            "pin_diameter": "48 mm",
            "pitch": places["pitch"],
            "bearing": "3",
            **gallery_train.parameters(train),
        },
        "steps": {
            "engine": {
                "template": "engine",
                "version": 1,
                "inputs": {**engine, **placed, "crankpin_diameter": "= pin_diameter"},
                "outputs": _OUTPUTS,
                "limits": {"permissible_main_load": "60 kN", "permissible_crankpin_load": "60 kN"},
            },
            "film": film_step(
                Bearing("20 mm", "0.055 mm"),
                dynamic_viscosity="10 mPa*s",
                permissible_film="1 um",
                groove_width="3 mm",
                supply_pressure="4 bar",
            ),
            **gallery_train.steps(train),
        },
        "models": {
            "shell": SHELL,
            "crankshaft": {
                "id": "crankshaft",
                "version": 1,
                "parameters": {**_CRANKSHAFT, **shaft},
                "analyses": gallery_train.analyses(),
            },
        },
        "variants": variants,
    }


FOUR_CYLINDERS = _document(
    "four-cylinder engine",
    _places("8 mm", [0], 25),
    FOUR,
    {
        "pin_angles": "= engine.crankpin_angles",
        "counterweight_radius": {"value": [72, 0, 0, 72, 72, 0, 0, 72], "unit": "mm"},
    },
    bearings(5, [0] * 4, _BIG_END),
    Train(
        bank="0 deg",
        per_throw=1,
        ring="0.02 kg*m**2",
        flywheel="0.14 kg*m**2",
    ),
)
V8 = _document(
    "cross-plane V8",
    _places("28 mm", [-11, 11], 33),
    V_EIGHT,
    {
        "pin_angles": [f"= engine.crankpin_angles[{n}]" for n in (1, 3, 5, 7)],
        "counterweight_radius": {"value": [76, 60, 60, 76, 76, 60, 60, 76], "unit": "mm"},
    },
    bearings(5, [45, -45] * 4, _BIG_END),
    Train(
        bank="engine.bank_angles[1]",
        per_throw=2,
        ring="0.03 kg*m**2",
        flywheel="0.18 kg*m**2",
    ),
)
