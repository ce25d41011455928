"""Comparisons in a rule are recorded while the rule runs."""

import numpy as np
import pytest

from templates.core.language.comparisons import outcome, worst_share
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Array, Template, Truth, given, require


class Bar(Template):
    """A bar with rules of every form."""

    a: Array = given("mm", "thickness")
    b: Array = given("mm", "width")
    f: Array = given("kN", "force", default="1 kN")
    r: Array = given("mm", "fillet", default="0 mm", ge=0)

    @require("thickness", remedy="make it thinner", warning="thick")
    def thin(self) -> Truth:
        """The bar is thinner than twice its width and a metre."""
        return (self.a < 2 * self.b) & (self.a < 1)

    @require("fillet", remedy="make it larger", warning="sharp")
    def round_enough(self) -> Truth:
        """A fillet, if there is one, is at least a tenth of the thickness."""
        return (self.r <= 0) | (self.r >= self.a / 10)

    @require("width", remedy="make it wider", warning="narrow")
    def not_narrow(self) -> Truth:
        """The bar is not both narrower than thick and narrower than 5 mm."""
        return ~((self.b < self.a) & (self.b < 5e-3))

    @require("width", remedy="make it wider", warning="rounded")
    def through_numpy(self) -> Truth:
        """The square root of the width exceeds that of the smaller side."""
        return np.sqrt(self.b) >= np.sqrt(np.minimum(self.a, self.b))

    @require("thickness", remedy="use a number", warning="strict")
    def needs_plain_numbers(self) -> Truth:
        """The thickness is a float."""
        if not isinstance(self.a, (float, np.ndarray)):
            raise TypeError("no number")
        return self.a < self.b

    @require("thickness", remedy="use less", warning="reversed")
    def plain_values_first(self) -> Truth:
        """Numbers and arrays of numpy may stand on the left."""
        return (np.float64(2e-3) <= self.a) & (np.asarray([1e-3]) * 2 <= self.b)


def recorded(rule, **inputs):
    template = evaluate(Bar, {"thickness": "10 mm", "width": "20 mm", **inputs}).template
    return outcome(template, getattr(Bar, rule))


def described(result):
    return [(one.sign, one.share) for one in result.decisive()]


def test_both_sides_of_each_comparison_are_recorded():
    result = recorded("thin")
    first, second = result.decisive()
    assert bool(result.value)
    assert (first.sign, float(first.left), float(first.right)) == (
        "<",
        pytest.approx(0.01),
        pytest.approx(0.04),
    )
    assert first.share == pytest.approx(0.25)
    assert (second.left.attribute, second.right.constant) == ("a", 1)


def test_an_alternative_that_holds_leaves_nothing_to_compare():
    assert described(recorded("round_enough")) == []
    assert described(recorded("round_enough", fillet="2 mm")) == [(">=", pytest.approx(0.5))]


def test_of_an_array_only_points_count_at_which_no_alternative_holds():
    result = recorded("round_enough", fillet={"value": [0, 4, 2], "unit": "mm"})
    (one,) = result.decisive()
    assert one.where.tolist() == [False, True, True]
    assert one.share == pytest.approx(0.5)
    assert result.value.tolist() == [True, True, True]


def test_the_opposite_of_a_conjunction_is_an_alternative():
    assert described(recorded("not_narrow")) == []
    result = recorded("not_narrow", width="8 mm")
    (one,) = result.decisive()
    assert (one.sign, one.right.constant, bool(one.holds)) == (">=", 5e-3, True)
    assert not recorded("not_narrow", width="4 mm").value


def test_numpy_functions_keep_the_comparison():
    assert described(recorded("through_numpy")) == [(">=", pytest.approx(np.sqrt(0.5)))]


def test_a_rule_that_needs_plain_numbers_has_its_truth_alone():
    result = recorded("needs_plain_numbers")
    assert bool(result.value)
    assert described(result) == []


def test_plain_values_of_numpy_may_stand_on_the_left():
    shares = [share for _, share in described(recorded("plain_values_first"))]
    assert shares == [pytest.approx(0.2), pytest.approx(0.1)]


@pytest.mark.parametrize(
    ("small", "large", "share"),
    [
        (1.0, 2.0, 0.5),
        (np.array([1.0, np.nan]), np.array([4.0, 1.0]), 0.25),
        (np.nan, 1.0, None),
        (-1.0, 1.0, None),
        (1.0, 0.0, None),
    ],
)
def test_a_share_needs_amounts(small, large, share):
    assert worst_share(small, large) == (None if share is None else pytest.approx(share))
