"""What a solid measures, as the interface tells it: also of builds that an older recipe made."""

from app.solids.measures import measurements
from cad.inspect import MEASURES

ALL = {name: float(i) for i, name in enumerate(MEASURES)}


def test_polar_inertia_is_told() -> None:
    told = measurements(ALL, {})
    assert told["polar_inertia"] == {"value": ALL["polar_inertia"], "unit": "kg*m**2"}
    assert told["inertia"]["zz"]["value"] == ALL["inertia_zz"]


def test_build_of_an_older_recipe_tells_what_it_has() -> None:
    older = {name: value for name, value in ALL.items() if name != "polar_inertia"}
    told = measurements(older, {})
    assert "polar_inertia" not in told
    assert told["mass"]["value"] == ALL["mass"]
