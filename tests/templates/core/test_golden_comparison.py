"""When two results of a golden record agree: texts exactly, numbers to their precision, shapes too."""

import copy
import json
import math

import pytest

from templates.core.catalogue.golden import _as_text, record
from templates.core.checks.golden import _equal, differences
from templates.core.language.template import Template, formula, given

PRECISION = 1e-9


class Marched(Template):
    """A cheap level that repeats everywhere, and one that repeats to 1e-4 on other machines."""

    levels = ("cheap", "marched")
    default_level = "cheap"
    level_precision = {"marched": 1e-4}
    example = {"length": "2 m"}

    x = given("m", "length", ge=0)

    @formula("m", "size")
    def s(self):
        return 2 * self.x


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


@pytest.mark.parametrize(
    ("of", "off", "different"),
    [("levels", 1e-5, 0), ("levels", 1e-3, 1), ("cases", 1e-5, 1), ("cases", 0.0, 0)],
)
def test_a_level_is_held_to_its_own_precision_and_the_others_to_that_of_the_class(of, off, different):
    kept = copy.deepcopy(record(Marched))
    assert kept["levels"][0]["precision"] == 1e-4
    assert not any("precision" in case for case in kept["cases"])
    kept[of][0]["outputs"]["size"] *= 1 + off
    assert len(list(differences(Marched, kept))) == different


def test_a_written_record_has_the_digits_that_a_comparison_needs_and_a_line_for_each_case():
    kept = {**record(Marched), "precision": 1e-9}
    kept["cases"][0]["outputs"]["size"] = 4 * (1 + math.pi * 1e-13)
    kept["cases"][0]["inputs"]["length"] = 2 * (1 + math.pi * 1e-13)
    text = _as_text(kept)
    read = json.loads(text)
    assert read["cases"][0] == {"inputs": kept["cases"][0]["inputs"], "outputs": {"size": 4.0}}
    assert list(differences(Marched, read)) == []
    read["cases"][0]["outputs"]["size"] *= 1 + 1e-8
    assert len(list(differences(Marched, read))) == 1
    assert sum(line.startswith(" {") for line in text.splitlines()) == len(kept["cases"]) + 1
