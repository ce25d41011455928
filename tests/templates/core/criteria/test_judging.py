"""Verdicts agree with hand calculations: each verdict, edges, arrays, curves, expressions, temperatures."""

import math

import numpy as np
import pytest
from seeds import seeded

from templates.core.criteria.bands import Estimate
from templates.core.criteria.comparison import (
    MET,
    MET_ERROR_UNKNOWN,
    NOT_CHECKED,
    NOT_MET,
    UNDECIDED,
    VERDICTS,
    compare,
)
from templates.core.criteria.criterion import NameDescription, read_criterion
from templates.core.criteria.evaluation import Absent, Along, judge
from templates.core.criteria.judgement import sentence, verdict_sentence
from templates.core.criteria.summary import summarised, worst_first
from templates.core.criteria.worst import worst_of_rows
from templates.core.errors import FaultyText

NAN = math.nan
KNOWN = {
    "film": NameDescription("um", "smallest film"),
    "limit": NameDescription("um", "permissible film"),
    "load": NameDescription("kN", "load"),
    "temperature": NameDescription("degC", "film temperature"),
    "angle": NameDescription("deg", "attitude angle"),
}
FILM = read_criterion("film", "film >= 3 um", KNOWN)
LOAD = read_criterion("load", "load <= 25 kN", KNOWN)


def um(value, error=0.0, **more):
    si = np.asarray(value, dtype=float) * 1e-6
    return Estimate(si if si.ndim else float(si), error, **more)


def of_film(value, error=0.0, **more):
    return judge(FILM, {"film": um(value, error, **more)})


@pytest.mark.parametrize(
    ("value", "error", "verdict", "needs"),
    [
        (3.24, 0.003, "met", None),  # 3.2303 … 3.2497
        (2.9, 0.003, "not_met", None),
        (3.24, 0.1, "undecided", 0.08),  # 3.24/1.08 = 3
        (2.9, 0.1, "undecided", 1 - 2.9 / 3),  # 2.9/(1 - e) = 3
        (3.0, 0.0, "met", None),  # equality
        (3.0, 0.1, "undecided", 0.0),
        (0.0, 0.0, "not_met", None),
        (-1.0, 0.5, "not_met", None),
        (-1.0, NAN, "not_met", None),
        (3.24, NAN, "met", None),
        (9.0, 2.0, "met", None),  # 3 … infinity
        (8.9, 2.0, "undecided", None),  # an error below 197 %: nothing worth saying
    ],
)
def test_analytic_verdict_of_a_film(value, error, verdict, needs):
    result = of_film(value, error)
    assert result.verdict == verdict
    assert result.needs == (None if needs is None else pytest.approx(needs))
    assert VERDICTS[compare(FILM, {"film": um([value], np.array([error]))}).rows()[0]] == verdict


@pytest.mark.parametrize(
    ("load", "error", "verdict"),
    [(25e3, 0.0, "met"), (20e3, 0.1, "met"), (30e3, 0.1, "not_met"), (24e3, 0.1, "undecided")],
)
def test_analytic_verdict_of_an_upper_limit(load, error, verdict):
    assert judge(LOAD, {"load": Estimate(load, error)}).verdict == verdict


@pytest.mark.parametrize(
    ("text", "value", "verdict"),
    [
        ("ratio >= 3", 4.5, "met"),  # 4.5/1.5 … 9: the limit is the lower end
        ("ratio >= 9", 4.5, "undecided"),  # the upper end, which would meet
        ("ratio <= 9", 4.5, "met"),
        ("ratio <= 3", 4.5, "undecided"),
    ],
)
def test_analytic_limit_at_an_end_of_the_band(text, value, verdict):
    criterion = read_criterion("ratio", text, {"ratio": NameDescription("1", "ratio")})
    assert judge(criterion, {"ratio": Estimate(value, 0.5)}).verdict == verdict


def test_analytic_numbers_of_a_verdict():
    """As the interface shows it: 3.24 um against 3 um, within 0.3 %."""
    result = of_film(3.24, 0.003)
    assert result.value == pytest.approx(3.24)
    assert result.limit == pytest.approx(3)
    assert result.band == pytest.approx((3.24 / 1.003, 3.24 / 0.997))
    assert result.relative_error == 0.003
    assert result.utilisation == pytest.approx(3 / 3.24)
    assert (result.margin, result.margin_unit) == (pytest.approx(0.24), "um")
    load = judge(LOAD, {"load": Estimate(30e3)})
    assert (load.utilisation, load.margin) == (pytest.approx(1.2), pytest.approx(-5))


