"""Every template over twelve decades of its inputs, one by one, in pairs and as arrays, at every level.

Each answer is a finite number, or none with its reason, or a refusal that names an input or a result. A
result that cannot be negative is not, and none changes by more than tenfold where an input changes by a
thousandth of a thousandth, unless a word in the answer or a limit of a table tells why.
"""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from seeds import seeded
from test_catalogue_properties import is_single, starting, typed

import templates
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.spec import Choice, Curve, Given, Profile, Table, Text
from templates.core.language.template import Template

pytestmark = pytest.mark.slow

DECADES = 10.0 ** np.arange(-6, 7)
PAIRS = 40
SECONDS_EACH = {
    ("cycle_heat_balance", "supplied"): (2, 2),
    ("oil_film_cycle", "flooded"): (2, 2),
    ("oil_film_cycle", "supplied"): (6, 6),
    ("elastic_film", "housing"): (10, 10),
}
"""Of levels of which a point takes seconds: how many inputs, and how many pairs, a night takes."""
NEVER_NEGATIVE = ("film_thickness", "clearance", "_life", "minimum_film", "side_flow", "film_parameter")
"""Parts of the names of outputs that mean nothing below zero."""
SEIZED = {"thermal_clearance": "diametral_clearance"}
"""Templates whose clearance may be below zero, and the output of which a warning then says so."""
BUILT_IN = find([Path(templates.__file__).parent], Template)
LEVELS = [
    pytest.param(cls, level, id=f"{cls.id}-{cls.version}-{level or 'only'}")
    for cls in BUILT_IN
    for level in cls.levels or ("",)
]
every_level = pytest.mark.parametrize(("cls", "level"), LEVELS)


def numeric(cls):
    """Inputs that are single numbers: not choices, curves, tables or counts of points."""
    return [
        name for name in starting(cls)
        if not isinstance(cls.inputs[name], (Choice, Curve, Table)) and isinstance(cls.inputs[name], Given)
    ]  # fmt: skip


def swept(cls, level, names, rng, most):
    """Some of these, all unless a level is slow."""
    count = SECONDS_EACH.get((cls.id, level), (len(names), PAIRS))[most]
    return [names[i] for i in rng.permutation(len(names))[:count]]


def rounded(declared, values):
    return np.round(values) if declared.meaning.integer else values


def answer(cls, level, si):
    """The evaluation; None where it is refused by name."""
    try:
        return evaluate(cls, typed(cls, si), level=level or None)
    except InvalidInputs as refusal:
        faults = refusal.faults
    assert faults
    known = {*cls.inputs, *cls.formulas, "level"}
    assert all(fault.name.split(".")[0].split("[")[0] in known and fault.detail for fault in faults), faults
    return None


def checked(cls, evaluation, where):
    """Every value is finite or has a reason, none is of the wrong sign, and each error stated is a number."""
    warned = {name for notice in evaluation.warnings for name in (notice.name, *getattr(notice, "also", ()))}
    for name, one in evaluation.outputs.items():
        formula = cls.formulas[name]
        if isinstance(formula, Text):
            continue
        value = np.asarray(np.nan if one.value is None else one.value, float)
        assert not np.isinf(value).any(), (name, where)
        missing = np.isnan(value)
        if isinstance(formula, Profile):
            missing = missing.any(axis=tuple(range(-formula.axes, 0)))
        reasons = np.asarray(one.reason if one.reasons is None else one.reasons, dtype=object)
        told = np.broadcast_to(reasons != None, np.broadcast_shapes(missing.shape, reasons.shape))  # noqa: E711
        assert (told | ~missing).all(), (name, where)
        if any(part in name for part in NEVER_NEGATIVE) and (value < 0).any():
            assert SEIZED.get(cls.id, name) in warned, (name, float(np.nanmin(value)), where)


def at_once(cls, level, count):
    return min(count, cls.most_points.get(level, count))


def sweep(cls, level, changes):
    """Check the example with these inputs changed, arrays of points, as many at once as the level takes."""
    start = starting(cls)
    count = max(np.size(values) for values in changes.values())
    step = at_once(cls, level, count)
    for begin in range(0, count, step):
        part = {name: np.asarray(values)[begin : begin + step] for name, values in changes.items()}
        single = {n: v[0] for n, v in part.items() if is_single(cls.inputs[n])}
        for k in range(step if single else 1):
            one = {n: v[k] if single else v for n, v in part.items() if k < len(v)}
            if not one:
                continue
            evaluation = answer(cls, level, {**start, **one})
            if evaluation is not None:
                checked(cls, evaluation, {n: np.asarray(v).tolist() for n, v in one.items()})


@every_level
def test_property_every_input_over_twelve_decades(cls, level):
    rng = np.random.default_rng(seeded(61))
    start = starting(cls)
    for name in swept(cls, level, numeric(cls), rng, 0):
        values = start[name] * DECADES if start[name] else np.r_[0.0, DECADES]
        sweep(cls, level, {name: rounded(cls.inputs[name], np.r_[values, -start[name], 0.0])})


@every_level
def test_property_pairs_of_inputs_over_twelve_decades(cls, level):
    rng = np.random.default_rng(seeded(62))
    start, names = starting(cls), numeric(cls)
    pairs = [(a, b) for a, b in product(names, names) if a < b]
    for a, b in swept(cls, level, pairs, rng, 1):
        drawn = {n: rounded(cls.inputs[n], (start[n] or 1.0) * 10 ** rng.uniform(-6, 6, 4)) for n in (a, b)}
        sweep(cls, level, drawn)


@every_level
def test_property_every_input_may_be_an_array(cls, level):
    """Two values of one input are two answers, each that of its value alone."""
    rng = np.random.default_rng(seeded(63))
    start = starting(cls)
    names = [name for name in numeric(cls) if not is_single(cls.inputs[name])]
    if cls.most_points.get(level, 2) < 2:
        return
    for name in swept(cls, level, names, rng, 0):
        near = rounded(cls.inputs[name], start[name] * np.array([1.0, 1.01]))
        together = answer(cls, level, {**start, name: near})
        alone = [answer(cls, level, {**start, name: value}) for value in near]
        if together is None:
            assert None in alone, name
            continue
        checked(cls, together, {name: near.tolist()})
        for output, one in together.outputs.items():
            formula = cls.formulas[output]
            if isinstance(formula, (Text, Profile)):
                continue
            values = np.broadcast_to(np.asarray(np.nan if one.value is None else one.value, float), 2)
            for value, single in zip(values, alone, strict=True):
                if single is None:
                    assert np.isnan(value) or output not in dependents(cls, name), (output, name)
                    continue
                own = single.outputs[output].value
                assert value == pytest.approx(np.nan if own is None else own, rel=1e-6, nan_ok=True), output


def dependents(cls, name):
    attribute = cls.inputs[name].attribute
    return {
        output for output, formula in cls.formulas.items() if attribute in cls.ancestors(formula.attribute)
    }
