"""Measurements of a solid in the interface, also of builds from an older recipe."""

from app.solids.measures import measurements
from cad.inspect import MEASURES

ALL = {name: float(i) for i, name in enumerate(MEASURES)}


def test_polar_inertia_is_shown() -> None:
    measured = measurements(ALL, {}).model_dump(exclude_unset=True)
    assert measured["polar_inertia"] == {"value": ALL["polar_inertia"], "unit": "kg*m**2"}
    assert measured["inertia"]["zz"]["value"] == ALL["inertia_zz"]


def test_build_of_an_older_recipe_shows_what_it_has() -> None:
    older = {name: value for name, value in ALL.items() if name != "polar_inertia"}
    measured = measurements(older, {}).model_dump(exclude_unset=True)
    assert "polar_inertia" not in measured
    assert measured["mass"]["value"] == ALL["mass"]