@pytest.mark.parametrize(
    ("value", "text"), [(-2.0, "film >= 3 um"), (2.0, "film >= -3 um"), (0.0, "film <= 3 um")]
)
def test_no_utilisation_unless_both_are_positive(value, text):
    assert judge(read_criterion("film", text, KNOWN), {"film": um(value)}).utilisation is None


@pytest.mark.parametrize(
    ("value", "verdict"), [(-2.0, "met"), (-4.0, "not_met"), (-3.1, "undecided"), (-3.0, "undecided")]
)
def test_analytic_negative_limit(value, verdict):
    """The band of a negative value is swapped: -3.1 ± 10 % is -3.444 … -2.818."""
    criterion = read_criterion("film", "film >= -3 um", KNOWN)
    assert judge(criterion, {"film": um(value, 0.1)}).verdict == verdict


def test_analytic_temperatures_have_a_margin_in_kelvin_and_no_utilisation():
    criterion = read_criterion("hot", "temperature <= 120 degC", KNOWN)
    result = judge(criterion, {"temperature": Estimate(273.15 + 95)})
    assert (result.value, result.limit) == (pytest.approx(95), pytest.approx(120))
    assert (result.margin, result.margin_unit, result.utilisation) == (pytest.approx(25), "delta_degC", None)


def test_analytic_angles_are_off_by_a_share_of_90_degrees():
    criterion = read_criterion("angle", "angle <= 60 deg", KNOWN)
    angle = Estimate(math.radians(30), 0.2, scale=math.pi / 2)  # ± 22.5°
    result = judge(criterion, {"angle": angle})
    assert (result.verdict, result.band) == ("met", pytest.approx((7.5, 52.5)))
    assert (
        judge(criterion, {"angle": Estimate(math.radians(45), 0.2, scale=math.pi / 2)}).verdict == "undecided"
    )


def test_a_limit_has_a_band_too():
    criterion = read_criterion("film", "film >= limit", KNOWN)
    estimates = {"film": um(3.5, 0.1), "limit": um(3.0, 0.05)}  # 3.18 … 3.89 and 2.857 … 3.158
    assert judge(criterion, estimates).verdict == "met"
    wider = {"film": um(3.5, 0.1), "limit": um(3.0, 0.06)}  # up to 3.191
    assert judge(criterion, wider).verdict == "undecided"


@pytest.mark.parametrize("missing", ["film", "limit"])
def test_a_criterion_without_a_side_is_not_checked(missing):
    criterion = read_criterion("film", "film >= limit", KNOWN)
    other = {"film": "limit", "limit": "film"}[missing]
    result = judge(criterion, {other: um(3.0)}, {missing: Absent(("roughness",), "give the roughness")})
    assert (result.verdict, result.give, result.reason) == (
        "not_checked",
        ("roughness",),
        "give the roughness",
    )
    assert (result.value, result.limit) == ((None, 3.0) if missing == "film" else (3.0, None))


def test_nothing_is_met_by_a_value_that_does_not_exist():
    assert of_film(NAN).verdict == "not_checked"
    assert of_film([3.5, NAN]).counts == {"not_checked": 1, "met": 1}


def test_analytic_arrays_have_a_verdict_per_row_and_the_worst_is_reported():
    reasons = np.array([None, None, "no oil", None], dtype=object)
    result = of_film([4.0, 3.1, NAN, 2.0], np.array([0.0, 0.1, 0.0, 0.0]), reasons=reasons)
    assert result.rows.tolist() == [MET, UNDECIDED, NOT_CHECKED, NOT_MET]
    assert (result.verdict, result.points) == ("not_met", 4)
    assert result.counts == {"not_met": 1, "undecided": 1, "not_checked": 1, "met": 1}
    assert [(place.name, place.value) for place in result.where] == [("point", 4)]
    assert result.value == pytest.approx(2)
    assert of_film([4.0, NAN], reasons=reasons[1:3]).reason == "no oil"


def test_the_worst_of_equal_verdicts_is_nearest_to_its_limit():
    criterion = read_criterion("film", "film >= limit", KNOWN)
    result = judge(criterion, {"film": um([4.0, 40.0]), "limit": um([3.0, 39.0])})
    assert (result.verdict, result.where[0].value, result.value) == ("met", 2, pytest.approx(40))


