"""The US display converts every quantity: no metric viscosity next to inches and pounds."""

import pytest

from app.catalogue.discovery import find_templates
from app.presentation.units import shown_unit, shown_value
from templates.core.units.units import require_same_kind

METRIC_THERE_TOO = {
    "1",
    "%",
    "deg",
    "rad",
    "mrad",
    "rad/s",
    "rad/s**2",
    "rpm",
    "Hz",
    "s",
    "1/s",
    "h",
    "K",
    "1/K",
    "W/K",
    "W/(m*K)",
    "W/(m**2*K)",
    "kJ/(m**3*K)",
}
"""Used in American drawings as well, or for heat, of which customary units are many and none is common."""


def declared():
    """The units of all inputs and outputs of all templates."""
    return {one.meaning.unit for cls in find_templates([]) for one in cls.declarations.values()}


def test_every_unit_of_the_templates_is_shown_in_a_customary_one():
    assert {name for name in declared() if shown_unit(name, "us") == name} <= METRIC_THERE_TOO


@pytest.mark.parametrize("name", sorted(declared()))
def test_the_unit_shown_measures_the_same(name):
    assert require_same_kind(shown_unit(name, "us"), name)


@pytest.mark.parametrize(
    ("value", "metric", "shown", "customary"),
    [
        (11.877, "mPa*s", 1.72261, "ureyn"),  # 1 reyn = 6894.757 Pa·s
        (1.5e5, "N*m/rad", 1.32761e6, "lbf*inch/rad"),  # 1 lbf·in = 0.1129848 N·m
        (56.697, "delta_degC", 102.0546, "delta_degF"),  # a difference: 1.8 °F for each kelvin
        (56.697, "degC", 134.0546, "degF"),
        (110.0, "mm**2/s", 0.170500, "inch**2/s"),  # 1 in² = 645.16 mm²
    ],
)
def test_viscosities_and_stiffnesses_are_converted(value, metric, shown, customary):
    assert shown_unit(metric, "us") == customary
    assert shown_value(value, metric, "us") == pytest.approx(shown, rel=1e-5)
