"""Every template over twelve decades of its inputs, one by one and in pairs, with every option and as arrays.

At every level, optional inputs and curves too. Each answer is a finite number, or none with its reason, or a
refusal that names an input or a result. A result that cannot be negative is not, no share exceeds 1, nothing
is colder than 0 K. None jumps, but where a word of the answer or a warning changes too, or where `STEPS` says
why. A level that takes seconds is swept over several nights: the seed of a night draws what it takes.
"""

import re
from pathlib import Path

import numpy as np
import pytest
from extreme_inputs import (
    as_time_allows,
    common,
    curve_changes,
    decades,
    example_at,
    numeric,
    option_changes,
    parts,
    random_changes,
    rounded,
)
from seeds import seeded
from test_catalogue_properties import is_single, typed

import templates
from templates import get
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.spec import Profile, Text
from templates.core.language.template import Template

pytestmark = pytest.mark.slow

COMBINATIONS = 300
NEVER_NEGATIVE = re.compile(
    r"film_thickness|clearance$|_life|minimum_film|side_flow|oil_flow|film_parameter|power_loss|viscosity$|density"
    r"|_area$|safety|strength|reynolds_number|_max$|eccentricity$|maximum_pressure$|damage|share"
)
"""Names of outputs that mean nothing below zero."""
SHARE = re.compile(r"efficiency|share|maximum_eccentricity")
"""Names of outputs that mean nothing above 1."""
SIGNED = {
    ("engine", "energy_area"): "an area below the mean torque is taken out",
}
"""Outputs with such a name that may be negative after all, and why."""
SEIZED = {"thermal_clearance": "diametral_clearance"}
"""Templates whose clearance may be below zero, and the output of which a warning then says so."""
STEPS = {
    ("combustion_cycle", "peak_pressure_angle"): "of two peaks another becomes the higher",
    ("combustion_cycle", "energy_balance_error"): "below 1e-9 it is 0",
    ("engine", "rotating_couple_angle"): "a couple that passes through 0 points the other way",
    ("engine", "governing_main"): "it is the number of a bearing",
    ("engine", "governing_elastic_main"): "it is the number of a bearing",
    ("oil_film_cycle", "numerical_error"): "the orbit goes over to a finer ring, by which it is stated",
    ("oil_film_cycle", "minimum_film_angle"): "of two narrow places another becomes the narrower",
    ("oil_film_cycle", "maximum_pressure_angle"): "it is one of the angles given",
    ("oil_film", "smallest_permissible_film"): "the table of ISO 7902-3 has steps",
    ("oil_film", "fit_exponent"): "the paper's fit has three rows",
    ("oil_film", "fit_factor"): "the paper's fit has three rows",
}
"""Outputs that jump, by template and name, and why."""
JUMP = 0.02
"""Change of a value, relative, at an input that changes by 1e-8 of itself, that may be a jump."""
LEFT = 0.1
"""Share of its change over a tenth of a decade that a jump makes there, unlike a value through zero."""
FILM, PRESSURE = "minimum_film_thickness", "maximum_pressure"
SENSES = [
    ("oil_film", "short_bearing", "radial_load", {FILM: -1, PRESSURE: 1}),
    ("oil_film", "fit", "radial_load", {FILM: -1}),
    ("oil_film", "map", "radial_load", {FILM: -1, "relative_eccentricity": 1, PRESSURE: 1}),
    ("elastic_film", "rigid", "radial_load", {FILM: -1, PRESSURE: 1}),
    ("thermal_film", "one_temperature", "radial_load", {FILM: -1}),
    ("thermal_film", "one_temperature", "supply_temperature", {FILM: -1}),
    ("mixed_friction", "map", "radial_load", {FILM: -1, "contact_load": 1}),
    ("mixed_friction", "map", "speed", {FILM: 1}),
    ("thrust_bearing", None, "load", {FILM: -1}),
    ("hydrostatic_pad", None, "load", {"film_thickness": -1}),
    ("hydrostatic_pad", None, "supply_pressure", {"film_thickness": 1}),
    ("slider_bearing", "infinite", "dynamic_viscosity", {"load": 1}),
    ("oil_film_cycle", "mobility", "dynamic_viscosity", {FILM: 1, "maximum_eccentricity": -1}),
    ("oil_film_cycle", "mobility_grooved", "bearing_width", {FILM: 1}),
    ("cycle_heat_balance", "mobility", "supply_temperature", {FILM: -1}),
    ("cycle_heat_balance", "mobility_grooved", "heat_share", {"effective_viscosity": -1}),
    ("journal_friction", None, "speed", {"power_loss": 1}),
    ("thermal_clearance", None, "housing_temperature", {"diametral_clearance": 1}),
]
"""Template, level, input, and the outputs that rise (1) or fall (-1) with it."""
BUILT_IN = find([Path(templates.__file__).parent], Template)
LEVELS = [
    pytest.param(cls, level, id=f"{cls.id}-{cls.version}-{level or 'only'}")
    for cls in BUILT_IN
    for level in cls.levels or ("",)
]
every_level = pytest.mark.parametrize(("cls", "level"), LEVELS)


def answer(cls, level, si):
    """The evaluation; None where it is refused by name."""
    return tried(cls, level, si)[0]


def tried(cls, level, si):
    """The evaluation, or None and the names by which it is refused."""
    try:
        return evaluate(cls, typed(cls, si), level=level or None), set()
    except InvalidInputs as refusal:
        faults = refusal.faults
    assert faults
    known = {*cls.inputs, *cls.formulas, "level"}
    assert all(fault.name.split(".")[0].split("[")[0] in known and fault.detail for fault in faults), faults
    return None, {name for fault in faults for name in fault.names}