def test_analytic_curves_are_judged_at_every_place_by_their_own_band():
    """Two cycles of three angles; the second's film of 3.05 um is off by 10 % of 4 um / 0.9."""
    curves = um([[5.0, 4.0, 6.0], [3.05, 4.0, 3.8]], np.array([0.01, 0.1]), axes=1)
    along = Along("crank_angle", np.array([0.0, 120.0, 240.0]), "deg")
    result = judge(FILM, {"film": curves}, along=along)
    assert result.rows.tolist() == [MET, UNDECIDED]
    assert (result.verdict, result.points) == ("undecided", 2)
    assert [(p.name, p.value, p.unit) for p in result.where] == [
        ("point", 2, "1"),
        ("crank_angle", 0.0, "deg"),
    ]
    assert result.band == pytest.approx((3.05 - 4 / 9, 3.05 + 4 / 9))
    assert result.relative_error == 0.1
    one = judge(FILM, {"film": um([2.0, 4.0], axes=1)}, along=along)
    assert (one.verdict, one.points, one.counts) == ("not_met", None, None)


def test_limits_may_be_curves():
    criterion = read_criterion("film", "film >= limit", KNOWN)
    along = Along("crank_angle", np.array([0.0, 180.0]), "deg")
    estimates = {"film": um([3.0, 4.0], axes=1), "limit": um([2.0, 5.0], axes=1)}
    result = judge(criterion, estimates, along=along)
    assert (result.verdict, result.limit, result.where[0].value) == ("not_met", pytest.approx(5), 180.0)
    points = {"film": um([[3.0, 4.0], [3.0, 4.0]], axes=1), "limit": um([2.0, 3.5])}
    assert judge(criterion, points, along=along).rows.tolist() == [MET, NOT_MET]


def test_arrays_that_do_not_fit_are_not_checked():
    estimates = {"film": um([1.0, 2.0]), "limit": um([1.0, 2.0, 3.0])}
    for text in ("film + limit >= 0 um", "film >= limit"):
        result = judge(read_criterion("film", text, KNOWN), estimates)
        assert result.verdict == "not_checked"
        assert "different lengths" in result.reason


def test_an_expression_states_the_error_of_its_band():
    criterion = read_criterion("twice", "2 * film >= 6 um", KNOWN)
    result = judge(criterion, {"film": um(3.5, 0.1)})
    assert (result.verdict, result.unit, result.value) == ("met", "um", pytest.approx(7))
    assert result.relative_error == pytest.approx(0.1)


@pytest.mark.parametrize(("value", "verdict"), [(4.0, "met"), (2.133, "not_met"), (3.0, "met")])
def test_without_a_known_error_the_value_itself_is_judged_and_nothing_is_green(value, verdict):
    result = of_film(value, NAN)
    assert (result.verdict, result.error_known, result.band, result.needs) == (verdict, False, None, None)
    assert result.reason == "error of film unknown"
    assert result.is_open
    assert not summarised([result]).green
    assert summarised([of_film(4.0)]).green


@pytest.mark.parametrize(
    ("limit", "verdict"), [("8 um", "met"), ("10 um", "undecided"), ("12 um", "not_met")]
)
def test_analytic_the_known_part_of_a_band_may_hold_the_limit(limit, verdict):
    """The sum of 5 um ± 20 % (4.167 … 6.25 um) and of 5 um of an unknown error: 9.167 … 11.25 um at least."""
    meanings = {**KNOWN, "other": NameDescription("um", "other")}
    criterion = read_criterion("both", f"film + other >= {limit}", meanings)
    result = judge(criterion, {"film": um(5.0, 0.2), "other": um(5.0, NAN)})
    assert (result.verdict, result.error_known, result.band) == (verdict, False, None)
    assert result.reason.startswith("error of other unknown")
    assert ("known part" in result.reason) == (verdict == "undecided")


def test_met_with_an_unknown_error_is_counted_apart_and_comes_before_what_is_met():
    ordered = worst_first([of_film(4.0), of_film(9.0, NAN), of_film(2.0, NAN)])
    assert [(j.verdict, j.error_known) for j in ordered] == [
        ("not_met", False),
        ("met", False),
        ("met", True),
    ]
    summary = summarised(ordered)
    assert summary.headline == "1 met, 1 met (error unknown), 1 not met"
    assert (summary.counts["met"], summary.error_unknown) == (2, 1)


