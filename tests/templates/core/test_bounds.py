"""Limits of single values and of arrays accept the same values."""

import math

import numpy as np
import pytest

from templates.core.language.meaning import Bounds, Meaning

SIDES = {
    "none": Bounds(),
    "above": Bounds(gt=1.0),
    "from": Bounds(ge=1.0),
    "below": Bounds(lt=5.0),
    "to": Bounds(le=5.0),
    "between": Bounds(gt=1.0, le=5.0),
    "both of a side": Bounds(gt=1.0, ge=0.5, lt=6.0, le=5.0),
}
VALUES = np.array(
    [-math.inf, -1.0, 0.0, 1.0, np.nextafter(1.0, 2), 2.5, 5.0, np.nextafter(5.0, 6), math.inf, math.nan]
)


@pytest.mark.parametrize("integer", [False, True])
@pytest.mark.parametrize("bounds", SIDES.values(), ids=SIDES)
def test_a_single_value_is_admitted_exactly_where_a_point_of_an_array_is(bounds, integer):
    meaning = Meaning(words="width", unit="m", name="width", domain=bounds, integer=integer)
    points = meaning.admits(VALUES)
    assert [bool(meaning.admits(value)) for value in VALUES] == points.tolist()
    assert points.any()
    assert not points.all()
