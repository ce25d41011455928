"""Each construct of Mathcad becomes a worksheet line whose value agrees with a stored result."""

import math as python
from pathlib import Path

import pytest
from mathcad_files import (
    apply,
    call,
    constant,
    define,
    define_function,
    legacy,
    legacy_math,
    math,
    name,
    prime,
    raw,
    real,
    scale,
    shown,
    tag,
    text,
    unit,
    united,
    vector,
    words,
)

from app.worksheets.imports.job import imported
from templates.core.language.evaluate import evaluate
from templates.core.sheets import read


def regions_of(*regions, **options):
    """The records of regions, and the text, which the language reads without a fault."""
    sheet = imported(prime(*regions, **options), "Sheet")
    read(sheet.text)
    return sheet.record["regions"], sheet.text


def last(*regions, **options):
    """The record of the last region."""
    return regions_of(*regions, **options)[0][-1]


X = math(define("x", scale(500, "mm")))
LIST = math(define("v", vector(real(1), real(2), real(4))))


def test_a_literal_is_an_input_and_a_formula_is_an_output():
    sheet = [X, math(define("y", apply("mult", real(2), name("x"))))]
    records, text = regions_of(*sheet)
    assert 'given x [mm] = 500 mm "x"' in text
    assert 'y [mm] = 2 * x "y"' in text
    assert [record["state"] for record in records] == ["unverified", "unverified"]


def test_where_inputs_are_tagged_only_these_are_inputs():
    tagged = math(define("x", scale(500, "mm")), tag="Input")
    _, text = regions_of(tagged, math(define("y", scale(2, "mm"))))
    assert "given x [mm] = 500 mm" in text
    assert "\ny [mm] = 2 mm" in text


@pytest.mark.parametrize(
    ("formula", "result"),
    [
        (apply("plus", name("x"), scale(1, "m")), united(real(1.5), meter=1)),
        (apply("minus", name("x"), scale(1, "m")), united(real(-0.5), meter=1)),
        (apply("neg", name("x")), united(real(-0.5), meter=1)),
        (apply("div", name("x"), unit("mm")), real(500)),
        (apply("pow", name("x"), real(2)), united(real(0.25), meter=2)),
        (apply("pow", name("x"), apply("div", real(1), real(2))), None),
        (apply("nthRoot", tag("placeholder"), apply("pow", name("x"), real(2))), united(real(0.5), meter=1)),
        (apply("absval", apply("neg", name("x"))), united(real(0.5), meter=1)),
        (apply("div", name("x"), apply("percent", real(50))), united(real(1), meter=1)),
        (call("sin", scale(30, "deg")), real(0.5)),
        (call("atan2", real(2), real(1)), real(python.atan2(1, 2))),
        (call("log", real(1000)), real(3)),
        (call("log", real(256), real(2)), real(8)),
        (call("ln", real(2)), real(python.log(2))),
        (apply("pow", constant("e"), real(3)), real(python.exp(3))),
        (apply("factorial", real(5)), real(120)),
        (call("max", real(1), real(3), real(2)), real(3)),
        (call("round", real(2.6)), real(3)),
        (apply("xor", real(0), real(1)), real(1)),
        (apply("and", real(1), real(0)), real(0)),
        (apply("lessThan", name("x"), scale(1, "m")), real(1)),
        (call("if", apply("greaterThan", name("x"), scale(1, "m")), real(7), real(8)), real(8)),
        (apply("mult", constant("g"), scale(2, "kg")), united(real(19.6133), newton=1)),
    ],
)
def test_a_result_is_that_of_mathcad(formula, result):
    record = last(X, math(shown(formula), result or ""))
    assert record["state"] == ("verified" if result else "refused"), record


def test_a_result_in_a_unit_that_is_asked_for_is_a_multiple_of_it():
    sheet = [X, math(define("y", shown(apply("mult", name("x"), real(3)), unit("cm"))), "150")]
    records, text = regions_of(*sheet)
    assert 'y [cm] = x * 3 "y"' in text
    assert records[-1]["state"] == "verified"
    assert records[-1]["mathcad"] == [pytest.approx(150)]
    assert records[-1]["unit"] == "cm"


def test_another_value_than_mathcads_is_shown_beside_it():
    record = last(X, math(shown(apply("mult", name("x"), real(3))), united(real(1.6), meter=1)))
    assert record["state"] == "differs"
    assert record["mathcad"] == [pytest.approx(1.6)]
    assert record["worksheet"] == [pytest.approx(1.5)]


def test_results_agree_within_a_part_in_a_thousand_million():
    near, far = (str(1.5 * (1 + error)) for error in (5e-10, 5e-9))
    formula = shown(apply("mult", name("x"), real(3)))
    assert last(X, math(formula, united(real(near), meter=1)))["state"] == "verified"
    assert last(X, math(formula, united(real(far), meter=1)))["state"] == "differs"


