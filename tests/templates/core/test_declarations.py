"""The language of templates, on small ones made here."""

import json

import jsonschema_rs
import numpy as np
import pytest

from app.calculations import rendering
from templates.core.errors import InvalidInputs
from templates.core.language import dimensions
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.core.language.template import (
    Template,
    Truth,
    choice,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    units,
)
from templates.core.paper.report import rows
from templates.core.paper.schema import describe, inputs_schema


@units("m", returns="m", latex=r"f\left({0}\right)")
def rounded_up(x):
    return np.ceil(x / 1e-3) * 1e-3


@units("m", "1", returns="m**2", latex=r"2\,{0}^2\,{1}-{1}")
def swept(a, x):
    return 2 * np.square(a) * np.asarray(x)


def doubled(x):
    return 2 * x


def branched(x):
    if np.any(x > 0):
        return x
    return -x


class Shaft(Template):
    """A shaft. It turns.

    Limits
    ------
    For shafts only.

    Errata
    ------
    The first is said in one line.
    The second takes
    two lines.

    References
    ----------
    Nobody 1900.
    """

    example = {"bore": "50 mm", "load": {"value": [1, 3, 2], "unit": "kN"}}

    d = given("mm", "bore", gt=1, le=100, also=("inner diameter",))
    n = given("1", "balls", default=8, integer=True, ge=3)
    m = given("kg", "rod mass", default="1 kg", published=(0.5, 2), source="Nobody 1900")
    load = curve("N", "load")
    shape = choice("round", "square_cut", words="web shape", default="round")

    @derived("mm", "outer diameter", gt=0)
    def D(self):
        return 2 * self.d

    @require("outer_diameter", "bore", remedy="make the outside larger")
    def has_wall(self) -> Truth:
        """The outside is larger than the bore."""
        return self.D > self.d

    @formula("mm", "wall", symbol="t")
    def t(self):
        return (self.D - self.d) / 2

    @formula("N", "largest load", symbol=r"F_\max")
    def F(self):
        return np.max(self.load, axis=-1)

    @formula("MPa", "pressure", ge=0, lt=1000, remedy="lower the load")
    def p(self):
        return self.F / (self.d * rounded_up(doubled(self.t)))

    @formula("kg/mm", "mass per width", name="linear_mass")
    def q(self):
        return branched(self.m) / self.t


def codes(refusal):
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


