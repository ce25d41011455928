"""On random designs, no sentence about a criterion contradicts its own numbers."""

import random
import re

import numpy as np
import pytest
from row_designs import CATALOGUES
from seeds import seeded

from app.calculations.json_values import criterion as rendered
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.verdicts import judged
from app.designs.graph import build_graph, starts
from app.pool.cost import estimated_seconds
from app.presentation.criteria import line
from app.schemas.criteria import Criterion
from templates.core.criteria.judgement import sentence
from templates.core.criteria.summary import summarised
from templates.core.language.spec import Given, Profile, Text
from templates.core.units.quantity import read
from templates.core.units.units import unit_symbol
from templates.door import built_in

CHEAP = 0.02  # s
_NUMBER = r"(-?\d[\d.]*(?:e[-+]?\d+)?)"
_SIGN = "(below|not below|above|not above)"
TRUE_OF = {
    "below": lambda one, other: one < other,
    "not below": lambda one, other: one >= other,
    "above": lambda one, other: one > other,
    "not above": lambda one, other: one <= other,
}


def cheap():
    """The templates whose examples take little time, as the service estimates it."""
    return [
        cls
        for cls in built_in()
        if cls.example and cls.declared_criteria
        and estimated_seconds(cls, dict(cls.example), None, None, list(cls.formulas)) < CHEAP
    ]  # fmt: skip


def wobbled(cls, rng):
    """The inputs of an example, single numbers by up to a third larger or smaller."""
    inputs = {}
    for name, raw in cls.example.items():
        inputs[name] = raw
        declared = cls.inputs.get(name)
        if isinstance(declared, Given) and isinstance(raw, str) and rng.random() < 0.5:
            scale, si = declared.meaning.scale, read(raw, declared.meaning.unit).si
            if not np.ndim(si) and not declared.meaning.integer and declared.meaning.unit != "degC":
                value = float(scale.from_si(si)) * rng.uniform(0.7, 1.4)
                several = rng.random() < 0.1 and not declared.single
                values = [value, value * rng.uniform(0.7, 1.4)] if several else value
                inputs[name] = {"value": values, "unit": declared.meaning.unit}
    return inputs


def own_criteria(cls, step, rng):
    """Criteria of the design about results of a step, each with a limit somewhere in six decades."""
    numbers = [
        (name, formula.meaning.unit)
        for name, formula in cls.formulas.items()
        if not isinstance(formula, (Text, Profile))
    ]
    return {
        f"{step}_{k}": {
            "require": f"{step}.{name} {sign} {10 ** rng.uniform(-3, 3):.6g} {unit}".removesuffix(" 1")
        }
        for k, (name, unit) in enumerate(rng.sample(numbers, min(2, len(numbers))))
        for sign in [rng.choice(["<=", ">="])]
    }


def random_design(classes, rng, number):
    steps, criteria = {}, {}
    for step in range(rng.choice([1, 1, 2])):
        cls = rng.choice(classes)
        limits = {
            limit.name: {"value": 10 ** rng.uniform(-3, 3), "unit": limit.unit}
            for one in cls.declared_criteria
            for limit in one.limits
            if rng.random() < 0.6
        }
        steps[f"s{step}"] = {"template": cls.id, "version": cls.version, "inputs": wobbled(cls, rng)}
        if limits:
            steps[f"s{step}"]["limits"] = limits
        if rng.random() < 0.5:
            criteria |= own_criteria(cls, f"s{step}", rng)
    return {"name": f"random {number}", "steps": steps, "criteria": criteria}


def assert_true(judgement):
    """Verdict, words, sign, share and sentence of one criterion agree with its numbers."""
    plain = rendered(judgement)
    shown = line(Criterion.model_validate(plain))
    assert plain["sentence"] == shown.sentence == sentence(judgement)
    if judgement.value is None or judgement.limit is None or judgement.margin is None:
        assert judgement.verdict in ("not_checked", "met", "undecided"), judgement
        return False
    misses = judgement.margin < 0
    if judgement.verdict != "undecided":
        assert judgement.verdict == ("not_met" if misses else "met"), judgement
    else:
        assert judgement.needs is not None or judgement.reason, judgement
    if judgement.utilisation is not None:
        assert (judgement.utilisation > 1) == misses, judgement
    assert ("error unknown" in shown.verdict_words) == (
        not judgement.error_known and judgement.verdict in ("met", "not_met")
    )
    assert (shown.error == "unknown") == (not judgement.error_known)
    if judgement.band is not None and judgement.verdict != "undecided":
        low, high = judgement.band
        assert low <= judgement.value * (1 + 1e-12) or low <= judgement.value
        assert high >= judgement.value * (1 - 1e-12) or high >= judgement.value
    unit = f"(?: {re.escape(unit_symbol(judgement.unit))})?"
    stated = re.search(f"{_NUMBER}{unit} is {_SIGN} .*?{_NUMBER}{unit}: ", sentence(judgement))
    assert stated, sentence(judgement)
    assert TRUE_OF[stated[2]](float(stated[1]), float(stated[3])), sentence(judgement)
    assert stated[2].startswith("not ") != misses, sentence(judgement)
    return True


def check(count, seed):
    rng, classes = random.Random(seed), cheap()
    assert len(classes) > 10
    compared = 0
    for number in range(count):
        document = Document.model_validate(random_design(classes, rng, number))
        graph, faults = build_graph(document, CATALOGUES)
        if faults:
            continue
        calculation = calculate(graph, lambda _: None, lambda *_: None, starts(document))
        if calculation.faults:
            continue
        judgements = judged(calculation)
        compared += sum(map(assert_true, judgements))
        summary = summarised(judgements)
        assert sum(summary.counts.values()) == len(judgements)
        assert sum(int(n) for n in re.findall(r"(\d+) (?:met|not|undecided)", summary.headline)) == len(
            judgements
        )
        certain = [one.verdict == "met" and one.is_certain for one in judgements]
        assert summary.green == (bool(judgements) and all(certain))
        if any(one.verdict == "not_met" for one in judgements):
            assert summary.verdict == "not_met"
    return compared


def test_property_no_sentence_contradicts_its_numbers():
    assert check(100, seeded(36)) > 100


@pytest.mark.slow
def test_property_no_sentence_of_500_designs_contradicts_its_numbers():
    assert check(500, seeded(37)) > 500
