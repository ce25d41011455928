"""A crossing between two samples is a root, or a jump whose two sides the answer names."""

from types import SimpleNamespace

import numpy as np
import pytest

from templates.core.language.crossings import Leap, Place, _closed

SAMPLES = SimpleNamespace(x=np.array([0.0, 1.0, 3.0]), miss=np.array([-5.0, -2.0, 4.0]))


def curve(miss, beside):
    """A curve whose target is 10, with what it has just beside the crossing."""
    return SimpleNamespace(wanted=10.0, miss=miss, sample=lambda x: SimpleNamespace(miss=np.array(beside)))


@pytest.mark.parametrize(
    ("beside", "sides"),
    [([-1.0, 3.0], (9, 13)), ([np.nan, 3.0], (8, 13)), ([-1.0, np.nan], (9, 14)), ([np.nan] * 2, (8, 14))],
)
def test_a_jump_has_the_values_beside_it_or_else_of_its_samples(beside, sides):
    leap = _closed(curve(lambda x: -1.0 if x < 2 else 3.0, beside), SAMPLES, 1)
    assert isinstance(leap, Leap)
    assert leap.x == pytest.approx(2)
    assert (leap.before, leap.after) == sides


def test_a_root_has_the_direction_in_which_the_output_crosses():
    place = _closed(curve(lambda x: 3 * x - 5.0, []), SAMPLES, 1)
    assert isinstance(place, Place)
    assert (place.x, place.crossing) == (pytest.approx(5 / 3), "rises")