def test_a_fixed_limit_that_is_met_does_not_govern_while_the_real_one_is_missing():
    meanings = {**KNOWN, "permissible": NameDescription("um", "permissible film")}
    exists = read_criterion("exists", "film >= 0.05 um", meanings)
    real = judge(read_criterion("film", "film >= permissible", meanings), {"film": um(4.0)})
    assert summarised(worst_first([judge(exists, {"film": um(4.0)}), real])).governing is None
    assert summarised(worst_first([judge(exists, {"film": um(0.04)}), real])).governing == "exists"
    given = judge(
        read_criterion("film", "film >= permissible", meanings), {"film": um(4.0), "permissible": um(3.0)}
    )
    assert summarised(worst_first([judge(exists, {"film": um(4.0)}), given])).governing == "film"


@pytest.mark.parametrize(
    ("value", "low", "high", "verdict"),
    [(0.9, 1, 2, MET), (1.5, 1, 2, UNDECIDED), (2.1, 1, 2, NOT_MET)],
)
def test_analytic_verdict_against_an_uncertain_limit(value, low, high, verdict):
    """The limit lies between limit/(1 + e) and limit/(1 - e)."""
    criterion = read_criterion("film", "film <= limit", KNOWN)
    error = (high - low) / (high + low)
    assert compare(criterion, {"film": um(value), "limit": um(low * (1 + error), error)}).rows() == verdict


def test_a_limit_whose_error_is_not_known_is_named():
    criterion = read_criterion("film", "film >= limit", KNOWN)
    of_limit = judge(criterion, {"film": um(4.0), "limit": um(3.0, NAN)})
    assert (of_limit.verdict, of_limit.reason) == ("met", "error of limit unknown")
    elsewhere = {"film": um([3.1, 9.0], np.array([0.1, NAN])), "limit": um(3.0)}
    assert "a relative error below" in judge(criterion, elsewhere).reason


@pytest.mark.parametrize("places", [1, 2, 3])
def test_the_worst_place_of_each_row_is_reported(places):
    value = np.array([[5.0, 2.0, 4.0], [2.5, 6.0, 1.0]])[:, :places] * 1e-6
    compared = compare(FILM, {"film": Estimate(value)}, [])
    codes, sides = worst_of_rows(FILM, compared, 2)
    smallest = value.min(axis=1)
    assert codes.tolist() == [MET if one >= 3e-6 else NOT_MET for one in smallest]
    assert sides[0] == pytest.approx(smallest)


def test_property_scalars_and_arrays_agree():
    random = np.random.default_rng(seeded(2))
    value = random.choice([-3.0, -1.0, 0.0, 1.0, 2.7, 3.0, 3.3, 4.0, NAN], size=400)
    error = random.choice([0.0, 0.1, 0.5, 1.0, 3.0, NAN], size=400)
    rows = compare(FILM, {"film": um(value, error)}).rows()
    single = [
        compare(FILM, {"film": um(float(v), float(e))}).rows() for v, e in zip(value, error, strict=True)
    ]
    assert rows.tolist() == single
    assert set(single) == {MET, MET_ERROR_UNKNOWN, NOT_MET, UNDECIDED, NOT_CHECKED}


def test_property_a_verdict_holds_for_every_truth_of_the_stated_error():
    random = np.random.default_rng(seeded(3))
    truth = 3e-6 * (1 + random.normal(scale=0.1, size=3000))
    error = random.uniform(0, 0.3, size=3000)
    value = truth * (1 + error * random.uniform(-1, 1, size=3000))
    rows = compare(FILM, {"film": Estimate(value, error)}).rows()
    assert (truth[rows == MET] >= 3e-6 * (1 - 1e-12)).all()
    assert (truth[rows == NOT_MET] < 3e-6 * (1 + 1e-12)).all()
    assert (rows == UNDECIDED).any()


def test_summary_is_worst_first_and_the_governing_one_is_checked():
    names = {"a": 4.0, "b": 2.0, "c": 1.0, "d": NAN, "e": 3.1}
    errors = {"e": 0.2}
    judged = [
        judge(read_criterion(n, "film >= 3 um", KNOWN), {"film": um(v, errors.get(n, 0.0))})
        for n, v in names.items()
    ]
    ordered = worst_first(judged)
    assert [j.name for j in ordered] == ["c", "b", "e", "d", "a"]
    summary = summarised(ordered)
    assert (summary.verdict, summary.governing) == ("not_met", "c")
    assert summary.headline == "1 met, 2 not met, 1 undecided, 1 not checked"
    assert summarised([]).headline == "no criteria"


