"""Every template over twelve decades of its inputs, one by one, in pairs and as arrays, at every level.

Each answer is a finite number, or none with its reason, or a refusal that names an input or a result. A
result that cannot be negative is not. None jumps, but where a word of the answer or a warning changes too, or
where `STEPS` says why.
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
STEPS = {
    ("oil_film", "smallest_permissible_film"): "the table of ISO 7902-3 has steps",
    ("oil_film", "fit_exponent"): "the paper's fit has three rows",
    ("oil_film", "fit_factor"): "the paper's fit has three rows",
}
"""Outputs that jump, by template and name, and why."""
JUMP = 0.02
"""Change of a value, relative, at an input that changes by 1e-8 of itself, that may be a jump."""
LEFT = 0.1
"""Share of its change over a tenth of a decade that a jump makes there, unlike a value through zero."""
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
        if isinstance(formula, Profile) and missing.ndim >= formula.axes:
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
                if single is None:  # a level that does not use an input may answer where it is wrong
                    continue
                own = single.outputs[output].value
                assert value == pytest.approx(np.nan if own is None else own, rel=1e-6, nan_ok=True), output


def quick(cls, level):
    """Whether a point takes milliseconds, as far as the most points at once tell."""
    return cls.most_points.get(level, 10_000) >= 2000 and (cls.id, level) not in SECONDS_EACH


JUMPY = [one for one in LEVELS if quick(*one.values)]


@pytest.mark.parametrize(("cls", "level"), JUMPY)
def test_property_nothing_jumps_without_a_word(cls, level):
    start, jumps = starting(cls), []
    for name in numeric(cls):
        declared = cls.inputs[name]
        if declared.meaning.integer or is_single(declared) or not start[name]:
            continue
        grid = start[name] * 10 ** np.linspace(-6, 6, 121)
        whole = answer(cls, level, {**start, name: grid})
        if whole is not None:
            jumps += [f"{output} at {name}" for output in steepest(cls, whole, grid.size)
                      if jumps_at(cls, level, name, output, whole, grid)]  # fmt: skip
    assert not [jump for jump in jumps if (cls.id, jump.split(" at ")[0]) not in STEPS], jumps


def numbers_of(cls, evaluation, count):
    """The outputs that are one number a point."""
    return {
        name: np.broadcast_to(np.asarray(np.nan if one.value is None else one.value, float), count)
        for name, one in evaluation.outputs.items()
        if not isinstance(cls.formulas[name], (Text, Profile))
    }


def change(values):
    """Relative changes between neighbours; 0 where there is no value."""
    size = np.maximum(np.abs(values[1:]), np.abs(values[:-1]))
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(np.abs(np.diff(values)) / np.where(size > 0, size, 1.0))


def steepest(cls, whole, count):
    """Outputs that change most between two neighbours, three at most."""
    worst = {name: change(values).max() for name, values in numbers_of(cls, whole, count).items()}
    return [name for name in sorted(worst, key=worst.get, reverse=True)[:3] if worst[name] > JUMP]


def jumps_at(cls, level, name, output, whole, grid):
    """Whether the largest change remains where the interval shrinks to nothing, and no word tells why."""
    start = starting(cls)
    k = int(change(numbers_of(cls, whole, grid.size)[output]).argmax())
    low, high = grid[k], grid[k + 1]
    coarse = float(np.abs(np.diff(numbers_of(cls, whole, grid.size)[output])[k]))
    for _ in range(4):
        near = np.linspace(low, high, 101)
        part = answer(cls, level, {**start, name: near})
        if part is None:
            return False
        k = int(change(numbers_of(cls, part, near.size)[output]).argmax())
        low, high = near[k], near[k + 1]
    ends = [answer(cls, level, {**start, name: end}) for end in (low, high)]
    if None in ends or abs(high / low - 1) > 1e-8:
        return False
    if words(cls, ends[0]) != words(cls, ends[1]):
        return False
    values = np.array([numbers_of(cls, end, 1)[output][0] for end in ends])
    return bool(change(values)[0] > JUMP and np.abs(np.diff(values))[0] > LEFT * coarse)


def words(cls, evaluation):
    """What the answer says in words: texts, warnings and reasons."""
    texts = [
        one.value if isinstance(cls.formulas[n], Text) else one.reason
        for n, one in evaluation.outputs.items()
    ]
    return [*map(str, texts), *sorted(str(notice.code) for notice in evaluation.warnings)]
