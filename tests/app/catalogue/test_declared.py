"""Declarations are read once for each schema, and quantities have the same form everywhere."""

import pytest

from app.calculations.schemas.evaluations import Output
from app.catalogue.schemas.declarations import properties
from app.presentation import numbers
from app.schemas.answers import Quantity, Shown


def schema(title):
    return {"properties": {"load": {"title": title, "anyOf": [{"type": "array"}]}}}


def test_property_a_schema_is_read_once():
    one = schema("Load")
    assert properties(one) is properties(one)
    assert properties(one)["load"].is_list


def test_property_each_schema_has_its_own_declarations():
    # more than are remembered, each dropped at once, so that later ones take the addresses of earlier ones
    assert all(properties(schema(f"Load {n}"))["load"].title == f"Load {n}" for n in range(500))


@pytest.mark.parametrize(
    ("quantity", "line"),
    [
        (Quantity(value=25.0, unit="kN"), "25 kN"),
        (Output(value=None, reason="no load"), "no load"),
        (Output(value=[1.0, None], unit="mm**2/s"), "[1, –] mm²/s"),
        (Output(value="full_film"), "full_film"),
        (Shown(value=48.0, unit="mm", upper=0.025, lower=0.0, zone="H7"), "48 mm H7 (+0.025 +0)"),
    ],
)
def test_property_a_model_reads_like_its_fields(quantity, line):
    assert numbers.in_line(quantity) == line
    assert numbers.in_line(quantity.model_dump()) == line


class Bare:
    """A quantity that is no model."""

    value, unit, zone = 48.0, "mm", "H7"


def test_property_a_quantity_may_be_any_object():
    assert numbers.in_line(Bare()) == "48 mm H7"
