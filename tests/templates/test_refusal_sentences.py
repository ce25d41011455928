"""Refusals of violated rules: each sentence agrees with its own numbers.

Every rule of every template and model is violated: most by one input of the example, which is searched over
its bounds and around what the rule compares; others beside random changes; the rest by the inputs of `HARD`.
"""

import random
import re
from time import process_time

import numpy as np
import pytest
from seeds import seeded
from true_numbers import assert_true_of_its_numbers

from cad.catalogue import models
from templates.core.errors import InvalidInputs, TemplateError
from templates.core.language.comparisons import outcome
from templates.core.language.intake import admitted, read_inputs
from templates.core.language.ledger import Ledger
from templates.core.language.spec import Choice, Curve, Table
from templates.core.units.quantity import read
from templates.door import built_in

ROUNDS, SECONDS = 20, 10.0  # changed examples that the long search begins at, and its time for one rule
NEAR = (0.3, 0.5, 0.8, 0.95, 0.999, 1.0, 1.0003, 1.001, 1.05, 1.2, 2.0, 3.0, 10.0, -1.0)
DECADES = [sign * size * 10.0**power for power in range(-12, 13) for size in (1, 3) for sign in (1, -1)]
WHOLE = (*range(13), 16, 20, 25, 32, 50, 100, 101, 200, 1000, 1001, 10**4, 10**5, 10**6)
ROWS = ([], [[0.0]], [[10.0, 400.0]], [[10.0, -5.0]], [[0.0, 20.0]] * 40, [[1.0, 3.0], [1.0, 3.0]])


def given(values, unit):
    return {"value": np.asarray(values, dtype=float).tolist(), "unit": unit}


def matrix(**entries):
    """The compliance of 38 modes, with the entries (row, column) changed."""
    values = np.eye(38)
    for place, value in entries.items():
        values[tuple(int(number) for number in place[1:].split("_"))] = value
    return values