class TestInputs:
    def test_property_kinds_and_defaults(self):
        assert list(Shaft.inputs) == ["bore", "balls", "rod_mass", "load", "web_shape", "outer_diameter"]
        assert list(Shaft.formulas) == ["wall", "largest_load", "pressure", "linear_mass"]
        echo = evaluate(Shaft, Shaft.example).inputs
        assert {name: e.source for name, e in echo.items() if e.source == "given"} == {
            "bore": "given",
            "load": "given",
        }
        assert (echo["outer_diameter"].value, echo["outer_diameter"].unit) == (pytest.approx(100), "mm")
        assert (echo["web_shape"].value, echo["web_shape"].unit) == ("round", None)
        assert echo["balls"].value == 8

    def test_property_derived_gives_way_to_what_is_given(self):
        given_one = evaluate(Shaft, {**Shaft.example, "outer_diameter": "60 mm"})
        assert given_one.outputs["wall"].value == pytest.approx(5)
        assert given_one.inputs["outer_diameter"].source == "given"

    def test_property_curve_reduces_along_its_last_axis(self):
        assert evaluate(Shaft, Shaft.example).outputs["largest_load"].value == pytest.approx(3000)
        two = {"value": [[1, 3, 2], [5, 4, 4]], "unit": "kN"}
        answer = evaluate(Shaft, {**Shaft.example, "load": two}, outputs=["largest_load"]).outputs[
            "largest_load"
        ]
        np.testing.assert_allclose(answer.value, [3000, 5000])

    @pytest.mark.parametrize(
        ("inputs", "name", "code", "words"),
        [
            ({"bore": "1 mm"}, "bore", "out_of_range", "bore is 1 mm; it must be > 1 mm and ≤ 100 mm"),
            ({"bore": "5 inch"}, "bore", "out_of_range", "bore is 5 inch; it must be"),
            ({"balls": 8.5}, "balls", "out_of_range", "it must be a whole number ≥ 3"),
            ({"balls": 2}, "balls", "out_of_range", "balls is 2"),
            ({"web_shape": "oval"}, "web_shape", "not_an_option", "'oval' is none of round, square_cut"),
            ({"web_shape": 5}, "web_shape", "not_an_option", "5 is none of"),
            ({"web_shape": {"value": "oval"}}, "web_shape", "not_an_option", "is none of"),
            ({"web_shape": {"value": "round", "unit": "mm"}}, "web_shape", "not_an_option", "is none of"),
            ({"load": "5 kN"}, "load", "not_a_curve", "give an array over the cycle"),
            ({"bor": "5 mm"}, "bor", "unknown_name", "did you mean bore"),
            ({"\ud800": 1}, "\\ud800", "unknown_name", "known are bore"),
            (
                {"outer_diameter": "50 mm"},
                "bore",
                "inconsistent",
                "outer_diameter = 50 mm, bore = 50 mm; make the",
            ),
        ],
    )
    def test_property_refusals_name_and_mend(self, inputs, name, code, words):
        with pytest.raises(InvalidInputs) as refusal:
            Shaft.from_quantities({**Shaft.example, **inputs})
        detail = next(f.detail for f in refusal.value.faults if name in f.names and f.code == code)
        assert words in detail
        detail.encode("utf-8")

    def test_property_an_option_is_taken_as_answers_write_it(self):
        reported = {**Shaft.example, "web_shape": {"value": "square_cut"}}
        assert evaluate(Shaft, reported, outputs=[]).inputs["web_shape"].value == "square_cut"

    def test_property_missing_inputs_are_named_with_their_unit(self):
        with pytest.raises(InvalidInputs, match="bore is needed; give it in mm") as refusal:
            Shaft.from_quantities({})
        assert codes(refusal) == {("bore", "missing"), ("load", "missing")}

    def test_property_si_values_are_checked_like_typed_ones(self):
        good = Shaft.from_quantities(Shaft.example).inputs_si()
        assert Shaft.from_si(good).t == pytest.approx(0.025)
        with pytest.raises(InvalidInputs) as refusal:
            Shaft.from_si({**good, "rod_mass": np.nan, "bore": 5.0, "load": np.array([1.0, np.inf])})
        assert codes(refusal) == {
            ("rod_mass", "out_of_range"),
            ("bore", "out_of_range"),
            ("load", "out_of_range"),
        }

    def test_property_arrays_must_fit_together(self):
        wrong = {"bore": {"value": [10, 20], "unit": "mm"}, "rod_mass": {"value": [1, 2, 3], "unit": "kg"}}
        with pytest.raises(InvalidInputs, match="bore 2, rod_mass 3") as refusal:
            Shaft.from_quantities({**Shaft.example, **wrong})
        assert codes(refusal) >= {("bore", "shape"), ("rod_mass", "shape")}

    def test_property_curve_is_one_thing_for_each_point(self):
        """Points of other inputs have nothing to do with the places of a curve, only with its other axes."""
        two = {"bore": {"value": [10, 20], "unit": "mm"}, "outer_diameter": "40 mm"}
        answer = evaluate(Shaft, {**Shaft.example, **two}, outputs=["pressure"]).outputs["pressure"]
        assert answer.value.shape == (2,)
        rows = {"load": {"value": [[1, 3, 2]] * 3, "unit": "kN"}}
        with pytest.raises(InvalidInputs, match="bore 2, load 3×3"):
            Shaft.from_quantities({**Shaft.example, **two, **rows})


