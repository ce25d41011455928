"""Property tests over the whole catalogue: every template and model file is covered automatically."""

import json
import re
from itertools import chain
from pathlib import Path
from xml.etree import ElementTree

import jsonschema_rs
import numpy as np
import pytest
from newest import older_slow
from seeds import seeded

import templates
from cad.catalogue import models
from templates.core.catalogue import golden
from templates.core.catalogue.digests import digest, release_file
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language import dimensions
from templates.core.language.evaluate import evaluate, is_reported
from templates.core.language.intake import is_single
from templates.core.language.spec import Choice, Curve, Derived, Given, Profile, Table, Text
from templates.core.language.template import Template
from templates.core.paper import report
from templates.core.paper.schema import describe, inputs_schema

GOLDEN = Path(__file__).parents[1] / "golden"
BUILT_IN = find([Path(templates.__file__).parent], Template)
EVERY = [pytest.param(cls, id=f"{cls.id}-{cls.version}") for cls in chain(BUILT_IN, models())]
every_template = pytest.mark.parametrize("cls", EVERY)
newest_templates = pytest.mark.parametrize("cls", older_slow(chain(BUILT_IN, models())))
SAMPLED = {
    ("cycle_heat_balance", 1): 20,
    ("engine", 1): 6,
    ("fatigue_life", 1): 4,
    ("forced_torsion", 1): 4,
    ("mixed_friction", 1): 6,
    ("oil_film", 2): 3,
    ("oil_film_cycle", 1): 3,
    ("thermal_film", 1): 9,
    ("thrust_bearing", 1): 6,
}
"""Of these versions, which take long, one golden case in so many, one bad point and one output in six:
test_golden_at_length.py calculates the others."""
SLOW_LEVELS = {
    ("oil_film_cycle", 1, "flooded"),
    ("oil_film_cycle", 1, "supplied"),
    ("cycle_heat_balance", 1, "supplied"),
    ("thermal_film", 1, "fine_field"),
}
"""Levels of which one golden case takes seconds: that file calculates them too."""

SNAKE_CASE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def typed(cls, si):
    """SI values by API name, as a user types them."""
    return {name: as_typed(cls.inputs[name], value) for name, value in si.items()}


def as_typed(declared, value):
    if isinstance(declared, Choice):
        return value
    shown = declared.meaning.scale.from_si(np.asarray(value, dtype=float))
    return {"value": shown.tolist(), "unit": declared.meaning.unit}


def example_si(cls):
    template = cls.from_quantities(cls.example)
    reported = {name: declared for name, declared in cls.inputs.items() if is_reported(template, declared)}
    return {name: getattr(template, declared.attribute) for name, declared in reported.items()}


class TestDeclarations:
    @every_template
    def test_property_names_are_snake_case(self, cls):
        names = [cls.id, *cls.inputs, *cls.formulas]
        assert all(SNAKE_CASE.fullmatch(name) for name in names), names

    @every_template
    def test_property_example_covers_required_inputs(self, cls):
        required = {name for name, declared in cls.inputs.items() if declared.required}
        assert required <= cls.example.keys() <= cls.inputs.keys()

    @every_template
    def test_property_defaults_lie_in_their_domain(self, cls):
        declared = [d for d in cls.inputs.values() if isinstance(d, Given) and d.default]
        assert all(np.all(d.meaning.admits(d.default.si)) for d in declared)

    @every_template
    def test_property_formulas_use_what_is_declared_without_loops(self, cls):
        for formula in cls.formulas.values():
            assert formula.uses, f"{formula.name} is a constant, no formula"
            beneath = [cls.ancestors(used) for used in formula.uses]
            assert all(formula.attribute not in ancestors for ancestors in beneath), formula.name

    @every_template
    def test_property_dimensions_of_every_formula(self, cls):
        assert dimensions.faults(cls) == []


