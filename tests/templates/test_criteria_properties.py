"""Property tests over the criteria of all templates: a new criterion is covered automatically.

Inputs and limits are removed one by one: no criterion is met without its value and its limit.
"""

import math
from pathlib import Path

import pytest
from newest import older_slow

import templates
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template

BUILT_IN = find([Path(templates.__file__).parent], Template)
EVERY = older_slow(cls for cls in BUILT_IN if cls.declared_criteria)
every_template = pytest.mark.parametrize("cls", EVERY)
LENIENT = {">=": 1e-9, "<=": 1e9}


def lenient(cls):
    """Every limit that a template declares, such that its criterion is easily met."""
    return {
        limit.name: {"value": LENIENT[criterion.sign], "unit": limit.unit}
        for criterion in cls.declared_criteria
        for limit in criterion.limits
    }


def judged(cls, inputs, limits):
    """The criteria by name; none of inputs that the template refuses."""
    outputs = sorted({n for c in cls.declared_criteria for n in c.names if n in cls.formulas})
    try:
        result = evaluate(cls, inputs, outputs=outputs, limits=limits)
    except InvalidInputs:
        return {}
    return {judgement.name: judgement for judgement in result.criteria}


def assert_honest(judgement):
    """A verdict has what it needs; `met` is true of the whole band, if one is known."""
    if judgement.verdict == "not_checked":
        assert judgement.give or judgement.reason
        return
    assert math.isfinite(judgement.value)
    assert math.isfinite(judgement.limit)
    if judgement.verdict == "met" and (judgement.error_known or judgement.band is not None):
        low, high = judgement.band
        assert (low if ">=" in judgement.require else -high) > -math.inf
    if judgement.verdict in ("met", "not_met"):
        assert (judgement.margin >= 0) == (judgement.verdict == "met")


@every_template
def test_property_every_criterion_of_the_example_is_judged(cls):
    assert set(judged(cls, cls.example, lenient(cls))) == {c.name for c in cls.declared_criteria}


@every_template
def test_property_nothing_is_met_without_its_limit(cls):
    limits = lenient(cls)
    for criterion in cls.declared_criteria:
        for limit in criterion.limits:
            rest = {name: value for name, value in limits.items() if name != limit.name}
            inputs = {n: v for n, v in cls.example.items() if not (limit.default and n == limit.default[1])}
            judgement = judged(cls, inputs, rest)[criterion.name]
            assert judgement.verdict == "not_checked"
            assert limit.name in judgement.give


@every_template
def test_property_nothing_is_met_without_an_input_that_it_needs(cls):
    limits = lenient(cls)
    for removed in cls.example:
        inputs = {name: value for name, value in cls.example.items() if name != removed}
        for name, judgement in judged(cls, inputs, limits).items():
            assert_honest(judgement)
            criterion = next(c for c in cls.declared_criteria if c.name == name)
            if removed in criterion.names and cls.inputs[removed].required:
                assert judgement.verdict == "not_checked"


@every_template
def test_property_the_example_is_judged_honestly(cls):
    for judgement in judged(cls, cls.example, lenient(cls)).values():
        assert_honest(judgement)