@pytest.mark.parametrize(
    ("require", "numbers", "said"),
    [
        ("a.t_out <= a.t_in + 30 delta_degC", (90.0, 70.0, "degC"),
         "t out 90 °C is above t in + 30 K = 70 °C: not met"),
        ("p <= 231 GPa * psi", (300.0, 264.0, "MPa"), "p 300 MPa is above 231 GPa * psi = 264 MPa: not met"),
        ("1 - eps >= 0.05", (0.02, 0.05, "1"), "1 - eps = 0.02 is below 0.05: not met"),
        ("p <= 30 W/(m*K)", (40.0, 30.0, "W/(m*K)"), "p 40 W/(m·K) is above 30 W/(m·K): not met"),
    ],
)  # fmt: skip
def test_both_sides_of_a_sentence_are_in_words_with_printed_units(require, numbers, said):
    assert verdict_sentence(require, "not_met", numbers, misses=True, error_known=True, truth=None) == said


@pytest.mark.parametrize(
    ("truth", "named"),
    [("rigid film", True), ("balanced film", True), ("fine_field", False), ("finer sector", False),
     ("Swift-Stieber, shear all around", False)],
)  # fmt: skip
def test_a_verdict_names_a_model_and_no_other_solution_of_the_same_model(truth, named):
    said = verdict_sentence("h >= 3 um", "met", (4.0, 3.0, "um"), misses=False, error_known=True, truth=truth)
    assert said == "h 4 µm is not below 3 µm: met" + (f", {truth}" if named else "")


def test_a_sentence_is_about_the_case():
    assert sentence(of_film(1.53)) == "film 1.53 µm is below 3 µm: not met"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("film > 3 um", "syntax"),
        ("film == 3 um", "syntax"),
        ("film >= 3 um >= limit", "syntax"),
        ("film >= 3 um and limit >= 1 um", "syntax"),
        (">= 3 um", "syntax"),
        ("film >=", "syntax"),
        ("flim >= 3 um", "unknown_name"),
        ("film >= 3 kN", "unit_mismatch"),
        ("film >= 3", "unit_mismatch"),
        ("film + load >= 3 um", "unit_mismatch"),
        ({"require": "film >= p", "limits": {"p": {"unit": "um"}, "q": {"unit": "um"}}}, "unused_limit"),
        ({"require": "film >= load", "limits": {"load": {"unit": "um"}}}, "twice"),
        ({"require": "film >= p", "limits": {"p": {"unit": "kN"}}}, "unit_mismatch"),
        ({"require": "film >= p", "limits": {"p": {"unit": "glurk"}}}, "unknown_unit"),
        ({"demand": "film >= 3 um"}, "syntax"),
        ({"require": "film >= 3 um", "word": "x"}, "unknown_name"),
        ({"require": "film >= 3 um", "words": ""}, "syntax"),
        (3, "syntax"),
    ],
)
def test_a_bad_criterion_is_refused_with_its_reason(text, code):
    with pytest.raises(FaultyText) as refusal:
        read_criterion("film", text, KNOWN)
    assert refusal.value.code == code


LIMITED = {"unit": "um", "default": "max(film)"}
REASON = {"with": "load", "reason": "it has no end"}


def declared(limit=LIMITED, absent=None):
    raw = {"require": "film <= largest", "limits": {"largest": limit}}
    return read_criterion("thin", {**raw, "absent": absent} if absent else raw, KNOWN)


def test_a_limit_may_have_a_default_and_a_value_a_reason_for_its_absence():
    criterion = declared(absent={"film": REASON})
    assert criterion.limits[0].default == ("max", "film")
    assert criterion.limits[0].remedy == "give largest in um, or film"
    assert (criterion.absent["film"].beside, criterion.absent["film"].reason) == ("load", "it has no end")


@pytest.mark.parametrize(("limit", "absent", "message"), [
    ({"unit": "um", "default": "max(films)"}, None, "min.NAME. or max.NAME. of an input"),
    ({"unit": "um", "default": "mean(film)"}, None, "min.NAME. or max.NAME. of an input"),
    ({"unit": "um", "default": "max(load)"}, None, "a length"),
    ({"unit": "um", "default": 3}, None, "default must be a text"),
    (LIMITED, {"load": REASON}, "load"),
    (LIMITED, {"film": {**REASON, "with": "loads"}}, "loads"),
    (LIMITED, {"film": {"with": "load"}}, "reason"),
    (LIMITED, {"film": "it has no end"}, "reason"),
    (LIMITED, "no end", "objects keyed by name"),
])  # fmt: skip
def test_a_wrong_default_or_reason_is_refused_with_the_class(limit, absent, message):
    with pytest.raises(FaultyText, match=message):
        declared(limit, absent)
