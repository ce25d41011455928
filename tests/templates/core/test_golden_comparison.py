"""When two results of a golden record agree: texts exactly, numbers to their precision, shapes too."""

import math

import pytest

from templates.core.checking.golden import _equal

PRECISION = 1e-9


@pytest.mark.parametrize(
    ("old", "new", "agree"),
    [
        (2.0, 2.0 * (1 + 1e-10), True),
        (2.0, 2.0 * (1 + 1e-8), False),
        ([1.0, math.nan], [1.0, math.nan], True),
        ([1.0, math.nan], [1.0, 2.0], False),
        ([1.0, 1.0], 1.0, False),
        ("laminar", "laminar", True),
        ("laminar", "turbulent", False),
        ("1.0", 1.0, False),
        (None, None, True),
        (None, 0.0, False),
        (0.0, 1e-300, False),
    ],
)
def test_results_agree_or_do_not(old, new, agree):
    assert _equal(old, new, PRECISION) is agree
    assert _equal(new, old, PRECISION) is agree