def test_greek_letters_and_subscripts_make_names_that_keep_their_look():
    _, text = regions_of(math(define("σ_c", scale(3, "MPa"))))
    assert 'given sigma_c [MPa] = 3 MPa "sigma_c" (symbol "\\sigma_{c}")' in text


def test_a_name_that_is_defined_again_becomes_another():
    records, text = regions_of(
        X, math(define("x", scale(1, "m"))), math(shown(name("x")), united(real(1), meter=1))
    )
    assert "given x_2 [m] = 1 m" in text
    assert records[1]["notes"] == ["x is defined again here: from here on it is x_2"]
    assert records[2]["state"] == "verified"


def test_a_function_gets_its_units_from_its_calls():
    square = define_function("f", ["a"], apply("mult", name("a"), name("a")))
    of_length, of_number = call("f", name("x")), call("f", real(3))
    records, text = regions_of(
        X, math(square), math(shown(of_length), united(real(0.25), meter=2)), math(shown(of_number), "9")
    )
    assert "f(a [mm]) [m**2] = a * a" in text
    assert "f_2(a [1]) [1] = a * a" in text
    assert [record["state"] for record in records[2:]] == ["verified", "verified"]


def test_a_condition_of_several_lines_is_one_formula():
    test = tag("test", apply("lessThan", name("a"), real(1)))
    chain = tag("if", test, tag("then", tag("program", real(10))))
    other = tag("elseif", tag("test", apply("lessThan", name("a"), real(2))), tag("then", real(20)))
    body = tag("program", chain, other, tag("else", real(30)))
    calls = [
        math(shown(call("f", real(value))), str(result)) for value, result in ((0, 10), (1, 20), (2, 30))
    ]
    records, text = regions_of(math(define_function("f", ["a"], body)), *calls)
    assert "if a < 1 then 10 else if a < 2 then 20 else 30" in text
    assert [record["state"] for record in records[1:]] == ["verified"] * 3


def test_local_names_of_a_program_are_written_out():
    body = tag(
        "program", tag("localDefine", name("b"), apply("mult", real(2), name("x"))), tag("return", name("b"))
    )
    assert last(X, math(define("y", shown(body)), united(real(1), meter=1)))["state"] == "verified"


def test_a_vector_is_a_list_and_its_first_item_has_mathcads_index():
    item = math(shown(apply("indexer", name("v"), real(1))), "2")
    assert last(LIST, item)["state"] == "verified"
    item = math(shown(apply("indexer", name("v"), real(1))), "1")
    assert last(LIST, item, origin=1)["state"] == "verified"


@pytest.mark.parametrize(
    ("formula", "result"),
    [
        (apply("mult", real(2), name("v")), vector(real(2), real(4), real(8))),
        (apply("mult", name("v"), name("v")), real(21)),
        (apply("vectorize", apply("mult", name("v"), name("v"))), vector(real(1), real(4), real(16))),
        (call("mean", name("v")), real(7 / 3)),
        (call("max", name("v")), real(4)),
        (call("length", name("v")), real(3)),
        (call("stdev", name("v")), real(python.sqrt(14 / 9))),
        (call("Stdev", name("v")), real(python.sqrt(14 / 6))),
        (
            apply(
                "summation",
                tag("lambda", tag("boundVars", name("k")), apply("indexer", name("v"), name("k"))),
                tag("lowerBound", real(0)),
                tag("upperBound", real(2)),
            ),
            real(7),
        ),
        (
            apply(
                "summation",
                tag("lambda", tag("boundVars", name("k")), apply("mult", name("k"), name("k"))),
                tag("lowerBound", real(1)),
                tag("upperBound", real(4)),
            ),
            real(30),
        ),
    ],
)
def test_lists_calculate_as_mathcads_vectors_do(formula, result):
    record = last(LIST, math(shown(formula), result))
    assert record["state"] == "verified", record


def test_a_range_defines_items_one_by_one():
    along = math(define("i", tag("range", real(0), real(3))))
    items = math(define(apply("indexer", name("w"), name("i")), apply("mult", name("i"), scale(2, "mm"))))
    total = math(shown(call("max", name("w"))), united(real(0.006), meter=1))
    records, _ = regions_of(along, items, total)
    assert [record["state"] for record in records] == ["unverified", "unverified", "verified"]


def test_one_item_of_a_list_may_get_another_value():
    item = math(define(apply("indexer", name("v"), real(1)), real(9)))
    records, text = regions_of(LIST, item, math(shown(call("mean", name("v"))), str(14 / 3)))
    assert "v_2 [1] over items_3 = [v[1], 9, v[3]]" in text
    assert records[-1]["state"] == "verified"


