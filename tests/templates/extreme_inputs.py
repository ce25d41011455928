"""Extreme inputs: decades, bounds, options, tables, and curves of other shapes and lengths."""

from time import process_time

import numpy as np
from test_catalogue_properties import is_single, starting

from templates.core.language.spec import Choice, Curve, Derived, Given, Table
from templates.physics.elastic.bore_modes import HIGHEST
from templates.physics.elastic.compliance import ring_compliance

DECADES = 10.0 ** np.arange(-6, 7)
SCALES = (1e-6, 1e-3, 0.5, 2.0, 1e3, 1e6, -1.0, 0.0)
TABLES = (
    [], [[0.0, 0.0]], [[1.0, 0.3]], [[1.0, 0.3], [1.0, 0.3]], [[1.0, 0.3], [1.1, 0.3]], [[0.0, 6.28]],
    [[0.0, 7.0]], [[2.0, 1e-6]], [[3.0, 0.3]] * 9, [[1.0]], [[-3.0, 0.1], [3.2, 0.1]],
)  # fmt: skip
"""Rows of a table, right and wrong ones [SI]."""
SECONDS, FEWEST = 30.0, 4
"""Processor time that a night spends on one test of one level, and how many cases it takes however long."""
_RING = ring_compliance(24.3e-3, 38e-3, 210e9, 0.3)[[0, *(n for n in range(1, HIGHEST + 1) for _ in "cs")]]
NEEDED = {("elastic_film", "elastic"): {"compliance": np.diag(np.r_[_RING, np.zeros(_RING.size)])}}
"""What a level needs besides the example [SI]: the compliance of a bore, here of a ring."""


def example_at(cls, level):
    """Return the inputs of the example [SI], with what the level needs."""
    return {**starting(cls), **NEEDED.get((cls.id, level), {})}


def as_time_allows(cases, rng):
    """Yield cases in the order that the seed draws, until the time is over: other nights take the others."""
    begin = process_time()
    for number, k in enumerate(rng.permutation(len(cases))):
        if number >= FEWEST and process_time() - begin > SECONDS:
            return
        yield cases[k]


def numeric(cls):
    """Return the inputs that are single numbers, optional ones and those with a formula too."""
    return [name for name, declared in cls.inputs.items() if not isinstance(declared, (Choice, Curve, Table))]


def curves(cls):
    return [name for name, declared in cls.inputs.items() if isinstance(declared, Curve)]


def common(cls, name):
    """Return the value of an input in the example, else its default, else one of its unit, within bounds."""
    declared, start = cls.inputs[name], starting(cls)
    if name in start:
        return start[name]
    default = cls.from_quantities(cls.example).__dict__.get(declared.attribute)
    if default is not None and np.ndim(default) == 0 and np.isfinite(default):
        return float(default)
    low, high = declared.meaning.interval
    one = float(declared.meaning.scale.to_si(1.0))
    return min(max(one, low), high if isinstance(declared, (Given, Derived)) else one)


def rounded(declared, values):
    return np.round(values) if declared.meaning.integer else values


def decades(cls, name):
    """Return a number over twelve decades, with its negative, zero and its bounds."""
    declared, value = cls.inputs[name], common(cls, name)
    bounds = [end for end in declared.meaning.interval if abs(end) < 1e100]
    return rounded(declared, np.r_[value * DECADES if value else DECADES, -value, 0.0, bounds])


def parts(cls, level, changes):
    """Return changes as pieces of as many points as the level takes at once, and each point alone."""
    count = max(np.size(values) for values in changes.values())
    alone = [{name: values[k] for name, values in changes.items()} for k in range(count)]
    step = min(count, cls.most_points.get(level, count))
    if step == 1 or any(is_single(cls.inputs[name]) for name in changes):
        return alone
    begins = range(0, count, step)
    return alone + [{n: values[k : k + step] for n, values in changes.items()} for k in begins]


def curve_of(cls, name):
    """Return the curve of the example, else a constant one as long as the example's along the same axis."""
    declared, start = cls.inputs[name], starting(cls)
    if name in start and np.ndim(start[name]):
        return np.asarray(start[name], float)
    beside = (
        start[other] for other in curves(cls) if cls.inputs[other].along == declared.along and other in start
    )
    count = max((np.shape(value)[-1] for value in beside if np.ndim(value)), default=4)
    return np.full(count, float(common(cls, name)))


def forms(values, rng):
    """Return a curve in other forms: shorter, longer, reversed, constant, repeated, stacked, with a spike."""
    first, last, spike, turned = (values.copy() for _ in range(4))
    if values.size > 1:
        first[1], last[-1] = values[0], values[0]
    spike[0], turned[0] = values[0] * 1e6, -values[0]
    return [
        values[:1], values[:2], values[:-1], values[::-1], np.full_like(values, values.mean()), 0 * values,
        first, last, np.repeat(values, 2), np.concatenate([values, values]), rng.permutation(values),
        np.stack([values, 1.01 * values]), np.stack([values, -values]), spike, turned, values[:0],
        float(values.mean()),
    ]  # fmt: skip


def curve_changes(cls, rng):
    """Return changes of one curve, in size and form, and of all curves along one axis, in form."""
    changes = []
    for name in curves(cls):
        declared, values = cls.inputs[name], curve_of(cls, name)
        one = float(declared.meaning.scale.to_si(1.0))
        sizes = [*(values * scale for scale in SCALES), values + one, values - one]
        changes += [{name: rounded(declared, value)} for value in [*sizes, *forms(values, rng)]]
    given = {name: value for name, value in starting(cls).items() if name in curves(cls) and np.ndim(value)}
    for along in dict.fromkeys(cls.inputs[name].along for name in given):
        names = [name for name in given if cls.inputs[name].along == along]
        changes += [
            dict(zip(names, together, strict=True))
            for together in zip(*(forms(np.asarray(given[name], float), rng) for name in names), strict=True)
        ]
    return changes


def option_changes(cls):
    """Return every option of every choice, and rows of every table."""
    changes = []
    for name, declared in cls.inputs.items():
        if isinstance(declared, Choice):
            changes += [{name: option} for option in declared.options]
        elif isinstance(declared, Table):
            changes += [{name: rows} for rows in TABLES]
    return changes


def random_changes(cls, level, rng, count):
    """Return two or three numbers somewhere in twelve or in three decades, with other options and a curve.

    Every other change is of four points at once, where the level takes them and the inputs may be arrays.
    """
    names, changes = numeric(cls), []
    for k in range(count):
        chosen = rng.choice(names, min(len(names), rng.integers(2, 4)), replace=False).tolist()
        alone = k % 2 or cls.most_points.get(level, 4) < 4 or any(is_single(cls.inputs[n]) for n in chosen)
        reach = 6 if k % 4 < 2 else 1.5
        drawn = {}
        for name in chosen:
            values = (common(cls, name) or 1.0) * 10 ** rng.uniform(-reach, reach, 4)
            drawn[name] = rounded(cls.inputs[name], values[0] if alone else values)
        for name, declared in cls.inputs.items():
            if isinstance(declared, Choice) and rng.random() < 0.3:
                drawn[name] = str(rng.choice(declared.options))
        if curves(cls) and rng.random() < 0.3:
            name = str(rng.choice(curves(cls)))
            drawn[name] = rounded(cls.inputs[name], curve_of(cls, name) * 10 ** rng.uniform(-3, 3))
        changes.append(drawn)
    return changes