class TestLimits:
    LOAD = {"load": {"value": [[1, 2]], "unit": "kN"}}

    def test_property_rule_masks_points_of_arrays(self):
        outside = {"value": [60, 40, 70], "unit": "mm"}
        raw = {**Shaft.example, "outer_diameter": outside}
        answer = evaluate(Shaft, raw, outputs=["wall", "largest_load"]).outputs
        np.testing.assert_allclose(answer["wall"].value, [5, np.nan, 10])
        assert list(answer["wall"].reasons) == [
            None,
            "The outside is larger than the bore: make the outside larger",
            None,
        ]
        assert answer["largest_load"].value == pytest.approx(3000)

    def test_property_masks_reach_what_is_beneath_only(self):
        bores = {"value": [50, 500, 20], "unit": "mm"}
        answer = evaluate(
            Shaft, {**Shaft.example, "bore": bores}, outputs=["wall", "largest_load", "pressure"]
        ).outputs
        assert answer["wall"].reasons[1] == "bore must be > 1 mm and ≤ 100 mm"
        assert np.isnan(answer["pressure"].value).tolist() == [False, True, False]
        assert answer["largest_load"].reasons is None

    def test_property_result_outside_its_domain(self):
        heavy = {**Shaft.example, "load": {"value": [1, 9e9], "unit": "N"}}
        assert evaluate(Shaft, heavy, outputs=["wall"]).outputs["wall"].value == pytest.approx(25)
        with pytest.raises(
            InvalidInputs, match=r"would be 3.6e\+06 MPa; it must be ≥ 0 MPa and < 1000 MPa; lower"
        ) as refusal:
            evaluate(Shaft, heavy)
        assert codes(refusal) == {("pressure", "outside_domain")}

    def test_property_published_range_warns(self):
        (warning,) = evaluate(Shaft, {**Shaft.example, "rod_mass": "3 kg"}).warnings
        assert warning.detail == "published for rod mass ≥ 0.5 kg and ≤ 2 kg (Nobody 1900); here it is 3 kg"
        many = {**Shaft.example, "rod_mass": {"value": [1, 3, 4], "unit": "kg"}}
        (warning,) = evaluate(Shaft, many).warnings
        assert "leaves it at 2 of 3 points" in warning.detail

    def test_property_withdrawn_is_said(self):
        class Old(Shaft):
            withdrawn = "wrong by 2 %, use 2"

        (warning,) = evaluate(Old, Shaft.example).warnings
        assert (warning.code, "use 2" in warning.detail) == ("withdrawn", True)
        assert describe(Shaft)["status"] == "released"

    def test_property_tolerance_that_nobody_measured(self):
        (warning,) = evaluate(Shaft, Shaft.example, tolerance=0.01).warnings
        assert warning.code == "tolerance_unmet"
        with pytest.raises(InvalidInputs, match="one level only"):
            evaluate(Shaft, Shaft.example, level="map")


def stations(length):
    return np.asarray(length)[..., None] * np.linspace(0, 1, 3)


class Beam(Template):
    """A beam."""

    example = {"length": "2 m", "load": "1 N", "sag": "1 m"}

    l = given("m", "length", gt=0)  # noqa: E741
    w = given("N", "load")
    s = given("m", "sag", optional=True)

    @profile("m", "place", along="place")
    def x(self):
        return stations(self.l)

    @profile("N*m", "moment", along="place", lt=10, remedy="lower the load")
    def m(self):
        return self.w * self.x

    @profile("m", "line", along="place")
    def y(self):
        return stations(self.s)


class Chain(Template):
    """A chain of masses with springs between them."""

    m = curve("kg", "masses", along="mass", gt=0)
    k = curve("N/m", "springs", along="spring", alternative=True, gt=0)
    limit = given("kg", "limit", default="100 kg")

    @profile("kg", "sums of masses", along="masses", axes=2, lt=10, remedy="take lighter masses")
    def sums(self):
        return self.m[..., None, :] + self.m[..., :, None] + 0 * np.asarray(self.limit)[..., None, None]


class TestProfiles:
    MANY = {"load": "4 N", "sag": "1 m", "length": {"value": [1, -1, 3], "unit": "m"}}

    def test_property_profile_of_a_point(self):
        outputs = evaluate(Beam, {"length": "2 m", "load": "1 N"}).outputs
        np.testing.assert_array_equal(outputs["moment"].value, [0, 1, 2])
        assert (outputs["line"].value, outputs["line"].reason) == (None, "needs sag")
        assert describe(Beam)["outputs"]["properties"]["moment"]["along"] == "place"

    def test_property_profile_of_a_point_is_refused_whole(self):
        with pytest.raises(InvalidInputs, match=r"moment would be 12 N\*m; .*lower the load") as refusal:
            evaluate(Beam, {"length": "3 m", "load": "4 N"})
        assert codes(refusal) == {("moment", "outside_domain")}

    def test_property_profiles_of_arrays_are_masked_whole(self):
        moment = evaluate(Beam, self.MANY).outputs["moment"]
        np.testing.assert_array_equal(moment.value, [[0, 2, 4], [np.nan] * 3, [np.nan] * 3])
        assert [bool(reason) for reason in moment.reasons] == [False, True, True]
        assert "length must be" in moment.reasons[1]
        shown = rendering.outputs({"moment": moment})["moment"]
        assert shown["value"] == [[0, 2, 4], None, None]
        assert json.loads(json.dumps(shown))["reasons"] == list(moment.reasons)

    def test_property_profile_of_two_axes_is_one_thing_for_each_point(self):
        pairs = evaluate(Chain, {"masses": ["1 kg", "2 kg", "3 kg"], "springs": ["1 N/m", "5 N/m"]})
        np.testing.assert_array_equal(pairs.outputs["sums_of_masses"].value[0], [2, 3, 4])
        many = {"masses": {"value": [[1, 2], [9, 1], [3, 3]], "unit": "kg"}}
        answer = evaluate(Chain, many).outputs["sums_of_masses"]
        assert [bool(reason) for reason in answer.reasons] == [False, True, False]
        shown = rendering.outputs({"sums": answer})["sums"]
        assert shown["value"] == [[[2, 3], [3, 4]], None, [[6, 6], [6, 6]]]
        limits = evaluate(Chain, {"masses": ["1 kg"], "limit": ["1 kg", "2 kg"]})
        assert limits.outputs["sums_of_masses"].value.shape == (2, 1, 1)

    def test_property_a_curve_may_be_missing_but_is_no_single_value(self):
        assert np.isnan(Chain.from_quantities({"masses": ["1 kg"]}).k)
        with pytest.raises(InvalidInputs, match="give an array over the mass, in kg"):
            Chain.from_quantities({"masses": "1 kg"})

    def test_property_profile_is_no_target(self):
        with pytest.raises(InvalidInputs, match="single value") as refusal:
            solve(Beam, {"load": "1 N"}, "length", ["1 m", "2 m"], {"moment": "1 N*m"})
        assert codes(refusal) == {("target.moment", "not_a_number")}