def test_linear_interpolation_is_a_curve():
    across = vector(scale(0, "mm"), scale(10, "mm"), scale(20, "mm"))
    curve = call("linterp", across, vector(real(1), real(2), real(4)), scale(15, "mm"))
    records, text = regions_of(math(shown(curve), "3"))
    assert "curve interpolation(x [mm]) [1]" in text
    assert records[0]["state"] == "verified"
    assert "outside its points" in records[0]["notes"][0]


def test_a_combo_box_is_a_choice_and_its_row_gives_the_value():
    values = tag("ComboBoxValues", real(410), real(500), real(550))
    box = tag("ComboBoxControl", values, rows=3, cols=1, SelectedRow=2)
    doubled = math(shown(apply("mult", real(2), name("f"))), "1100")
    records, text = regions_of(math(define("f", box)), doubled)
    assert 'choice f_row = row_550 "f_row" (row_410 | row_500 | row_550)' in text
    assert records[-1]["state"] == "verified"


def test_a_combo_box_of_texts_can_be_tested():
    box = tag(
        "ComboBoxControl", tag("ComboBoxValues", text("Yes"), text("No")), rows=2, cols=1, SelectedRow=1
    )
    test = call("if", apply("equal", name("crack"), text("Yes")), real(1), real(2))
    records, text_ = regions_of(math(define("crack", box)), math(shown(test), "2"))
    assert "if crack is yes then 1 else 2" in text_
    assert records[-1]["state"] == "verified"


def test_a_global_definition_counts_above_itself():
    early = math(shown(apply("mult", real(2), name("G"))), "20")
    late = math(tag("globalDefine", name("G"), real(10)))
    assert regions_of(early, late)[0][0]["state"] == "verified"


@pytest.mark.parametrize(
    ("formula", "construct"),
    [
        (tag("matrix", *[real(1)] * 4, rows=2, cols=2), "matrix"),
        (tag("program", tag("for", name("i"), tag("range", real(1), real(3)), real(1))), "loop"),
        (apply("integral", tag("lambda", tag("boundVars", name("z")), name("z"))), "integral"),
        (call("rnorm", real(3), real(0), real(1)), "random numbers"),
        (text("ok"), "text"),
        (tag("imag", ""), "complex number"),
        (call("eigenvals", name("x")), "matrix function"),
        (constant("∞"), "infinity"),
        (tag("if", tag("test", real(1)), tag("then", real(1))), "the condition has no `otherwise` branch"),
        (apply("plus", name("x"), real(1)), "the worksheet language refuses the formula"),
        (name("nothing"), "name nothing that nothing above defines"),
        (tag("unheard"), "construct unheard"),
    ],
)
def test_what_worksheets_do_not_have_is_refused_by_its_name(formula, construct):
    needs = math(define("z", apply("mult", real(2), name("y"))))
    records, text = regions_of(X, math(define("y", formula)), needs)
    assert records[1]["state"] == "refused"
    assert records[1]["reason"].startswith(construct)
    assert records[1]["remedy"]
    assert f"// refused: {records[1]['reason']} (region 1)" in text
    assert (records[2]["state"], records[2]["blocked_by"]) == ("blocked", "1")


def test_a_solve_block_asks_for_bounds():
    inner = "".join(
        f'<region region-id="{number}" solve-block-category="{role}"><math>{body}</math></region>'
        for number, (role, body) in enumerate(
            {
                "guess-value": define("q", real(3)),
                "constraint": apply("equal", apply("pow", name("q"), real(2)), real(2)),
                "solver": define("r", call("find", name("q"))),
            }.items(),
            start=10,
        )
    )
    records, _ = regions_of(raw(f"<solveblock><regions>{inner}</regions></solveblock>"))
    assert [record["state"] for record in records] == ["shown", "shown", "shown", "refused"]
    assert "so that" in records[-1]["remedy"]


def test_every_region_is_accounted_for_in_its_place():
    sheet = [words("Bearing"), X, raw("<plot/>"), raw("<picture/>"), raw("<pageBreak/>"), words("The end")]
    records, text = regions_of(*sheet)
    assert [record["kind"] for record in records] == ["text", "math", "plot", "picture", "page break", "text"]
    assert [record["top"] for record in records] == [0, 20, 40, 60, 80, 100]
    assert text.startswith("# Bearing\n")
    assert "> The end" in text


def test_text_that_looks_like_a_statement_stays_prose():
    _, text = regions_of(X, words('given y [mm] = 1 mm "y"'))
    assert '> given y [mm] = 1 mm "y"' in text