HALF_TABLE = {
    "gas_cycle": "table",
    "pressure_angle": given(np.arange(0, 361, 45), "deg"),
    "pressure": given([1, 1, 2, 9, 40, 9, 3, 2, 1], "bar"),
}
BACKWARDS = HALF_TABLE | {"pressure_angle": given(np.arange(720, 0, -80), "deg")}
MANY = {"speed": given(np.full(20_001, 2000.0), "rpm"), "crank_angle_step": "1 deg"}
GAS = ("bearing_load", "engine", "flywheel")
COLD = {"viscosity_law": "vogel", "temperature_1": "-99 degC"}
OILED = sorted({cls.id for cls in built_in() if hasattr(cls, "vogel_is_known")})
CYCLE = given(np.arange(0, 721, 45), "deg")
OPEN_TABLE = {
    "gas_cycle": "table",
    "pressure_angle": given(np.arange(0, 721, 90), "deg"),
    "pressure": given([1, 1, 2, 9, 40, 9, 3, 2, 5], "bar"),
}
TURNS = {
    "pin_hole_length": "5 mm", "pin_hole_arc": "5 mm", "pin_hole_angle": "0 deg", "speed": "4321 rpm",
    "crank_speed": "5000 rpm",
}  # fmt: skip
IN_LINE = {
    **dict.fromkeys(["pin_angles", "throws", "masters", "articulation_radius", "articulation_angle"]),
    "main_positions": None, "web_positions": None, "bank_angles": "0 deg",
    "cylinder_positions": given([0, 90, 180], "mm"), "rod_length": "145 mm", "rod_mass": "0.8 kg",
    "rod_centre": "40 mm", "rod_inertia": "2900 kg*mm**2",
}  # fmt: skip
CHAIN = {
    **dict.fromkeys(["absolute_damping", "shaft_damping", "loss_factors", "section_moduli"]),
    **dict.fromkeys(["gear_from", "gear_to", "gear_ratios"]),
}
FED = ("cycle_heat_balance", "oil_film_cycle")
LONG = np.arange(120_000.0) % 7
HARD = [  # a template or model, its rule, and what violates it
    *[(id, "manageable", MANY) for id in GAS],
    *[(id, "table_closes", OPEN_TABLE) for id in GAS],
    *[(id, "table_is_full", HALF_TABLE) for id in GAS],
    *[(id, "table_rises", BACKWARDS) for id in GAS],
    *[(id, "vogel_is_known", COLD) for id in OILED],
    ("oil_film", "lobes_stand_still", {"bore_shape": "lemon", "preload": 0.5, "sleeve_speed": "1000 rpm"}),
    *[(id, "sleeve_comes_back", {"sleeve_speed": "100 rpm"}) for id in FED],
    *[(id, "journal_comes_back", TURNS) for id in FED],
    ("elastic_film", "compliance_is_square", {"compliance": given(matrix()[:37], "um/GPa")}),
    ("elastic_film", "compliance_is_mutual", {"compliance": given(matrix(_0_3=0.5), "um/GPa")}),
    ("elastic_film", "compliance_takes_energy", {"compliance": given(matrix(_2_2=-1), "um/GPa")}),
    ("engine", "order_agrees",
     {**IN_LINE, "firing_order": [1, 3, 2], "firing_angles": given([0, 240, 480], "deg")}),
    ("fatigue_life", "points_are_the_same", {"stress_of_force_1": given([[2, 1, 7, 0, 0, 2]], "MPa/kN")}),
    ("fatigue_life", "not_too_much",
     {"force_1": given(LONG, "kN"), "force_2": given(LONG, "kN"), "moment_1": given(LONG, "N*m")}),
    ("forced_torsion", "few",
     {**CHAIN, "inertias": given(np.ones(101), "kg*m**2"), "shaft_from": [*range(1, 101)],
      "shaft_to": [*range(2, 102)], "shaft_stiffness": given(np.ones(100), "kN*m/rad")}),
    ("forced_torsion", "no_gear_loop", {"gear_from": [6, 7], "gear_to": [7, 6], "gear_ratios": [-0.4, -0.4]}),
    ("forced_torsion", "gas_closes",
     {"crank_angle": CYCLE, "gas_torque": given([0, 700, 300, 9] * 4 + [50], "N*m"), "inertia_torque": None,
      "inertia_speed": None}),
    ("forced_torsion", "inertia_closes",
     {"crank_angle": CYCLE, "gas_torque": None, "inertia_torque": given([0, -60, 0, 60] * 4 + [50], "N*m")}),
    ("forced_torsion", "manageable", {"speeds": given(np.linspace(800, 2300, 2001), "rpm")}),
    ("torsional_vibration", "not_too_long", {"engine_orders": [*range(1, 502)]}),
    *[(id, "flanks_clear_corners", {"web_shape": "obround", "counterweight_angle": "179.95 deg"})
      for id in ("crank_throw", "crankshaft")],
    ("crankshaft", "throws_are_few",
     {"pin_angles": given(np.arange(17) * 20, "deg"), "counterweight_radius": "0 mm"}),
    ("plain_bearing", "groove_ends_clearly", {"oil_groove_depth": "0.5 mm", "lining_thickness": "0.5 mm"}),
]  # fmt: skip


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


def beneath(cls, rule):
    """The inputs that a rule names or reads."""
    read = {name for used in rule.uses for name in cls.dependencies(used)} | set(rule.uses_as_given)
    return [name for name, declared in cls.inputs.items() if declared.attribute in read or name in rule.names]


def compared(cls, rule, raw):
    """The numbers that a rule names or compares [SI], three of each side at most."""
    typed, _ = read_inputs(cls, raw)
    intake = admitted(cls, typed)
    template = cls(intake.values, Ledger(typed=typed, missing=intake.missing))

    def sides(result):
        if result.comparison is not None:
            yield from (result.comparison.left.value, result.comparison.right.value)
        for part in result.parts:
            yield from sides(part)

    try:
        with np.errstate(all="ignore"):
            named = [getattr(template, cls.inputs[name].attribute) for name in rule.names]
            numbers = [one for one in named if isinstance(one, (float, np.ndarray))]
            values = [*numbers, *sides(outcome(template, rule))]
            found = [np.ravel(np.asarray(value, dtype=float))[:3] for value in values]
    except (TemplateError, TypeError, ValueError, ArithmeticError, LookupError):
        return []  # the rule needs what is not there
    return [float(value) for side in found for value in side if np.isfinite(value)]