class TestLanguage:
    def test_property_a_template_is_a_record(self):
        template = Shaft.from_quantities(Shaft.example)
        with pytest.raises(AttributeError, match="make a new one"):
            template.d = 1.0
        with pytest.raises(AttributeError, match="make a new one"):
            del template.d
        assert template.t is template.t

    def test_property_equal_names_are_refused(self):
        with pytest.raises(TypeError, match="'bore'"):

            class Twice(Template):
                a = given("mm", "bore")
                b = given("mm", "Bore")

    def test_property_words_of_the_language_are_refused(self):
        with pytest.raises(TypeError, match="version has a meaning"):

            class Reserved(Template):
                version = given("1", "number")

    @pytest.mark.parametrize("keywords", [{"words": "Ø"}, {"words": "2 radii"}, {"words": "x", "name": "aB"}])
    def test_property_names_must_be_snake_case(self, keywords):
        with pytest.raises(TypeError, match="snake_case"):
            given("mm", **keywords)

    def test_property_border_must_be_si(self):
        with pytest.raises(TypeError, match="mm is not SI"):
            units("mm", returns="m")

    def test_property_rule_needs_a_sentence(self):
        with pytest.raises(TypeError, match="docstring"):
            require("a", remedy="b")(lambda self: True)

    def test_property_branches_have_no_place_in_a_formula(self):
        class Branching(Template):
            """Branches."""

            a = given("m", "length")

            @formula("m", "result")
            def r(self):
                if self.a > 1:
                    return self.a
                return -self.a

        with pytest.raises(TypeError, match="a formula is one return"):
            describe_formulas(Branching)


def describe_formulas(cls):
    return [f.expression for f in cls.formulas.values()]


