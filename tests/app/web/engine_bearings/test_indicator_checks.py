"""A wrong indicator diagram is refused beside its field, and a right one states its assumptions."""

import pytest
from engine_fields import gas_table

from app.web.engine_bearings.gas import diagram_of
from templates.core.errors import FaultyText

WRONG = {
    "wrong_span": (gas_table(last=345), "a span of 345°; one cycle of four strokes has 720°"),
    "unpegged": (gas_table(lowest=-7.0), "the lowest pressure is -7 bar, taken as gauge"),
    "unpegged_high": (gas_table(lowest=12.0), "the lowest pressure is 12 bar, taken as absolute"),
    "shifted": (gas_table(peak_at=430.0), "the largest pressure is at 430°, 70° after dead centre"),
    "shifted_early": (gas_table(peak_at=350.0), "the largest pressure is at 350°, 10° before dead centre"),
    "wrong_count": (gas_table(last=600, step=120), "the table has 6 points; a cycle needs at least 8"),
    "wrong_count_of_pressures": (
        b"angle [deg];p1 [bar];p2 [bar]\n" + b"\n".join(b"%d;1;2" % a for a in range(0, 720, 10)),
        "the table has 2 columns of pressures (p1, p2)",
    ),
    "wrong_count_of_angles": (b"p [bar]\n1\n2\n3\n", "the table has 0 columns of crank angles"),
    "unreadable": (b"crank angle [deg];pressure [bar]\n0;1\n5;x\n", "line 3"),
}


@pytest.mark.parametrize("code", WRONG)
def test_a_wrong_diagram_is_refused_with_its_numbers(code):
    table, words = WRONG[code]
    with pytest.raises(FaultyText) as refusal:
        diagram_of(table)
    assert words in str(refusal.value)
    assert code.startswith(refusal.value.code)


def test_a_right_diagram_states_what_was_assumed():
    diagram = diagram_of(gas_table(first=-360, last=360, peak_at=12, lowest=0.9))
    assert (diagram.angles[0], diagram.angles[-1], len(diagram.angles)) == (0, 715, 144)
    assert not diagram.is_gauge
    said = " ".join(diagram.assumed)
    assert "absolute pressures, because the lowest is 0.9 bar" in said
    assert "largest pressure 10° after dead centre" in said
    assert "combustion moved from 0° to 360°" in said


def test_property_the_table_in_the_form_is_read_as_the_same_diagram():
    diagram = diagram_of(gas_table(lowest=-0.2))
    again = diagram_of(diagram.text.encode())
    assert (again.angles, again.is_gauge) == (diagram.angles, True)
    assert again.pressures == pytest.approx(diagram.pressures, abs=1e-9)
