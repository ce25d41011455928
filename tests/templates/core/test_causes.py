"""Property: one cause is one fault, at an input that can have broken the rules."""

import pytest

from cad.catalogue import models
from templates.core.errors import Fault, InvalidInputs
from templates.core.language.causes import by_cause

THROW = models().get("crank_throw", 1)
SHELL = models().get("plain_bearing", 1)


def refused(cls, **changes):
    with pytest.raises(InvalidInputs) as caught:
        cls.from_quantities({**cls.example, **changes})
    return caught.value.faults


def refused_shell(**given):
    with pytest.raises(InvalidInputs) as caught:
        SHELL.from_quantities({"inner_diameter": "48 mm", **given})
    return caught.value.faults


@pytest.mark.parametrize("fillet", ["0.1 um", "1 nm", "0.05 mm"])
def test_a_fillet_too_small_to_draw_is_one_fault_at_the_fillet(fillet):
    (fault,) = refused(THROW, fillet=fillet)
    assert (fault.name, fault.code, fault.also) == ("fillet", "inconsistent", ("journal_diameter",))
    assert fault.detail.endswith("use 0 for none")
    assert "pin_bore" not in fault.detail


@pytest.mark.parametrize(
    ("changes", "cause"),
    [
        ({"fillet": "30 mm"}, "fillet"),  # breaks eight rules
        ({"pin_bore": "60 mm"}, "pin_bore"),
        ({"oil_drilling_diameter": "40 mm"}, "oil_drilling_diameter"),
        ({"throw": "1 mm"}, "throw"),
    ],
)
def test_rules_that_one_input_breaks_are_one_fault(changes, cause):
    (fault,) = refused(THROW, **changes)
    assert fault.name == cause
    assert fault.detail.count("; required: ") > 1


def test_two_causes_are_two_faults():
    assert [fault.name for fault in refused(THROW, pin_bore="60 mm", journal_bore="70 mm")] == [
        "journal_bore",
        "pin_bore",
    ]


def test_an_input_that_was_given_comes_before_one_that_follows_from_others():
    (fault,) = refused_shell(oil_groove_depth="10 mm", wall="2.4 mm")
    assert (fault.name, fault.also) == ("oil_groove_depth", ("wall",))
    (fault,) = refused_shell(oil_groove_width="0.1 um")
    assert fault.name == "oil_groove_width"


def test_other_faults_stay_as_they_are():
    speed, first = Fault("speed", "missing", "…"), Fault("a", "inconsistent", "A; do", ("b",))
    second = Fault("c", "inconsistent", "C; do", ("b",))
    assert by_cause([speed, first, second]) == [
        speed,
        Fault("b", "inconsistent", "A; do. C; do", ("a", "c")),
    ]


def test_seen_from_outside_every_name_has_its_prefix():
    assert Fault("a", "x", "…", ("b",)).within("film").names == ("film.a", "film.b")