class TestPaper:
    def test_property_report(self):
        written = {row.name: row for row in rows(evaluate(Shaft, Shaft.example).template)}
        assert written["wall"].latex == (
            r"t=\frac{D-d}{2}=\frac{100\,\text{mm}-50\,\text{mm}}{2}=25\,\text{mm}"
        )
        assert written["pressure"].expression == r"\frac{F_\max}{d\,f\left(2\,t\right)}"
        assert written["linear_mass"].expression == r"\frac{\operatorname{branched}\left(m\right)}{t}"
        assert written["largest_load"].numbers == ""

    def test_property_negative_numbers_stand_in_parentheses(self):
        class Difference(Template):
            """A difference."""

            a = given("degC", "first")
            x = given("1", "second")

            @formula("1", "result")
            def r(self):
                return 2 - self.x**2

        (row,) = rows(evaluate(Difference, {"first": "5 degC", "second": -3}).template)
        assert row.latex == r"r=2-x^{2}=2-\left(-3\right)^{2}=-7"

    def test_property_formulas_written_by_hand_hold_numbers_as_well(self):
        class Momentum(Template):
            """A product whose LaTeX is written by hand."""

            a = given("mm", "first")
            x = given("1", "second")

            @formula("m**2", "result", symbol="P")
            def r(self):
                return swept(self.a, self.x)

        (row,) = rows(evaluate(Momentum, {"first": "5 mm", "second": -3}).template)
        assert row.expression == r"2\,a^2\,x-x"
        five, three = r"\left(5\,\text{mm}\right)^2", r"\left(-3\right)"
        assert row.numbers == rf"2\cdot {five}\cdot {three}-{three}"

    def test_property_page(self):
        page = json.loads(json.dumps(describe(Shaft)))
        assert page["title"] == "A shaft"
        assert page["errata"] == ["The first is said in one line.", "The second takes two lines."]
        assert page["references"] == ["Nobody 1900."]
        limits = {(limit.get("name"), limit["text"]) for limit in page["limits"]}
        assert (None, "For shafts only.") in limits
        assert ("bore", "bore > 1 mm and ≤ 100 mm") in limits
        assert ("outer_diameter", "The outside is larger than the bore") in limits

    def test_property_schema(self):
        schema = inputs_schema(Shaft)
        assert schema["required"] == ["bore", "load"]
        bore, balls, shape = (schema["properties"][name] for name in ("bore", "balls", "web_shape"))
        assert (bore["unit"], bore["exclusiveMinimum"], bore["maximum"]) == ("mm", 1, 100)
        assert (balls["multipleOf"], balls["minimum"], balls["default"]) == (
            1,
            3,
            {"value": 8.0, "unit": "1"},
        )
        assert (shape["enum"], shape["default"]) == (["round", "square_cut"], "round")
        assert schema["properties"]["outer_diameter"]["default_formula"] == r"2\,d"


def squared(self):
    return self.d**2


def added_to_mass(self):
    return self.d + self.m


def added_to_number(self):
    return self.d + 1


def exponential(self):
    return np.exp(self.d) * self.d


def mass_across_border(self):
    return rounded_up(self.m)


def mass_doubled(self):
    return doubled(self.m)


class TestDimensions:
    def test_analytic_right_dimensions_pass(self):
        assert dimensions.faults(Shaft) == []

    @pytest.mark.parametrize(
        ("calculate", "words"),
        [
            (squared, "wrong is declared in m, but its formula gives m²"),
            (added_to_mass, "wrong: Cannot convert"),
            (added_to_number, "wrong: Cannot convert"),
            (exponential, "wrong: Cannot convert"),
            (mass_across_border, "rounded_up takes x in m, not in kg"),
            (mass_doubled, "wrong is declared in m, but its formula gives kg"),
        ],
    )
    def test_analytic_wrong_dimensions_are_found(self, calculate, words):
        class Wrong(Template):
            """Wrong on purpose."""

            example = {"length": "2 m", "mass": "3 kg"}
            d = given("m", "length")
            m = given("kg", "mass")
            w = formula("m", "wrong")(calculate)

        (fault,) = dimensions.faults(Wrong)
        assert words in fault

    def test_analytic_wrong_rule_is_found(self):
        class Wrong(Template):
            """Wrong on purpose."""

            example = {"length": "2 m", "mass": "3 kg"}
            d = given("m", "length")
            m = given("kg", "mass")

            @require("length", "mass", remedy="none")
            def rule(self) -> Truth:
                """A length is less than a mass."""
                return self.d < self.m

        (fault,) = dimensions.faults(Wrong)
        assert fault.startswith("A length is less than a mass: Cannot convert")


class Stepped(Template):
    """Steps of a length."""

    example = {"length": "2 m", "steps": "3"}

    a = given("m", "length", gt=0)
    n = given("1", "steps", integer=True, single=True, ge=1, le=9)

    @profile("m", "places", along="places")
    def x(self):
        return np.asarray(self.a)[..., None] * np.arange(int(self.n))


class TestSingle:
    def test_property_one_value_serves_all_points(self):
        outputs = evaluate(Stepped, {"length": {"value": [1, 2], "unit": "m"}, "steps": 3}).outputs
        assert outputs["places"].value.tolist() == [[0, 1, 2], [0, 2, 4]]

    def test_property_an_array_is_refused_by_name(self):
        with pytest.raises(InvalidInputs) as refusal:
            Stepped.from_quantities({"length": "1 m", "steps": [3, 4]})
        assert [(fault.name, fault.code) for fault in refusal.value.faults] == [("steps", "not_single")]

    def test_property_schema_takes_no_array(self):
        forms = inputs_schema(Stepped)["properties"]["steps"]
        assert not jsonschema_rs.is_valid(forms, [3, 4])
        assert not jsonschema_rs.is_valid(forms, {"value": [3, 4], "unit": "1"})
        assert jsonschema_rs.is_valid(forms, 3)
