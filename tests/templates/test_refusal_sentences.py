"""Refusals of violated rules: each sentence agrees with its own numbers.

Random changes to the examples of all templates and models look for inputs that violate each rule.
"""

import random
import re

import numpy as np
import pytest
from seeds import seeded
from true_numbers import assert_true_of_its_numbers

from cad.catalogue import models
from templates.core.errors import InvalidInputs, TemplateError
from templates.core.language.spec import Choice, Table
from templates.core.units.quantity import read
from templates.door import built_in

LEAST = 0.8  # of all rules that the long search violates; the rest need data that nobody meets by chance


def changed(cls, name, rng):
    """Another value of an input; None leaves it out."""
    declared = cls.inputs[name]
    if isinstance(declared, Choice):
        return rng.choice(declared.options)
    if isinstance(declared, Table) or rng.random() < 0.15:
        return None
    meaning, factor = declared.meaning, 10.0 ** rng.uniform(-3, 3) * rng.choice([1, 1, 1, -1])
    if meaning.integer and name not in cls.example:
        return rng.choice([1, 2, 3, 5])
    value = _value(cls, declared, factor)
    if np.ndim(value):
        value = _list(np.array(value, dtype=float), factor, rng)
    elif meaning.integer:
        value = rng.choice([0, 1, 2, 3, 4, 5, 7, 10, 100, 10**6])
    else:
        value = rng.choice([0.0, float(value) * factor, float(value) * factor, float(value) * factor])
    return {"value": value, "unit": meaning.unit}


def _value(cls, declared, factor):
    """The value of an example, else the default, else any, in the declared unit."""
    raw, default = cls.example.get(declared.name), getattr(declared, "default", None)
    if raw is None and default is None:
        return 0.01 * factor
    return declared.meaning.scale.from_si(
        read(raw, declared.meaning.unit).si if raw is not None else default.si
    )


def _list(values, factor, rng):
    kind = rng.choice(["short", "long", "one", "all", "back"])
    if kind == "short":
        return values[:-1].tolist()
    if kind == "long":
        return np.append(values, values[-1:], axis=0).tolist()
    if kind == "one":
        values[rng.randrange(len(values))] *= factor
        return values.tolist()
    return (values[::-1] if kind == "back" else values * factor).tolist()


def violating(cls, rules, rng):
    """The example with some inputs of a rule, or any, changed."""
    names = set(rng.choice(rules).names)
    if rng.random() < 0.5:
        names = {*rng.sample(sorted(names), 1), *(name for name in cls.inputs if rng.random() < 0.15)}
    choices = [name for name, declared in cls.inputs.items() if isinstance(declared, Choice)]
    names |= set(rng.sample(choices, 1)) if choices and rng.random() < 0.5 else set()
    inputs = dict(cls.example)
    for name in sorted(names):
        if rng.random() < 0.7:
            value = changed(cls, name, rng)
            inputs = (
                {**inputs, name: value}
                if value is not None
                else {k: v for k, v in inputs.items() if k != name}
            )
    return inputs


def violated(cls, tries, rng):
    """The sentences of refusal rules that random inputs violate; each refusal is checked."""
    rules = {rule.sentence: rule for rule in cls.requirements if not rule.warning}
    found = set()
    for _ in range(tries):
        wanted = [rule for sentence, rule in rules.items() if sentence not in found]
        if not wanted:
            break
        try:
            cls.from_quantities(violating(cls, wanted, rng))
        except InvalidInputs as error:
            found |= {s for fault in error.faults for s in rules if states_the_case(fault, s)}
        except TemplateError:
            continue
    return found, rules


def states_the_case(fault, sentence):
    """Whether a fault is about a rule; then its case stands before what is required, and is true."""
    case, required, _ = fault.detail.partition(f"; required: {sentence};")
    if not required:
        return False
    own = case.rpartition(". ")[2]  # of several rules joined at one input
    assert sentence not in own, fault.detail
    assert assert_true_of_its_numbers(own) or re.search(r"\w+ = |\d", own), fault.detail
    return True


@pytest.mark.parametrize("cls", [*built_in(), *models()], ids=lambda cls: f"{cls.id}_{cls.version}")
def test_property_a_refusal_states_what_is(cls):
    found, rules = violated(cls, 25, random.Random(seeded(361)))
    assert found or len(rules) <= 3


@pytest.mark.slow
def test_property_every_refusal_states_what_is():
    counts = [violated(cls, 3000, random.Random(seeded(362))) for cls in (*built_in(), *models())]
    assert sum(len(found) for found, _ in counts) >= LEAST * sum(len(rules) for _, rules in counts)


def test_property_a_masked_point_states_what_is():
    """At points of arrays that violate a rule the reason names the relation, not what ought to be."""
    (cls,) = [cls for cls in built_in() if (cls.id, cls.version) == ("oil_film", 2)]
    clearance = {"value": [60.0, 0.05], "unit": "mm"}
    template = cls.from_quantities({**cls.example, "diametral_clearance": clearance})
    (mask,) = [mask for mask in template.ledger.masks if "required" in mask.reason]
    assert mask.reason.startswith("diametral clearance is not below bearing diameter; required: ")
    assert mask.where.tolist() == [True, False]