NEEDS = re.compile(r"needs ([a-z_0-9]+(?:(?:, | and | or )[a-z_0-9]+)*)")


def asked_for(cls, reasons):
    """The inputs that each reason of the form `needs this and that` asks for."""
    for reason in {str(one) for one in np.ravel(reasons) if one}:
        if match := NEEDS.fullmatch(reason):
            names = set(re.split(r", | and | or ", match[1]))
            if names <= cls.inputs.keys():
                yield names


def checked(cls, evaluation, where, given=()):
    """Every value is finite or has a reason, none is of the wrong sign, and each error stated is a number.

    A reason asks for no input that is given.
    """
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
        for names in asked_for(cls, reasons):
            assert not names <= set(given), (name, names, where)
        told = np.broadcast_to(reasons != None, np.broadcast_shapes(missing.shape, reasons.shape))  # noqa: E711
        assert (told | ~missing).all(), (name, where)
        if NEVER_NEGATIVE.search(name) and (cls.id, name) not in SIGNED and (value < 0).any():
            assert SEIZED.get(cls.id, name) in warned, (name, float(np.nanmin(value)), where)
        if SHARE.search(name) and formula.meaning.unit == "1":
            assert not (value > 1 + 1e-9).any(), (name, float(np.nanmax(value)), where)
        if formula.meaning.unit == "degC":
            assert not (value < -273.15).any(), (name, float(np.nanmin(value)), where)
    for name, error in evaluation.error.items():
        stated = np.asarray(error, float)
        assert not (np.isinf(stated) | (stated < 0)).any(), (name, error, where)


def sweep(cls, level, changes, rng):
    """Check the example with each of these changes, each for itself.

    Where an optional input of the example says the same in another way, it goes without that.
    """
    start, required = (
        example_at(cls, level),
        {name for name, declared in cls.inputs.items() if declared.required},
    )
    for change in as_time_allows(changes, rng):
        given = {**start, **change}
        evaluation, names = tried(cls, level, given)
        others = {name for name in names & start.keys() if name not in required | change.keys()}
        if evaluation is None and others:
            given = {name: value for name, value in given.items() if name not in others}
            evaluation, _ = tried(cls, level, given)
        if evaluation is not None:
            checked(cls, evaluation, {name: shown(value) for name, value in change.items()}, given)


def shown(value):
    return value if isinstance(value, str) else np.asarray(value).tolist()


@every_level
def test_property_every_input_over_twelve_decades(cls, level):
    rng = np.random.default_rng(seeded(61))
    changes = [part for name in numeric(cls) for part in parts(cls, level, {name: decades(cls, name)})]
    sweep(cls, level, changes, rng)


@every_level
def test_property_combinations_of_inputs_over_twelve_decades(cls, level):
    rng = np.random.default_rng(seeded(62))
    sweep(cls, level, random_changes(cls, level, rng, COMBINATIONS), rng)


@every_level
def test_property_every_option_and_every_table(cls, level):
    sweep(cls, level, option_changes(cls), np.random.default_rng(seeded(64)))


@every_level
def test_property_curves_of_other_sizes_and_forms(cls, level):
    rng = np.random.default_rng(seeded(65))
    sweep(cls, level, curve_changes(cls, rng), rng)


@every_level
def test_property_every_input_may_be_an_array(cls, level):
    """Two values of one input are two answers, each that of its value alone."""
    rng = np.random.default_rng(seeded(63))
    start = example_at(cls, level)
    names = [name for name in numeric(cls) if name in start and not is_single(cls.inputs[name])]
    if cls.most_points.get(level, 2) < 2:
        return
    for name in as_time_allows(names, rng):
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


@pytest.mark.parametrize(("name", "level", "changed", "follows"), SENSES)
def test_property_each_follows_in_the_sense_that_mechanics_has(name, level, changed, follows):
    """Over eight decades, or from -10 to 200 °C, wherever there is an answer."""
    cls = get(name, 1).template if name != "oil_film" else get(name, 2).template
    start = example_at(cls, level)
    warmer = cls.inputs[changed].meaning.unit == "degC"
    grid = np.linspace(263.15, 473.15, 106) if warmer else start[changed] * 10 ** np.linspace(-4, 4, 161)
    found = evaluate(cls, typed(cls, {**start, changed: grid}), outputs=[*follows], level=level).outputs
    for output, sense in follows.items():
        values = np.asarray(found[output].value, float)
        values = sense * values[np.isfinite(values)]
        assert values.size > 20, output
        assert (np.diff(values) >= -1e-9 * np.abs(values[1:])).all(), output


def quick(cls, level):
    """Whether a point takes milliseconds, as far as the most points at once tell."""
    return cls.most_points.get(level, 10_000) >= 2000


JUMPY = [one for one in LEVELS if quick(*one.values)]


@pytest.mark.parametrize(("cls", "level"), JUMPY)
def test_property_nothing_jumps_without_a_word(cls, level):
    start, jumps = example_at(cls, level), []
    for name in as_time_allows(numeric(cls), np.random.default_rng(seeded(66))):
        declared, value = cls.inputs[name], common(cls, name)
        if declared.meaning.integer or is_single(declared) or not value:
            continue
        grid = value * 10 ** np.linspace(-6, 6, 121)
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
    start = example_at(cls, level)
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