class TestSchema:
    @every_template
    def test_property_example_is_valid(self, cls):
        validator = jsonschema_rs.validator_for(inputs_schema(cls))
        assert validator.is_valid(dict(cls.example)), list(validator.iter_errors(dict(cls.example)))
        assert not validator.is_valid({**cls.example, "no_such_input": "1 mm"})

    @every_template
    def test_property_echo_is_accepted_again(self, cls):
        """What `evaluate` says it used, sent again, is valid and gives the same."""
        first = evaluate(cls, cls.example)
        echoed = {
            name: echo.value if echo.unit is None else {"value": echo.value, "unit": echo.unit, **echo.extra}
            for name, echo in first.inputs.items()
        }
        assert jsonschema_rs.is_valid(inputs_schema(cls), echoed)
        second = evaluate(cls, json.loads(json.dumps(echoed)))
        for name, answer in first.outputs.items():
            if isinstance(answer.value, (str, type(None))):
                assert second.outputs[name] == answer, name
            else:
                assert second.outputs[name].value == pytest.approx(answer.value, rel=1e-12, abs=0), name

    @every_template
    def test_property_description_is_json(self, cls):
        page = describe(cls)
        assert json.loads(json.dumps(page, allow_nan=False)) == page
        assert [formula["name"] for formula in page["formulas"]] == list(cls.formulas)
        assert page["title"]
        assert jsonschema_rs.meta.is_valid(page["inputs"])
        assert jsonschema_rs.meta.is_valid(page["outputs"])


class TestReport:
    @every_template
    def test_property_every_row_renders(self, cls):
        template = evaluate(cls, cls.example).template
        rows = list(report.rows(template))
        assert [row.name for row in rows] == list(cls.formulas)
        for row in rows:
            assert row.expression
            assert row.result or isinstance(cls.formulas[row.name], Profile)
            assert balanced(row.latex), row.latex
            assert ElementTree.fromstring(row.mathml).tag.endswith("math")

    @every_template
    def test_property_symbols_are_distinct(self, cls):
        page = describe(cls)
        properties = {**page["inputs"]["properties"], **page["outputs"]["properties"]}
        used = [p["symbol"] for p in properties.values() if "symbol" in p]
        assert len(used) == len(set(used)), sorted(used)


def balanced(latex):
    """Whether braces, and \\left with \\right, come in pairs."""
    depth = 0
    for brace in re.findall(r"(?<!\\)[{}]", latex):
        depth += 1 if brace == "{" else -1
        if depth < 0:
            return False
    return depth == 0 and latex.count(r"\left") == latex.count(r"\right")


class TestLaziness:
    @every_template
    def test_property_one_output_computes_its_ancestors_only(self, cls):
        assert_lazy(cls, some(cls, cls.formulas.values()))


def some(cls, items):
    """Of a version that takes long one item in six, else all."""
    return list(items)[:: 6 if (cls.id, cls.version) in SAMPLED else 1]


def assert_lazy(cls, formulas):
    """Each output calculates what it needs and nothing else."""
    for formula in formulas:
        template = cls.from_quantities(cls.example)
        before = set(vars(template))
        getattr(template, formula.attribute)
        computed = set(vars(template)) - before
        assert formula.attribute in computed | before
        assert computed <= with_assumed(cls, formula.attribute), formula.name


def with_assumed(cls, attribute):
    """The ancestors, and what their published ranges rest on."""
    beneath = cls.ancestors(attribute)
    assumed = chain.from_iterable(
        cls.declarations[n].meaning.assumes for n in beneath if n in cls.declarations
    )
    return beneath.union(*(cls.ancestors(name) for name in assumed))


class TestGolden:
    @every_template
    def test_golden_results_are_unchanged(self, cls):
        path = golden.golden_file(cls, GOLDEN)
        assert path.exists(), f"not frozen; run: crankwright freeze {cls.id} {cls.version}"
        record = json.loads(path.read_text(encoding="utf-8"))
        assert record["digest"] == digest(cls), (
            f"the code of {cls.id} {cls.version} was edited; a change to a released version is a new version"
        )
        assert json.loads(release_file(cls).read_text(encoding="utf-8")) == {"digest": digest(cls)}
        assert len(record["cases"]) > len(cls.inputs)
        for case in record["cases"][:: SAMPLED.get((cls.id, cls.version), 1)]:
            check_case(cls, case, record["precision"])

    @every_template
    def test_golden_results_of_every_level_are_unchanged(self, cls):
        cases = json.loads(golden.golden_file(cls, GOLDEN).read_text(encoding="utf-8"))
        recorded = {case["level"] for case in cases["levels"]}
        assert recorded == set(cls.levels) - {cls.default_level}
        for case in cases["levels"]:
            if (cls.id, cls.version, case["level"]) not in SLOW_LEVELS:
                check_case(cls, case, case.get("precision", cases["precision"]))


