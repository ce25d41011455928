"""Lines of a design: its values are names in formulas, plots join two, and hostile texts are refused."""

import pickle
import time

import pytest

from templates.core.language.evaluate import evaluate
from templates.core.sheets import DesignName, SheetRefused, read
from templates.core.sheets.sheet import from_text

DESIGN = (
    DesignName("film.thickness", "um", "um", "thickness"),
    DesignName("film.load", "N", "N", "load", axis="film.angle"),
    DesignName("film.angle", "deg", "deg", "angle", axis="film.angle"),
    DesignName("film.speed", "rpm", "rpm", "speed", turned=("film.speed",)),
    DesignName("T", "degC", "degC", "oil temperature"),
    DesignName("clearance", "um", "um", "clearance"),
)


def calculated(text, **inputs):
    cls = from_text(text, "worksheet", 1, None, DESIGN)
    return evaluate(cls, inputs).outputs


def refusal(text):
    with pytest.raises(SheetRefused) as refused:
        read(text, DESIGN)
    return refused.value.faults


def test_values_of_the_design_are_inputs_under_their_names():
    cls = from_text('r [1] = film.thickness / clearance "ratio"', "worksheet", 1, None, DESIGN)
    assert list(cls.inputs) == ["film_thickness", "clearance"]  # only those that a line uses
    answer = evaluate(cls, {"film_thickness": "3 um", "clearance": "60 um"}).outputs["ratio"]
    assert answer.value == pytest.approx(0.05)
    assert pickle.loads(pickle.dumps(cls)) is cls


def test_a_result_may_have_the_words_of_a_value_of_the_design():
    text = 'c [um] = clearance + 1 um "clearance"\ncheck clearance >= 2 um "not closed"'
    cls = from_text(text, "worksheet", 1, None, DESIGN)
    assert set(cls.inputs) == {"clearance_of_design"}
    assert cls.criteria["not_closed"]["require"] == "clearance_of_design >= 2 um"


def test_temperatures_and_turns_keep_their_rules():
    assert calculated('d [delta_degC] = T - 20 degC "rise"', t="80 degC")["rise"].value == pytest.approx(60)
    (fault,) = refusal('d [1] = T / 20 degC "ratio"')
    assert fault.code == "unit_mismatch"
    (fault,) = refusal('n [Hz] = film.speed "turns"')
    assert fault.code == "unit_mismatch"
    cls = from_text('n [1/s] = film.speed * 1 "turns"', "worksheet", 1, None, DESIGN)
    assert [one.code for one in evaluate(cls, {"film_speed": "60 rpm"}).warnings] == ["turns"]


def test_lists_keep_their_axis():
    text = 'w [N] over film.angle = film.load * 2 "twice"\nm [N] = max(w) "largest"\nplot w over film.angle'
    answer = calculated(
        text, film_load={"value": [1, 2, 3], "unit": "N"}, film_angle={"value": [0, 1, 2], "unit": "deg"}
    )
    assert list(answer["twice"].value) == [2, 4, 6]
    assert answer["largest"].value == 6
    (fault,) = refusal('m [N] = film.load "load itself"')
    assert fault.code == "axis_mismatch"
    (fault,) = refusal("plot film.load over clearance")
    assert (fault.code, fault.line, fault.column) == ("axis_mismatch", 1, 21)


def test_a_worksheet_of_a_team_has_no_plots_and_may_name_a_quantity_plot():
    with pytest.raises(SheetRefused, match="only the worksheet of a design draws plots"):
        read('p [1] = 1 "a"\nplot p over p')
    assert read('plot [mm] = 3 mm "a length"').names[0].name == "plot"


def test_the_digest_follows_the_lines_and_the_values_that_they_use():
    text = 'r [1] = film.thickness / 1 um "ratio"'
    other = tuple(DesignName(n.name, "mm", "mm", n.words) if n is DESIGN[0] else n for n in DESIGN)
    assert read(text, DESIGN).digest() == read(f"// a remark\n{text}", DESIGN).digest()
    assert read(text, DESIGN).digest() != read(text, other).digest()
    assert read(text, DESIGN).digest() == read(text, DESIGN[:1]).digest()


def long_text(lines):
    return "\n".join(f'a{n} [um] = clearance * {n} + film.thickness "line {n}"' for n in range(lines))


def test_the_time_is_linear_in_the_lines_and_500_lines_are_refused_at_once():
    assert [fault.code for fault in refusal(long_text(500))] == ["too_large"]
    read(long_text(400), DESIGN)  # the parser caches its tables
    least = {count: min(seconds(count, turn) for turn in range(3)) for count in (100, 400)}
    assert least[400] < 4 * 3 * least[100]


def seconds(count, turn):
    """Processor time of reading so many lines, which no earlier call has read."""
    text = long_text(count).replace("line", f"row {count} {turn}")
    begun = time.process_time()
    read(text, DESIGN)
    return time.process_time() - begun


@pytest.mark.parametrize(
    "text",
    [
        'p [1] = film.__class__ "x"',
        'p [1] = __import__("os") "x"',
        'p [1] = film.thickness.real "x"',
        'p [um] = design film thickness "x"',
        'p [1] = "design clearance" "x"',
        "plot film over clearance",
        "plot (clearance) over clearance",
        "plot clearance over clearance over clearance",
        "\x00",
        'p [1] = ' + "abs(" * 300 + "1" + ")" * 300 + ' "x"',
    ],
)  # fmt: skip
def test_a_hostile_line_is_refused_with_its_place(text):
    faults = refusal(text)
    assert all(fault.line == 1 and fault.column >= 1 and fault.message for fault in faults)