def values_for(cls, name, numbers):
    """Values of an input over all that it may be, and around numbers [SI]; None leaves it out."""
    declared = cls.inputs[name]
    if isinstance(declared, Choice):
        return list(declared.options)
    meaning = declared.meaning
    if isinstance(declared, Table):
        return [None, *(given(rows, meaning.unit) for rows in ROWS)]
    own = np.asarray(_value(cls, declared, 1.0), dtype=float)
    if isinstance(declared, Curve) or own.ndim:
        return [
            None,
            *(given(values, meaning.unit) for values in _curves(own if own.ndim else np.full(4, own))),
        ]
    if meaning.integer:
        return [None, *(given(value, meaning.unit) for value in WHOLE)]
    ends = [end for end in meaning.interval if abs(end) < 1e100]
    around = [float(meaning.scale.from_si(one * factor)) for one in (*numbers, *ends) for factor in NEAR]
    one = [0.0, *(float(own) * factor for factor in NEAR), *around, *DECADES]
    many = [] if getattr(declared, "single", False) else [np.full(20_001, own)]
    return [None, *(given(value, meaning.unit) for value in [*one, *many])]


def _curves(own):
    """A curve in other sizes, lengths and forms."""
    count = own.shape[-1]
    yield from (own * factor for factor in (1e-6, 1e-3, 0.1, 0.5, 0.9, 1.1, 2, 10, 1e3, 1e6, -1, 0))
    yield from (own[..., ::-1], own[..., :-1], own[..., :1], own[..., :2], own[..., :3])
    yield from (np.concatenate([own, own[..., -1:]], axis=-1), np.concatenate([own, own], axis=-1))
    yield from (np.ones(count), np.arange(count), np.arange(1, count + 1), own.max())
    yield from (np.stack([own, 1.01 * own]), np.stack([own, own[..., ::-1]]))
    for place in {0, count // 2, count - 1}:
        for factor in (0, 0.5, 2, 10, 1000, -1):
            spike = own.copy()
            spike[..., place] *= factor
            yield spike


def searched(cls, sentence, rules, rng):
    """Sentences that inputs violate with which a rule was looked for; each refusal is checked."""
    rule, found, begin = rules[sentence], set(), process_time()
    names = beneath(cls, rule)
    alone = {name: value for name, value in cls.example.items() if name not in rule.names}
    for start in [dict(cls.example), alone, *(violating(cls, [rule], rng) for _ in range(ROUNDS))]:
        for name in names:
            for value in values_for(cls, name, compared(cls, rule, start)):
                changes = {**start, name: value}
                try:
                    cls.from_quantities({key: one for key, one in changes.items() if one is not None})
                except InvalidInputs as error:
                    found |= {one for fault in error.faults for one in rules if states_the_case(fault, one)}
                except TemplateError:
                    continue
                if sentence in found or process_time() - begin > SECONDS:
                    return found
    return found


@pytest.mark.parametrize(("id", "name", "changes"), HARD)
def test_property_a_rule_that_no_search_violates_states_what_is(id, name, changes):
    cls = max((cls for cls in (*built_in(), *models()) if cls.id == id), key=lambda cls: cls.version)
    (rule,) = (rule for rule in cls.requirements if rule.function.__name__ == name)
    raw = {name: value for name, value in {**cls.example, **changes}.items() if value is not None}
    with pytest.raises(InvalidInputs) as refused:
        cls.from_quantities(raw)
    assert any(states_the_case(fault, rule.sentence) for fault in refused.value.faults)


@pytest.mark.slow
@pytest.mark.parametrize("cls", [*built_in(), *models()], ids=lambda cls: f"{cls.id}_{cls.version}")
def test_property_every_rule_is_violated_and_states_what_is(cls):
    rng = random.Random(seeded(362))
    found, rules = violated(cls, 150, rng)
    hard = {name for id, name, _ in HARD if id == cls.id}
    for sentence, rule in rules.items():
        if sentence not in found and rule.function.__name__ not in hard:
            found |= searched(cls, sentence, rules, rng)
    missing = {sentence for sentence, rule in rules.items() if rule.function.__name__ not in hard} - found
    assert not missing


def test_property_a_masked_point_states_what_is():
    """At points of arrays that violate a rule the reason names the relation, not what ought to be."""
    (cls,) = [cls for cls in built_in() if (cls.id, cls.version) == ("oil_film", 2)]
    clearance = {"value": [60.0, 0.05], "unit": "mm"}
    template = cls.from_quantities({**cls.example, "diametral_clearance": clearance})
    (mask,) = [mask for mask in template.ledger.masks if "required" in mask.reason]
    assert mask.reason.startswith("diametral clearance is not below bearing diameter; required: ")
    assert mask.where.tolist() == [True, False]