def test_a_sheet_of_mathcad_15_is_read_alike():
    half = "<ml:apply><ml:mult/><ml:real>500</ml:real><ml:id>mm</ml:id></ml:apply>"
    x = f"<ml:define><ml:id>x</ml:id>{half}</ml:define>"
    stored = "<result><ml:real>1500</ml:real></result>"
    united_ = (
        '<result><unitedValue><ml:real>1500</ml:real><u:unitMonomial><u:unitReference unit="millimeter"/>'
    )
    united_ += "</u:unitMonomial></unitedValue></result>"
    formula = "<ml:apply><ml:mult/><ml:real>3</ml:real><ml:id>x</ml:id></ml:apply>"
    y = f'<ml:define><ml:id subscript="a">y</ml:id><ml:eval>{formula}{united_}</ml:eval></ml:define>'
    case = '<ml:ifThen><ml:apply><ml:lessThan/><ml:id>x</ml:id><ml:id subscript="a">y</ml:id></ml:apply>'
    case += "<ml:real>1500</ml:real></ml:ifThen><ml:otherwise><ml:real>1</ml:real></ml:otherwise>"
    z = f"<ml:define><ml:id>z</ml:id><ml:eval><ml:program>{case}</ml:program>{stored}</ml:eval></ml:define>"
    bodies = [legacy_math(x), "<text><p>Some words</p></text>", legacy_math(y), legacy_math(z)]
    sheet = imported(legacy(*bodies), "Old")
    assert 'given x [mm] = 500 mm "x"' in sheet.text
    assert "> Some words" in sheet.text
    assert [record["state"] for record in sheet.record["regions"]] == [
        "unverified",
        "shown",
        "verified",
        "verified",
    ]


class TestRates:
    """To Mathcad rad, 1/s and Hz are alike; here a frequency in Hz stays one."""

    SPEED = math(define("N", scale(5000, "rpm")))

    def lines(self, *regions):
        _, written = regions_of(self.SPEED, *regions)
        return written.splitlines()

    def test_a_frequency_shown_in_hz_stays_in_hz(self):
        """The case syn_omega.mcdx: 5000 rpm are 83.33 Hz, and no angular speed of 83.33 rad/s."""
        turned = apply("div", name("N"), apply("mult", real(2), constant("π")))
        shown_f = math(shown(name("f"), unit("Hz")), real(83.33333333333333))
        records, written = regions_of(self.SPEED, math(define("f", turned)), shown_f)
        assert 'f [Hz] = N / (2 * pi) "f"' in written.splitlines()
        assert records[-1]["state"] == "verified"

    def test_the_case_of_a_sheet_with_speeds_and_frequencies(self):
        """`f` shown in Hz, 83.33 of them; `w2` shown in rpm and `w3` in rad/s, each v/r."""
        content = (Path(__file__).parent / "cases" / "syn_omega.mcdx").read_bytes()
        lines = imported(content, "Sheet").text.splitlines()
        assert 'f [Hz] = N / (2 * pi) "f"' in lines
        assert 'w2 [rad/s] = 2 * v / D "w2"' in lines
        assert 'w3 [rad/s] = 2 * v / D "w3"' in lines
        assert any(line.startswith("S [1] = ") for line in lines)
        cls = read("\n".join(line for line in lines if not line.startswith("//")) + "\n").template("case", 1)
        evaluation = evaluate(cls, cls.example)
        assert evaluation.outputs["f"].value == pytest.approx(5000 / 60)
        assert [warning.name for warning in evaluation.warnings if warning.code == "turns"] == ["v", "s"]

    def test_a_frequency_that_is_shown_in_no_unit_is_no_angular_speed(self):
        turned = apply("div", name("N"), apply("mult", real(2), constant("π")))
        assert 'f [1/s] = N / (2 * pi) "f"' in self.lines(math(define("f", turned)))
        assert 'g [Hz] = 2 * f "g"' in self.lines(
            math(define("f", scale(50, "Hz"))), math(define("g", apply("mult", real(2), name("f"))))
        )

    @pytest.mark.parametrize("asked", ["rpm", "rad"])
    def test_a_rate_that_is_shown_as_a_speed_is_one(self, asked):
        per_second = unit("rpm") if asked == "rpm" else apply("div", unit("rad"), unit("s"))
        rate = apply("div", scale(10, "m"), apply("mult", scale(2, "m"), scale(1, "s")))
        lines = self.lines(math(define("w", rate)), math(shown(name("w"), per_second)))
        assert any(line.startswith("w [rad/s] = ") or line.startswith("given w [rad/s] = ") for line in lines)

    def test_a_number_made_of_a_speed_in_turns_is_a_pure_number(self):
        product = apply("mult", name("N"), scale(2, "s"))
        assert 'S [1] = N * 2 s "S"' in self.lines(math(define("S", product)))