def check_case(cls, case, precision):
    if "refused" in case:
        with pytest.raises(InvalidInputs) as refusal:
            golden.results(cls, case["inputs"], case.get("level", ""))
        assert golden.codes(refusal.value) == sorted(set(case["refused"]))
        return
    results = golden.results(cls, case["inputs"], case.get("level", ""))
    assert results.keys() == case["outputs"].keys()
    for name, value in case["outputs"].items():
        if isinstance(value, list):
            measured, reference = np.asarray(results[name], dtype=float), np.asarray(value, dtype=float)
            assert measured == pytest.approx(reference, rel=precision, abs=0, nan_ok=True), (
                name,
                case["inputs"],
            )
            continue
        reference = (
            value if isinstance(value, (str, type(None))) else pytest.approx(value, rel=precision, abs=0)
        )
        assert results[name] == reference, (name, case["inputs"])


class TestArrays:
    """One point and many are the same calculation; a point that means nothing harms no other."""

    @newest_templates
    def test_property_array_is_pointwise(self, cls):
        inputs = around_example(cls, np.random.default_rng(1), 9)
        assert_pointwise(cls, inputs, range(9))

    @newest_templates
    def test_property_bad_point_harms_no_neighbour(self, cls):
        assert_harmless(cls, some(cls, bounded_givens(cls)))

    @newest_templates
    def test_property_extremes_are_finite_or_refused(self, cls):
        count = 30 if (cls.id, cls.version) in SAMPLED else 300
        assert_finite_or_refused(cls, extremes(cls, np.random.default_rng(3), count), count)

    @pytest.mark.slow
    @every_template
    def test_property_ten_thousand_extremes_are_finite_or_refused(self, cls):
        random, count = np.random.default_rng(seeded(3)), 10_000
        at_once = min(count, cls.most_points.get(cls.default_level, count))
        for _ in range(count // at_once):
            assert_finite_or_refused(cls, extremes(cls, random, at_once), at_once)

    @newest_templates
    @pytest.mark.parametrize("count", [80, pytest.param(400, marks=pytest.mark.slow)])
    def test_property_extremes_agree_with_single_points(self, cls, count):
        inputs = extremes(cls, np.random.default_rng(4), count)
        assert_pointwise(cls, inputs, range(count))


def assert_harmless(cls, names):
    """A bad point of one of these inputs changes no other point, and each output of it says why."""
    good = around_example(cls, np.random.default_rng(2), 9)
    clean = numbers(cls, typed(cls, good))
    for name in names:
        bad = {**good, name: with_bad_point(cls.inputs[name], good[name], 4)}
        outputs = numbers(cls, typed(cls, bad))
        hit = [output for output in outputs if cls.inputs[name].attribute in ancestors_of(cls, output)]
        for output in hit:
            assert np.isnan(outputs[output].value[4]).all(), output
            assert outputs[output].reasons[4], output
        for output, answer in outputs.items():
            others = np.delete(at_points(cls, output, answer, 9), 4, axis=0)
            expected = np.delete(at_points(cls, output, clean[output], 9), 4, axis=0)
            np.testing.assert_array_equal(others, expected, err_msg=f"{output} with bad {name}")


def numbers(cls, raw):
    """The outputs that are not texts, at the level that is taken when nothing is asked for."""
    outputs = evaluate(cls, raw, level=cls.default_level or None).outputs
    return {name: answer for name, answer in outputs.items() if not isinstance(cls.formulas[name], Text)}


def bounded_givens(cls):
    plain = (
        d
        for n, d in cls.inputs.items()
        if type(d) is Given and n in starting(cls) and not (d.meaning.integer or is_single(d))
    )
    return [d.name for d in plain if d.meaning.domain_si is not None]


def with_bad_point(declared, values, place):
    bounds = declared.meaning.domain_si
    below = next((limit for limit in (bounds.gt, bounds.ge) if limit is not None), None)
    bad = below - 1 if below is not None else next(x for x in (bounds.lt, bounds.le) if x is not None) + 1
    return np.where(np.arange(len(values)) == place, bad, values)


def ancestors_of(cls, output):
    return cls.ancestors(cls.formulas[output].attribute)


def around_example(cls, rng, size):
    """Arrays within ±2 % of the example for all inputs but the derived ones, which follow."""
    return {name: spread(cls.inputs[name], value, rng, size) for name, value in starting(cls).items()}


def starting(cls):
    return {
        name: value for name, value in example_si(cls).items() if not isinstance(cls.inputs[name], Derived)
    }


def spread(declared, value, rng, size):
    if isinstance(declared, (Choice, Curve, Table)) or declared.meaning.integer or is_single(declared):
        return value
    return value * rng.uniform(0.98, 1.02, size)


def extremes(cls, rng, size):
    return {name: extreme(cls.inputs[name], value, rng, size) for name, value in starting(cls).items()}


def extreme(declared, value, rng, size):
    """Near the example, decades away, at and beside the bounds, zero, negative, tiny and huge."""
    if isinstance(declared, (Choice, Curve, Table)) or is_single(declared):
        return value
    bounds = declared.meaning.domain_si
    limits = [x for x in (vars(bounds).values() if bounds else ()) if x is not None]
    edges = [e for x in limits for e in (x, np.nextafter(x, np.inf), np.nextafter(x, -np.inf))]
    special = rng.choice([*edges, 0.0, -value, 1e-300, 1e300, 1e-9, 1e9], size)
    near = value * rng.uniform(0.9, 1.1, size)
    decades = value * 10 ** rng.uniform(-6, 6, size)
    drawn = np.choose(rng.choice(3, size, p=[0.75, 0.2, 0.05]), [near, decades, special])
    return np.round(drawn) if declared.meaning.integer else drawn


def assert_finite_or_refused(cls, inputs, count):
    """Points far outside of common sense: each is a finite number, or none with its reason."""
    for name, answer in numbers(cls, typed(cls, inputs)).items():
        value = at_points(cls, name, answer, count)
        assert not np.isinf(value).any(), name
        missing = np.isnan(value.reshape(count, -1)).any(axis=1)
        reasons = np.full(count, None) if answer.reasons is None else answer.reasons
        np.testing.assert_array_equal(missing, reasons != None, err_msg=name)  # noqa: E711


def assert_pointwise(cls, inputs, points):
    """Each point of an array evaluation against the evaluation of that point alone."""
    shown = typed(cls, inputs)
    together = numbers(cls, shown)
    compared = 0
    for i in points:
        alone = evaluated_alone(cls, {n: point(cls.inputs[n], value, i) for n, value in shown.items()})
        at = {name: at_points(cls, name, answer, len(points))[i] for name, answer in together.items()}
        if alone is None:
            assert not at or any(np.isnan(value).any() for value in at.values()), (
                i
            )  # a model may have no formula
        else:
            compared += 1
            for name, answer in alone.items():
                expected = np.nan if answer.value is None else answer.value
                assert at[name] == pytest.approx(expected, rel=1e-9, abs=0, nan_ok=True), (name, i)
    assert compared > 0


def at_points(cls, name, answer, size):
    """The values of an output at every point; a profile's along a further axis."""
    value = np.asarray(answer.value)
    formula = cls.formulas[name]
    places = value.shape[-formula.axes :] if isinstance(formula, Profile) else ()
    return np.broadcast_to(value, (size, *places))


def point(declared, value, i):
    """One of the points that an input spans; a curve is the same at all of them here."""
    is_array = (
        isinstance(value, dict)
        and isinstance(value["value"], list)
        and not isinstance(declared, (Curve, Table))
    )
    return {**value, "value": value["value"][i]} if is_array else value


def evaluated_alone(cls, raw):
    """The outputs for single values, or None where they are refused by name."""
    try:
        outputs = numbers(cls, raw)
    except InvalidInputs as refusal:
        faults = refusal.faults
    else:
        for name, answer in outputs.items():
            assert answer.reason if answer.value is None else np.isfinite(answer.value).all(), name
        return outputs
    assert faults
    assert all(fault.name in {*cls.inputs, *cls.formulas} and fault.detail for fault in faults)
    return None
